// The thread's spin about its own axis: quasi-static, an angle an element. Internal to the step.
#pragma once

#include <trocar/suture/thread/thread.hpp>

namespace trocar::suture {

/// A hold's element whose director shall be `wanted`.
struct SpinHold {
  int element = 0;
  Vec3d wanted{0, 0, 0};
};

/// Twist at the nodes from the directors, near what it was.
void measure_twist(const ThreadModel& m, ThreadState& s, const ThreadWork& w) noexcept;

/// Turns all elements about themselves towards equilibrium of twist, bends that stay, friction and holds; friction's
/// strains follow.
void relax_spin(const ThreadModel& m, std::span<const SpinHold> holds, int self, int touching, ThreadState& s,
                ThreadWork& w) noexcept;

/// What twist does to the nodes, and the stiffness that goes with it, into the equations.
void add_twist(const ThreadModel& m, const ThreadState& s, ThreadWork& w) noexcept;

}  // namespace trocar::suture
