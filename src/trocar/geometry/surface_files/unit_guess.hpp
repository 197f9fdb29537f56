// What unit a surface's coordinates may be in. Files of most formats do not say. The size suggests a unit; what was
// taken is told, and where no unit makes an organ of it somebody must be asked.
//
//   const UnitChoice unit = choose_unit(extent_of(mesh), file.metres, "\"unit_mm\"");
//   if (!unit.question.empty()) ...   // a fault: "expected the unit of its coordinates, as no organ has ..."
//   say(unit.note);                   // "coordinates are taken as millimetres, guessed from the size: ..."
//
// Organs and instruments are some millimetres to half a metre long, organs hold 0.1 mL to 20 L, and few programs write
// centimetres: that is all there is to it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// In the file's unit.
struct Extent {
  Bounds box;
  double volume = 0;  ///< inside; 0: not known, as of an open surface
};
Extent extent_of(const TriMesh& closed);
/// An extent in metres, in a unit of so many metres.
Extent in_unit(const Extent& extent, double unit);

struct UnitGuess {
  /// Metres in the most likely of the units 1, 0.01 and 0.001; 0 where none makes an organ or instrument of it.
  double metres = 0;
  /// The other units in which it would be one, too: 15 may be centimetres or millimetres.
  std::vector<double> also;
  std::string words;  ///< "longest side 380.5: 38 cm and 1520 mL in millimetres, ..."
};
inline constexpr double kShortestBody = 0.004, kLongestBody = 0.8;    ///< [m] what counts as an organ or instrument
inline constexpr double kSmallestOrgan = 1e-7, kLargestOrgan = 0.02;  ///< [m^3]
inline constexpr double kUsualBody = 0.1;                             ///< [m] nearest to this is likeliest
inline constexpr double kSeldom = 4;  ///< so many times nearer it has to be in centimetres

UnitGuess guess_unit(const Extent& extent);

/// May an organ have this volume? One that is not known may. @param metres  in the unit of the extent
bool is_organs_volume(const Extent& extent, double metres);

struct UnitChoice {
  double metres = 0;     ///< in the file's unit; where there is a question the likeliest, or a millimetre
  std::string note;      ///< what was taken and why; empty where the file says its unit
  std::string question;  ///< a fault's words, where somebody must choose; empty where not
};
/// @param said  metres in the file's unit where the file says so, else 0
/// @param by    the option or key that sets a unit, as a person writes it: "--unit-mm"
UnitChoice choose_unit(const Extent& extent, double said, const char* by);

/// Metres in the unit that a line of a file's head names: "UNITS=in", "File units = meters"; 0 where it names none.
double unit_in_head(std::string_view line);

/// "millimetres"; other units by their length.
std::string unit_in_words(double metres);

}  // namespace trocar::geometry
