#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::sim {
namespace {

using interactions::MaterialPoint;

struct Nearest : Attached {
  double distance;  ///< [m]
};

void look_at_rod(const interactions::Bodies& bodies, size_t i, Vec3d p, Nearest& best) {
  const interactions::StrandBody& body = bodies.strand(i);
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    const Vec3d a = body.model.rest[size_t(e)], b = body.model.rest[size_t(e) + 1];
    const double w = geometry::closest_on_segment(p, a, b);
    const Vec3d at = a + w * (b - a);
    const double distance = length(p - at) - body.model.radius[size_t(e)];
    if (distance < best.distance) best = {{at_element(bodies, i, e, w, p - at)}, distance};
  }
}

void look_at_organ(const interactions::Bodies& bodies, size_t i, Vec3d p, Nearest& best) {
  const tissue::Skin& skin = bodies.models.skin(int(i));
  int nearest = -1;
  for (int v = 0; v < skin.size(); ++v) {
    const double distance = length(p - vec_cast<double>(skin.rest[size_t(v)]));
    if (distance >= best.distance || !skin.at_surface(v)) continue;
    best.distance = distance;
    nearest = v;
  }
  if (nearest >= 0) best.point = along_with_vertex(bodies, i, nearest, p), best.vertex = nearest;
}

void look_at_membrane(const interactions::Bodies& bodies, size_t i, Vec3d p, Nearest& best) {
  const MaterialPoint point = attach(bodies, BodyId::membrane(i), p);
  const double distance = length(p - foot_of(bodies, point));
  if (distance < best.distance) best = {{point}, distance};
}

void look_at_fat(const interactions::Bodies& bodies, size_t i, Vec3d p, Nearest& best) {
  const std::vector<Vec3d>& lobules = bodies.models.fat[i].fat.network.rest;
  for (size_t n = 0; n < lobules.size(); ++n) {
    const double distance = length(p - lobules[n]);
    if (distance >= best.distance) continue;
    best = {{at_node(bodies, BodyId(BodyKind::fat, i), std::int32_t(n), p - lobules[n])}, distance};
  }
}

}  // namespace

Attached attach_near(const DrawnBodies& drawn, const std::vector<std::string>& names, double reach, Vec3d p) {
  const interactions::Bodies bodies = drawn.all();
  Nearest best{{interactions::in_space(p)}, reach};
  for (const std::string& name : names) {
    if (const int i = drawn.model().strand_index(name); i >= 0) look_at_rod(bodies, size_t(i), p, best);
    if (const int i = drawn.model().organ_index(name); i >= 0) look_at_organ(bodies, size_t(i), p, best);
    if (const int i = drawn.model().membrane_index(name); i >= 0) look_at_membrane(bodies, size_t(i), p, best);
    for (size_t i = 0; i < bodies.models.fat.size(); ++i)
      if (bodies.models.fat[i].name == name) look_at_fat(bodies, i, p, best);
  }
  return best;
}

}  // namespace trocar::sim
