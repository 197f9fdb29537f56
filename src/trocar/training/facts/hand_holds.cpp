#include <algorithm>

#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

Value holds(const Snapshot& snapshot, const Arguments& a) {
  const interactions::ToolState& tool = snapshot.state.tools[size_t(a[0].index)];
  if (!a[1].given) return tool.holds > 0;
  return std::any_of(tool.hold, tool.hold + tool.holds, [&a](const interactions::Hold& h) {
    return std::find(a[1].bodies.begin(), a[1].bodies.end(), h.at.body) != a[1].bodies.end();
  });
}

Value held_at(const Snapshot& snapshot, const Arguments& a) {
  const double s = held_arc(snapshot.model, snapshot.state, size_t(a[0].index), a[1].index);
  return s >= 0 ? Value(s) : kUnknown;
}

Value holds_between(const Snapshot& snapshot, const Arguments& a) {
  const double s = held_arc(snapshot.model, snapshot.state, size_t(a[0].index), a[1].index);
  if (s < 0) return false;
  double from = 0, to = 1e9;
  for (const sim::LandmarkModel& l : snapshot.model.strands[size_t(a[1].index)].landmarks) {
    if (l.name == a[2].word) from = l.to;
    if (l.name == a[3].word) to = l.from;
  }
  return s >= from && s <= to;
}

}  // namespace

const Fact kHandHolds{"hand.holds",
                      {{"hand", ArgumentKind::hand, "whose jaws"},
                       {"any_of", ArgumentKind::bodies, "bodies; without it: any body", false}},
                      0,
                      1,
                      "The jaws hold one of these bodies.",
                      anywhere,
                      &stateless<holds>,
                      true};
const Fact kHandHeldAt{
    "hand.held_at_mm",
    {{"hand", ArgumentKind::hand, "whose jaws"}, {"strand", ArgumentKind::strand, "what they hold"}},
    0,
    1000,
    "Position of the jaws along the grasped strand, from its start. Unknown while they do not hold it.",
    anywhere,
    &stateless<held_at>};
const Fact kHandHoldsBetween{"hand.holds_between",
                             {{"hand", ArgumentKind::hand, "whose jaws"},
                              {"strand", ArgumentKind::strand, "what they hold"},
                              {"after", ArgumentKind::landmark, "landmark of the strand behind whose end"},
                              {"before", ArgumentKind::landmark, "landmark before whose beginning"}},
                             0,
                             1,
                             "The jaws hold the strand between two of its landmarks.",
                             anywhere,
                             &stateless<holds_between>,
                             true};

}  // namespace trocar::training
