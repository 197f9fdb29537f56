#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

Vec3d Surface::normal(int vertex) const noexcept {
  return moves() ? tissue::skin_normal(*skin, *pose, vertex) : vec_cast<double>(skin->rest_normal[size_t(vertex)]);
}

Vec3d Surface::velocity(int vertex) const noexcept {
  return moves() ? tissue::skin_velocity(nodes, *skin, vertex) : Vec3d{0, 0, 0};
}

float torn_beyond(double cell) noexcept {
  constexpr double kTimes = 5;  // beyond the failure strain of all tissues
  return float(kTimes * std::sqrt(3.0) * cell);
}

bool Surface::torn(int vertex) const noexcept {
  if (!(torn_beyond > 0)) return false;
  constexpr float kCarries = 0.01f;  // of the weight; below 0 where the skin stands out of the cells
  const Vec3d p = position(vertex) - nodes.origin;
  const double beyond2 = double(torn_beyond) * double(torn_beyond);
  bool beyond = false;
  skin->each_carrier(vertex, [&](int, int row, float weight) {
    if (beyond || std::fabs(weight) < kCarries) return;
    const tissue::NodeState& carrier = nodes.rows[size_t(row)];
    beyond = geometry::distance2(p, Vec3d{carrier.x, carrier.y, carrier.z}) > beyond2;
  });
  return beyond;
}

bool Surface::torn(int vertex, int neighbour) const noexcept {
  return torn_beyond > 0 &&
         geometry::distance2(position(vertex), position(neighbour)) > double(torn_beyond) * double(torn_beyond);
}

bool meets_box(const tissue::Box& box, Vec3d a, Vec3d b, double margin) noexcept {
  if (!box.near_segment(a, b, margin)) return false;
  constexpr double kRounding = 1e-9;
  double from = 0, to = 1;  // share of the segment between the planes of all faces so far
  for (int k = 0; k < 3; ++k) {
    const double low = double(box.low[k]) - margin - kRounding - a[k];
    const double high = double(box.high[k]) + margin + kRounding - a[k], along = b[k] - a[k];
    if (std::fabs(along) < kRounding) continue;  // near_segment has looked at that
    const double first = low / along, second = high / along;
    from = std::max(from, std::min(first, second));
    to = std::min(to, std::max(first, second));
  }
  return from <= to + kRounding;
}

int walk_to_nearest(const Surface& surface, int start, Vec3d p) noexcept {
  const tissue::Skin& skin = *surface.skin;
  int here = start;
  Vec3d d = surface.position(here) - p;
  double best = dot(d, d);
  for (int step = 0; step < 64; ++step) {
    int next = here;
    for (int k = skin.neighbour_first[size_t(here)]; k < skin.neighbour_first[size_t(here) + 1]; ++k) {
      const int v = skin.neighbour[size_t(k)];
      d = surface.position(v) - p;
      const double n = dot(d, d);
      if (n < best) {
        best = n;
        next = v;
      }
    }
    if (next == here) break;
    here = next;
  }
  return here;
}

int nearest_vertex(const Surface& surface, Vec3d p) noexcept {
  int best = 0;
  double least = 1e30;
  for (int v = 0; v < surface.skin->size(); ++v) {
    const Vec3d d = surface.position(v) - p;
    const double n = dot(d, d);
    if (n < least && surface.skin->at_surface(v)) {
      least = n;
      best = v;
    }
  }
  return best;
}

Clearance clearance_at(const Surface& surface, int vertex, Vec3d p) noexcept {
  Clearance c;
  c.normal = surface.normal(vertex);
  c.distance = dot(p - surface.position(vertex), c.normal);
  return c;
}

Clearance facing_clearance(const Surface& surface, int vertex, Vec3d p, Vec3d facing) noexcept {
  constexpr double kOpposed = -0.25;  // of the two normals' product
  constexpr double kBesides = 0.002;  // [m] what lies further beside a triangle is not above it
  const tissue::Skin& skin = *surface.skin;
  Clearance c{1e30, {0, 0, 1}};
  double least = 1e30;
  for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k) {
    const auto& t = skin.triangles[size_t(skin.face[size_t(k)])];
    const Vec3d a = surface.position(t[0]), b = surface.position(t[1]), d = surface.position(t[2]);
    const Vec3d n = normalised(cross(b - a, d - a));
    if (!(dot(n, facing) < kOpposed)) continue;
    const double far2 = geometry::closest_on_triangle(p, a, b, d).distance2;
    const double height = dot(p - a, n);
    if (!(far2 < least) || far2 - height * height > kBesides * kBesides) continue;
    least = far2;
    c = {height, n};
  }
  return c;
}

}  // namespace trocar::interactions
