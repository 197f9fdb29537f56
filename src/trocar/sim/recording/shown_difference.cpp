#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/shown_difference.hpp>

namespace trocar::sim {

std::string shown_difference(const Model& model, const std::vector<std::uint8_t>& keyframe, const State& state) {
  State recorded = state, now = state;  // both through a keyframe, so that only what it holds can differ
  if (!restore_display(model, keyframe, recorded)) return kDoesNotFit;
  if (!restore_display(model, display_bytes(model, state), now)) return {};
  return first_difference(recorded, now);
}

std::string told_difference(const Model& model, const Recording& recording, const State& state) {
  for (const Keyframe& key : recording.keyframes) {
    if (key.tick != state.tick) continue;
    const std::string shown = shown_difference(model, key.bytes, state);
    if (shown == kDoesNotFit) return {};
    return shown.empty() ? "the displayed state does not differ there"
                         : "the displayed state differs first in " + shown;
  }
  return {};
}

}  // namespace trocar::sim
