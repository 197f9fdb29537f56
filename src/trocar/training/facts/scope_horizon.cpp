#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/horizon.hpp>

namespace trocar::training {
namespace {

Value horizon(const Snapshot& snapshot, const Arguments&) {
  const std::optional<double> angle = horizon_of(snapshot.model, snapshot.state);
  return angle ? Value(*angle) : kUnknown;
}

}  // namespace

const Fact kScopeHorizon{"scope.horizon_deg",
                         {},
                         -180,
                         180,
                         "Rotation of the picture from upright, positive to the right. Unknown while the scope "
                         "points straight up or down.",
                         anywhere,
                         &stateless<horizon>};

}  // namespace trocar::training
