#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/piece_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kPieceReach = 0.008;  // [m] about a cell and a half: the nearest vertex is not further

/// The nearest vertex of another piece within reach, or -1.
int nearest_of_others(const Surface& surface, std::span<const std::int32_t> part, int vertex) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  const Vec3d p = surface.position(vertex);
  double least = kPieceReach * kPieceReach;
  int best = -1;
  for (size_t b = 0; b < pose.block.size(); ++b) {
    if (!pose.block[b].reaches(p, kPieceReach)) continue;
    const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
    for (int v = int(b) * tissue::kSkinBlock; v < last; ++v) {
      if (part[size_t(v)] == part[size_t(vertex)]) continue;
      const double d = geometry::distance2(surface.position(v), p);
      if (d >= least || !surface.skin->at_surface(v)) continue;
      least = d;
      best = v;
    }
  }
  return best;
}

/// Pushes two vertices apart along n, which points from the second to the first, and holds them back across it.
void part_pair(const Surface& surface, int first, int second, double depth, Vec3d n, NetworkLoads& loads) noexcept {
  const double half = 0.5 * std::min(depth, kQuickestApart);
  push_skin(surface, first, half * n, n, kBodyStiffness, kBodyDamping, loads);
  push_skin(surface, second, -half * n, n, kBodyStiffness, kBodyDamping, loads);
  const Vec3d ours = tissue::skin_velocity(surface.nodes, *surface.skin, first);
  const Vec3d theirs = tissue::skin_velocity(surface.nodes, *surface.skin, second);
  const BodyRub rub = body_rub(kBodyStiffness * half, n, ours, theirs);
  rub_skin(surface, first, rub, theirs, loads);
  rub_skin(surface, second, rub, ours, loads);
}

}  // namespace

void piece_on_piece(const Surface& surface, std::span<const std::int32_t> part, int largest,
                    NetworkLoads& loads) noexcept {
  for (int v = 0; v < surface.skin->size(); ++v) {
    if (part[size_t(v)] == largest || !surface.skin->at_surface(v)) continue;
    const int other = nearest_of_others(surface, part, v);
    if (other < 0) continue;
    const Clearance c = facing_clearance(surface, other, surface.position(v), surface.normal(v));
    if (!(c.distance < 0)) continue;
    part_pair(surface, v, other, -c.distance, c.normal, loads);
  }
}

void lip_on_lip(const Surface& surface, std::span<const std::int32_t> part, std::span<const std::int32_t> source,
                int from, int to, NetworkLoads& loads) noexcept {
  for (int v = from; v < to; ++v) {
    const int twin = source[size_t(v)];
    if (part[size_t(v)] != part[size_t(twin)] || !surface.skin->at_surface(v) || !surface.skin->at_surface(twin))
      continue;
    const Vec3d apart = surface.position(v) - surface.position(twin);
    if (dot(apart, apart) > kPieceReach * kPieceReach) continue;
    // What the two normals have in common is the organ's own surface, where the cut comes out of it.
    const Vec3d across = surface.normal(twin) - surface.normal(v);
    if (!(dot(across, across) > 0.25)) continue;
    const Vec3d n = normalised(across);
    const double depth = -dot(apart, n);
    if (depth > 0) part_pair(surface, v, twin, depth, n, loads);
  }
}

}  // namespace trocar::interactions
