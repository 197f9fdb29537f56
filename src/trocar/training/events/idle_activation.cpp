#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

class IdleActivation final : public EventDetector {
 public:
  IdleActivation(const sim::Model&, const Arguments& a) : m_watch({}, {}) { m_limits.idle_time = a[0].number(); }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    Incidents incidents;
    m_watch.update(m_limits, snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::idle, out);
  }

 private:
  EnergyLimits m_limits;
  EnergyWatch m_watch;
};

}  // namespace

const EventKind kIdleActivation{"idle_activation",
                                {{"lasting_s", ArgumentKind::number, "for longer than this", true, 0, 60}},
                                {},
                                "A pedal is pressed while the electrode touches nothing; reported once per activation.",
                                needs_energy,
                                &make_detector<IdleActivation>};

}  // namespace trocar::training
