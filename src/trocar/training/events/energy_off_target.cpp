#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/energy_watch.hpp>

namespace trocar::training {
namespace {

constexpr std::int32_t kCritical = 1;  // as a happening's number

class OffTarget final : public Noticer {
 public:
  OffTarget(const sim::Model& model, const Arguments& a)
      : m_watch(with_carrier_of_bleeder(model, a[0].bodies), a[1].bodies) {}
  void tick(const Moment& moment, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    m_watch.update(m_limits, moment.model, moment.state, mishaps);
    pass(mishaps, Mishap::off_target, out);
    pass(mishaps, Mishap::never_there, out, kCritical);
  }

 private:
  EnergyLimits m_limits;
  EnergyWatch m_watch;
};

Value critical(const Moment&, const Happening& h) { return h.number == kCritical; }

}  // namespace

const EventKind kEnergyOffTarget{
    "energy_off_target",
    {{"targets", ArgumentKind::bodies, "bodies that may be treated besides the bleeding vessel", false},
     {"never", ArgumentKind::bodies, "bodies on which current is a critical error", false}},
    {{"critical", "the body is one on which current is never allowed", critical, 0, 1, true}},
    "Current flows through tissue that must not be treated; reported once per activation.",
    needs_energy,
    &noticing<OffTarget>};

}  // namespace trocar::training
