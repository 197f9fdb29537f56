#include <algorithm>

#include <trocar/collision/rods.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::sim {
namespace {

constexpr double kMaskShare = 0.97;  // of the field's half angle: what the mask's rim leaves
constexpr double kSkinEdge = 0.004;  // [m] boxes of vertices are grown by this to hold their triangles
constexpr double kWallEdge = 0.012;  // [m] the same for walls

/// Does the segment meet a triangle of the surface? A triangle is looked at with its lowest vertex's block.
/// @param open   per triangle: 1 = it is not there; may be empty
/// @param front  only where it comes from outside
bool hits_surface(const interactions::Surface& surface, Vec3d from, Vec3d to, std::span<const std::uint8_t> open = {},
                  double edge = kSkinEdge, bool front = false) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  if (!pose.bounds.near_segment(from, to, 0)) return false;
  const tissue::Skin& skin = *surface.skin;
  const Vec3d along = to - from;
  for (size_t b = 0; b < pose.block.size(); ++b) {
    if (!interactions::meets_box(pose.block[b], from, to, edge)) continue;
    const int last = std::min(int(b + 1) * tissue::kSkinBlock, skin.size());
    for (int v = int(b) * tissue::kSkinBlock; v < last; ++v)
      for (int k = skin.face_first[size_t(v)]; k < skin.face_first[size_t(v) + 1]; ++k) {
        const auto& t = skin.triangles[size_t(skin.face[size_t(k)])];
        if (!open.empty() && open[size_t(skin.face[size_t(k)])]) continue;
        if (std::min({t[0], t[1], t[2]}) != v) continue;
        const auto hit =
            geometry::ray_triangle(from, along, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
        if (!hit.hit || hit.t >= 1) continue;
        if (!front) return true;
        const Vec3d a = surface.position(t[0]);
        if (dot(cross(surface.position(t[1]) - a, surface.position(t[2]) - a), along) < 0) return true;
      }
  }
  return false;
}

/// Is a wall between the eye and the point? From behind, as from within a trocar that goes through it, it hides
/// nothing.
bool behind_wall(const Model& model, Vec3d eye, Vec3d end) noexcept {
  for (const WallModel& wall : model.walls) {
    const interactions::Surface surface{&wall.skin, &wall.pose, {}};
    if (hits_surface(surface, eye, end, {}, kWallEdge, true)) return true;
  }
  return false;
}

/// A sample's point, moved to the side of its body that faces the eye.
Vec3d sample_point(const Model& model, const State& state, const Work& work, const VisibilitySample& sample,
                   Vec3d eye) noexcept {
  const VisibilityTarget& target = model.targets[size_t(sample.target)];
  const size_t i = size_t(target.index);
  if (target.kind == VisibilityTarget::jaw) return work.shapes[i].part[interactions::kJawA + sample.where].b;
  if (target.kind == VisibilityTarget::shaft) {
    const Vec3d port = port_of(model, state, i);
    return port + sample.w * (work.shapes[i].shaft.tip - port);
  }
  if (target.kind == VisibilityTarget::mark) return mark_sample(model, state, model.marks[i], sample.where, eye);
  if (target.kind == VisibilityTarget::organ) return work.surfaces[i].position(sample.where);
  if (target.kind == VisibilityTarget::fold) return work.membranes[i].sheet.surface.position(sample.where);
  const interactions::StrandBody& body = model.strand_bodies[i];
  const Vec3d centre = point_at(body, state.strands[i], {sample.where, sample.w});
  return centre + body.model.radius[size_t(sample.where)] * normalised(eye - centre);
}

bool faces_eye(const Model& model, const State& state, const Work& work, const VisibilitySample& sample, Vec3d point,
               Vec3d eye) noexcept {
  const VisibilityTarget& target = model.targets[size_t(sample.target)];
  if (target.kind == VisibilityTarget::mark) {
    const MarkModel& mark = model.marks[size_t(target.index)];
    return mark.is_stripe() || dot(pose_of(model, state, mark).normal, eye - point) > 0;
  }
  if (target.kind == VisibilityTarget::fold)  // of a closed wall one side only is outside
    return !model.membranes[size_t(target.index)].sheet.closed() ||
           dot(work.membranes[size_t(target.index)].sheet.surface.normal(sample.where), eye - point) > 0;
  if (target.kind != VisibilityTarget::organ) return true;
  return dot(work.surfaces[size_t(target.index)].normal(sample.where), eye - point) > 0;
}

/// The strand whose own tissue does not hide the target, -1 if there is none.
int strand_of(const Model& model, const VisibilityTarget& target) noexcept {
  if (target.kind == VisibilityTarget::strand) return target.index;
  if (target.kind != VisibilityTarget::mark) return -1;
  const MarkModel& mark = model.marks[size_t(target.index)];
  return mark.is_stripe() ? mark.body() : -1;
}

/// Is no fold between the eye and the point?
bool before_folds(const Work& work, Vec3d eye, Vec3d point, double margin) noexcept {
  const double distance = length(point - eye);
  if (distance <= margin) return true;
  const Vec3d end = eye + (1.0 - margin / distance) * (point - eye);
  for (const interactions::MembraneBodyWork& membrane : work.membranes)
    if (hits_surface(membrane.sheet.surface, eye, end, membrane.sheet.parted)) return false;
  return true;
}

bool sees(const Model& model, const State& state, const Work& work, const VisibilitySample& sample,
          const kinematics::ScopeFrame& scope) noexcept {
  const VisibilityTarget& target = model.targets[size_t(sample.target)];
  const Vec3d p = sample_point(model, state, work, sample, scope.eye);
  const double half = 0.5 * kMaskShare * model.scope.field_of_view;
  if (dot(normalised(p - scope.eye), scope.forward) < portable::cos(half)) return false;
  if (!faces_eye(model, state, work, sample, p, scope.eye)) return false;
  const bool own = target.kind == VisibilityTarget::jaw || target.kind == VisibilityTarget::shaft;
  const int tool = own ? target.index : -1;
  const int strand = strand_of(model, target);
  // Folds are translucent: an instrument right behind one is seen through it, an organ is not told apart.
  return unoccluded(model, state, work, scope.eye, p, 0.0015, tool, strand) &&
         (own || before_folds(work, scope.eye, p, 0.0015));
}

}  // namespace

