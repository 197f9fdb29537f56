#include <cmath>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/mark.hpp>

namespace trocar::sim {
namespace {

constexpr double kOut = 0.7;                   // radii: where a disc's outer samples lie
constexpr double kHalf = 0.86602540378443865;  // sine of 60 degrees

}  // namespace

MarkPose pose_of(const Model& model, const State& state, const MarkModel& mark) noexcept {
  const interactions::Bodies bodies = bodies_of(model, state);
  if (mark.is_stripe()) {
    const size_t rod = mark.at.body.index();
    return {place_of(bodies, mark.at), tangent_at(bodies.strand(rod), bodies.strand_state(rod), place_on_rod(mark.at))};
  }
  return {place_of(bodies, mark.at), normal_at(bodies, mark.at, mark.normal)};
}

Vec3d mark_sample(const Model& model, const State& state, const MarkModel& mark, int k, Vec3d eye) noexcept {
  if (mark.is_stripe()) {
    const interactions::StrandBody& body = model.strand_bodies[size_t(mark.body())];
    const interactions::StrandPlace at = interactions::place_at(body, mark.s + kOut * (k - 1) * mark.half);
    const Vec3d centre = interactions::point_at(body, state.strands[size_t(mark.body())], at);
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
