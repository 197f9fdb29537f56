#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Vec3d place_of_sample(const sim::Model& model, const sim::State& state, const sim::VisibilityTarget& target,
                      const sim::VisibilitySample& sample) {
  if (target.kind == sim::VisibilityTarget::strand || target.kind == sim::VisibilityTarget::organ ||
      target.kind == sim::VisibilityTarget::fold)
    return place_of(model, state, sample);
  const Vec3d tip = tip_of(model, state, size_t(target.index));
  if (target.kind == sim::VisibilityTarget::jaw) return tip;
  const Vec3d port = model.hands[size_t(target.index)].port;
  return port + sample.w * (tip - port);
}

}  // namespace

Vec3d place_of_mark(const sim::Model& model, const sim::State& state, int mark) {
  const sim::VisibilityTarget& target = model.targets[size_t(mark)];
  if (target.kind == sim::VisibilityTarget::mark)
    return sim::pose_of(model, state, model.marks[size_t(target.index)]).place;
  Vec3d sum{};
  for (int i = target.first; i < target.first + target.count; ++i)
    sum += place_of_sample(model, state, target, model.samples[size_t(i)]);
  return target.count > 0 ? sum / double(target.count) : sum;
}

bool can_face(const sim::Model& model, const sim::VisibilityTarget& target) {
  if (target.kind == sim::VisibilityTarget::mark) return !model.marks[size_t(target.index)].is_stripe();
  if (target.kind == sim::VisibilityTarget::fold) return model.membranes[size_t(target.index)].sheet.closed();
  return target.kind == sim::VisibilityTarget::organ;
}

namespace {

struct LivingSkin {
  const tissue::Skin& skin;
  tissue::NodeView nodes;
  Vec3d operator()(int vertex) const { return tissue::skin_point(nodes, skin, vertex); }
};
LivingSkin skin_of(const sim::Model& model, const sim::State& state, const sim::VisibilityTarget& target) {
  if (target.kind == sim::VisibilityTarget::organ)
    return {model.skin(target.index), nodes_of(model, state, target.index)};
  const sim::MembraneBody& m = model.membranes[size_t(target.index)];
  return {m.skin, view_of(m.sheet.network, state.membranes[size_t(target.index)].network)};
}

}  // namespace

std::optional<Vec3d> normal_of_mark(const sim::Model& model, const sim::State& state, int mark) {
  constexpr double kCancel = 0.3;  // of the samples' normals: less is a surface that goes all around
  const sim::VisibilityTarget& target = model.targets[size_t(mark)];
  if (!can_face(model, target)) return std::nullopt;
  if (target.kind == sim::VisibilityTarget::mark)
    return sim::pose_of(model, state, model.marks[size_t(target.index)]).normal;
  if (target.count == 0) return std::nullopt;
  const LivingSkin at = skin_of(model, state, target);
  Vec3d sum{};
  for (int i = target.first; i < target.first + target.count; ++i) {
    const int v = model.samples[size_t(i)].where;
    Vec3d around{};
    for (int k = at.skin.face_first[size_t(v)]; k < at.skin.face_first[size_t(v) + 1]; ++k) {
      const auto& t = at.skin.triangles[size_t(at.skin.face[size_t(k)])];
      const Vec3d a = at(t[0]);
      around += cross(at(t[1]) - a, at(t[2]) - a);
    }
    sum += normalised(around);
  }
  if (length(sum) < kCancel * target.count) return std::nullopt;
  return normalised(sum);
}

}  // namespace trocar::training
