// A part of a CAD file as the modeller takes it: triangles, and the NURBS that it is where it is one.
#pragma once

#include <optional>

#include <TopoDS_Shape.hxx>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/scene/description/body_shape.hpp>

namespace trocar::cad {

int faces_of(const TopoDS_Shape& part);

/// How far triangles may be from a part that nobody has said the unit of: more where it is far too large for an organ,
/// as its size is all that somebody is asked about then [m].
double within_of_size(const TopoDS_Shape& part, double within);

/// Its faces as triangles [m], of each face its own vertices, outwards as the file has it.
/// @param within  how far triangles may be from the surface [m]
geometry::TriMesh triangles_of(const TopoDS_Shape& part, double within);

/// The closed surface that a part of one whole face is, exactly: from pole to pole, or a ring. Nothing where it has
/// more faces, a trimmed one, or one that does not close.
std::optional<scene::NurbsShape> nurbs_of(const TopoDS_Shape& part);

}  // namespace trocar::cad
