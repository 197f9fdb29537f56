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

#include <trocar/core/decimal.hpp>
#include <trocar/geometry/formats/tet_reader.hpp>
#include <trocar/geometry/formats/vtk_data.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>

namespace trocar::geometry {
namespace {

class VtkReader {
 public:
  VtkReader(MeshSource& in, double scale) : m_in(in), m_values{in}, m_data(m_values), m_scale(scale) {}

  TetFile read() {
    header();
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
  std::vector<std::int64_t> m_start, m_nodes, m_types;  ///< of cells; start: one more than cells
  std::vector<std::uint32_t> m_at;                      ///< of m_nodes, their place in the file
  LeftOut m_left_out;
  TetFile m_out;

  void header() {
    const std::string_view first = m_in.line();
    const std::string_view version = first.substr(first.find_last_of(' ') + 1);
    m_in.line();  // the title
    m_in.skip_space();
    std::size_t at = m_in.at();
    const std::string form = lower(m_in.line());
    if (form == "binary")
      m_values.form = MeshSource::Form::binary_swapped;
    else if (form != "ascii")
      m_in.lose(at, fmt::format("expected ASCII or BINARY, got {}", m_in.shown(at)));
    m_out.format = fmt::format("VTK {}, {}", core::is_decimal(version) ? version.substr(0, 8) : "legacy",
                               m_values.binary() ? "binary" : "text");
    m_in.skip_space();
    at = m_in.at();
    if (m_values.word() != "dataset") m_in.lose(at, fmt::format("expected DATASET, got {}", m_in.shown(at)));
    m_in.skip_space();
    at = m_in.at();
    if (m_values.word() == "unstructured_grid") return m_in.skip_line();
    m_in.lose(at, fmt::format("expected UNSTRUCTURED_GRID, as tetrahedra need, got {}", m_in.shown(at)));
  }

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
    m_in.lose(at, fmt::format("expected POINTS, CELLS or CELL_TYPES, got {}", m_in.shown(at)));
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
      m_in.lose(m_in.at(), fmt::format("expected {} points, got {} bytes", count, m_in.left()));
    m_out.mesh.points.resize(count);
    for (Vec3d& p : m_out.mesh.points) read_point(m_in, type.width, m_scale, p);
    m_values.end();
  }

  void cells(std::size_t at) {
    if (!m_start.empty()) m_in.lose(at, "expected CELLS once, got them again");
    const bool text = !m_values.binary();
    const std::size_t first = m_in.count("cells", text ? 2 : 1), size = m_in.count("cells' nodes", text ? 2 : 1);
    m_in.skip_line();
    const std::size_t values_at = m_in.at();
    if (m_values.next_word() == "offsets") return new_cells(first, size);
    m_in.go_to(values_at);  // in binary files blanks are values, too
    old_cells(first, size);
  }

  /// @param size  of all numbers, those of nodes included
  void old_cells(std::size_t count, std::size_t size) {
    m_in.set_form(m_values.form);
    const std::size_t least = m_in.binary() ? 4 : 2;
    if (size > m_in.left() / least || count > size)
      m_in.lose(m_in.at(), fmt::format("expected {} cells in {} numbers, got {} bytes", count, size, m_in.left()));
    m_start.assign(1, 0);
    std::size_t left = size;
    for (std::size_t c = 0; c < count; ++c) {
      const std::size_t at = m_values.place();
      const std::int64_t nodes = m_values.whole(kVtkInt, "the number of a cell's nodes");
      if (left == 0 || nodes < 0 || std::uint64_t(nodes) > left - 1)
        m_in.lose(at, fmt::format("expected a cell of at most {} nodes, got {}", left == 0 ? 0 : left - 1, nodes));
      left -= 1 + std::size_t(nodes);
      for (std::int64_t k = 0; k < nodes; ++k) node(kVtkInt);
      m_start.push_back(std::int64_t(m_nodes.size()));
    }
    if (left != 0)
      m_in.lose(m_values.place(), fmt::format("expected {} numbers more in CELLS, got the end of the cells", left));
    m_values.end();
  }

