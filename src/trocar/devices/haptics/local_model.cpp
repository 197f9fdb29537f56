#include <algorithm>
#include <cmath>

#include <trocar/devices/haptics/local_model.hpp>

namespace trocar::devices {
namespace {

constexpr double kFlat = 1e-9;      // determinant of normals that lie in one plane, or on one line
constexpr double kOnPlane = 1e-12;  // [m] that rounding leaves on the wrong side

double above(const ContactPlane& plane, Vec3d p) { return dot(plane.normal, p - plane.point); }

bool allowed(Vec3d x, std::span<const ContactPlane> planes) {
  return std::all_of(planes.begin(), planes.end(),
                     [x](const ContactPlane& plane) { return above(plane, x) >= -kOnPlane; });
}

/// The foot of p on all planes of a set, and whether each of them pushes: the condition of Karush, Kuhn and Tucker.
struct Foot {
  Vec3d x;
  bool pushes = false;
};

Foot foot_on(Vec3d p, const ContactPlane& a) {
  const double l = -above(a, p);
  return {p + l * a.normal, l >= 0};
}

Foot foot_on(Vec3d p, const ContactPlane& a, const ContactPlane& b) {
  const double c = dot(a.normal, b.normal), det = 1 - c * c;
  if (!(det > kFlat)) return {p, false};
  const double da = -above(a, p), db = -above(b, p);
  const double la = (da - c * db) / det, lb = (db - c * da) / det;
  return {p + la * a.normal + lb * b.normal, la >= 0 && lb >= 0};
}

Foot foot_on(Vec3d p, const ContactPlane& a, const ContactPlane& b, const ContactPlane& c) {
  const Vec3d bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  const double det = dot(a.normal, bc);
  if (!(det * det > kFlat)) return {p, false};
  // The corner x - p = (da bc + db ca + dc ab) / det, and its share along each normal.
  const Vec3d way = (-above(a, p) * bc - above(b, p) * ca - above(c, p) * ab) / det;
  const double la = dot(way, bc) / det, lb = dot(way, ca) / det, lc = dot(way, ab) / det;
  return {p + way, la >= 0 && lb >= 0 && lc >= 0};
}

}  // namespace

// [Zilles & Salisbury 1995]: seven sets of active planes are few enough to try them all; at most one satisfies the
// conditions, as the problem is strictly convex.
Vec3d nearest_allowed(Vec3d p, std::span<const ContactPlane> planes) noexcept {
  planes = planes.first(std::min(planes.size(), std::size_t(kMostPlanes)));
  if (allowed(p, planes)) return p;
  const std::size_t n = planes.size();
  for (std::size_t i = 0; i < n; ++i)
    if (const Foot f = foot_on(p, planes[i]); f.pushes && allowed(f.x, planes)) return f.x;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      if (const Foot f = foot_on(p, planes[i], planes[j]); f.pushes && allowed(f.x, planes)) return f.x;
  if (n == 3)
    if (const Foot f = foot_on(p, planes[0], planes[1], planes[2]); f.pushes && allowed(f.x, planes)) return f.x;
  return nearest_allowed(p, planes.first(n - 1));  // they leave no room
}

}  // namespace trocar::devices
