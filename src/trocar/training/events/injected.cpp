// A plunger that begins to press while the point is in an organ, and again when the point comes into a vessel.
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

class Injected final : public EventDetector {
 public:
  Injected(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport& report, EventInstances& out) override {
    for (int i = 0; i < report.event_count; ++i) {
      const sim::Event& e = report.events[i];
      if (e.kind != sim::Event::injected) continue;
      const sim::NeedleHand& n = snapshot.state.injection.hands[size_t(e.hand)];
      out.add({e.hand, e.body, -1, name_of_body(snapshot.model, e.body),
               tip_of(snapshot.model, snapshot.state, size_t(e.hand)), n.at});
    }
  }
};

const sim::NeedleHand& needle_at(const Snapshot& snapshot, const EventInstance& h) {
  return snapshot.state.injection.hands[size_t(h.hand)];
}

}  // namespace

const EventKind kInjected{
    "injected",
    {},
    {{"depth_mm", "depth of the needle's point below the nearest surface of the organ",
      [](const Snapshot& m, const EventInstance& h) -> Value { return needle_at(m, h).depth; }, -30, 60},
     {"drawn_s", "time of aspiration at that point before the injection",
      [](const Snapshot& m, const EventInstance& h) -> Value { return needle_at(m, h).drawn_for; }, 0, 3600},
     {"in_vessel", "the needle's point is in a vessel",
      [](const Snapshot& m, const EventInstance& h) -> Value { return needle_at(m, h).vessel >= 0; }, 0, 1, true}},
    "An injection into an organ began: the plunger is pressed with the needle's point inside.",
    needs_syringe,
    &make_detector<Injected>,
    true};

}  // namespace trocar::training
