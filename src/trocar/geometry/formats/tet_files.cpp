// Which format a file has, and what the readers share.
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_reader.hpp>

namespace trocar::geometry {

TetFile read_tets(std::string_view bytes, const std::string& file, double scale) {
  if (bytes.size() > kMaxMeshBytes)
    throw core::BadInput({{{file, 1, 1}, tr("expected at most {} bytes, got {}", kMaxMeshBytes, bytes.size())}});
  MeshSource in(bytes, file);
  const std::string_view first = in.peek_word();
  if (first.substr(0, 1) == "$") return read_gmsh(in, scale);
  if (bytes.substr(in.at(), 14) == "# vtk DataFile") return read_vtk(in, scale);
  const bool xml = first.substr(0, 5) == "<?xml" || first.substr(0, 8) == "<VTKFile";
  in.lose(in.at(), tr("expected a Gmsh file ($MeshFormat, $NOD) or a legacy VTK file (# vtk DataFile Version), "
                      "got {}",
                      xml ? "XML" : in.shown(in.at())));
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
    point[k] = value * scale;
    if (std::fabs(point[k]) <= kMaxCoordinate) continue;
    in.fault(at, tr("expected {} within {} m, got {} m", kNames[k], kMaxCoordinate, point[k]));
    point[k] = 0;
    good = false;
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
