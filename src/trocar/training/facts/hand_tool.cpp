#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const interactions::KindOfTool& k : interactions::kToolKinds) names.emplace_back(k.name);
  return names;
}

Value has(const Snapshot& snapshot, const Arguments& a) {
  return a[1].word == about(snapshot.model.tool(snapshot.state, size_t(a[0].index)).kind).name;
}
Value clips_left(const Snapshot& snapshot, const Arguments& a) {
  if (!snapshot.model.tool(snapshot.state, size_t(a[0].index)).can().set_clips) return kUnknown;
  return double(snapshot.state.tools[size_t(a[0].index)].clips_left);
}

std::string not_in_rack(const sim::Model& model, const Arguments& a) {
  const sim::HandModel& hand = model.hands[size_t(a[0].index)];
  std::string there;
  for (const interactions::ToolModel& tool : hand.rack) {
    if (a[1].word == about(tool.kind).name) return "";
    there += (there.empty() ? "" : ", ") + std::string(about(tool.kind).name);
  }
  return tr("expected a kind that the rack at the trocar \"{}\" holds ({}), got \"{}\"", hand.name, there, a[1].word);
}
std::string no_applier_in_rack(const sim::Model& model, const Arguments& a) {
  const sim::HandModel& hand = model.hands[size_t(a[0].index)];
  if (can_take(hand, &interactions::Abilities::set_clips)) return "";
  return tr("expected a hand with a clip applier, got \"{}\", which has none in its rack", hand.name);
}

}  // namespace

const Fact kHandHas{
    "hand.has",
    {{"hand", ArgumentKind::hand, "which"}, {"kind", ArgumentKind::word, "of instrument", true, 0, 0, kinds()}},
    0,
    1,
    "The instrument in this port is of that kind.",
    anywhere,
    &stateless<has>,
    true,
    not_in_rack};
const Fact kHandClipsLeft{"hand.clips_left",
                          {{"hand", ArgumentKind::hand, "hand that has a clip applier"}},
                          0,
                          1000,
                          "Number of clips in the magazine. Unknown while another instrument is in the port.",
                          anywhere,
                          &stateless<clips_left>,
                          false,
                          no_applier_in_rack};

}  // namespace trocar::training