bool unoccluded(const Model& model, const State& state, const Work& work, Vec3d eye, Vec3d point, double margin,
                int skip_tool, int skip_strand) noexcept {
  const Vec3d sight = point - eye;
  const double distance = length(sight);
  if (distance <= margin) return true;
  const Vec3d end = eye + (1.0 - margin / distance) * sight;
  for (size_t s = 0; s < size_t(model.organs()); ++s)
    if (hits_surface(work.surfaces[s], eye, end)) return false;
  if (behind_wall(model, eye, end) || behind_fat(model, state, eye, end)) return false;
  for (size_t s = 0; s < model.strand_bodies.size(); ++s) {
    if (int(s) == skip_strand) continue;
    const tissue::StrandState& strand = state.strands[s];
    for (size_t e = 0; e + 1 < strand.x.size(); ++e)
      if (strand.alive[e] &&
          collision::passes_within(eye, end, strand.x[e], strand.x[e + 1], model.strand_bodies[s].model.radius[e]))
        return false;
  }
  for (size_t t = 0; t < model.hands.size(); ++t) {
    if (int(t) == skip_tool) continue;
    const interactions::ToolShape& shape = work.shapes[t];
    for (int part = interactions::kShaft; part < end_of(shape); part = interactions::next(part)) {
      const interactions::Capsule& c = shape.rod(part);
      if (collision::passes_within(eye, end, c.a, c.b, c.radius)) return false;
    }
  }
  return true;
}

void update_visibility(const Model& model, State& state, const Work& work) noexcept {
  if (model.samples.empty()) return;
  const kinematics::ScopeFrame scope = scope_of(model, state);
  for (int k = 0; k < kLooksPerTick; ++k) {
    const size_t i = size_t((state.tick * kLooksPerTick + std::uint64_t(k)) % model.samples.size());
    state.seen[i] = sees(model, state, work, model.samples[i], scope);
  }
}

}  // namespace trocar::sim
