#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value tips_in_view(const Snapshot& snapshot, const Arguments& a) {
  return double(sim::jaw_tips_visible(snapshot.model, snapshot.state, a[0].index));
}

}  // namespace

const Fact kHandTipsInView{"hand.tips_in_view",
                           {{"hand", ArgumentKind::hand, "whose instrument"}},
                           0,
                           2,
                           "Number of the instrument's two jaw tips in view.",
                           anywhere,
                           &stateless<tips_in_view>};

}  // namespace trocar::training
