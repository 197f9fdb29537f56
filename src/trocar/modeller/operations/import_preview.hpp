// What a file of another program holds, before it becomes a body: its parts, its size in each unit that it may be in,
// whether it is closed.
//
//   const ImportPreview preview = preview_of("liver.obj");
//   const Vec3d size = preview.size_mm(0.01);     // in centimetres
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

struct ImportPreview {
  struct Part {
    std::string name;  ///< of STEP and IGES its number
    geometry::Bounds box;
    double volume = 0;  ///< inside; of an open surface about, 0 of a sheet
    std::size_t triangles = 0;
    bool closed = true;
  };
  enum class Kind { surface, tetrahedra, drawing } kind = Kind::surface;
  std::string format;  ///< "STL, binary"
  std::vector<Part> parts;
  geometry::Bounds box;  ///< of all, in the file's unit
  double volume = 0;     ///< of all, in the file's unit
  std::size_t triangles = 0;
  bool closed = true;
  double metres = 0;    ///< in the file's unit where the format says so, else 0
  double guess = 1e-3;  ///< the unit that is likeliest [m], or the one that the format says
  std::vector<std::string> notes;

  /// What its unit is guessed by: the box of all, the volume of the largest part.
  geometry::Extent extent() const;
  /// Units that the file may be in [m]: millimetres, centimetres, metres, and its own.
  std::vector<double> units() const;
  Vec3d size_mm(double unit) const { return (box.high - box.low) * (1e3 * unit); }
  double volume_mL(double unit) const { return 1e6 * volume * unit * unit * unit; }
  Vec3d middle_mm(double unit) const { return (box.high + box.low) * (0.5e3 * unit); }
};
/// @throws core::BadInput for a file that cannot be read, core::EnvironmentLacks for one whose reader is missing
ImportPreview preview_of(const fs::path& file);

}  // namespace trocar::modeller
