// STEP and IGES files as Open CASCADE reads them, cut into the parts that a modeller would call bodies.
#pragma once

#include <filesystem>
#include <vector>

#include <TopoDS_Shape.hxx>

namespace trocar::cad {

/// Solids; faces that bound none are sewn to shells. In millimetres.
/// @throws core::BadInput when the file is neither, or holds no faces
std::vector<TopoDS_Shape> parts_of(const std::filesystem::path& file);

}  // namespace trocar::cad
