// Meshes that come with a scan are along the patient's axes. 3D Slicer says which in the file's head: SPACE=LPS or
// SPACE=RAS, and writes millimetres. Other programs name other signs of the three directions. [Slicer: "Mesh file
// coordinate system", since 4.11]
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

enum class PatientAxes : unsigned char {
  none,  ///< not told: coordinates are taken as ours
  lps,   ///< left, posterior, superior
  ras,   ///< right, anterior, superior
  las,
  rps,
  lpi,
  rai,
  lai,
  rpi,
  other  ///< the same directions in another order, which is refused
};
inline constexpr double kPatientUnit = 1e-3;  ///< [m] of coordinates of files that name such axes

/// What a line of a file's head says.
PatientAxes patient_axes_in(std::string_view line);
/// The name of such axes alone, short or long (left-posterior-superior), in small or large letters.
PatientAxes patient_axes_named(std::string_view name);

/// Do they mirror what is turned from them into ours? Then triangles and cells run the other way round.
bool is_mirrored(PatientAxes axes);
/// Into our axes: x to the patient's left, y to the head, z to the front. Nothing where the file does not say.
void turn_to_our_axes(PatientAxes axes, std::vector<Vec3d>& points);
/// For people: "turned from the patient's axes LPS ...".
std::string turned_in_words(PatientAxes axes);
/// A fault's words of PatientAxes::other.
std::string axes_fault();

}  // namespace trocar::geometry
