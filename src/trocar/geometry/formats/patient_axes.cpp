#include <algorithm>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/patient_axes.hpp>

namespace trocar::geometry {

namespace {

constexpr const char* kNames[] = {"", "LPS", "RAS", "LAS", "RPS", "LPI", "RAI", "LAI", "RPI", "another order of these"};
const char* name_of(PatientAxes axes) { return kNames[int(axes)]; }

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

/// First letters of "LEFT-POSTERIOR-SUPERIOR", or the letters of a word of three.
std::string short_name(std::string_view name) {
  std::string out;
  std::size_t length = 0;
  for (std::size_t at = 0; at < name.size() && (is_capital(name[at]) || name[at] == '-'); at = length + 1) {
    length = std::min(name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ", at), name.size());
    if (out.empty() && length - at == 3) return std::string(name.substr(at, 3));
    out += name[at];
    if (length >= name.size() || name[length] != '-') break;
  }
  return out;
}

}  // namespace

PatientAxes patient_axes_named(std::string_view name) {
  const std::string text = core::in_capitals(name), known = short_name(text);
  for (int i = int(PatientAxes::lps); i < int(PatientAxes::other); ++i)
    if (known == kNames[i] || text.starts_with(kNames[i])) return PatientAxes(i);  // heads of STL run on behind it
  const auto once = [&known](const char* pair) { return known.find_first_of(pair) != known.npos; };
  return known.size() == 3 && once("LR") && once("AP") && once("IS") ? PatientAxes::other : PatientAxes::none;
}

PatientAxes patient_axes_in(std::string_view line) {
  constexpr std::string_view kKey = "SPACE=";
  const std::string text = core::in_capitals(line.substr(0, 1000));
  const std::size_t at = text.find(kKey);
  if (at == text.npos || (at > 0 && (is_capital(text[at - 1]) || text[at - 1] == '_'))) return PatientAxes::none;
  return patient_axes_named(std::string_view(text).substr(at + kKey.size()));
}

bool is_mirrored(PatientAxes axes) {
  const std::string_view name = name_of(axes);
  if (axes == PatientAxes::none || axes == PatientAxes::other) return false;
  return (int(name[0] == 'R') + int(name[1] == 'A') + int(name[2] == 'I')) % 2 == 1;
}

void turn_to_our_axes(PatientAxes axes, std::vector<Vec3d>& points) {
  if (axes == PatientAxes::none || axes == PatientAxes::other) return;
  const std::string_view name = name_of(axes);
  const double left = name[0] == 'L' ? 1 : -1, front = name[1] == 'A' ? 1 : -1, up = name[2] == 'S' ? 1 : -1;
  for (Vec3d& p : points) p = {left * p.x, up * p.z, front * p.y};
}

std::string turned_in_words(PatientAxes axes) {
  return tr("its head says SPACE={}: turned so that x is to the patient's left, y to the head, z to the front",
            name_of(axes));
}

std::string axes_fault() {
  return tr(
      "expected SPACE=LPS, RAS or other signs of these directions in this order, got another order: save the "
      "mesh in LPS");
}

}  // namespace trocar::geometry
