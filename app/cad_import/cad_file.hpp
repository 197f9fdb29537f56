// STEP and IGES files as Open CASCADE reads them, cut into the parts that a modeller would call bodies.
#pragma once

#include <filesystem>
#include <vector>

#include <TopoDS_Shape.hxx>

namespace trocar::cad {

struct CadFile {
  std::vector<TopoDS_Shape> parts;  ///< solids; faces that bound none are sewn to shells [mm]
  double unit_mm = 1;               ///< of the file's own numbers, as it says; 1 where it names none or several
};
/// @throws core::BadInput when the file is neither, or holds no faces
CadFile read_cad(const std::filesystem::path& file);

}  // namespace trocar::cad
