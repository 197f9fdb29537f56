#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

Value pull(const Moment& moment, const Arguments& a) {
  const interactions::ToolState& tool = moment.state.tools[size_t(a[0].index)];
  return tool.holds > 0 ? Value(norm(tool.pull)) : kUnknown;
}
Value pinch(const Moment& moment, const Arguments& a) {
  const interactions::ToolState& tool = moment.state.tools[size_t(a[0].index)];
  return tool.holds > 0 ? Value(tool.pinch) : kUnknown;
}
Value contact(const Moment& moment, const Arguments& a) {
  return norm(moment.state.tools[size_t(a[0].index)].contact_force);
}

}  // namespace

const Fact kHandPull{"hand.pull_N",
                     {{"hand", ArgumentKind::hand, "whose jaws"}},
                     0,
                     1000,
                     "What the held tissue pulls at the jaws. Unknown while they hold nothing.",
                     anywhere,
                     &stateless<pull>};
const Fact kHandPinch{"hand.pinch_N",
                      {{"hand", ArgumentKind::hand, "whose jaws"}},
                      0,
                      1000,
                      "The force between the jaws. Unknown while they hold nothing.",
                      anywhere,
                      &stateless<pinch>};
const Fact kHandContact{"hand.contact_N",
                        {{"hand", ArgumentKind::hand, "whose instrument"}},
                        0,
                        1000,
                        "What tissue that it touches presses on the instrument.",
                        anywhere,
                        &stateless<contact>};

}  // namespace trocar::training
