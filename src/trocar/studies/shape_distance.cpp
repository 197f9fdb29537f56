#include <algorithm>
#include <cmath>

#include <trocar/studies/shape_distance.hpp>

namespace trocar::studies {

using namespace kinematics;

PlacedShape placed(const BodyShape& s, const Pose& pose) noexcept {
  const Frame& f = pose.frames[std::size_t(s.body)];
  if (s.kind == ShapeKind::box) return {true, f * s.from, 0.5 * s.to, 0, f.r * s.turn};
  return {false, f * s.from, f * s.to, s.radius, Mat3d::identity()};
}

double segment_distance(Vec3d a, Vec3d b, Vec3d c, Vec3d d) noexcept {
  const Vec3d u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const auto share = [](double top, double bottom) { return bottom > 0 ? std::clamp(top / bottom, 0.0, 1.0) : 0.0; };
  const double sine = uu * vv - uv * uv;
  double s = sine > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / sine, 0.0, 1.0) : 0;
  double t = share(uv * s + vw, vv);
  s = share(uv * t - uw, uu);
  t = share(uv * s + vw, vv);
  return length(w + s * u - t * v);
}

namespace {

/// From a point to a box's surface, below 0 inside: a convex function of the point.
double to_box(const PlacedShape& box, Vec3d p) noexcept {
  const Vec3d local = transposed(box.axes) * (p - box.a);
  Vec3d beyond;
  double deepest = -1e300;
  for (int k = 0; k < 3; ++k) {
    const double d = std::fabs(local[k]) - box.b[k];
    deepest = std::max(deepest, d);
    beyond[k] = std::max(d, 0.0);
  }
  return deepest > 0 ? length(beyond) : deepest;
}

/// The least of a segment's points: golden section, as the distance along it is convex [Kiefer 1953].
double segment_to_box(const PlacedShape& box, Vec3d from, Vec3d to) noexcept {
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double t) { return to_box(box, from + t * (to - from)); };
  double low = 0, high = 1, left = 1 - kGolden, right = kGolden;
  double f_left = at(left), f_right = at(right);
  for (int k = 0; k < 40; ++k)  // to 4e-9 of the segment
    if (f_left <= f_right) {
      high = right, right = left, f_right = f_left;
      left = high - kGolden * (high - low), f_left = at(left);
    } else {
      low = left, left = right, f_left = f_right;
      right = low + kGolden * (high - low), f_right = at(right);
    }
  return std::min({f_left, f_right, at(0), at(1)});
}

/// The least over the twelve edges of one box to the other.
double edges_to_box(const PlacedShape& edges, const PlacedShape& box) noexcept {
  double least = 1e300;
  for (int along = 0; along < 3; ++along)
    for (int corner = 0; corner < 4; ++corner) {
      Vec3d from = edges.b;
      from[(along + 1) % 3] *= corner & 1 ? -1 : 1;
      from[(along + 2) % 3] *= corner & 2 ? -1 : 1;
      Vec3d to = from;
      to[along] = -to[along];
      least = std::min(least, segment_to_box(box, edges.a + edges.axes * from, edges.a + edges.axes * to));
    }
  return least;
}

/// The widest gap of two boxes along any axis that could part them; below 0: how little a move parts them
/// [Gottschalk 1996].
double box_gap(const PlacedShape& a, const PlacedShape& b) noexcept {
  const Vec3d apart = b.a - a.a;
  double widest = -1e300;
  const auto look = [&](Vec3d axis) {
    const double size = length(axis);
    if (size < 1e-9) return;  // of parallel edges
    double reach = 0;
    for (int k = 0; k < 3; ++k)
      reach += a.b[k] * std::fabs(dot(a.axes.column(k), axis)) + b.b[k] * std::fabs(dot(b.axes.column(k), axis));
    widest = std::max(widest, (std::fabs(dot(apart, axis)) - reach) / size);
  };
  for (int i = 0; i < 3; ++i) {
    look(a.axes.column(i));
    look(b.axes.column(i));
    for (int k = 0; k < 3; ++k) look(cross(a.axes.column(i), b.axes.column(k)));
  }
  return widest;
}

}  // namespace

double clearance(const PlacedShape& first, const PlacedShape& second) noexcept {
  if (first.box && second.box) {
    const double gap = box_gap(first, second);
    return gap < 0 ? gap : std::min(edges_to_box(first, second), edges_to_box(second, first));
  }
  if (first.box) return segment_to_box(first, second.a, second.b) - second.radius;
  if (second.box) return segment_to_box(second, first.a, first.b) - first.radius;
  return segment_distance(first.a, first.b, second.a, second.b) - first.radius - second.radius;
}

}  // namespace trocar::studies
