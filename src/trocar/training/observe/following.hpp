// Following a strand from one of its landmarks back to its beginning, with the eye or with an instrument's tip: how a
// tube is distinguished from the ligaments beside it, from its fimbriae to the uterus. The followed place moves along
// the strand no faster than an eye can, over what is in view or near a tip; a short covered stretch is skipped; lost
// for too long, it starts over at the landmark.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// What counts as following, in SI.
struct FollowingLimits {
  double to = 0;     ///< arc length up to which it has to be followed
  double speed = 0;  ///< no faster than this
  double gap = 0;    ///< a covered stretch that may be skipped
  double pause = 0;  ///< lost longer than this, it starts over
  double touch = 0;  ///< a tip this near follows as well as the eye
};

class Following {
 public:
  Following() = default;
  /// @param from  a landmark of that strand
  Following(const FollowingLimits& limits, const sim::Model& model, int strand, const std::string& from);

  /// Once a sample. @param tips  of instruments that are in the body; @param dt  since the last call [s]
  void update(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt);

  bool done() const { return m_done; }
  bool begun() const { return m_front >= 0; }
  double reached() const;  ///< arc length of the followed place [m]; that of the landmark before it has begun

 private:
  bool followed(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, int sample) const;

  FollowingLimits m_limits;
  int m_strand = -1, m_target = -1, m_from = -1;
  std::vector<double> m_arc;  ///< of the trace's samples, rising [m]
  int m_first = 0;            ///< sample at the landmark, where following begins
  int m_front = -1;
  double m_credit = 0, m_lost_for = 0;
  bool m_done = false;
};

}  // namespace trocar::training
