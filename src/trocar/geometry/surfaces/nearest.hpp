// Closest points and ray hits between points, segments, triangles and capsules, in float or double. All of it holds for
// degenerate input (segments and triangles of no extent) and never divides by zero. Made for the step: noexcept, no
// allocation, + - * / sqrt only.
//   const auto hit = closest_segment_triangle(shaft_tip, shaft_end, a, b, c);
//   if (hit.distance2 < radius * radius) push(hit.on_triangle - hit.on_segment);
// [Ericson 2005, Real-Time Collision Detection, chapter 5] for the cases to tell apart; the arithmetic is our choice.
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

template <class T>
T distance2(Vec3<T> a, Vec3<T> b) noexcept {
  const Vec3<T> d = b - a;
  return dot(d, d);
}

/// Where on the segment ab (0 = a, 1 = b) lies the point closest to p; 0 for a segment of no length.
template <class T>
T closest_on_segment(Vec3<T> p, Vec3<T> a, Vec3<T> b) noexcept {
  const Vec3<T> ab = b - a;
  const T along = dot(p - a, ab), whole = dot(ab, ab);
  if (!(along > T(0))) return T(0);
  return along < whole ? along / whole : T(1);
}

template <class T>
struct TrianglePoint {
  Vec3<T> point;
  Vec3<T> weights;  ///< of the corners a, b, c; each >= 0, sum 1
  T distance2;      ///< to the point asked for
};

namespace detail {

// Weights of the foot of the perpendicular from p, where it falls inside the triangle; false where it does not, or
// where the triangle is thinner than rounding.
template <class T>
bool foot_inside(Vec3<T> p, Vec3<T> a, Vec3<T> b, Vec3<T> c, Vec3<T>& weights) noexcept {
  const Vec3<T> ab = b - a, ac = c - a, ap = p - a, n = cross(ab, ac);
  const T whole = dot(n, n), thin = T(sizeof(T) == 4 ? 1e-12 : 1e-26);
  if (!(whole > thin * dot(ab, ab) * dot(ac, ac))) return false;
  const T wb = dot(cross(ap, ac), n), wc = dot(cross(ab, ap), n), wa = whole - wb - wc;
  if (wa < T(0) || wb < T(0) || wc < T(0)) return false;
  weights = {wa / whole, wb / whole, wc / whole};
  return true;
}

}  // namespace detail

/// The same where the foot of the perpendicular from p falls inside the triangle, at a fraction of the cost.
/// @return whether it does
template <class T>
bool foot_on_triangle(Vec3<T> p, Vec3<T> a, Vec3<T> b, Vec3<T> c, TrianglePoint<T>& foot) noexcept {
  if (!detail::foot_inside(p, a, b, c, foot.weights)) return false;
  foot.point = a + foot.weights.y * (b - a) + foot.weights.z * (c - a);
  foot.distance2 = distance2(p, foot.point);
  return true;
}

template <class T>
TrianglePoint<T> closest_on_triangle(Vec3<T> p, Vec3<T> a, Vec3<T> b, Vec3<T> c) noexcept {
  TrianglePoint<T> best;
  if (detail::foot_inside(p, a, b, c, best.weights)) {
    best.point = a + best.weights.y * (b - a) + best.weights.z * (c - a);
    best.distance2 = distance2(p, best.point);
    return best;
  }
  const T s = closest_on_segment(p, a, b), t = closest_on_segment(p, b, c), u = closest_on_segment(p, c, a);
  const TrianglePoint<T> ab{a + s * (b - a), {T(1) - s, s, T(0)}, T(0)};
  const TrianglePoint<T> bc{b + t * (c - b), {T(0), T(1) - t, t}, T(0)};
  const TrianglePoint<T> ca{c + u * (a - c), {u, T(0), T(1) - u}, T(0)};
  best = ab;
  best.distance2 = distance2(p, ab.point);
  for (TrianglePoint<T> other : {bc, ca}) {
    other.distance2 = distance2(p, other.point);
    if (other.distance2 < best.distance2) best = other;
  }
  return best;
}

