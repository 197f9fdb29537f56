// A body's surface as its file describes it, whatever its shape is: for lines that are laid on it, and for what it
// faces.
#pragma once

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/scene/description/description.hpp>

namespace trocar::modeller {

/// In metres, as the description has it.
geometry::TriMesh surface_mesh(const scene::Solid& solid);
geometry::TriMesh surface_mesh(const scene::Pouch& pouch);

/// In millimetres, with edges of about 2 mm; without triangles where the thing is no solid or pouch with a closed
/// shape.
/// @throws core::BadInput where the document cannot be read
geometry::TriMesh body_mesh(const Document& document, const Thing& thing);

struct Foot {
  Vec3d at, normal;     ///< [mm]; of length 1, outwards
  double distance = 0;  ///< [mm]
};
/// The nearest place of a mesh that has triangles, in its unit.
Foot nearest_foot(const geometry::TriMesh& mesh, Vec3d point);

}  // namespace trocar::modeller
