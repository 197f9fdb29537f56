#include <limits>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/modeller/operations/sketch.hpp>
#include <trocar/modeller/operations/values.hpp>

namespace trocar::modeller {
namespace {

constexpr double kEdge = 2;  // [mm] of the surface's triangles

/// Of a body's sections [mm]; empty where it has none that can be read.
geometry::TriMesh surface_of(const scene::JsonValue& body) {
  std::vector<geometry::Section> sections;
  if (const scene::JsonMember* list = body.find("sections"))
    for (const scene::JsonValue& s : list->value.items) {
      const scene::JsonMember *centre = s.find("centre_mm"), *across = s.find("across_mm"), *deep = s.find("deep_mm");
      if (!centre || !across || !deep || !is_point(centre->value) || !is_point(across->value) || !is_point(deep->value))
        return {};
      sections.push_back(
          {point_of(centre->value), point_of(across->value), point_of(deep->value), number_in(s, "squareness", 2)});
    }
  return sections.size() < 2 ? geometry::TriMesh{} : geometry::tessellate(geometry::loft(sections), kEdge);
}

Vec3d laid_on(const geometry::TriMesh& mesh, Vec3d point, double lift) {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3d out = point;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[std::size_t(t[0])], b = mesh.positions[std::size_t(t[1])],
                c = mesh.positions[std::size_t(t[2])];
    const geometry::TrianglePoint<double> foot = geometry::closest_on_triangle(point, a, b, c);
    if (foot.distance2 >= nearest) continue;
    nearest = foot.distance2;
    const Vec3d normal = cross(b - a, c - a);
    out = foot.point + normal * (lift / std::max(length(normal), 1e-12));
  }
  return out;
}

}  // namespace

std::vector<scene::Key> sketch_keys() {
  return {scene::keys::text("sketched_on", "a body with sections, on whose surface the points are laid; default: none"),
          scene::keys::number("lift_mm", -20, 20, "how far above that surface, default 0")};
}

std::vector<Vec3d> sketched(const scene::JsonObject& o, const Draft& draft, std::vector<Vec3d> points) {
  if (!o.has("sketched_on")) return points;
  const Thing body = draft.thing(o.text("sketched_on"));
  const geometry::TriMesh mesh = surface_of(draft.value(body.file, body.path));
  if (mesh.triangles.empty()) o.fault("sketched_on", "expected a body with sections, got another one");
  for (Vec3d& p : points) p = laid_on(mesh, p, o.number("lift_mm"));
  return points;
}

}  // namespace trocar::modeller
