#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value pool(const Moment& moment, const Arguments&) {
  return fluids::kM3PerPicolitre * double(at(moment.state.fluids.ledger, fluids::Place::kPool).total());
}

}  // namespace

const Fact kPoolVolume{"pool.volume_mL", {}, 0, 1e4, "What stands in the pool.", needs_fluids, &stateless<pool>};

}  // namespace trocar::training
