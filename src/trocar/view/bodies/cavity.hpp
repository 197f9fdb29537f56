// The rest of the body cavity around a scene: a large, smooth space, so that a picture never shows nothing where the
// scene file's walls end. It leaves their borders as they end, bends as little as it can, and becomes an egg around
// everything: so no crease shows where it begins. Walls are seen whole from the egg's middle.
#pragma once

#include <vector>

#include <trocar/render/frame/material.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// A wall's look with its vessels drawn around the cavity, so that they continue from one mesh to the next.
render::Material lining(render::Material material, const sim::Model& model);
/// Seen from inside; a few millimetres of it lie below the walls.
MeshBuffer cavity_around(const sim::Model& model);
/// A wall's border: its vertices in the order in which its edges follow each other.
std::vector<std::vector<int>> border_loops(const tissue::Skin& wall);
/// How much fat lies below the peritoneum at a place, 0..1: what makes a pelvis patchy yellow.
double fat_below(Vec3d p);

}  // namespace trocar::view
