// Which elements of a thread are near each other or near an obstacle, which touch, and how hard. Internal to the step.
#pragma once

#include <trocar/suture/thread/thread.hpp>

namespace trocar::suture {

/// Pairs of elements nearer than `reach` between their axes, ordered, into work.near. Returns their number.
int find_near(const ThreadModel& m, const ThreadState& s, double reach, ThreadWork& w) noexcept;

/// Which of the first `near` of them touch, into work.self. Returns how many do; more than fit are left out and `full`
/// is set. `closest` becomes no more than the least distance of axes of those that touch.
int find_touching(const ThreadModel& m, const ThreadState& s, int near, ThreadWork& w, bool& full,
                  double& closest) noexcept;
/// Least distance of the axes of those first `self` that touched, as they lie now.
double closest_of(const ThreadState& s, int self, const ThreadWork& w) noexcept;

/// Elements that touch obstacles where those are seen, into work.touch. `radius` and `friction` of each come from
/// `given`.
int find_obstacles(const ThreadModel& m, const ThreadState& s, std::span<const Obstacle> given, ThreadWork& w,
                   bool& full) noexcept;

/// How the press of two things at rest `gap` apart grows with what they overlap.
void set_press(Touch& touch, double stiffness, double thickness, double gap) noexcept;

/// The largest share of `delta` at which no two elements come nearer than a part of their distance, nor a thread and an
/// obstacle (which moves by w.obstacle_moves).
/// @param most  that a node moves [m]
double safe_share(const ThreadModel& m, const ThreadState& s, int near, std::span<const Obstacle> given, double most,
                  ThreadWork& w) noexcept;

/// The share of its stiffness that something which yields at `bound` keeps in a solve: what makes its force right if it
/// goes as far as in the last (`reached`).
inline double kept_share(double bound, double reached) noexcept { return reached > bound ? bound / reached : 1; }

/// Friction's bound and stiffness in a solve.
inline void set_friction(Touch& touch, double friction, double rub_stiffness) noexcept {
  touch.bound = friction * touch.press / rub_stiffness;
  touch.rub_stiffness = touch.bound > 0 ? rub_stiffness * kept_share(touch.bound, touch.reached) : 0;
}

}  // namespace trocar::suture
