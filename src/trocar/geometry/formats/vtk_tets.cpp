// Tetrahedra in legacy VTK files.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_reader.hpp>
#include <trocar/geometry/formats/vtk_dataset.hpp>

namespace trocar::geometry {
namespace {

class VtkTets {
 public:
  VtkTets(MeshSource& in, double scale)
      : m_in(in), m_grid(in, true, [&in, scale](std::size_t at, double value) {
          return checked_tet_coordinate(in, at, "a coordinate", value * scale);
        }) {}

  TetFile read() {
    for (std::size_t c = 0; c < m_grid.cells.count(); ++c) cell(c);
    if (m_out.mesh.cells.empty() && m_in.faults() == 0)
      m_in.lose(0, tr("expected tetrahedra, got {}: convert other cells to tetrahedra, for instance by "
                      "Tetrahedralize in ParaView",
                      m_left_out.instead()));
    m_in.finish();
    m_out.format = m_grid.format();
    m_out.axes = m_grid.axes();
    m_out.mesh.points = std::move(m_grid.points);
    m_out.notes = m_left_out.notes();
    m_grid.tell(m_out.notes);
    return std::move(m_out);
  }

 private:
  MeshSource& m_in;
  VtkDataset m_grid;
  LeftOut m_left_out;
  TetFile m_out;

  void cell(std::size_t c) {
    const std::size_t faults = m_in.faults();
    const VtkCell* type = m_grid.type_of(c);
    if (m_in.faults() > faults) return;
    if (!type || !type->is_tet) return m_left_out.cell(type ? type->name : tr("cells of type {}", m_grid.types[c]));
    if (m_grid.cells.length(c) > 4) m_left_out.middle_nodes(int(m_grid.cells.length(c)));
    std::array<int, 4> corners{};
    for (int k = 0; k < 4; ++k) corners[std::size_t(k)] = std::max(0, m_grid.point(m_grid.cells, c, k));
    m_out.mesh.cells.push_back(corners);
    if (!m_grid.regions().empty()) m_out.mesh.region.push_back(m_grid.regions()[c]);
  }
};

}  // namespace

TetFile read_vtk(MeshSource& in, double scale) { return VtkTets(in, scale).read(); }

}  // namespace trocar::geometry
