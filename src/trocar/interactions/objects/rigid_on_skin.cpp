#include <algorithm>

#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/objects/rigid_on_skin.hpp>

namespace trocar::interactions {
namespace {

constexpr double kBedAhead = 0.0005;  // [m] contacts are there before beads touch

int heaviest_of(const SkinPoint& on) noexcept {
  size_t best = 0;
  for (size_t k = 1; k < 3; ++k)
    if (on.weights[int(k)] > on.weights[int(best)]) best = k;
  return on.vertex[best];
}

void rest_bead(const RigidModel& m, std::int32_t body, std::int32_t bead, Vec3d p, const Surface& surface, int near,
               NetworkLoads& loads, RigidWork& work) noexcept {
  const SkinPoint on = nearest_skin_point(surface, walk_to_nearest(surface, near, p), p);
  const Vec3d off = p - on.point;
  const double away = length(off), side = dot(off, on.normal) < 0 ? -1.0 : 1.0, gap = side * away - m.radius;
  if (gap > kBedAhead || -side * away > kDeepestContact) return;
  if (work.beds.size() == work.beds.capacity()) {
    work.overflowed = true;
    return;
  }
  const int vertex = heaviest_of(on);
  const Vec3d normal = away > 1e-6 ? (side / away) * off : on.normal;
  work.beds.push_back({body, bead, normal, surface.velocity(vertex), gap < 0 ? 0.5 * gap : gap});
  if (gap < 0)
    push_skin(surface, vertex, -0.5 * std::min(-gap, kQuickestApart) * normal, normal, kBodyStiffness, kBodyDamping,
              loads);
}

}  // namespace

void rest_on_skin(const RigidModels& models, const Rigid::States& states, const Surface& surface, NetworkLoads& loads,
                  RigidWork& work) noexcept {
  for (size_t i = 0; i < states.size(); ++i) {
    const RigidModel& m = models.list[i];
    const Vec3d middle = states[i].x;
    if (states[i].inside() || !surface.pose->bounds.reaches(middle, m.reach + kBedAhead)) continue;
    const int near = nearest_vertex_near(surface, middle, m.reach + kFarthestContact);
    if (near < 0 || surface.torn(near)) continue;
    for (size_t b = 0; b < m.beads.size(); ++b)
      rest_bead(m, std::int32_t(i), std::int32_t(b), place_of(states[i], m.beads[b]), surface, near, loads, work);
  }
}

}  // namespace trocar::interactions
