#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value in_view(const Snapshot& snapshot, const Arguments& a) {
  return sim::visible(snapshot.model, snapshot.state, a[0].index);
}
Value share(const Snapshot& snapshot, const Arguments& a) {
  return sim::visible_share(snapshot.model, snapshot.state, a[0].index);
}

}  // namespace

const Fact kMarkInView{"mark.in_view",
                       {{"of", ArgumentKind::mark, "the mark"}},
                       0,
                       1,
                       "At least half of the mark's sample points are visible in the picture.",
                       anywhere,
                       &stateless<in_view>,
                       true};
const Fact kMarkVisibleShare{"mark.visible_share",
                             {{"of", ArgumentKind::mark, "the mark"}},
                             0,
                             1,
                             "The share of the mark's sample points that are visible in the picture.",
                             anywhere,
                             &stateless<share>};

}  // namespace trocar::training
