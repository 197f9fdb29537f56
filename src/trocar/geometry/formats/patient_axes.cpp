#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/patient_axes.hpp>

namespace trocar::geometry {

namespace {

std::string in_capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

}  // namespace

PatientAxes patient_axes_named(std::string_view name) {
  const std::string known = in_capitals(name);
  if (known.starts_with("LPS") || known.starts_with("LEFT-POSTERIOR-SUPERIOR")) return PatientAxes::lps;
  return known.starts_with("RAS") || known.starts_with("RIGHT-ANTERIOR-SUPERIOR") ? PatientAxes::ras
                                                                                  : PatientAxes::none;
}

PatientAxes patient_axes_in(std::string_view line) {
  constexpr std::string_view kKey = "SPACE=";
  const std::string text = in_capitals(line.substr(0, 1000));
  const std::size_t at = text.find(kKey);
  return at == text.npos ? PatientAxes::none : patient_axes_named(std::string_view(text).substr(at + kKey.size()));
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
