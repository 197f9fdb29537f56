#include <trocar/modeller/operations/body_mesh.hpp>
#include <trocar/modeller/operations/sketch.hpp>

namespace trocar::modeller {

std::vector<scene::Key> sketch_keys() {
  return {scene::keys::text("sketched_on", "a solid or a pouch on whose surface the points are laid; default: none"),
          scene::keys::number("lift_mm", -20, 20, "how far above that surface, default 0")};
}

std::vector<Vec3d> sketched(const scene::JsonObject& o, const Draft& draft, std::vector<Vec3d> points) {
  if (!o.has("sketched_on")) return points;
  const geometry::TriMesh mesh = body_mesh(draft.document(), draft.thing(o.text("sketched_on")));
  if (mesh.triangles.empty()) {
    o.fault("sketched_on", "expected a solid or a pouch with a shape, got something else");
    return points;
  }
  for (Vec3d& p : points) {
    const Foot foot = nearest_foot(mesh, p);
    p = foot.at + foot.normal * o.number("lift_mm");
  }
  return points;
}

}  // namespace trocar::modeller
