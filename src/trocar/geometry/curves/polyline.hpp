// Polylines by arc length: where the point at a given way along is, and the same line in equal steps.
//   const Polyline line(points);
//   for (Vec3d p : line.resampled(33)) ...     // 33 points, 32 equal lengths of way
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/curves/spline.hpp>

namespace trocar::geometry {

struct Polyline {
  std::vector<Vec3d> points;
  std::vector<double> arc;  ///< way from the first point [m]

  Polyline() = default;
  explicit Polyline(std::vector<Vec3d> line);

  double length() const noexcept { return arc.empty() ? 0.0 : arc.back(); }
  /// The point after the way s (clamped to the line; needs at least one point).
  Vec3d point(double s) const noexcept;
  /// `count` points (at least 2), the first and last included, in equal steps of way along the line. The chords are
  /// shorter than the steps where the line bends.
  std::vector<Vec3d> resampled(int count) const;
  /// As many as come nearest to the wished step, at least 2.
  std::vector<Vec3d> resampled_by_step(double step) const;
};

/// `count` points of the curve (at least 2) in equal steps of way; a periodic curve's end is not repeated.
std::vector<Vec3d> sampled_by_arc(const NurbsCurve& curve, int count);
/// The parameters of these points.
std::vector<double> arc_parameters(const NurbsCurve& curve, int count);
/// Length of the curve [m], from a dense polyline (relative error about 1e-5).
double length(const NurbsCurve& curve);

}  // namespace trocar::geometry
