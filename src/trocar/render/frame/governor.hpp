// Keeps the picture at 20 images a second or more by lowering its quality, never the physics: things get coarser at
// shorter distances first (nobody sees it), then resolution goes, then effects. Steps down when several frames were
// late, as far as it predicts to be necessary but not far at a time; steps up only after a calm while and only if the
// better level is predicted to fit; a step up that failed is not tried again for longer and longer.
//
//   Governor governor;
//   frame.quality = governor.quality();
//   ... draw, measure ...
//   governor.frame_took(seconds);
#pragma once

#include <cstddef>
#include <span>

#include <trocar/render/frame/frame.hpp>

namespace trocar::render {

/// Best first.
std::span<const Quality> quality_levels();
/// Where to begin: with the best, or, where processors draw, where two of them get along; it goes up if there is room.
std::size_t first_level(bool on_processors);

class Governor {
 public:
  struct Limits {
    double late = 1.0 / 21;   ///< [s] a frame slower than this is late
    double roomy = 1.0 / 26;  ///< [s] step up only if the better level is predicted below this
    int late_frames = 4;      ///< this many late ones in the last 8: step down
    int calm_frames = 60;     ///< frames without step before a step up is considered
  };
  Governor() : Governor(Limits{}) {}
  explicit Governor(Limits limits, std::size_t start_level = 0);

  /// @param seconds  time the last frame took, on the clock that counts for the user; ignored unless finite and > 0
  /// @param crowds   it took processors that a simulation needs to keep real time: late, however quick it was
  void frame_took(double seconds, bool crowds = false);
  /// What a frame is to cost at one quality has become another: more pictures in it, or fewer. It goes down at once
  /// where that would be late, and may come up again without waiting for mistakes of another load.
  /// @param load  beside one picture over the whole window, > 0
  void load_becomes(double load);
  Quality quality() const { return quality_levels()[m_level]; }
  std::size_t level() const { return m_level; }

 private:
  void step_to(std::size_t level);
  std::size_t level_that_fits() const;
  double predicted(std::size_t level) const;  ///< [s] a frame

  Limits m_limits;
  std::size_t m_level = 0;
  double m_mean = 0;       ///< [s] smoothed frame time at this level; 0 = unknown
  unsigned m_history = 0;  ///< bit per frame: late
  int m_since_step = 0;
  int m_patience;  ///< frames to wait before stepping up; doubles after a failed step up
  double m_load = 1;
  bool m_came_up = false;
};

}  // namespace trocar::render
