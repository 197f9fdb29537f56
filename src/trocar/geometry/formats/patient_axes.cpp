#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/patient_axes.hpp>

namespace trocar::geometry {

PatientAxes patient_axes_named(std::string_view name) {
  return name == "LPS" ? PatientAxes::lps : name == "RAS" ? PatientAxes::ras : PatientAxes::none;
}

PatientAxes patient_axes_in(std::string_view line) {
  constexpr std::string_view kKey = "SPACE=";
  const std::size_t at = line.find(kKey);
  return at == line.npos ? PatientAxes::none : patient_axes_named(line.substr(at + kKey.size(), 3));
}

void turn_to_our_axes(PatientAxes axes, std::vector<Vec3d>& points) {
  if (axes == PatientAxes::none) return;
  const double side = axes == PatientAxes::lps ? 1 : -1;
  for (Vec3d& p : points) p = {side * p.x, p.z, -side * p.y};
}

std::string turned_in_words(PatientAxes axes) {
  return tr("its head says SPACE={}: turned so that x is to the patient's left, y to the head, z to the front",
            axes == PatientAxes::lps ? "LPS" : "RAS");
}

}  // namespace trocar::geometry