  void new_cells(std::size_t offsets, std::size_t size) {
    m_in.word();
    const VtkType& offset_type = m_values.index_type();
    m_values.begin();
    const std::size_t least = m_in.binary() ? std::size_t(offset_type.width) : 2;
    if (offsets == 0 || offsets > (m_in.left() + 1) / least)
      m_in.lose(m_in.at(),
                fmt::format("expected at least one offset and room for {}, got {} bytes", offsets, m_in.left()));
    for (std::size_t i = 0; i < offsets; ++i) {
      const std::size_t at = m_values.place();
      const std::int64_t offset = m_values.whole(offset_type, "an offset"), before = i == 0 ? 0 : m_start.back();
      if (offset < before || std::uint64_t(offset) > size || (i == 0 && offset != 0))
        m_in.lose(at, fmt::format("expected an offset from {} to {}, got {}", before, i == 0 ? 0 : size, offset));
      m_start.push_back(offset);
    }
    m_values.end();
    connectivity(size);
  }

  void connectivity(std::size_t size) {
    m_in.skip_space();
    const std::size_t at = m_in.at();
    if (m_values.word() != "connectivity") m_in.lose(at, fmt::format("expected CONNECTIVITY, got {}", m_in.shown(at)));
    const VtkType& type = m_values.index_type();
    m_values.begin();
    const std::size_t least = m_in.binary() ? std::size_t(type.width) : 2;
    if (size > (m_in.left() + 1) / least || std::uint64_t(m_start.back()) != size)
      m_in.lose(m_in.at(), fmt::format("expected {} nodes of cells, as OFFSETS says, got {} announced and {} bytes",
                                       m_start.back(), size, m_in.left()));
    for (std::size_t i = 0; i < size; ++i) node(type);
    m_values.end();
  }

  void node(const VtkType& type) {
    m_at.push_back(static_cast<std::uint32_t>(m_values.place()));
    m_nodes.push_back(m_values.whole(type, "the number of a node"));
  }

  void cell_types() {
    const std::size_t count = m_in.count("cell types", m_values.binary() ? 4 : 1);
    m_values.begin();
    for (std::size_t i = 0; i < count; ++i) m_types.push_back(m_values.whole(kVtkInt, "a cell's type"));
    m_values.end();
  }

  void data_of(bool of_cells, std::size_t at) {
    const std::size_t cells = m_start.empty() ? 0 : m_start.size() - 1;
    m_data.begin(of_cells, of_cells ? cells : m_out.mesh.points.size(), at);
  }

  // All together.

  void assemble() {
    const std::size_t cells = m_start.empty() ? 0 : m_start.size() - 1;
    if (!m_have_points || m_start.empty() || m_types.size() != cells) {
      m_in.finish();
      m_in.lose(0, fmt::format("expected POINTS, CELLS and as many CELL_TYPES, got {} points, {} cells, {} types",
                               m_out.mesh.points.size(), cells, m_types.size()));
    }
    m_in.set_form(m_values.form);
    for (std::size_t c = 0; c < cells; ++c) cell(c);
    if (m_out.mesh.cells.empty() && m_in.faults() == 0)
      m_in.lose(0, "expected tetrahedra, got " + m_left_out.instead());
  }

  void cell(std::size_t c) {
    const std::int64_t nodes = m_start[c + 1] - m_start[c];
    const VtkCell* type = vtk_cell(m_types[c]);
    const bool fits = !type || (type->exactly ? nodes == type->nodes : nodes >= type->nodes);
    if (!fits) {
      const std::size_t at = m_start[c] < std::int64_t(m_at.size()) ? m_at[m_start[c]] : m_in.all().size();
      return m_in.fault(at, fmt::format("expected {}{} nodes of a cell of type {}, got {}",
                                        type->exactly ? "" : "at least ", type->nodes, type->type, nodes));
    }
    if (!type || !type->is_tet) return m_left_out.cell(type ? type->name : fmt::format("cells of type {}", m_types[c]));
    if (nodes > 4) m_left_out.middle_nodes(int(nodes));
    std::array<int, 4> corners{};
    for (int k = 0; k < 4; ++k) corners[k] = corner(std::size_t(m_start[c] + k));
    m_out.mesh.cells.push_back(corners);
    if (!m_data.regions().empty()) m_out.mesh.region.push_back(m_data.regions()[c]);
  }

  int corner(std::size_t i) {
    const std::int64_t count = std::int64_t(m_out.mesh.points.size());
    if (m_nodes[i] >= 0 && m_nodes[i] < count) return int(m_nodes[i]);
    m_in.fault(m_at[i], fmt::format("expected the number of a point from 0 to {}, got {}", count - 1, m_nodes[i]));
    return 0;
  }
};

}  // namespace

TetFile read_vtk(MeshSource& in, double scale) { return VtkReader(in, scale).read(); }

}  // namespace trocar::geometry
