#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

class Overpinched final : public EventDetector {
 public:
  Overpinched(const sim::Model&, const Arguments& a) {
    m_tissues.bowel = a[0].bodies;
    m_limits.pinch_limit = a[1].number();
    m_limits.pinch_impulse = a[2].number();
  }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    Incidents incidents;
    m_watch.update(m_limits, m_tissues, snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::overpinched, out);
  }

 private:
  Handling m_limits;
  Tissues m_tissues;
  PinchWatch m_watch;
};

}  // namespace

const EventKind kOverpinched{"overpinched",
                             {{"bowel", ArgumentKind::bodies, "delicate bodies"},
                              {"force_N", ArgumentKind::number, "largest pinch force", true, 0, 200},
                              {"impulse_N_s", ArgumentKind::number, "largest product of pinch force and time"}},
                             {},
                             "A hand pinches one of these bodies too hard or for too long; reported once per grasp.",
                             anywhere,
                             &make_detector<Overpinched>,
                             false,
                             EventKind::Hold::now};

}  // namespace trocar::training
