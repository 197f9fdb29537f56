#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value in_view(const Moment& moment, const Arguments& a) { return sim::visible(moment.model, moment.state, a[0].index); }
Value share(const Moment& moment, const Arguments& a) {
  return sim::visible_share(moment.model, moment.state, a[0].index);
}

}  // namespace

const Fact kMarkInView{"mark.in_view",
                       {{"of", ArgumentKind::mark, "what is looked for"}},
                       0,
                       1,
                       "At least half of its samples are in the picture and nothing is before them.",
                       anywhere,
                       &stateless<in_view>,
                       true};
const Fact kMarkVisibleShare{"mark.visible_share",
                             {{"of", ArgumentKind::mark, "what is looked for"}},
                             0,
                             1,
                             "The share of its samples that are in the picture with nothing before them.",
                             anywhere,
                             &stateless<share>};

}  // namespace trocar::training
