// The single formulas behind metrics.hpp, on plain arrays, so that each can be tested alone. docs/guides/metrics.md
// names their sources.
#pragma once

#include <span>

#include <trocar/training/metrics/metrics.hpp>

namespace trocar::training {

/// One hand's motion after the low-pass filter, at every sample of the trace.
struct Motion {
  std::vector<Vec3d> tip;
  std::vector<Quatd> orientation;  ///< unit, signs continuous
  std::vector<double> speed;       ///< central differences, one-sided at the ends [m/s]
};
Motion filtered_motion(const TraceHand& hand, double rate);

/// Points after the same filter, and how fast they move.
struct PointMotion {
  std::vector<Vec3d> place;
  std::vector<double> speed;  ///< [m/s]
};
PointMotion filtered_points(std::vector<Vec3d> place, double rate);

double path_length(std::span<const Vec3d> tip);
/// Sum of the angles between neighbours; 2 atan2(|v|, |w|) of the turn between them, which is 2 acos(|q . q'|) without
/// its loss of digits at small angles.
double angular_path(std::span<const Quatd> orientation);

/// Axial coordinate: sum of the steps' parts along the shaft (mean direction of both samples).
std::vector<double> axial_coordinate(std::span<const Vec3d> tip, std::span<const Quatd> orientation);
/// Sizes of the above's steps, summed.
double depth_travel(std::span<const double> axial);
/// Samples at which the coordinate turns back by more than `least` after having advanced by more than `least`.
std::vector<std::size_t> reversals(std::span<const double> axial, double least);

/// sqrt(T^5 / (2 L^2) * integral of |p'''|^2 dt), T = (n - 1) / rate, third differences.
double mean_jerk(std::span<const Vec3d> tip, double rate);

/// Per sample: 1 where it belongs to a run of at least kIdleTime in which all `speeds` are below kIdleSpeed.
std::vector<char> idle_samples(std::span<const std::span<const double>> speeds, double rate);

double pearson(std::span<const double> a, std::span<const double> b);

/// @param force  none: not measured, all NaN
/// @param limit  of time above it [N]
ForceMetrics force_metrics(std::span<const Vec3d> force, double rate, double limit);

}  // namespace trocar::training
