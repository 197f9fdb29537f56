// Surfaces in legacy VTK files: polygons and strips of POLYDATA, faces among the cells of an UNSTRUCTURED_GRID.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_dataset.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

/// Cells that are faces [VTK: vtkCellType.h].
enum FaceCell : std::int64_t {
  kTriangle = 5,
  kStrip = 6,
  kPolygon = 7,
  kPixel = 8,
  kQuadrangle = 9,
  kQuadraticTriangle = 22,
  kQuadraticQuadrangle = 23,
  kLagrangeTriangle = 69,
  kLagrangeQuadrangle = 70
};

class VtkSurface {
 public:
  VtkSurface(MeshSource& in, const std::string& name)
      : m_in(in), m_data(in, false, [&in](std::size_t at, double value) { return checked_coordinate(in, at, value); }) {
    m_part.name = name;
  }

  SurfaceFile read() {
    bound_items(m_in, m_data.points.size(), "vertices");
    m_file.format = m_data.format();
    m_file.axes = m_data.axes();
    for (std::size_t l = 0; l < m_data.polygons.count(); ++l)
      take(m_data.polygons, l, m_data.polygons.length(l), m_polygons);
    for (std::size_t l = 0; l < m_data.strips.count(); ++l) take(m_data.strips, l, m_data.strips.length(l), m_strips);
    for (std::size_t c = 0; c < m_data.cells.count(); ++c) cell(c);
    m_left_out.add("lines", std::int64_t(m_data.lines.count()));
    m_in.finish();
    if (m_polygons.count() + m_strips.count() == 0 && m_tetrahedra > 0)
      m_in.lose(0, tr("expected triangles, got {} tetrahedra", m_tetrahedra));
    if (m_polygons.count() + m_strips.count() == 0 && m_solids > 0)
      m_in.lose(0,
                tr("expected triangles or tetrahedra, got {} other cells with a volume (hexahedra, polyhedra): convert "
                   "them to tetrahedra, for instance by Tetrahedralize in ParaView",
                   m_solids));
    assemble();
    return std::move(m_file);
  }

 private:
  MeshSource& m_in;
  VtkDataset m_data;
  PolygonList m_polygons, m_strips;
  SurfacePart m_part;
  SurfaceFile m_file;
  SurfaceLeftOut m_left_out;
  std::int64_t m_tetrahedra = 0, m_solids = 0;

  /// Hexahedra, voxels, wedges, pyramids and polyhedra.
  static bool is_solid(std::string_view name) {
    for (const char* part : {"hexa", "voxel", "wedge", "pyramid", "polyhedr", "prism"})
      if (name.find(part) != name.npos) return true;
    return false;
  }

  /// The first corners of list l.
  void take(const VtkLists& lists, std::size_t l, std::int64_t corners, PolygonList& to) {
    for (std::int64_t k = 0; k < corners; ++k) to.corners.push_back(m_data.point(lists, l, k));
    to.end_polygon(m_in, lists.place(l));
  }

  void cell(std::size_t c) {
    const std::size_t faults = m_in.faults();
    const VtkCell* type = m_data.type_of(c);
    if (m_in.faults() > faults) return;
    const std::int64_t all = m_data.cells.length(c);
    switch (m_data.types[c]) {
      case kStrip:
        return take(m_data.cells, c, all, m_strips);
      case kTriangle:
      case kQuadrangle:
      case kPolygon:
        return take(m_data.cells, c, all, m_polygons);
      case kQuadraticTriangle:
      case kLagrangeTriangle:
        return take(m_data.cells, c, 3, m_polygons);
      case kQuadraticQuadrangle:
      case kLagrangeQuadrangle:
        return take(m_data.cells, c, 4, m_polygons);
      case kPixel:  // row by row, not around
        take(m_data.cells, c, all, m_polygons);
        std::swap(m_polygons.corners.end()[-1], m_polygons.corners.end()[-2]);
        return;
      default:
        m_tetrahedra += type && type->is_tet;
        m_solids += type && is_solid(type->name);
        m_left_out.add(type ? type->name : tr("cells of type {}", m_data.types[c]));
    }
  }

  void assemble() {
    TriMesh& mesh = m_part.mesh;
    mesh.positions = std::move(m_data.points);
    mesh.triangles = cut_polygons(m_in, mesh.positions, m_polygons, 0, m_polygons.count(), 0, m_left_out);
    for (int s = 0; s < m_strips.count(); ++s) add_strip(m_strips.polygon(s), mesh.triangles);
    m_left_out.tell(m_file.notes);
    m_data.tell(m_file.notes);
    m_file.parts.push_back(std::move(m_part));
  }
};

}  // namespace

SurfaceFile read_vtk_surface(MeshSource& in, const std::string& name) { return VtkSurface(in, name).read(); }

}  // namespace trocar::geometry
