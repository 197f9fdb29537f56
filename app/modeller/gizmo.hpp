// What stands about the chosen thing: arrows that move it, rings that turn it, and cubes that scale it, an axis each.
// To press one begins what the keys G, R or S and X, Y or Z begin.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <trocar/numerics/vec3.hpp>

#include "modeller/gesture.hpp"
#include "modeller/viewport.hpp"

struct ImDrawList;

namespace trocar::app {

struct Gizmo {
  Vec3d at;            ///< [m]
  bool shown = false;  ///< else there is none
  bool whole = false;  ///< turns and scales as well: a thing, not a point of one
};
struct GizmoPart {
  Gesture::Kind kind = Gesture::Kind::move;
  int axis = 0;
};

/// The part under a spot of the window; none: there is none.
std::optional<GizmoPart> gizmo_at(const Gizmo& gizmo, const Viewport& view, float x, float y);

/// @param lit the part that is pointed at or led
void draw_gizmo(const Gizmo& gizmo, const Viewport& view, const std::optional<GizmoPart>& lit, ImDrawList& list);

/// Where each of its parts that is shown may be pressed, by name ("move x"): what a robot at the window goes by.
std::vector<std::pair<std::string, modeller::Spot>> gizmo_spots(const Gizmo& gizmo, const Viewport& view);

}  // namespace trocar::app
