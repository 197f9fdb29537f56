#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

class Collided final : public EventDetector {
 public:
  Collided(const sim::Model&, const Arguments& a) { m_limits.collision_speed = a[0].number(); }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    constexpr int kEvery = 4;  // ticks between looks at instruments against each other: 250 Hz
    if (snapshot.state.tick % kEvery != 0) return;
    Incidents incidents;
    m_watch.update(m_limits, snapshot.model, snapshot.state, kEvery * sim::kTick, incidents);
    pass(incidents, Incident::collided, out);
  }

 private:
  Handling m_limits;
  CollisionWatch m_watch;
};

}  // namespace

const EventKind kCollided{"collided", {{"speed_mm_s", ArgumentKind::number, "faster than this", true, 0, 1000}},
                          {},         "Two instruments strike each other; reported once per contact.",
                          anywhere,   &make_detector<Collided>,
                          false,      EventKind::Hold::now};

}  // namespace trocar::training
