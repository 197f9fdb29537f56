// Which points of a thing can be taken and moved: what a window draws as handles.
#pragma once

#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

struct PointList {
  enum Kind { line, net, sections, balls };
  std::string path, key;  ///< path within the thing
  Kind kind = line;
};
std::vector<PointList> point_lists(const scene::JsonValue& thing);

struct PlacedPoint {
  std::string path;  ///< within the thing
  Vec3d at;          ///< [mm]
};
/// Of a list: its points, the centres of its sections, a net's row by row.
std::vector<PlacedPoint> points_in(const scene::JsonValue& thing, const std::string& list);

/// Those that change when one is moved: with `soft` [mm] those around it by (1 - (d / soft)^2)^2 of the way.
std::vector<PlacedPoint> moved(const std::vector<PlacedPoint>& all, std::size_t item, Vec3d by, double soft,
                               bool symmetric);

}  // namespace trocar::modeller
