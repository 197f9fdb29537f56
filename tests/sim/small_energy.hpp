// The small scene with a generator: a hook where the scissors were, bipolar forceps where the grasper was.
#pragma once

#include "small_scene.hpp"

namespace trocar::small {

inline constexpr int kBipolar = kGrasper, kHook = kScissors;
inline constexpr Vec3d kOnOrgan{-0.022, 0, 0.0118};  ///< of the hook's tip: 0.2 mm below the organ's top as drawn

inline scene::Description energy_description() {
  scene::Description d = description();
  scene::Instrument bipolar = d.instruments[kGrasper], hook = instrument("hook", interactions::ToolKind::hook);
  bipolar.name = "bipolar";
  bipolar.kind = interactions::ToolKind::bipolar;
  hook.jaw_length = 0.012;
  hook.jaw_width = 0.0015;
  hook.jaw_thickness = 0.0012;
  hook.opening = 0;
  hook.pinch_max = 0;
  d.instruments.push_back(bipolar);
  d.instruments.push_back(hook);
  d.placements[kBipolar].instrument = "bipolar";
  d.placements[kHook].instrument = "hook";
  d.energy = scene::EnergySetting{};
  return d;
}

inline const sim::Model& energy() {
  static const sim::Model compiled = scene::compile(energy_description());
  return compiled;
}

/// The hook from where it hangs down to the organ's top, and a little into it.
inline void put_hook_down(Table& t) {
  t.carry(kHook, {0.026, 0.02, 0.05}, {-0.022, 0, 0.030}, 0.25);
  t.carry(kHook, {-0.022, 0, 0.030}, kOnOrgan, 0.1);
  t.steps(100);
}

}  // namespace trocar::small
