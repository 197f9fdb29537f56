#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

Value straightness(const Snapshot& snapshot, const Arguments& a) {
  const size_t i = size_t(a[0].index);
  double to = snapshot.model.strand_bodies[i].arc.back();
  for (const sim::LandmarkModel& l : snapshot.model.strands[i].landmarks)
    if (a[1].given && l.name == a[1].word) to = l.to;
  return straightness_of(snapshot.model, snapshot.state, a[0].index, to);
}

Value severed(const Snapshot& snapshot, const Arguments& a) {
  for (const std::uint8_t alive : snapshot.state.strands[size_t(a[0].index)].alive)
    if (!alive) return true;
  return false;
}

}  // namespace

const Fact kStrandStraightness{"strand.straightness",
                               {{"of", ArgumentKind::strand, "which"},
                                {"to", ArgumentKind::landmark,
                                 "landmark at whose end the measured part ends; without it: the whole strand", false}},
                               0,
                               1,
                               "Ratio of chord to length of the strand from its start, or of the part "
                               "before a cut; 1 is straight.",
                               anywhere,
                               &stateless<straightness>};
const Fact kStrandSevered{"strand.severed",
                          {{"of", ArgumentKind::strand, "which"}},
                          0,
                          1,
                          "The strand is divided by a cut or a tear.",
                          anywhere,
                          &stateless<severed>,
                          true};

}  // namespace trocar::training
