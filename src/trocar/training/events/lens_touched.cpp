#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

bool at_wall(const sim::Model& model, Vec3d eye, double near) {
  for (const sim::WallModel& wall : model.walls) {
    if (!wall.pose.bounds.near_segment(eye, eye, float(near))) continue;
    for (const Vec3f& x : wall.skin.rest)
      if (length(vec_cast<double>(x) - eye) < near) return true;
  }
  return false;
}

/// Is a vertex of an organ's skin or of a wall, or a node of a strand or a fold, that near to the lens?
bool touches(const Snapshot& snapshot, Vec3d eye, double near, BodyId& body) {
  const sim::Model& model = snapshot.model;
  for (int i = 0; i < model.organs(); ++i) {
    const tissue::NodeView nodes = nodes_of(model, snapshot.state, i);
    const tissue::Skin& skin = model.skin(i);
    for (int v = 0; v < skin.size(); ++v)
      if (length(tissue::skin_point(nodes, skin, v) - eye) < near) return body = BodyId::organ(size_t(i)), true;
  }
  for (size_t i = 0; i < model.strands.size(); ++i)
    for (const Vec3d& x : snapshot.state.strands[i].x)
      if (length(x - eye) < near) return body = BodyId::strand(i), true;
  return at_wall(model, eye, near);
}

class LensTouched final : public EventDetector {
 public:
  LensTouched(const sim::Model&, const Arguments& a) : m_near(a[0].number()) {}
  void sample(const Snapshot& snapshot, double, EventInstances& out) override {
    constexpr int kEvery = 5;  // samples: ten times a second
    if (++m_sample % kEvery != 0) return;
    const Vec3d eye = sim::scope_of(snapshot.model, snapshot.state).eye;
    BodyId body;
    const bool now = touches(snapshot, eye, m_near, body);
    if (now && !m_touching) out.add({-1, body, -1, name_of_body(snapshot.model, body), eye, eye});
    m_touching = now;
  }

 private:
  double m_near;
  int m_sample = 0;
  bool m_touching = false;
};

}  // namespace

const EventKind kLensTouched{
    "lens_touched",
    {{"within_mm", ArgumentKind::number, "a smaller distance counts as a contact", true, 0, 100}},
    {},
    "The endoscope's lens comes this close to tissue or a wall; reported once until it has moved away.",
    anywhere,
    &make_detector<LensTouched>,
    true};

}  // namespace trocar::training
