// The rest of the body cavity around a scene: a large, smooth, dark-red space, so that a picture never shows nothing
// where the scene file's walls end, and peritoneum that leads from the walls' borders over to it.
#pragma once

#include <span>

#include <trocar/sim/model.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

/// An egg around all organs, walls and ports, seen from inside.
MeshBuffer cavity_around(const sim::Model& model);
/// From a wall's border to the cavity, without an edge. @param paint of the wall's vertices
MeshBuffer around_wall(const sim::Model& model, const tissue::Skin& wall, std::span<const Paint> paint);
/// A wall's border: its vertices in the order in which its edges follow each other.
std::vector<std::vector<int>> border_loops(const tissue::Skin& wall);
/// How much fat lies below the peritoneum at a place, 0..1: what makes a pelvis patchy yellow.
double fat_below(Vec3d p);

}  // namespace trocar::view
