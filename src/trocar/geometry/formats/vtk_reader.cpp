// Legacy VTK files with an unstructured grid, as text or big-endian binary.
//
//   # vtk DataFile Version 3.0 / title / ASCII or BINARY / DATASET UNSTRUCTURED_GRID
//   POINTS n float, CELLS n size, CELL_TYPES n                     old: each cell its number of nodes, then these
//   CELLS n+1 size / OFFSETS vtktypeint64 / CONNECTIVITY ...       from 5.0 on
//   POINT_DATA, CELL_DATA                                          vtk_data.hpp
//
// [VTK file formats: Simple legacy formats; vtkDataReader of VTK 9 for what these leave open]
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_reader.hpp>
#include <trocar/geometry/formats/vtk_data.hpp>
#include <trocar/geometry/formats/vtk_lists.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {
namespace {

class VtkReader {
 public:
  VtkReader(MeshSource& in, double scale)
      : m_in(in), m_values{in}, m_data(m_values), m_scale(scale), m_cells(m_values, "cells") {}

  TetFile read() {
    m_out.format = read_vtk_header(m_values, "UNSTRUCTURED_GRID", "tetrahedra");
    while (m_data.stopped().empty() && !m_in.peek_word().empty()) keyword();
    assemble();
    m_in.finish();
    m_out.notes = m_left_out.notes();
    if (!m_data.stopped().empty())
      m_out.notes.push_back("what comes from " + in_quotes(m_data.stopped()) + " on is not read");
    return std::move(m_out);
  }

 private:
  MeshSource& m_in;
  VtkValues m_values;
  VtkData m_data;
  double m_scale;
  bool m_have_points = false;
  VtkLists m_cells;
  std::vector<std::int64_t> m_types;  ///< of cells
  LeftOut m_left_out;
  TetFile m_out;

  void keyword() {
    const std::size_t at = m_in.at();
    const std::string word = m_values.word();
    if (word == "points") return points(at);
    if (word == "cells") return cells(at);
    if (word == "cell_types") return cell_types();
    if (word == "metadata") return m_data.metadata();
    if (word == "point_data" || word == "cell_data") return data_of(word == "cell_data", at);
    if (word == "field") return m_data.field();
    if (m_have_points && !m_types.empty()) return m_data.attribute(word);
    m_in.lose(at, tr("expected POINTS, CELLS or CELL_TYPES, got {}", m_in.shown(at)));
  }

  // The mesh.

  void points(std::size_t at) {
    if (m_have_points) m_in.lose(at, "expected POINTS once, got them again");
    m_have_points = true;
    const std::size_t count = m_in.count("points", m_values.binary() ? 3 : 5);
    const VtkType& type = m_values.type();
    if (type.whole) m_in.lose(at, "expected POINTS of type float or double, got another one");
    m_values.begin();
    if (m_in.binary() && count > m_in.left() / (3 * std::size_t(type.width)))
      m_in.lose(m_in.at(), tr("expected {} points, got {} bytes", count, m_in.left()));
    m_out.mesh.points.resize(count);
    for (Vec3d& p : m_out.mesh.points) read_point(m_in, type.width, m_scale, p);
    m_values.end();
  }

  void cells(std::size_t at) {
    if (!m_cells.empty()) m_in.lose(at, "expected CELLS once, got them again");
    m_cells.read();
  }

  void cell_types() {
    const std::size_t count = m_in.count("cell types", m_values.binary() ? 4 : 1);
    m_values.begin();
    for (std::size_t i = 0; i < count; ++i) m_types.push_back(m_values.whole(kVtkInt, "a cell's type"));
    m_values.end();
  }

  void data_of(bool of_cells, std::size_t at) {
    m_data.begin(of_cells, of_cells ? m_cells.count() : m_out.mesh.points.size(), at);
  }

  // All together.

  void assemble() {
    const std::size_t cells = m_cells.count();
    if (!m_have_points || m_cells.empty() || m_types.size() != cells) {
      m_in.finish();
      m_in.lose(0, tr("expected POINTS, CELLS and as many CELL_TYPES, got {} points, {} cells, {} types",
                      m_out.mesh.points.size(), cells, m_types.size()));
    }
    m_in.set_form(m_values.form);
    for (std::size_t c = 0; c < cells; ++c) cell(c);
    if (m_out.mesh.cells.empty() && m_in.faults() == 0)
      m_in.lose(0, "expected tetrahedra, got " + m_left_out.instead());
  }

  void cell(std::size_t c) {
    const std::int64_t nodes = m_cells.length(c);
    const VtkCell* type = vtk_cell(m_types[c]);
    const bool fits = !type || (type->exactly ? nodes == type->nodes : nodes >= type->nodes);
    if (!fits)
      return m_in.fault(m_cells.place(c), tr("expected {}{} nodes of a cell of type {}, got {}",
                                             type->exactly ? "" : "at least ", type->nodes, type->type, nodes));
    if (!type || !type->is_tet) return m_left_out.cell(type ? type->name : tr("cells of type {}", m_types[c]));
    if (nodes > 4) m_left_out.middle_nodes(int(nodes));
    std::array<int, 4> corners{};
    for (int k = 0; k < 4; ++k) corners[k] = corner(c, k);
    m_out.mesh.cells.push_back(corners);
    if (!m_data.regions().empty()) m_out.mesh.region.push_back(m_data.regions()[c]);
  }

  int corner(std::size_t c, int k) {
    const std::int64_t count = std::int64_t(m_out.mesh.points.size()), node = m_cells.point(c, k);
    if (node >= 0 && node < count) return int(node);
    m_in.fault(m_cells.place(c, k), tr("expected the number of a point from 0 to {}, got {}", count - 1, node));
    return 0;
  }
};

}  // namespace

TetFile read_vtk(MeshSource& in, double scale) { return VtkReader(in, scale).read(); }

}  // namespace trocar::geometry
