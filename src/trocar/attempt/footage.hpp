// The display keyframes of a recording as a moving picture: ten a second, and in between halfway. Shows what any
// version of the physics has recorded, and what a scrub passes before the exact State is there.
//
//   Footage footage(model, recording.keyframes);
//   draw(footage.at(12345));
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::attempt {

/// From `a` to `b`, 0 <= f <= 1: places and poses halfway, everything that jumps (clips, cuts, grips, instruments) as
/// in `a`. f = 0 gives a, f = 1 gives b. Both must be States of this Model.
void blend(const sim::Model& model, const sim::State& a, const sim::State& b, double f, sim::State& out);

class Footage {
 public:
  /// Keeps references to both. Keyframes that do not fit the Model end the footage; see sound().
  Footage(const sim::Model& model, const std::vector<sim::Keyframe>& keyframes);

  /// What it looked like after `tick` ticks, held still before the first and after the last keyframe. The reference
  /// lives until the next call.
  const sim::State& at(std::uint64_t tick);
  /// Ticks from the start that there are keyframes for; 0: none.
  std::uint64_t last() const { return m_count > 0 ? m_keyframes[m_count - 1].tick : 0; }
  std::size_t count() const { return m_count; }  ///< keyframes that may be shown
  bool empty() const { return m_count == 0; }
  /// False once a keyframe did not fit the scene as it is now.
  bool sound() const { return m_sound; }

 private:
  struct Shown {
    std::size_t index = ~std::size_t(0);
    sim::State state;
  };
  const Shown& shown(std::size_t index, const Shown* keep);

  const sim::Model& m_model;
  const std::vector<sim::Keyframe>& m_keyframes;
  std::size_t m_count = 0;
  bool m_sound = true;
  Shown m_cache[2];
  sim::State m_between;
};

}  // namespace trocar::attempt
