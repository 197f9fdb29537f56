// Legacy VTK files with a surface, as text or big-endian binary: DATASET POLYDATA with POINTS, POLYGONS and
// TRIANGLE_STRIPS, and whatever data follow.
// [VTK file formats: Simple legacy formats]
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_data.hpp>
#include <trocar/geometry/formats/vtk_lists.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

class PolydataReader {
 public:
  PolydataReader(MeshSource& in, const std::string& name)
      : m_in(in),
        m_values{in},
        m_data(m_values),
        m_polygons(m_values, "polygons"),
        m_strips(m_values, "strips"),
        m_lines(m_values, "lines"),
        m_vertices(m_values, "vertices") {
    m_part.name = name;
  }

  SurfaceFile read() {
    m_file.format = read_vtk_header(m_values, "POLYDATA", "surfaces");
    while (m_data.stopped().empty() && !m_in.peek_word().empty()) keyword();
    if (!m_have_points) m_in.lose(0, "expected POINTS, got none");
    m_in.set_form(m_values.form);
    triangles();
    m_left_out.add("lines", std::int64_t(m_lines.count()));
    m_left_out.tell(m_file.notes);
    if (!m_data.stopped().empty())
      m_file.notes.push_back("what comes from " + in_quotes(m_data.stopped()) + " on is not read");
    m_file.parts.push_back(std::move(m_part));
    return std::move(m_file);
  }

 private:
  MeshSource& m_in;
  VtkValues m_values;
  VtkData m_data;
  VtkLists m_polygons, m_strips, m_lines, m_vertices;
  bool m_have_points = false;
  SurfacePart m_part;
  SurfaceFile m_file;
  SurfaceLeftOut m_left_out;

  void keyword() {
    const std::size_t at = m_in.at();
    const std::string word = m_values.word();
    if (word == "points") return points(at);
    if (word == "polygons") return lists(m_polygons, at);
    if (word == "triangle_strips") return lists(m_strips, at);
    if (word == "lines") return lists(m_lines, at);
    if (word == "vertices") return lists(m_vertices, at);
    if (word == "metadata") return m_data.metadata();
    if (word == "point_data") return m_data.begin(false, m_part.mesh.positions.size(), at);
    if (word == "cell_data")
      return m_data.begin(true, m_vertices.count() + m_lines.count() + m_polygons.count() + m_strips.count(), at);
    if (word == "field") return m_data.field();
    if (m_have_points) return m_data.attribute(word);
    m_in.lose(at, tr("expected POINTS, POLYGONS or TRIANGLE_STRIPS, got {}", m_in.shown(at)));
  }

  void lists(VtkLists& of, std::size_t at) {
    if (!of.empty()) m_in.lose(at, tr("expected {} once, got them again", m_in.shown(at)));
    of.read();
  }

  void points(std::size_t at) {
    if (m_have_points) m_in.lose(at, "expected POINTS once, got them again");
    m_have_points = true;
    const std::size_t count = m_in.count("points", m_values.binary() ? 3 : 5);
    const VtkType& type = m_values.type();
    if (type.whole) m_in.lose(at, "expected POINTS of type float or double, got another one");
    m_values.begin();
    if (m_in.binary() && count > m_in.left() / (3 * std::size_t(type.width)))
      m_in.lose(m_in.at(), tr("expected {} points, got {} bytes", count, m_in.left()));
    bound_items(m_in, count, "vertices");
    m_part.mesh.positions.resize(count);
    for (Vec3d& p : m_part.mesh.positions) p = read_surface_point(m_in, type.width);
    m_values.end();
  }

  /// Corners of list l, checked.
  void take(const VtkLists& lists, std::size_t l, PolygonList& to) {
    const std::int64_t count = std::int64_t(m_part.mesh.positions.size());
    for (std::int64_t k = 0; k < lists.length(l); ++k) {
      const std::int64_t p = lists.point(l, k);
      const bool good = p >= 0 && p < count;
      if (!good) m_in.fault(lists.place(l, k), tr("expected the number of a point from 0 to {}, got {}", count - 1, p));
      to.corners.push_back(good ? int(p) : PolygonList::kTold);
    }
    to.end_polygon(m_in, lists.place(l));
  }

  void triangles() {
    PolygonList polygons, strips;
    for (std::size_t l = 0; l < m_polygons.count(); ++l) take(m_polygons, l, polygons);
    for (std::size_t l = 0; l < m_strips.count(); ++l) take(m_strips, l, strips);
    m_in.finish();
    TriMesh& mesh = m_part.mesh;
    mesh.triangles = cut_polygons(m_in, mesh.positions, polygons, 0, polygons.count(), 0, m_file.notes);
    for (int s = 0; s < strips.count(); ++s)
      add_strip({strips.corners.data() + strips.start[s], std::size_t(strips.start[s + 1] - strips.start[s])},
                mesh.triangles);
  }
};

}  // namespace

SurfaceFile read_polydata(MeshSource& in, const std::string& name) { return PolydataReader(in, name).read(); }

}  // namespace trocar::geometry
