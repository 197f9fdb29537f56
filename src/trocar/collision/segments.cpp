#include <algorithm>

#include <trocar/collision/segments.hpp>

namespace trocar::collision {

double nearest_on_segment(Vec3d a, Vec3d b, Vec3d p) noexcept {
  const Vec3d ab = b - a;
  const double n = dot(ab, ab);
  return n > 1e-24 ? std::clamp(dot(p - a, ab) / n, 0.0, 1.0) : 0.0;
}

SegmentPair nearest_segments(Vec3d a0, Vec3d a1, Vec3d b0, Vec3d b1) noexcept {
  const Vec3d u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double a = dot(u, u), e = dot(v, v), f = dot(v, w), b = dot(u, v), c = dot(u, w);
  SegmentPair r;
  if (a > 1e-24 && e > 1e-24) {
    const double den = a * e - b * b;
    r.s = den > 1e-12 * a * e ? std::clamp((b * f - c * e) / den, 0.0, 1.0) : 0.5;
    r.t = (b * r.s + f) / e;
    if (r.t < 0.0 || r.t > 1.0) {
      r.t = std::clamp(r.t, 0.0, 1.0);
      r.s = std::clamp((b * r.t - c) / a, 0.0, 1.0);
    }
  } else if (a > 1e-24) {
    r.s = std::clamp(-c / a, 0.0, 1.0);
  } else if (e > 1e-24) {
    r.t = std::clamp(f / e, 0.0, 1.0);
  }
  r.on_first = a0 + r.s * u;
  r.on_second = b0 + r.t * v;
  r.distance = length(r.on_first - r.on_second);
  return r;
}

bool passes_within(Vec3d from, Vec3d to, Vec3d a, Vec3d b, double radius) noexcept {
  return nearest_segments(from, to, a, b).distance < radius;
}

}  // namespace trocar::collision
