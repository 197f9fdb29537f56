// An object that no hand holds any more has fallen.
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

/// From when it was let go of to when it lies.
struct Fall {
  BodyId body;
  int hand = -1;  ///< the last that held it; -1: none has
  bool held = false;
  Vec3d from, last;      ///< where it was let go of, and in the tick before [m]
  double still_for = 0;  ///< [s]
};

class Dropped final : public EventDetector {
 public:
  Dropped(const sim::Model& model, const Arguments& a) : m_least(a[0].number()) {
    interactions::visit_objects(model, [this](auto kind, BodyId id) {
      if (kind.kRigidInJaws) m_falls.emplace_back().body = id;
    });
  }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    const Vec3d down = normalised(snapshot.model.gravity, {0, 0, -1});
    for (Fall& f : m_falls) {
      const Vec3d now = place_of(snapshot, f.body);
      note_hands(snapshot, f, now);
      f.still_for = length(now - f.last) < kStill * sim::kTick ? f.still_for + sim::kTick : 0;
      f.last = now;
      if (f.held || f.hand < 0 || f.still_for < kLies) continue;
      const double fallen = dot(now - f.from, down);
      if (fallen > m_least)
        out.add({f.hand, f.body, -1, name_of_body(snapshot.model, f.body),
                 tip_of(snapshot.model, snapshot.state, size_t(f.hand)), now});
      f.hand = -1;
    }
  }

 private:
  static constexpr double kStill = 0.005, kLies = 0.2;  // [m/s], [s] slower for so long it lies

  static Vec3d place_of(const Snapshot& snapshot, BodyId body) {
    Vec3d at;
    interactions::visit_object(body, [&](auto kind) {
      at = kind.middle(interactions::part_of<decltype(kind)>(snapshot.model),
                       interactions::part_of<decltype(kind)>(snapshot.state), body.index());
    });
    return at;
  }
  static void note_hands(const Snapshot& snapshot, Fall& f, Vec3d now) {
    bool held = false;
    for (size_t t = 0; t < hands(snapshot.model); ++t) {
      const interactions::ToolState& tool = snapshot.state.tools[t];
      if (tool.holds == 0 || tool.hold[0].at.body != f.body) continue;
      held = true;
      f.hand = int(t);
    }
    if (f.held && !held) f.from = now;
    f.held = held;
  }

  double m_least;
  std::vector<Fall> m_falls;
};

/// The endoscope points at it: its middle lies within the picture.
Value in_view(const Snapshot& snapshot, const EventInstance& h) {
  const kinematics::ScopeFrame scope = sim::scope_of(snapshot.model, snapshot.state);
  const double half = 0.5 * snapshot.model.scope.field_of_view;
  return dot(normalised(h.where - scope.eye), scope.forward) > portable::cos(half);
}

std::string_view needs_objects(const sim::Model& model) {
  bool any = false;
  interactions::visit_objects(model, [&any](auto kind, BodyId) { any = any || kind.kRigidInJaws; });
  return any ? "" : "objects";
}

}  // namespace

const EventKind kDropped{
    "dropped",
    {{"by_mm", ArgumentKind::number, "the object has fallen more than this when it comes to rest", true, 0, 500}},
    {{"in_view", "the endoscope shows where it came to rest", in_view, 0, 1, true}},
    "An object that a hand held has fallen and come to rest.",
    needs_objects,
    &make_detector<Dropped>,
    true};

}  // namespace trocar::training