template <class T>
struct SegmentPair {
  T s, t;  ///< where on the first and on the second segment, 0 .. 1
  Vec3<T> on_first, on_second;
  T distance2;
};

/// Closest points of the segments p0 p1 and q0 q1. Parallel ones: one of the closest pairs.
template <class T>
SegmentPair<T> closest_segments(Vec3<T> p0, Vec3<T> p1, Vec3<T> q0, Vec3<T> q1) noexcept {
  const Vec3<T> d = p1 - p0, e = q1 - q0, r = p0 - q0;
  const T dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
  const T spread = dd * ee - de * de;  // |d x e|^2
  T s = T(0);
  if (spread > T(sizeof(T) == 4 ? 1e-6 : 1e-14) * dd * ee) s = std::clamp((de * er - dr * ee) / spread, T(0), T(1));
  // The best partner of each other's point; the second pass settles the clamped and the parallel cases.
  T t = closest_on_segment(p0 + s * d, q0, q1);
  s = closest_on_segment(q0 + t * e, p0, p1);
  SegmentPair<T> best{s, t, p0 + s * d, q0 + t * e, T(0)};
  best.distance2 = distance2(best.on_first, best.on_second);
  if (spread > T(0.01) * dd * ee) return best;
  // Nearly parallel (under 6 degrees): rounding may have misplaced s, but then some end is as good as any other point.
  const T ends[2] = {T(0), T(1)};
  for (T end : ends) {
    const Vec3<T> p = p0 + end * d;
    const T on_q = closest_on_segment(p, q0, q1);
    const T from_p = distance2(p, q0 + on_q * e);
    if (from_p < best.distance2) best = {end, on_q, p, q0 + on_q * e, from_p};
    const Vec3<T> q = q0 + end * e;
    const T on_p = closest_on_segment(q, p0, p1);
    const T from_q = distance2(q, p0 + on_p * d);
    if (from_q < best.distance2) best = {on_p, end, p0 + on_p * d, q, from_q};
  }
  return best;
}

template <class T>
struct RayHit {
  bool hit = false;
  T t = T(0);         ///< origin + t * direction is the hit; in units of the direction's length
  Vec3<T> weights{};  ///< of the triangle's corners
};

/// Ray against triangle, from both sides, t >= 0. Watertight: the sign computed for an edge is exactly opposite in the
/// triangle on its other side, so no ray slips between neighbours (a ray through an edge hits at least one).
template <class T>
RayHit<T> ray_triangle(Vec3<T> origin, Vec3<T> direction, Vec3<T> a, Vec3<T> b, Vec3<T> c) noexcept {
  a -= origin;
  b -= origin;
  c -= origin;
  const T wa = dot(direction, cross(b, c)), wb = dot(direction, cross(c, a)), wc = dot(direction, cross(a, b));
  const bool all_positive = wa >= T(0) && wb >= T(0) && wc >= T(0);
  const bool all_negative = wa <= T(0) && wb <= T(0) && wc <= T(0);
  const T whole = wa + wb + wc;
  if (!(all_positive || all_negative) || whole == T(0)) return {};
  RayHit<T> result;
  result.weights = {wa / whole, wb / whole, wc / whole};
  const Vec3<T> point = result.weights.x * a + result.weights.y * b + result.weights.z * c;
  result.t = dot(point, direction) / dot(direction, direction);
  result.hit = result.t >= T(0);
  return result;
}

template <class T>
struct SegmentTriangle {
  T s;  ///< where on the segment, 0 .. 1
  Vec3<T> on_segment, on_triangle;
  Vec3<T> weights;  ///< of the triangle's corners
  T distance2;      ///< 0 where they cross
};

