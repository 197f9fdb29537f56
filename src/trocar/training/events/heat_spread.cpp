#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

class HeatSpread final : public EventDetector {
 public:
  HeatSpread(const sim::Model&, const Arguments& a) : m_watch({}, {}) {
    m_limits.hook_spread = a[0].number();
    m_limits.bipolar_spread = a[1].number();
  }
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances&) override {
    Incidents of_others;
    m_watch.update(m_limits, snapshot.model, snapshot.state, of_others);
  }
  void sample(const Snapshot& snapshot, double, EventInstances& out) override {
    constexpr int kEvery = 25;  // samples between looks, which are dear: twice a second
    if (++m_sample % kEvery != 0) return;
    Incidents incidents;
    m_watch.look_at_spread(snapshot.model, snapshot.state, incidents);
    pass(incidents, Incident::spread, out);
  }

 private:
  EnergyLimits m_limits;
  EnergyWatch m_watch;
  int m_sample = 0;
};

}  // namespace

const EventKind kHeatSpread{
    "heat_spread",
    {{"hook_mm", ArgumentKind::number, "distance from the edge of a monopolar electrode", true, 0, 100},
     {"bipolar_mm", ArgumentKind::number, "from bipolar jaws", true, 0, 100}},
    {},
    "Thermal necrosis has spread beyond this distance from the electrode; reported once per body.",
    needs_energy,
    &make_detector<HeatSpread>};

}  // namespace trocar::training
