// Which format a file has, and what the readers share.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_reader.hpp>
#include <trocar/geometry/formats/vtk_dataset.hpp>

namespace trocar::geometry {

namespace {

constexpr std::string_view kVtkBegins = "# vtk DataFile";

TetFile read_known_tets(MeshSource& in, double scale) {
  const std::string_view first = in.peek_word(), rest = in.all().substr(in.at());
  if (first.starts_with('$')) return read_gmsh(in, scale);
  if (rest.starts_with(kVtkBegins)) return read_vtk(in, scale);
  in.refuse_wide_text();
  const std::string foreign = core::foreign_file(rest, core::Wanted::mesh);
  in.lose(in.at(), tr("expected a Gmsh file ($MeshFormat, $NOD) or a legacy VTK file (# vtk DataFile Version), "
                      "got {}",
                      foreign.empty() ? in.shown(in.at()) : foreign));
}

}  // namespace

TetFile read_tets(std::string_view bytes, const std::string& path, double scale) {
  if (bytes.size() > kMaxMeshBytes)
    throw core::BadInput({{{path, 1, 1}, tr("expected at most {} bytes, got {}", kMaxMeshBytes, bytes.size())}});
  MeshSource in(bytes, path);
  TetFile file = read_known_tets(in, scale);
  if (file.axes == PatientAxes::none) return file;
  if (file.axes == PatientAxes::other) in.lose(0, axes_fault());
  turn_to_our_axes(file.axes, file.mesh.points);
  if (is_mirrored(file.axes))
    for (auto& cell : file.mesh.cells) std::swap(cell[2], cell[3]);
  file.metres = kPatientUnit;
  file.notes.push_back(turned_in_words(file.axes));
  return file;
}

bool holds_tetrahedra(std::string_view bytes) {
  MeshSource in(bytes, "");
  if (in.peek_word().starts_with('$')) return true;
  if (!bytes.substr(in.at()).starts_with(kVtkBegins)) return false;
  try {
    const VtkDataset data(in, false, [](std::size_t, double value) { return value; });
    return std::any_of(data.types.begin(), data.types.end(), [](std::int64_t type) {
      const VtkCell* cell = vtk_cell(type);
      return cell && cell->is_tet;
    });
  } catch (const core::BadInput&) {  // whoever reads it tells what is wrong with it
    return bytes.find("UNSTRUCTURED_GRID") != bytes.npos;
  }
}

double checked_tet_coordinate(MeshSource& in, std::size_t at, const char* what, double metres) {
  if (std::fabs(metres) <= kMaxCoordinate) return metres;
  in.fault(at, tr("expected {} within {} m, got {} m", what, kMaxCoordinate, metres));
  return 0;
}

bool read_point(MeshSource& in, int width, double scale, Vec3d& point) {
  static constexpr const char* kNames[] = {"an x coordinate", "a y coordinate", "a z coordinate"};
  bool good = true;
  for (int k = 0; k < 3; ++k) {
    in.begin_value();
    const std::size_t at = in.at();
    double value = 0;
    if (!in.real(value, width, kNames[k])) {
      good = false;
      if (!in.binary() && !in.value_follows()) break;  // the line is short: told once
      continue;
    }
    const std::size_t faults = in.faults();
    point[k] = checked_tet_coordinate(in, at, kNames[k], value * scale);
    good = good && in.faults() == faults;
  }
  return good;
}

std::vector<std::string> LeftOut::notes() const {
  std::vector<std::string> out;
  for (const auto& [nodes, count] : m_higher)
    out.push_back(tr("{} tetrahedra of {} nodes: only their corners are used", count, nodes));
  for (const auto& [kinds, count] : m_cells) out.push_back(tr("{} {} left out", count, kinds));
  return out;
}

std::string LeftOut::instead() const {
  std::string out;
  for (const auto& [kinds, count] : m_cells) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, kinds);
  return out.empty() ? "none" : out;
}

}  // namespace trocar::geometry
