// A view of the document: the trainer's picture from around a point, with the selected thing's handles over it.
#pragma once

#include <optional>
#include <string>

#include <trocar/modeller/picture/easel.hpp>
#include <trocar/modeller/picture/handles.hpp>
#include <trocar/view/base/cameras.hpp>

#include "shell/area.hpp"
#include "shell/pane_canvas.hpp"

namespace trocar::app {

/// A ray meets what is so near to it [m]: bodies are pointed at by places on their skins.
inline constexpr double kRayReach = 0.003;

struct Viewport {
  std::string name;  ///< "free", "front", "side", "top"
  Area area;
  view::Orbit orbit;
  PaneCanvas canvas;
  render::Camera camera;  ///< of what is drawn
  std::uint64_t drawn = ~0ull;

  modeller::Spot local(float x, float y) const { return {x - area.x, y - area.y}; }
  std::optional<modeller::Spot> spot(Vec3d place) const {
    std::optional<modeller::Spot> s = modeller::spot_of(camera, int(area.width), int(area.height), place);
    if (s) s->x += area.x, s->y += area.y;
    return s;
  }
  Vec3d ray(float x, float y) const {
    return modeller::ray_through(camera, int(area.width), int(area.height), local(x, y));
  }
  Vec3d eye() const { return {camera.position.x, camera.position.y, camera.position.z}; }
  /// Where the ray through a spot meets the plane across the view through a place.
  Vec3d on_plane_of(Vec3d place, float x, float y) const {
    const Vec3d forward = ray(area.x + area.width / 2, area.y + area.height / 2), way = ray(x, y);
    return eye() + way * (dot(place - eye(), forward) / dot(way, forward));
  }
  /// How far along an axis through a place the ray through a spot passes it [m]; 0 where one looks along the axis.
  double along(Vec3d place, Vec3d axis, float x, float y) const {
    const Vec3d way = ray(x, y), from = eye() - place;
    const double slant = dot(way, axis), across = 1 - slant * slant;
    return across < 0.01 ? 0.0 : (dot(from, axis) - dot(from, way) * slant) / across;
  }
  /// Length of a pixel at that depth [m].
  double pixel(Vec3d place) const {
    return length(on_plane_of(place, area.x + 1, area.y) - on_plane_of(place, area.x, area.y));
  }
};

}  // namespace trocar::app
