#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

constexpr std::int32_t kCritical = 1;  // as an event instance's number

class OffTarget final : public EventDetector {
 public:
  OffTarget(const sim::Model& model, const Arguments& a)
      : m_watch(with_carrier_of_bleeder(model, a[0].bodies), a[1].bodies) {}
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    Incidents incidents;
    m_watch.update(m_limits, snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::off_target, out);
    pass(incidents, Incident::never_there, out, kCritical);
  }

 private:
  EnergyLimits m_limits;
  EnergyWatch m_watch;
};

Value critical(const Snapshot&, const EventInstance& h) { return h.number == kCritical; }

}  // namespace

const EventKind kEnergyOffTarget{
    "energy_off_target",
    {{"targets", ArgumentKind::bodies, "bodies that may be treated besides the bleeding vessel", false},
     {"never", ArgumentKind::bodies, "bodies on which current is a critical error", false}},
    {{"critical", "the body is one on which current is never allowed", critical, 0, 1, true}},
    "Current flows through tissue that must not be treated; reported once per activation.",
    needs_energy,
    &make_detector<OffTarget>};

}  // namespace trocar::training
