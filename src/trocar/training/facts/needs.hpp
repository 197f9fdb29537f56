// What a scene lacks for facts and events, in words for people; empty: nothing.
#pragma once

#include <algorithm>
#include <string_view>

#include <trocar/sim/model/model.hpp>

namespace trocar::training {

inline std::string_view needs_energy(const sim::Model& model) { return model.energy.there ? "" : "energy"; }
inline std::string_view needs_fluids(const sim::Model& model) { return model.wet.there ? "" : "fluids"; }

inline std::string_view needs_bleeder(const sim::Model& model) {
  return model.vessels.bleeder.vessel >= 0 ? "" : "bleeder";
}

/// Is there an instrument in the hand's rack that can do that?
inline bool can_take(const sim::HandModel& hand, bool interactions::Abilities::*can) {
  return std::any_of(hand.rack.begin(), hand.rack.end(),
                     [can](const interactions::ToolModel& tool) { return tool.can().*can; });
}
/// `what`, where no hand can take an instrument that can do that: "a clip applier".
inline std::string_view unless_there_is(const sim::Model& model, bool interactions::Abilities::*can,
                                        std::string_view what) {
  const auto takes = [can](const sim::HandModel& hand) { return can_take(hand, can); };
  return std::any_of(model.hands.begin(), model.hands.end(), takes) ? "" : what;
}
inline std::string_view needs_applier(const sim::Model& model) {
  return unless_there_is(model, &interactions::Abilities::set_clips, "a clip applier");
}
inline std::string_view needs_scissors(const sim::Model& model) {
  return unless_there_is(model, &interactions::Abilities::cut, "scissors");
}
inline std::string_view needs_grip(const sim::Model& model) {
  return unless_there_is(model, &interactions::Abilities::grip, "an instrument that grips");
}
inline std::string_view needs_current(const sim::Model& model) {
  if (!model.energy.there) return needs_energy(model);
  return unless_there_is(model, &interactions::Abilities::coagulate, "an electrode");
}
inline std::string_view needs_syringe(const sim::Model& model) {
  return model.injection.there() ? "" : "an injection needle";
}
inline std::string_view needs_sling(const sim::Model& model) {
  const auto& list = model.objects.sutures.list;
  const auto sling = [](const interactions::SutureModel& m) { return m.sling.there(); };
  return std::any_of(list.begin(), list.end(), sling) ? "" : "a sling";
}
/// Nothing can be exchanged where every rack holds one instrument.
inline std::string_view needs_choice(const sim::Model& model) {
  const auto choice = [](const sim::HandModel& hand) { return hand.rack.size() > 1; };
  return std::any_of(model.hands.begin(), model.hands.end(), choice) ? "" : "a rack of several instruments";
}

}  // namespace trocar::training
