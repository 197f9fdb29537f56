#include <algorithm>
#include <array>

#include <trocar/geometry/nearest.hpp>
#include <trocar/interactions/membrane_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kStiffness = 400;    // [N/m] per triangle, implicit: decides how firm, never how stable
constexpr double kDamping = 0.02;     // [N s/m]
constexpr double kQuickest = 0.0012;  // [m] a tick that a contact moves a sheet: twice the fastest hand
constexpr double kRemember = 0.002;   // [m] beyond touching, the side is still known
constexpr double kDeepest = 0.006;    // [m] beyond this a rod is on the other side for good: it went around

struct Corners {
  Vec3d a, b, c;
};

/// How far the rod's end reaches beyond the triangle's plane, seen along `side`; 0 where both ends are before it.
double poke(const Capsule& rod, const Corners& t, Vec3d side) noexcept {
  Vec3d n = normalised(cross(t.b - t.a, t.c - t.a), side);
  if (dot(n, side) < 0) n = -n;
  const double first = dot(rod.a - t.a, n), second = dot(rod.b - t.a, n);
  const double far = std::max(first, second), near = std::min(first, second);
  return near < 0 ? std::max(0.0, far) : 0.0;
}

struct Touch {
  double depth = -1;
  Vec3d normal, weights;
};

Touch touch_triangle(const Capsule& rod, const Corners& t, double half_thickness, Vec3f& side) noexcept {
  Touch r;
  const auto near = geometry::closest_segment_triangle(rod.a, rod.b, t.a, t.b, t.c);
  const double distance = std::sqrt(near.distance2), sum = rod.radius + half_thickness;
  const Vec3d known = vec_cast<double>(side);
  const bool knows = dot(known, known) > 0.5;
  r.weights = near.weights;
  if (distance > sum + kRemember) {
    side = {0, 0, 0};
    return r;
  }
  if (distance > 1e-7) {
    r.normal = (near.on_triangle - near.on_segment) / distance;
    if (knows && dot(r.normal, known) < -0.2) {  // it has passed: back to the old side
      r.normal = -r.normal;
      r.depth = sum + distance;
    } else {
      side = vec_cast<float>(r.normal);
      r.depth = sum - distance;
    }
  } else if (knows) {  // the axis is in the triangle
    r.normal = known;
    r.depth = sum + poke(rod, t, known);
  }
  if (r.depth > kDeepest) {
    side = {0, 0, 0};
    r.depth = -1;
  }
  return r;
}

void push(const Surface& surface, const std::array<int, 3>& triangle, const Touch& touch, Tag tag,
          NetworkLoads& loads) noexcept {
  const double depth = std::min(touch.depth, kQuickest);
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = touch.weights[int(k)];
    if (share < 0.02) continue;
    tissue::NodeLoad load;
    load.node = triangle[k];
    load.k = float(share * kStiffness);
    load.d = float(share * kDamping);
    load.dir = vec_cast<float>(touch.normal);
    load.x0 = vec_cast<float>(surface.position(triangle[k]) + depth * touch.normal);
    loads.add(load, tag);
  }
}

}  // namespace

bool tool_on_sheet(const ToolShape& shape, const ToolState& tool_state, int tool, int body, const SheetView& sheet,
                   std::span<Vec3f> side, NetworkLoads& loads) noexcept {
  const Surface& surface = sheet.surface;
  const tissue::Skin& skin = *surface.skin;
  const auto held = [&](const std::array<int, 3>& t) {
    for (int h = 0; h < tool_state.holds; ++h)
      if (tool_state.hold[h].body == body)
        for (int v : t)
          if (tool_state.hold[h].element == v) return true;
    return false;
  };
  bool remembers = false;
  for (int part = 0; part < kToolParts; ++part) {
    const Capsule& rod = shape.part[part];
    const double reach = rod.radius + sheet.half_thickness + kRemember;
    const bool near_at_all = surface.pose->bounds.near_segment(rod.a, rod.b, reach);
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
      Vec3f& memory = side[i * std::size_t(kToolParts) + std::size_t(part)];
      const auto& t = skin.triangles[i];
      if (!near_at_all || sheet.parted[i]) {
        memory = {};
        continue;
      }
      const Corners corners{surface.position(t[0]), surface.position(t[1]), surface.position(t[2])};
      const Vec3d middle = (corners.a + corners.b + corners.c) / 3.0;
      const double size2 = std::max({geometry::distance2(middle, corners.a), geometry::distance2(middle, corners.b),
                                     geometry::distance2(middle, corners.c)});
      const double way2 = geometry::distance2(middle, collision::nearest_on_axis(rod, middle));
      if (way2 > 2 * (size2 + reach * reach)) {  // (r + s)^2 <= 2 (r^2 + s^2)
        memory = {};
        continue;
      }
      if (part != kShaft && held(t)) {
        memory = {};
        continue;
      }
      const Touch touch = touch_triangle(rod, corners, sheet.half_thickness, memory);
      remembers = remembers || dot(memory, memory) > 0;
      if (touch.depth > 0) push(surface, t, touch, {Owner::tool_contact, tool, part}, loads);
    }
  }
  return remembers;
}

}  // namespace trocar::interactions
