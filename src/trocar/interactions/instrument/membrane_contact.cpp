#include <algorithm>
#include <array>

#include <trocar/core/tick.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/instrument/membrane_contact.hpp>
#include <trocar/interactions/instrument/needle.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSheetStiffness = 3000;  // [N/m] per triangle, implicit: decides how firm, never how stable
constexpr double kSheetDamping = 0.02;    // [N s/m]
constexpr double kRemember = 0.002;       // [m] beyond touching, the side is still known
constexpr double kDeepestRod = 0.006;     // [m] beyond this a rod that is not right over the triangle went around it
constexpr double kLost = 0.025;           // [m] beyond this it is on the other side for good

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

struct Meeting {
  double depth = -1;
  double distance = 0;  ///< of the rod's axis [m]
  Vec3d normal, weights;
};

Meeting meet(const Capsule& rod, const Corners& t, double half_thickness, Vec3f& side) noexcept {
  Meeting r;
  const auto near = geometry::closest_segment_triangle(rod.a, rod.b, t.a, t.b, t.c);
  const double distance = std::sqrt(near.distance2), sum = rod.radius + half_thickness;
  const Vec3d known = vec_cast<double>(side);
  const bool knows = dot(known, known) > 0.5;
  r.weights = near.weights;
  r.distance = distance;
  const bool over = near.weights.x > 0.01 && near.weights.y > 0.01 && near.weights.z > 0.01;
  if (distance > 1e-7) r.normal = (near.on_triangle - near.on_segment) / distance;
  const bool passed = knows && dot(r.normal, known) < -0.2;
  if (distance > sum + kRemember && !(passed && over && distance < kLost)) {
    side = {0, 0, 0};
    return r;
  }
  if (distance > 1e-7) {
    if (passed) {  // back to the old side
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
  if (r.depth > (over ? kLost : kDeepestRod)) {
    side = {0, 0, 0};
    r.depth = -1;
  }
  return r;
}

/// The same for a rod and a triangle that have moved in straight lines: in as many places as it takes.
/// @param most  [m] to move in between
Meeting meet_on_the_way(const Capsule& rod0, const Capsule& rod, const Corners& t0, const Corners& t,
                        double half_thickness, double most, Vec3f& side) noexcept {
  constexpr int kMostPlaces = 16;
  const double rod_way = std::max(length(rod.a - rod0.a), length(rod.b - rod0.b));
  const double sheet_way = std::max({length(t.a - t0.a), length(t.b - t0.b), length(t.c - t0.c)});
  const double way = rod_way + sheet_way;
  const int places = way < kMostPlaces * most ? int(way / most) + 1 : kMostPlaces;
  for (int i = 1; i < places; ++i) {
    const double share = double(i) / places;
    const auto mixed = [share](Vec3d from, Vec3d to) { return from + share * (to - from); };
    meet({mixed(rod0.a, rod.a), mixed(rod0.b, rod.b), rod.radius},
         {mixed(t0.a, t.a), mixed(t0.b, t.b), mixed(t0.c, t.c)}, half_thickness, side);
  }
  return meet(rod, t, half_thickness, side);
}

Vec3d place(const Corners& t, double b, double c) noexcept { return t.a + b * (t.b - t.a) + c * (t.c - t.a); }

void rub(Touching& c, std::int32_t number, const Touch* was, const Surface& surface, const std::array<int, 3>& triangle,
         const Corners& t, const Meeting& touch, double depth, NetworkLoads& loads) noexcept {
  const double b_share = touch.weights.y, c_share = touch.weights.z;
  const Vec3d now = place(t, b_share, c_share);
  const Vec3d velocity = touch.weights.x * surface.nodes.velocity(triangle[0]) +
                         b_share * surface.nodes.velocity(triangle[1]) + c_share * surface.nodes.velocity(triangle[2]);
  const Rub r = c.rub(number, {touch.normal, now, velocity, {b_share, c_share}},
                      was ? place(t, double(was->weight[0]), double(was->weight[1])) : now);
  if (r.kind == Rub::free) return;
  const double shares[3] = {1 - r.weight[0] - r.weight[1], r.weight[0], r.weight[1]};
  for (std::size_t k = 0; k < 3; ++k) {
    if (shares[k] < 0.02) continue;
    tissue::NodeLoad load;
    load.node = triangle[k];
    load.x0 = vec_cast<float>(surface.position(triangle[k]) + r.to + depth * touch.normal);
    if (r.kind == Rub::sticks) {
      load.k = float(shares[k] * r.stiffness);
    } else {
      load.d = float(shares[k] * r.damping);
      load.dir = vec_cast<float>(r.dir);
      load.f0 = vec_cast<float>((shares[k] * r.damping * r.speed) * r.dir);
    }
    loads.add(load, {Owner::tool_contact, c.tool, number});
  }
}

void push(const Surface& surface, const std::array<int, 3>& triangle, const Meeting& touch, double depth, Tag tag,
          NetworkLoads& loads) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = touch.weights[int(k)];
    if (share < 0.02) continue;
    tissue::NodeLoad load;
    load.node = triangle[k];
    load.k = float(share * kSheetStiffness);
    load.d = float(share * kSheetDamping);
    load.dir = vec_cast<float>(touch.normal);
    load.x0 = vec_cast<float>(surface.position(triangle[k]) + depth * touch.normal);
    loads.add(load, tag);
  }
}

