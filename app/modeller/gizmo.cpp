#include "modeller/gizmo.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include <trocar/numerics/portable.hpp>

namespace trocar::app {
namespace {

// All of it stays of one size on the screen [px]: rings lie within the arrows, cubes beyond their heads.
constexpr float kRing = 50, kArrow = 72, kHead = 11, kCube = 90, kCubeHalf = 4.5f, kReach = 7;
constexpr float kEdgeOn = 0.12f;  // of its length: an arrow that points so much at the eye is not shown
constexpr int kRingParts = 48;

using Spots = std::array<ImVec2, kRingParts + 1>;

struct Axis {
  ImVec2 middle, way;  ///< where it begins, and one pixel's worth of it on the screen
  bool shown = false;
};

Vec3d unit(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

Axis axis_of(const Gizmo& gizmo, const Viewport& view, int axis) {
  Axis out;
  const std::optional<modeller::Spot> from = view.spot(gizmo.at);
  const std::optional<modeller::Spot> to = view.spot(gizmo.at + unit(axis) * (kArrow * view.pixel(gizmo.at)));
  if (!from || !to) return out;
  out.middle = {from->x, from->y};
  out.way = {(to->x - from->x) / kArrow, (to->y - from->y) / kArrow};
  out.shown = std::hypot(out.way.x, out.way.y) > kEdgeOn;
  return out;
}

ImVec2 on(const Axis& axis, float pixels) {
  return {axis.middle.x + axis.way.x * pixels, axis.middle.y + axis.way.y * pixels};
}

/// A ring about an axis; false: it cannot be seen from here.
bool ring_of(const Gizmo& gizmo, const Viewport& view, int axis, Spots& out) {
  const Vec3d u = unit((axis + 1) % 3), w = unit((axis + 2) % 3);
  const double r = kRing * view.pixel(gizmo.at);
  for (int i = 0; i <= kRingParts; ++i) {
    const double a = 2 * portable::pi * i / kRingParts;
    const std::optional<modeller::Spot> s = view.spot(gizmo.at + (u * std::cos(a) + w * std::sin(a)) * r);
    if (!s) return false;
    out[std::size_t(i)] = {s->x, s->y};
  }
  return true;
}

float from_line(ImVec2 p, ImVec2 a, ImVec2 b) {
  const float x = b.x - a.x, y = b.y - a.y, l = x * x + y * y;
  const float t = l > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / l, 0.0f, 1.0f) : 0;
  return std::hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

ImU32 colour(int axis, bool lit) {
  if (lit) return IM_COL32(255, 255, 255, 255);
  static constexpr ImU32 kColours[3] = {IM_COL32(230, 120, 60, 235), IM_COL32(90, 180, 230, 235),
                                        IM_COL32(220, 220, 120, 235)};  // as the axes in the corner
  return kColours[axis];
}

void draw_arrow(const Axis& axis, ImU32 colour, bool lit, ImDrawList& list) {
  const ImVec2 head = on(axis, kArrow), neck = on(axis, kArrow - kHead);
  const float l = std::hypot(axis.way.x, axis.way.y);
  const ImVec2 across = {-axis.way.y / l * kHead * 0.4f, axis.way.x / l * kHead * 0.4f};
  list.AddLine(on(axis, 8), neck, colour, lit ? 3.0f : 2.0f);
  list.AddTriangleFilled(head, {neck.x + across.x, neck.y + across.y}, {neck.x - across.x, neck.y - across.y}, colour);
}

void draw_cube(const Axis& axis, ImU32 colour, ImDrawList& list) {
  const ImVec2 c = on(axis, kCube);
  list.AddRectFilled({c.x - kCubeHalf, c.y - kCubeHalf}, {c.x + kCubeHalf, c.y + kCubeHalf}, colour);
}

}  // namespace

std::optional<GizmoPart> gizmo_at(const Gizmo& gizmo, const Viewport& view, float x, float y) {
  if (!gizmo.shown) return std::nullopt;
  const ImVec2 p{x, y};
  for (int axis = 0; axis < 3; ++axis) {
    const Axis a = axis_of(gizmo, view, axis);
    if (!a.shown) continue;
    if (gizmo.whole && from_line(p, on(a, kCube), on(a, kCube)) < kReach + kCubeHalf)
      return GizmoPart{Gesture::Kind::scale, axis};
    if (from_line(p, on(a, kRing * 0.35f), on(a, kArrow)) < kReach) return GizmoPart{Gesture::Kind::move, axis};
  }
  for (int axis = 0; gizmo.whole && axis < 3; ++axis) {
    Spots ring;
    if (!ring_of(gizmo, view, axis, ring)) continue;
    for (int i = 0; i < kRingParts; ++i)
      if (from_line(p, ring[std::size_t(i)], ring[std::size_t(i) + 1]) < kReach * 0.7f)
        return GizmoPart{Gesture::Kind::rotate, axis};
  }
  return std::nullopt;
}

void draw_gizmo(const Gizmo& gizmo, const Viewport& view, const std::optional<GizmoPart>& lit, ImDrawList& list) {
  if (!gizmo.shown) return;
  const auto is_lit = [&](Gesture::Kind kind, int axis) { return lit && lit->kind == kind && lit->axis == axis; };
  for (int axis = 0; axis < 3; ++axis) {
    Spots ring;
    if (gizmo.whole && ring_of(gizmo, view, axis, ring)) {
      const bool bright = is_lit(Gesture::Kind::rotate, axis);
      list.AddPolyline(ring.data(), kRingParts + 1, colour(axis, bright), 0, bright ? 2.4f : 1.3f);
    }
    const Axis a = axis_of(gizmo, view, axis);
    if (!a.shown) continue;
    draw_arrow(a, colour(axis, is_lit(Gesture::Kind::move, axis)), is_lit(Gesture::Kind::move, axis), list);
    if (gizmo.whole) draw_cube(a, colour(axis, is_lit(Gesture::Kind::scale, axis)), list);
  }
}

std::vector<std::pair<std::string, modeller::Spot>> gizmo_spots(const Gizmo& gizmo, const Viewport& view) {
  std::vector<std::pair<std::string, modeller::Spot>> out;
  for (int axis = 0; gizmo.shown && axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    Spots ring;
    if (gizmo.whole && ring_of(gizmo, view, axis, ring)) out.push_back({"rotate " + name, {ring[6].x, ring[6].y}});
    const Axis a = axis_of(gizmo, view, axis);
    if (!a.shown) continue;
    const ImVec2 arrow = on(a, kRing * 0.7f), cube = on(a, kCube);
    out.push_back({"move " + name, {arrow.x, arrow.y}});
    if (gizmo.whole) out.push_back({"scale " + name, {cube.x, cube.y}});
  }
  return out;
}

}  // namespace trocar::app
