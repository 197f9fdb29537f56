#include <algorithm>
#include <cmath>

#include <trocar/fluids/capsule.hpp>

namespace trocar::fluids {
namespace {

bool fits(Vec3f p, float most) { return std::fabs(p.x) < most && std::fabs(p.y) < most && std::fabs(p.z) < most; }

Interval joined(Interval a, Interval b) {  // of a convex body's parts: their union is one interval
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval in_sphere(Vec3f centre, float radius, float x, float y) {
  const float dx = x - centre.x, dy = y - centre.y;
  const float rest = radius * radius - (dx * dx + dy * dy);
  if (!(rest > 0)) return {};
  const float half = std::sqrt(rest);
  return {centre.z - half, centre.z + half};
}

/// Points (x, y, a.z + t) of the line within the radius of the axis, and between its ends.
Interval in_cylinder(const Capsule& c, float x, float y) {
  const Vec3f axis = c.b - c.a;
  const float far = length(axis);
  if (!(far > 1e-7f)) return {};
  const Vec3f n = axis / far;
  const float ex = x - c.a.x, ey = y - c.a.y, along = n.x * ex + n.y * ey;
  // |e + t k - n (along + t nz)|^2 = q0 - 2 q1 t + q2 t^2 <= r^2
  const float q0 = (ex * ex + ey * ey) - along * along, q1 = along * n.z, q2 = 1 - n.z * n.z;
  Interval t{-1e3f, 1e3f};
  if (q2 > 1e-6f) {
    const float rest = q1 * q1 - q2 * (q0 - c.radius * c.radius);
    if (!(rest > 0)) return {};
    const float half = std::sqrt(rest);
    t = {(q1 - half) / q2, (q1 + half) / q2};
  } else if (q0 > c.radius * c.radius) {
    return {};
  }
  if (std::fabs(n.z) > 1e-6f) {  // 0 <= along + t nz <= far
    const float t0 = -along / n.z, t1 = (far - along) / n.z;
    t = {std::max(t.low, std::min(t0, t1)), std::min(t.high, std::max(t0, t1))};
  } else if (along < 0 || along > far) {
    return {};
  }
  return t.empty() ? Interval{} : Interval{c.a.z + t.low, c.a.z + t.high};
}

}  // namespace

bool sound(const Capsule& c) noexcept {
  return fits(c.a, 100) && fits(c.b, 100) && fits(c.va, 1e3f) && fits(c.vb, 1e3f) && c.radius > 0 && c.radius < 1 &&
         c.body >= 0;
}

Interval upright_chord(const Capsule& c, float x, float y) noexcept {
  return joined(joined(in_sphere(c.a, c.radius, x, y), in_sphere(c.b, c.radius, x, y)), in_cylinder(c, x, y));
}

float nearest_share(const Capsule& c, Vec3f p) noexcept {
  const Vec3f axis = c.b - c.a;
  const float square = dot(axis, axis);
  if (!(square > 1e-14f)) return 0;
  return std::clamp(dot(p - c.a, axis) / square, 0.0f, 1.0f);
}

}  // namespace trocar::fluids
