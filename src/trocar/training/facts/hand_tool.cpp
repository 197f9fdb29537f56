#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr const char* kKinds[] = {"grasper",           "clip_applier", "scissors", "probe",
                                  "suction_irrigator", "hook",         "bipolar"};

Value has(const Look& look, const Arguments& a) {
  return a[1].word == kKinds[size_t(look.model.tool(look.state, size_t(a[0].index)).kind)];
}
Value clips_left(const Look& look, const Arguments& a) {
  if (look.model.tool(look.state, size_t(a[0].index)).kind != interactions::ToolKind::clip_applier) return kUnknown;
  return double(look.state.tools[size_t(a[0].index)].clips_left);
}

}  // namespace

const Fact kHandHas{"hand.has",
                    {{"hand", ArgumentKind::hand, "which"},
                     {"kind", ArgumentKind::word, "of instrument", true, 0, 0, {std::begin(kKinds), std::end(kKinds)}}},
                    0,
                    1,
                    "The instrument in this trocar is of that kind.",
                    anywhere,
                    &stateless<has>,
                    true};
const Fact kHandClipsLeft{"hand.clips_left",
                          {{"hand", ArgumentKind::hand, "that has a clip applier"}},
                          0,
                          1000,
                          "Clips in its magazine. Unknown while another instrument is in the trocar.",
                          anywhere,
                          &stateless<clips_left>};

}  // namespace trocar::training
