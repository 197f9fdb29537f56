// What errors of dimensions do to a quantity at a pose: slopes, their worst and their likely sum, and samples of
// mechanisms as they may be made (Monte Carlo), each closed again.
//
//   const ToleranceStudy study(m, handles, {MeasuredKind::along, tip, -1, {1, 0, 0}}, everywhere(m, 1e-5, 0));
//   study.linear().ranked[0];                                   // the dimension that matters most
//   std::vector<double> values(100'000);
//   study.sample(seed, 0, values, &pool);
//   const Statistics s = statistics(values, study.linear().nominal, limits);
//
// A sample's errors follow from the seed and the sample's number alone, and statistics are taken of all values in their
// order: any number of threads or machines gives the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/parallel.hpp>
#include <trocar/kinematics/loops/close.hpp>

namespace trocar::studies {

enum class MeasuredKind : unsigned char {
  along,     ///< place of a frame along a direction [m]
  distance,  ///< between two frames' origins [m]
  turn       ///< how far a frame has turned about a direction from where it stands as described [rad]
};

struct Measured {
  MeasuredKind kind = MeasuredKind::along;
  int frame = 0;      ///< of the mechanism
  int from = -1;      ///< seen from this frame's origin (along, distance), from its axes (turn); -1: from the ground
  Vec3d direction{};  ///< unit; in the ground's axes (along), in those of `from` (turn)
};
/// @param nominal  the frame as it is seen from `from` without errors; only for turns
double measure(const kinematics::Mechanism& m, const Measured& what, const kinematics::Pose& pose,
               const kinematics::Frame& nominal) noexcept;

/// A parameter's error, within plus or minus [m, rad, 1].
struct Toleranced {
  int parameter = 0;
  double plus_minus = 0;
};
/// Every dimension that places depend on (shapes do not count), lengths by `length`, angles by `angle`; where that is
/// 0, by what the file says, if anything.
std::vector<Toleranced> everywhere(const kinematics::Mechanism& m, double length, double angle);

enum class Distribution : unsigned char {
  normal,  ///< a third of plus_minus is the standard deviation
  uniform
};

struct Sensitivity {
  int parameter = 0;
  double plus_minus = 0;
  double slope = 0;  ///< d quantity / d parameter
  double share = 0;  ///< of the variance
  double effect() const noexcept { return slope * plus_minus; }
};

/// The first-order answer.
struct LinearTolerance {
  double nominal = 0;
  std::vector<Sensitivity> ranked;  ///< the largest effect first
  double worst = 0;                 ///< sum of |slope| plus_minus
  double rss = 0;                   ///< root of the sum of squares of slope plus_minus
  double deviation = 0;             ///< standard, for the distribution
};

/// A dimension that cannot change alone, as the loops would stand open: play takes it up, or it strains the parts.
struct Misfit {
  int parameter = 0;
  double gap = 0;  ///< of the loops, at a change by plus_minus [m]; of angles [rad]
};

class ToleranceStudy {
 public:
  /// @param handles (drives) where the drives stand
  /// @throws std::invalid_argument where the pose does not close, is singular or beyond limits, or drives leave a
  /// freedom open
  ToleranceStudy(const kinematics::Mechanism& m, std::span<const double> handles, const Measured& what,
                 const std::vector<Toleranced>& tolerances, Distribution distribution = Distribution::normal);

  const LinearTolerance& linear() const noexcept { return m_linear; }
  const std::vector<Misfit>& misfits() const noexcept { return m_misfits; }
  const kinematics::Mechanism& mechanism() const noexcept { return m; }

  /// Values of samples first, first + 1, ...; NaN where the loops stay open. @param pool  null: on this thread
  void sample(std::uint64_t seed, std::int64_t first, std::span<double> values, core::ThreadPool* pool = nullptr) const;

 private:
  struct Lane;
  double value_with(Lane& lane) const noexcept;
  double slope_of(Lane& lane, const Toleranced& t, double& gap) const noexcept;
  void differentiate(const std::vector<Toleranced>& tolerances);

  kinematics::Mechanism m;
  std::vector<double> m_handles, m_start;  ///< m_start: the closed pose
  Measured m_what;
  Distribution m_distribution;
  int m_rank = -1;
  kinematics::Frame m_nominal;
  LinearTolerance m_linear;
  std::vector<Toleranced> m_varied;  ///< in the order of parameters: what samples draw
  std::vector<double> m_response;    ///< (varied x u_count) d u / d parameter: where samples are begun from
  std::vector<Misfit> m_misfits;
};

}  // namespace trocar::studies
