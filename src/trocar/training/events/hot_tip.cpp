#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

class HotTip final : public EventDetector {
 public:
  HotTip(const sim::Model& model, const Arguments& a) : m_watch(with_carrier_of_bleeder(model, a[0].bodies), {}) {}
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    Incidents incidents;
    m_watch.update(m_limits, snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::hot_tip, out);
  }

 private:
  EnergyLimits m_limits;
  EnergyWatch m_watch;
};

}  // namespace

const EventKind kHotTip{
    "hot_tip_touched",
    {{"targets", ArgumentKind::bodies, "bodies that may be touched besides the bleeding vessel", false}},
    {},
    "A tip that is still hot touches tissue that must not be treated; reported once per contact.",
    needs_energy,
    &make_detector<HotTip>};

}  // namespace trocar::training
