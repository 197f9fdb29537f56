// Curves described otherwise: more knots, fewer knots, higher degree, in parts, turned round. Only without_knot and
// reduced may change the shape, by no more than they are allowed.
//
//   Curve finer = inserted(curve, 0.3);                     // through its new control points the same curve
//   auto [front, back] = split(curve, 0.5);
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>

namespace trocar::geometry::nurbs {

Curve inserted(const Curve& curve, double u, int times = 1);         ///< [PT97 A5.1]
Curve refined(const Curve& curve, const std::vector<double>& more);  ///< [PT97 A5.4]
Curve elevated(const Curve& curve, int times = 1);                   ///< [PT97 A5.9]
Curve reversed(const Curve& curve);
Curve opened(const Curve& curve, double u);  ///< a periodic curve as a clamped one from u on
inline Curve opened(const Curve& curve) { return opened(curve, curve.knots.start()); }
Curve part(const Curve& curve, double a, double b);           ///< a < b; periodic: also b beyond the end
std::pair<Curve, Curve> split(const Curve& curve, double u);  ///< a clamped curve inside of its domain
/// a, and on from its end b, which starts there (1e-9 m); degrees are made equal. Both clamped.
Curve joined(const Curve& a, const Curve& b);
Curve on_domain(const Curve& curve, double start, double end);
Curve moved(const Curve& curve, const Mat3d& turn, Vec3d shift);  ///< x -> turn x + shift

/// The curve with u as a knot once less if no point of it moves by more than `tolerance` [m] for that.  [PT97 A5.8]
std::optional<Curve> without_knot(const Curve& curve, double u, double tolerance);
/// All knots gone that can go, each within the tolerance; the curve is off by at most that times their number.
Curve without_needless_knots(const Curve& curve, double tolerance);
/// The curve of one degree less, if no point of it moves by more than `tolerance` [m] for that.  [PT97 A5.11]
std::optional<Curve> reduced(const Curve& curve, double tolerance);

/// How far weighted control points may move so that no point of the curve moves by more than `tolerance` [m].
/// [PT97 eq.5.30]
double weighted_tolerance(const std::vector<Vec3d>& points, const std::vector<double>& weights, double tolerance);

}  // namespace trocar::geometry::nurbs