/// Closed jaws as one rod; of no radius while a fold may lie between them, as it always may between wire and foot.
Capsule both_jaws(const ToolShape& shape, double half_thickness) noexcept {
  const Capsule &a = shape.part[kJawA], &b = shape.part[kJawB];
  const double apart = length(a.b - b.b) - a.radius - b.radius, radius = 0.85 * (a.radius + b.radius);
  const Vec3d axis = shape.frame.axis();
  const bool one = !shape.has_foot && apart < 2 * half_thickness;
  return {shape.pivot, shape.frame.tip + (a.radius - radius) * axis, one ? radius : 0};
}

/// Does the rod reach through the fold, much further than a contact lets it? It may then leave as it likes.
bool impales(const Capsule& rod, const SheetView& sheet) noexcept {
  const Surface& surface = sheet.surface;
  const double size = length(rod.b - rod.a);
  if (!(size > kImpaled) || !meets_box(surface.pose->bounds, rod.a, rod.b, 0)) return false;
  const Vec3d back = (rod.a - rod.b) / size;
  int through = 0;
  for (std::size_t i = 0; i < surface.skin->triangles.size(); ++i) {
    const auto& t = surface.skin->triangles[i];
    if (sheet.parted[i]) continue;
    const auto on =
        geometry::ray_triangle(rod.b, back, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
    if (on.hit && on.t > kImpaled && on.t < size) ++through;
  }
  return through % 2 == 1;  // twice: it lies across, in a trough that it has pressed in
}

/// Is any part of the instrument in the fold, or at it?
bool at_sheet(const ToolShape& shape, const SheetView& sheet) noexcept {
  const Surface& surface = sheet.surface;
  for (int part = kShaft; part < end_of(shape); part = next(part)) {
    const Capsule& rod = shape.rod(part);
    const double sum = rod.radius + sheet.half_thickness;
    if (!meets_box(surface.pose->bounds, rod.a, rod.b, sum)) continue;
    for (std::size_t i = 0; i < surface.skin->triangles.size(); ++i) {
      const auto& t = surface.skin->triangles[i];
      const auto near = geometry::closest_segment_triangle(rod.a, rod.b, surface.position(t[0]), surface.position(t[1]),
                                                           surface.position(t[2]));
      if (!sheet.parted[i] && near.distance2 < sum * sum) return true;
    }
  }
  return false;
}

/// What closing jaws have between them is not to be pushed out: a triangle is known from outside or not at all.
bool begins_inside(const Capsule& rod, const Corners& t, Vec3f side) noexcept {
  if (dot(side, side) > 0) return false;
  const double inside = 0.9 * rod.radius;
  return geometry::closest_segment_triangle(rod.a, rod.b, t.a, t.b, t.c).distance2 < inside * inside;
}

}  // namespace

