#include <cmath>

#include <trocar/sim/model/mark.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {
namespace {

constexpr double kOut = 0.7;                   // radii: where a disc's outer samples lie
constexpr double kHalf = 0.86602540378443865;  // sine of 60 degrees

/// Out of the triangle, and the point of it.
MarkPose on_skin(const tissue::Skin& skin, const tissue::NodeView& nodes, const MarkModel& mark) noexcept {
  const Vec3d a = tissue::skin_point(nodes, skin, mark.vertex[0]), b = tissue::skin_point(nodes, skin, mark.vertex[1]),
              c = tissue::skin_point(nodes, skin, mark.vertex[2]);
  return {mark.weight.x * a + mark.weight.y * b + mark.weight.z * c, normalised(cross(b - a, c - a), mark.normal)};
}

}  // namespace

MarkPose pose_of(const Model& model, const State& state, const MarkModel& mark) noexcept {
  if (mark.on == MarkModel::space) return {mark.place, mark.normal};
  if (mark.on == MarkModel::organ) return on_skin(model.skin(mark.body), nodes_of(model, state, mark.body), mark);
  if (mark.on == MarkModel::membrane) {
    const MembraneBody& m = model.membranes[size_t(mark.body)];
    return on_skin(m.skin, view_of(m.sheet.network, state.membranes[size_t(mark.body)].network), mark);
  }
  const interactions::StrandBody& body = model.strand_bodies[size_t(mark.body)];
  const tissue::StrandState& strand = state.strands[size_t(mark.body)];
  return {interactions::point_at(body, strand, mark.at), interactions::tangent_at(body, strand, mark.at)};
}

Vec3d mark_sample(const Model& model, const State& state, const MarkModel& mark, int k, Vec3d eye) noexcept {
  if (mark.is_stripe()) {
    const interactions::StrandBody& body = model.strand_bodies[size_t(mark.body)];
    const interactions::StrandPlace at = interactions::place_at(body, mark.s + kOut * (k - 1) * mark.half);
    const Vec3d centre = interactions::point_at(body, state.strands[size_t(mark.body)], at);
    return centre + body.model.radius[size_t(at.element)] * normalised(eye - centre);
  }
  const MarkPose pose = pose_of(model, state, mark);
  if (k == 0) return pose.place;
  const Vec3d aside = std::fabs(pose.normal.z) < 0.995 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d right = normalised(cross(aside, pose.normal)), up = cross(pose.normal, right);
  const double x[6] = {1, 0.5, -0.5, -1, -0.5, 0.5}, y[6] = {0, kHalf, kHalf, 0, -kHalf, -kHalf};
  return pose.place + kOut * mark.half * (x[k - 1] * right + y[k - 1] * up);
}

}  // namespace trocar::sim
