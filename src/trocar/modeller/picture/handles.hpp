// What can be taken on things: their points and the lines between them, where they stand in a picture, and what lies
// under a pointer. A window draws them over its picture, a script into its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/document/outline.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/render/frame/image.hpp>

namespace trocar::modeller {

struct Handle {
  std::string thing, list;  ///< list: path within the thing
  std::size_t item = 0;
  Vec3d at;  ///< [m]
};
struct HandleLine {
  std::vector<Vec3d> points;  ///< [m]
};
struct Handles {
  std::vector<Handle> points;
  std::vector<HandleLine> lines;
};
/// Of a thing of the document; none where it has no points.
Handles handles_of(const Document& document, const std::string& thing);

/// Where a place stands in a picture [px from its upper left corner]; none: behind the camera.
struct Spot {
  float x = 0, y = 0;
};
std::optional<Spot> spot_of(const render::Camera& camera, int width, int height, Vec3d place);
/// The ray through a spot: from the camera, of length 1.
Vec3d ray_through(const render::Camera& camera, int width, int height, Spot spot);

/// The number of the handle nearest to a spot, within `reach` [px]; none: there is none so near.
std::optional<std::size_t> handle_at(const Handles& handles, const render::Camera& camera, int width, int height,
                                     Spot spot, float reach);

/// Paints them into a picture.
void paint(const Handles& handles, const render::Camera& camera, render::Image& image);

}  // namespace trocar::modeller
