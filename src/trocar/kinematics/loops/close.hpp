// Loops are closed by Gauss-Newton steps from where the mechanism stands, on conditions that may depend on each other:
// each step is the shortest of all that do equally well, found by a rank-revealing factorisation. Metres are measured
// by the mechanism's length, so that they and radians weigh alike.
//
//   LoopWork work(m);
//   std::vector<double> u = m.start_u();
//   hold(work, {crank});                               // stays as u says
//   const LoopReport report = close(m, u, work);       // the others follow
//   if (!report.closed()) say(words(m, report));
//
// From one closed pose to another, step by step, on the same branch:
//
//   const Branch branch = branch_at(m, u, work);
//   const MoveReport moved = move(m, u, {{crank, 2.1}}, branch, work);
//
// Limits are looked at last: a pose beyond them is closed, and the report says which coordinate is.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/numerics/pivoted_qr.hpp>

namespace trocar::kinematics {

struct LoopOptions {
  double tolerance = 1e-12;  ///< of the residual, in lengths of the mechanism and radians
  double singular = 1e-5;    ///< pivots below this say so
  int rank = -1;             ///< of the conditions where nothing is singular, if known (Branch); a lower one says so
  int iterations = 60;       ///< at most
};

/// Scratch, and which coordinates are held.
struct LoopWork {
  /// @param goals  how many conditions there may be beside the mechanism's own
  explicit LoopWork(const Mechanism& m, int goals = 0);
  Pose pose;
  std::vector<unsigned char> held;  ///< (u_count)
  std::vector<int> free;            ///< columns in use
  std::vector<double> r, slope;     ///< residuals, d r / d u, scaled
  std::vector<double> step, trial, minor;
  numerics::PivotedQr qr;
};
/// Holds these independent coordinates and frees all others.
void hold(LoopWork& work, std::span<const int> held) noexcept;
inline void hold(LoopWork& work, std::initializer_list<int> held) noexcept {
  hold(work, std::span<const int>(held.begin(), held.size()));
}
/// Holds what actuators drive.
void hold_drives(const Mechanism& m, LoopWork& work) noexcept;

enum class LoopStatus : unsigned char {
  closed,
  singular,      ///< closed, and at a dead point: what is held does not say how the rest continues
  out_of_reach,  ///< no pose nearby closes it
};

struct LoopReport {
  LoopStatus status = LoopStatus::closed;
  double metres = 0, radians = 0;  ///< the largest gap of a closure
  int unknowns = 0, conditions = 0, rank = 0;
  double pivot = 0;  ///< the smallest of the factorisation that counts, scaled; 0 where the rank is less
  int iterations = 0;
  int limit = -1;  ///< first coordinate (of q) that is beyond its limits
  bool closed() const noexcept { return status != LoopStatus::out_of_reach; }
  int redundant() const noexcept { return conditions - rank; }  ///< conditions that the others imply
  int idle() const noexcept { return unknowns - rank; }         ///< freedoms that neither loops nor drives hold
};

/// Closes all loops, and `goals` with them; u becomes the closed pose, or the nearest that was found.
LoopReport close(const Mechanism& m, std::span<double> u, LoopWork& work, const LoopOptions& options = {},
                 std::span<const Closure> goals = {}) noexcept;

/// "closed to 3.1e-14 m; 3 of 5 conditions are implied by the others (over-constrained but consistent)"
std::string words(const Mechanism& m, const LoopReport& report);

/// Which of a loop's assemblies one is on: the sign of a minor of the slopes, chosen where it is large.
struct Branch {
  std::vector<int> rows, columns;  ///< of d r / d u, as many as its rank there
  double there = 0;                ///< the minor where it was chosen
  int rank() const noexcept { return int(rows.size()); }
};
/// For the closed pose u and what is held there.
Branch branch_at(const Mechanism& m, std::span<const double> u, LoopWork& work);
/// The minor where close() has ended, divided by what it was where it was chosen: below 0 on another branch.
double branch_share(const Mechanism& m, const Branch& branch, LoopWork& work) noexcept;

struct Target {
  int independent = 0;  ///< a held one
  double value = 0;
};
struct MoveReport {
  LoopReport last;     ///< of the pose where it stands now
  double reached = 0;  ///< share of the way
  int steps = 0;
  bool singular = false;  ///< stopped at a dead point
  bool arrived() const noexcept { return reached >= 1; }
};
/// From a closed pose along a straight way of what is held, on the branch; stops before the loops come open or the
/// branch changes. u is then the last good pose.
MoveReport move(const Mechanism& m, std::span<double> u, std::span<const Target> targets, const Branch& branch,
                LoopWork& work, const LoopOptions& options = {});
inline MoveReport move(const Mechanism& m, std::span<double> u, std::initializer_list<Target> targets,
                       const Branch& branch, LoopWork& work, const LoopOptions& options = {}) {
  return move(m, u, std::span<const Target>(targets.begin(), targets.size()), branch, work, options);
}
std::string words(const Mechanism& m, const MoveReport& report);

}  // namespace trocar::kinematics