/// Closest points of the segment p0 p1 and the triangle abc: they cross, or an end of the segment faces the triangle's
/// inside, or the segment faces an edge.
template <class T>
SegmentTriangle<T> closest_segment_triangle(Vec3<T> p0, Vec3<T> p1, Vec3<T> a, Vec3<T> b, Vec3<T> c) noexcept {
  const RayHit<T> crossing = ray_triangle(p0, p1 - p0, a, b, c);
  if (crossing.hit && crossing.t <= T(1)) {
    const Vec3<T> w = crossing.weights, point = w.x * a + w.y * b + w.z * c;
    return {crossing.t, point, point, w, T(0)};
  }
  const SegmentPair<T> ab = closest_segments(p0, p1, a, b);
  SegmentTriangle<T> best{ab.s, ab.on_first, ab.on_second, {T(1) - ab.t, ab.t, T(0)}, ab.distance2};
  const SegmentPair<T> bc = closest_segments(p0, p1, b, c);
  if (bc.distance2 < best.distance2) best = {bc.s, bc.on_first, bc.on_second, {T(0), T(1) - bc.t, bc.t}, bc.distance2};
  const SegmentPair<T> ca = closest_segments(p0, p1, c, a);
  if (ca.distance2 < best.distance2) best = {ca.s, ca.on_first, ca.on_second, {ca.t, T(0), T(1) - ca.t}, ca.distance2};
  const T ends[2] = {T(0), T(1)};
  for (T end : ends) {
    const Vec3<T> p = end == T(0) ? p0 : p1;
    Vec3<T> w;
    if (!detail::foot_inside(p, a, b, c, w)) continue;
    const Vec3<T> foot = a + w.y * (b - a) + w.z * (c - a);
    const T d2 = distance2(p, foot);
    if (d2 < best.distance2) best = {end, p, foot, w, d2};
  }
  return best;
}

namespace detail {

// Smallest t >= 0 at which origin + t direction is on the sphere, for an origin outside it; negative if none.
template <class T>
T ray_sphere(Vec3<T> origin, Vec3<T> direction, Vec3<T> centre, T radius) noexcept {
  const Vec3<T> m = origin - centre;
  const T dd = dot(direction, direction), b = dot(m, direction), c = dot(m, m) - radius * radius;
  const T square = b * b - dd * c;
  if (!(dd > T(0)) || square < T(0) || b > T(0)) return T(-1);
  return std::max(T(0), (-b - std::sqrt(square)) / dd);
}

}  // namespace detail

/// Ray against the solid capsule around the segment ab, t >= 0 (0 where the origin is inside). No weights.
template <class T>
RayHit<T> ray_capsule(Vec3<T> origin, Vec3<T> direction, Vec3<T> a, Vec3<T> b, T radius) noexcept {
  RayHit<T> result;
  const T nearest = closest_on_segment(origin, a, b);
  if (distance2(origin, a + nearest * (b - a)) <= radius * radius) {
    result.hit = true;
    return result;
  }
  const auto take = [&result](T t) {
    if (t >= T(0) && (!result.hit || t < result.t)) {
      result.hit = true;
      result.t = t;
    }
  };
  take(detail::ray_sphere(origin, direction, a, radius));
  take(detail::ray_sphere(origin, direction, b, radius));
  // The cylinder between: everything seen along the axis.
  const Vec3<T> axis = b - a, m = origin - a;
  const T axis2 = dot(axis, axis);
  if (!(axis2 > T(0))) return result;
  const Vec3<T> d = direction - (dot(direction, axis) / axis2) * axis, p = m - (dot(m, axis) / axis2) * axis;
  const T dd = dot(d, d), half = dot(p, d), square = half * half - dd * (dot(p, p) - radius * radius);
  if (!(dd > T(0)) || square < T(0)) return result;
  const T t = (-half - std::sqrt(square)) / dd;
  const T along = dot(m + t * direction, axis);
  if (along >= T(0) && along <= axis2) take(t);
  return result;
}

}  // namespace trocar::geometry
