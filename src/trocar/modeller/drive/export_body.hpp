// Bodies as compiled, for other programs: the skin as OBJ, STL, PLY or VTK, the network with its springs and cells as
// .msh. Of strands and vessels the skin is a closed tube of their outer radius and the network their middle line; of a
// wall, which has none, it is its triangles.
#pragma once

#include <string>

#include <trocar/sim/model/model.hpp>

namespace trocar::modeller {

/// The bytes of a file of that ending (".obj", ".stl", ".ply", ".vtk", ".msh"), in millimetres, as drawn.
/// @throws core::BadInput for a body or an ending that has none
std::string exported(const sim::Model& model, const std::string& body, const std::string& ending);

}  // namespace trocar::modeller
