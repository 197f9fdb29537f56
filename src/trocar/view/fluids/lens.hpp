// What is on the lens in a frame: fog from the simulation, a wipe while it lasts, and drops and smears that a splash
// has left. Drops and smears are looks only: the score knows nothing of them.
//
//   view::Lens lens;
//   lens.splash(0.7, {.blood = kMicrolitre}, tick);        // something hit the lens
//   lens.list(model.smoke, state.smoke, frame);            // each frame
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/fluids/mix.hpp>
#include <trocar/fluids/optics.hpp>
#include <trocar/fluids/smoke.hpp>
#include <trocar/render/frame/frame.hpp>

namespace trocar::view {

class Lens {
 public:
  /// Drops on the lens. @param strength 0 .. 1: how many and how large; @param seed any number, for variety
  void splash(double strength, const fluids::Mix& mix, std::uint32_t seed);
  /// Sets frame.look.soil. A wipe takes drops away and leaves a smear, which thins out with time.
  void list(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame);
  void clear();

 private:
  double since_last(std::uint64_t tick);

  std::vector<render::LensDrop> m_drops;
  double m_smear = 0;        ///< left by the last wipe
  double m_wipe_left = 0;    ///< of a wipe, in the last frame [s]
  std::uint64_t m_tick = 0;  ///< of the last frame
  Vec3f m_tint{1, 1, 1};
};

}  // namespace trocar::view
