#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

Value pull(const Snapshot& snapshot, const Arguments& a) {
  const interactions::ToolState& tool = snapshot.state.tools[size_t(a[0].index)];
  return tool.holds > 0 ? Value(norm(tool.pull)) : kUnknown;
}
Value pinch(const Snapshot& snapshot, const Arguments& a) {
  const interactions::ToolState& tool = snapshot.state.tools[size_t(a[0].index)];
  return tool.holds > 0 ? Value(tool.pinch) : kUnknown;
}
Value contact(const Snapshot& snapshot, const Arguments& a) {
  return norm(snapshot.state.tools[size_t(a[0].index)].contact_force);
}

}  // namespace

const Fact kHandPull{"hand.pull_N",
                     {{"hand", ArgumentKind::hand, "whose jaws"}},
                     0,
                     1000,
                     "Pull of the grasped tissue on the jaws. Unknown while the jaws hold nothing.",
                     anywhere,
                     &stateless<pull>};
const Fact kHandPinch{"hand.pinch_N",
                      {{"hand", ArgumentKind::hand, "whose jaws"}},
                      0,
                      1000,
                      "Force between the jaws. Unknown while the jaws hold nothing.",
                      anywhere,
                      &stateless<pinch>};
const Fact kHandContact{"hand.contact_N",
                        {{"hand", ArgumentKind::hand, "whose instrument"}},
                        0,
                        1000,
                        "Contact force of tissue on the instrument.",
                        anywhere,
                        &stateless<contact>};

}  // namespace trocar::training
