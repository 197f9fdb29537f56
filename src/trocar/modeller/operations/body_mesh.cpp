#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/core/error.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/modeller/operations/body_mesh.hpp>

namespace trocar::modeller {
namespace {

constexpr double kEdge = 0.002;     // [m]
constexpr double kMostEdges = 150;  // along a body: one drawn metres long stays a small mesh
constexpr double kChord = 0.0002;   // [m] by which a spline's triangles may be off it

geometry::TriMesh mesh_of(const std::vector<scene::Section>& of_file, const scene::ClosedShape& shape) {
  if (shape.surface) return shape.surface->mesh;
  if (const auto spline = scene::spline_of(shape)) return geometry::nurbs::tessellate(*spline, kChord).mesh;
  std::vector<geometry::Section> sections;
  for (const scene::Section& s : of_file) sections.push_back({s.centre, s.across, s.deep, s.squareness});
  if (sections.size() < 2) return {};
  std::vector<Vec3d> middles;
  for (const geometry::Section& s : sections) middles.push_back(s.centre);
  const geometry::Bounds box = geometry::bounds(middles);
  return geometry::tessellate(geometry::loft(sections), std::max(kEdge, length(box.high - box.low) / kMostEdges));
}

}  // namespace

geometry::TriMesh surface_mesh(const scene::Solid& solid) {
  return solid.tets ? geometry::surface_of(solid.tets->mesh).mesh : mesh_of(solid.sections, solid.shape);
}
geometry::TriMesh surface_mesh(const scene::Pouch& pouch) { return mesh_of(pouch.sections, pouch.shape); }

geometry::TriMesh body_mesh(const Document& document, const Thing& thing) {
  std::vector<core::Fault> faults;
  const std::optional<scene::Description> d = document.description(faults);
  if (!d) throw core::BadInput(std::move(faults));
  geometry::TriMesh mesh;
  for (const scene::Solid& solid : d->solids)
    if (thing.kind == "solid" && solid.name == thing.name) mesh = mesh_of(solid.sections, solid.shape);
  for (const scene::Pouch& pouch : d->pouches)
    if (thing.kind == "pouch" && pouch.name == thing.name) mesh = mesh_of(pouch.sections, pouch.shape);
  for (Vec3d& p : mesh.positions) p = p * 1e3;
  return mesh;
}

Foot nearest_foot(const geometry::TriMesh& mesh, Vec3d point) {
  Foot out;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[std::size_t(t[0])], b = mesh.positions[std::size_t(t[1])],
                c = mesh.positions[std::size_t(t[2])];
    const geometry::TrianglePoint<double> foot = geometry::closest_on_triangle(point, a, b, c);
    if (foot.distance2 >= nearest) continue;
    nearest = foot.distance2;
    const Vec3d across = cross(b - a, c - a);
    out.at = foot.point;
    out.normal = across / std::max(length(across), 1e-12);
  }
  out.distance = std::sqrt(nearest);
  return out;
}

}  // namespace trocar::modeller