void tool_on_sheet(Touching& c, const ToolState& tool_state, BodyId body, const SheetView& sheet, std::span<Vec3f> side,
                   SheetBond& bond, NetworkLoads& loads, double& gap) noexcept {
  const ToolShape& shape = c.shape;
  const Surface& surface = sheet.surface;
  const tissue::Skin& skin = *surface.skin;
  const auto held = [&](const std::array<int, 3>& t) {
    for (int h = 0; h < tool_state.holds; ++h)
      if (tool_state.hold[h].at.body == body)
        for (int v : t)
          if (tool_state.hold[h].at.node[0] == v) return true;
    return false;
  };
  const auto before = [&surface](int node) {
    return surface.position(node) - core::kTick * surface.nodes.velocity(node);
  };
  bool impaled = impales(shape.part[kShaft], sheet);
  for (int i = 0; i < shape.links; ++i) impaled = impaled || impales(shape.link[i], sheet);
  if (impaled || (bond == SheetBond::through && at_sheet(shape, sheet))) {
    if (bond == SheetBond::noted) std::fill(side.begin(), side.end(), Vec3f{});
    bond = SheetBond::through;
    gap = kLost;
    return;
  }
  const bool jaws_through =
      gap_of(shape) > kWide && (impales(shape.part[kJawA], sheet) || impales(shape.part[kJawB], sheet));
  bond = SheetBond::none;
  gap = kRemember;
  const std::size_t stride = side.size() / std::max<std::size_t>(1, skin.triangles.size());
  constexpr int kInTurn[] = {kShaft, kBothJaws, kJawA, kJawB};
  for (int turn = 0; turn < kSheetParts + shape.links; ++turn) {
    const int part = turn < kSheetParts ? kInTurn[turn] : turn;  // links are numbered from there on
    const bool both = part == kBothJaws;
    const Capsule rod = both ? both_jaws(shape, sheet.half_thickness) : shape.rod(part);
    const Capsule rod0 = both ? both_jaws(c.before, sheet.half_thickness) : c.before.rod(part);
    const double way = c.way(both ? kJawA : part), reach = rod.radius + sheet.half_thickness + kRemember + way;
    const double most = 0.9 * (both ? kRemember : rod.radius + sheet.half_thickness + kRemember);
    const bool near = meets_box(surface.pose->bounds, rod.a, rod.b, reach);
    const bool near_at_all = near || meets_box(surface.pose->bounds, rod.a, rod.b, std::max(reach, rod.radius + kLost));
    const bool through = is_jaw(part) && jaws_through;
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
      Vec3f& memory = side[i * stride + std::size_t(part)];
      const auto& t = skin.triangles[i];
      if (!near && dot(memory, memory) == 0) continue;
      const Vec3f together = side[i * stride + std::size_t(kBothJaws)];
      const bool by_both = (part == kJawA || part == kJawB) && dot(together, together) > 0;
      if (!near_at_all || sheet.parted[i] || rod.radius == 0 || by_both || through) {
        memory = {};
        continue;
      }
      const Corners corners{surface.position(t[0]), surface.position(t[1]), surface.position(t[2])};
      const Vec3d middle = (corners.a + corners.b + corners.c) / 3.0;
      const double size2 = std::max({geometry::distance2(middle, corners.a), geometry::distance2(middle, corners.b),
                                     geometry::distance2(middle, corners.c)});
      const double way2 = geometry::distance2(middle, collision::nearest_on_axis(rod, middle));
      const double far = dot(memory, memory) > 0 ? rod.radius + kLost : reach;
      if (way2 > 2 * (size2 + far * far)) {  // (r + s)^2 <= 2 (r^2 + s^2)
        memory = {};
        continue;
      }
      if (is_jaw(part) && held(t)) {
        memory = {};
        continue;
      }
      const Corners corners0{before(t[0]), before(t[1]), before(t[2])};
      if (both && (rod0.radius == 0 || begins_inside(rod0, corners0, memory))) {
        gap = 0;
        memory = {};
        continue;
      }
      const Meeting touch = meet_on_the_way(rod0, rod, corners0, corners, sheet.half_thickness, most, memory);
      if (dot(memory, memory) > 0) bond = SheetBond::noted;
      gap = std::min(gap, touch.distance);
      if (touch.depth <= -kGrazes) continue;
      const std::int32_t number = c.note(body, int(i), part);
      const double depth = std::clamp(touch.depth, 0.0, kQuickestPush + way);
      rub(c, number, c.anchored(body, int(i), part), surface, t, corners, touch, depth, loads);
      if (touch.depth > 0) push(surface, t, touch, depth, {Owner::tool_contact, c.tool, number}, loads);
    }
  }
}

}  // namespace trocar::interactions
