#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

class Overpulled final : public EventDetector {
 public:
  Overpulled(const sim::Model&, const Arguments& a) {
    m_tissues.delicate = a[0].bodies;
    m_limits.pull_limit = a[1].number();
    m_limits.pull_limit_other = a[2].number();
    m_limits.pull_excursion = a[3].number();
  }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    Incidents incidents;
    m_watch.update(m_limits, m_tissues, snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::overpulled, out);
  }

 private:
  Handling m_limits;
  Tissues m_tissues;
  PullWatch m_watch;
};

}  // namespace

const EventKind kOverpulled{"overpulled",
                            {{"delicate", ArgumentKind::bodies, "delicate bodies", false},
                             {"delicate_N", ArgumentKind::number, "largest pull on these bodies", true, 0, 100},
                             {"other_N", ArgumentKind::number, "largest pull on any other body", true, 0, 100},
                             {"lasting_s", ArgumentKind::number, "time from which a pull counts", true, 0.001, 10}},
                            {},
                            "A hand pulls harder than the limit; reported once until it pulls less.",
                            anywhere,
                            &make_detector<Overpulled>,
                            false,
                            EventKind::Hold::now};

}  // namespace trocar::training
