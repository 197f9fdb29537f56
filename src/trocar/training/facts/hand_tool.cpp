#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const interactions::KindOfTool& k : interactions::kToolKinds) names.emplace_back(k.name);
  return names;
}

Value has(const Look& look, const Arguments& a) {
  return a[1].word == about(look.model.tool(look.state, size_t(a[0].index)).kind).name;
}
Value clips_left(const Look& look, const Arguments& a) {
  if (!look.model.tool(look.state, size_t(a[0].index)).can().set_clips) return kUnknown;
  return double(look.state.tools[size_t(a[0].index)].clips_left);
}

}  // namespace

const Fact kHandHas{
    "hand.has",
    {{"hand", ArgumentKind::hand, "which"}, {"kind", ArgumentKind::word, "of instrument", true, 0, 0, kinds()}},
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
