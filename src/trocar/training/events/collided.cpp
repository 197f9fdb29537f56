#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

class Collided final : public Noticer {
 public:
  Collided(const sim::Model&, const Arguments& a) { m_limits.collision_speed = a[0].number(); }
  void tick(const Moment& moment, const sim::StepReport&, Happenings& out) override {
    constexpr int kEvery = 4;  // ticks between looks at instruments against each other: 250 Hz
    if (moment.state.tick % kEvery != 0) return;
    Mishaps mishaps;
    m_watch.update(m_limits, moment.model, moment.state, kEvery * sim::kTick, mishaps);
    pass(mishaps, Mishap::collided, out);
  }

 private:
  Handling m_limits;
  CollisionWatch m_watch;
};

}  // namespace

const EventKind kCollided{"collided", {{"speed_mm_s", ArgumentKind::number, "faster than this", true, 0, 1000}},
                          {},         "Two instruments strike each other; reported once per contact.",
                          anywhere,   &noticing<Collided>,
                          false,      EventKind::Hold::now};

}  // namespace trocar::training
