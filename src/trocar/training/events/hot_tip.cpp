#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

class HotTip final : public Noticer {
 public:
  HotTip(const sim::Model& model, const Arguments& a) : m_watch(with_carrier_of_bleeder(model, a[0].bodies), {}) {}
  void tick(const Moment& moment, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    m_watch.update(m_limits, moment.model, moment.state, mishaps);
    pass(mishaps, Mishap::hot_tip, out);
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
    &noticing<HotTip>};

}  // namespace trocar::training
