#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_dataset.hpp>

namespace trocar::geometry {
namespace {

struct VtkHeader {
  std::string format;
  PatientAxes axes;
  bool is_grid;
};

/// The first lines, up to the one that says which data set it is.
VtkHeader read_vtk_header(VtkValues& values, bool needs_grid) {
  MeshSource& in = values.in;
  const std::string_view first = in.line();
  const std::string_view version = first.substr(first.find_last_of(' ') + 1);
  const PatientAxes axes = patient_axes_in(in.line());  // the title
  in.skip_space();
  std::size_t at = in.at();
  const std::string form = core::in_small_letters(in.line());
  if (form == "binary")
    values.form = MeshSource::Form::binary_swapped;
  else if (form != "ascii")
    in.lose(at, tr("expected ASCII or BINARY, got {}", in.shown(at)));
  in.skip_space();
  at = in.at();
  if (values.word() != "dataset") in.lose(at, tr("expected DATASET, got {}", in.shown(at)));
  in.skip_space();
  at = in.at();
  const std::string dataset = values.word();
  const bool is_grid = dataset == "unstructured_grid";
  if (dataset == "structured_points")
    in.lose(at, tr("expected a mesh (POLYDATA or UNSTRUCTURED_GRID), got an image (STRUCTURED_POINTS): save it as NRRD "
                   "or MetaImage, and open it as a scan"));
  if (needs_grid && !is_grid) in.lose(at, tr("expected UNSTRUCTURED_GRID, as tetrahedra need, got {}", in.shown(at)));
  if (!is_grid && dataset != "polydata")
    in.lose(at, tr("expected POLYDATA or UNSTRUCTURED_GRID, as surfaces need, got {}", in.shown(at)));
  in.skip_line();
  return {fmt::format("VTK {}, {}", core::is_decimal(version) ? version.substr(0, 8) : "legacy",
                      values.binary() ? "binary" : "text"),
          axes, is_grid};
}

}  // namespace

VtkDataset::VtkDataset(MeshSource& in, bool needs_grid, const Coordinate& coordinate)
    : m_in(in),
      m_values{in},
      cells(m_values, "cells"),
      polygons(m_values, "polygons"),
      strips(m_values, "strips"),
      lines(m_values, "lines"),
      vertices(m_values, "vertices"),
      m_data(m_values) {
  const VtkHeader header = read_vtk_header(m_values, needs_grid);
  m_format = header.format;
  m_axes = header.axes;
  m_is_grid = header.is_grid;
  while (m_data.stopped().empty() && !m_in.only_padding_left()) keyword(coordinate);
  if (!m_data.stopped().empty() && !complete())
    m_in.lose(m_data.stopped_at(), tr("expected data of a type that is known, such as float, int or string, got {}",
                                      in_quotes(m_data.stopped())));
  if (!m_has_points) m_in.lose(0, "expected POINTS, got none");
  // Polygon data have no cells, but a file may write some all the same.
  if ((m_is_grid && cells.empty()) || types.size() != cells.count()) {
    m_in.finish();
    m_in.lose(0, tr("expected POINTS, CELLS and as many CELL_TYPES, got {} points, {} cells, {} types", points.size(),
                    cells.count(), types.size()));
  }
  m_in.set_form(m_values.form);  // of the places of faults that follow
}

PatientAxes VtkDataset::axes() const { return m_data.axes() == PatientAxes::none ? m_axes : m_data.axes(); }

void VtkDataset::keyword(const Coordinate& coordinate) {
  m_in.skip_comments();
  const std::size_t at = m_in.at();
  const std::string word = m_values.word();
  if (word.empty()) return;  // only comments were left
  if (word == "points") return read_points(at, coordinate);
  if (word == "cells") return read_lists(cells, at);
  if (word == "cell_types") return read_types();
  if (word == "polygons") return read_lists(polygons, at);
  if (word == "triangle_strips") return read_lists(strips, at);
  if (word == "lines") return read_lists(lines, at);
  if (word == "vertices") return read_lists(vertices, at);
  if (word == "metadata") return m_data.metadata();
  if (word == "field") return m_data.field();
  if (word == "point_data") return m_data.begin(false, points.size(), at);
  if (word == "cell_data")
    return m_data.begin(
        true, m_is_grid ? cells.count() : vertices.count() + lines.count() + polygons.count() + strips.count(), at);
  if (complete()) return m_data.attribute(word);
  m_in.lose(at, m_is_grid ? tr("expected POINTS, CELLS or CELL_TYPES, got {}", m_in.shown(at))
                          : tr("expected POINTS, POLYGONS or TRIANGLE_STRIPS, got {}", m_in.shown(at)));
}

void VtkDataset::read_points(std::size_t at, const Coordinate& coordinate) {
  static constexpr const char* kNames[] = {"an x coordinate", "a y coordinate", "a z coordinate"};
  if (m_has_points) m_in.lose(at, "expected POINTS once, got them again");
  m_has_points = true;
  const std::size_t count = m_in.count("points", m_values.binary() ? 3 : 5);
  const VtkType& type = m_values.type();
  m_values.begin();
  if (m_in.binary() && count > m_in.left() / (3 * std::size_t(type.width)))
    m_in.lose(m_in.at(), tr("expected {} points, got {} bytes", count, m_in.left()));
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d& p = points.emplace_back();
    for (int k = 0; k < 3; ++k) {
      m_in.begin_value();
      const std::size_t place = m_in.at();
      double value = 0;
      if (type.whole)
        value = double(m_values.whole(type, kNames[k]));
      else if (!m_in.real(value, type.width, kNames[k]))
        continue;
      p[k] = coordinate(place, value);
    }
  }
  m_values.end();
}

void VtkDataset::read_lists(VtkLists& of, std::size_t at) {
  if (!of.empty()) m_in.lose(at, tr("expected {} once, got them again", m_in.shown(at)));
  of.read();
}

void VtkDataset::read_types() {
  const std::size_t count = m_in.count("cell types", m_values.binary() ? 4 : 1);
  m_values.begin();
  for (std::size_t i = 0; i < count; ++i) types.push_back(m_values.whole(kVtkInt, "a cell's type"));
  m_values.end();
}

const VtkCell* VtkDataset::type_of(std::size_t c) {
  const std::int64_t nodes = cells.length(c);
  const VtkCell* type = vtk_cell(types[c]);
  if (type && (type->exactly ? nodes != type->nodes : nodes < type->nodes))
    m_in.fault(cells.place(c), tr("expected {}{} nodes of a cell of type {}, got {}", type->exactly ? "" : "at least ",
                                  type->nodes, type->type, nodes));
  return type;
}

int VtkDataset::point(const VtkLists& lists, std::size_t l, std::int64_t k) {
  const std::int64_t count = std::int64_t(points.size()), p = lists.point(l, k);
  if (p >= 0 && p < count) return int(p);
  m_in.fault(lists.place(l, k), tr("expected the number of a point from 0 to {}, got {}", count - 1, p));
  return -1;
}

void VtkDataset::tell(std::vector<std::string>& notes) const {
  if (!m_data.stopped().empty()) notes.push_back(tr("what comes from {} on is not read", in_quotes(m_data.stopped())));
}

}  // namespace trocar::geometry
