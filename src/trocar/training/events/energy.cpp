// What current does where it should not. What carries the vessel that bleeds by itself may always be treated.
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/energy_watch.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/liquid.hpp>

namespace trocar::training {
namespace {

std::vector<BodyId> with_carrier(const sim::Model& model, std::vector<BodyId> bodies) {
  if (const BodyId carrier = carrier_of_bleeder(model); carrier.exists()) bodies.push_back(carrier);
  return bodies;
}

class Watch : public Noticer {
 public:
  Watch(std::vector<BodyId> targets, std::vector<BodyId> never) : m_watch(std::move(targets), std::move(never)) {}

 protected:
  void look_at(const Look& look, Mishaps& mishaps) { m_watch.update(m_limits, look.model, look.state, mishaps); }
  static void pass(const Mishaps& mishaps, Mishap::Kind kind, Happenings& out, std::int32_t number = -1) {
    for (int i = 0; i < mishaps.count; ++i) {
      const Mishap& m = mishaps.list[size_t(i)];
      if (m.kind == kind) out.add({m.hand, kNoBody, number, nullptr, m.where, m.where});
    }
  }
  EnergyLimits m_limits;
  EnergyWatch m_watch;
};

class Idle final : public Watch {
 public:
  Idle(const sim::Model&, const Arguments& a) : Watch({}, {}) { m_limits.idle_time = a[0].number(); }
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    look_at(look, mishaps);
    pass(mishaps, Mishap::idle, out);
  }
};

constexpr std::int32_t kCritical = 1;  // as a happening's number

class OffTarget final : public Watch {
 public:
  OffTarget(const sim::Model& model, const Arguments& a) : Watch(with_carrier(model, a[0].bodies), a[1].bodies) {}
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    look_at(look, mishaps);
    pass(mishaps, Mishap::off_target, out);
    pass(mishaps, Mishap::never_there, out, kCritical);
  }
};

class HotTip final : public Watch {
 public:
  HotTip(const sim::Model& model, const Arguments& a) : Watch(with_carrier(model, a[0].bodies), {}) {}
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    look_at(look, mishaps);
    pass(mishaps, Mishap::hot_tip, out);
  }
};

class SpreadWatch final : public Watch {
 public:
  SpreadWatch(const sim::Model&, const Arguments& a) : Watch({}, {}) {
    m_limits.hook_spread = a[0].number();
    m_limits.bipolar_spread = a[1].number();
  }
  void tick(const Look& look, const sim::StepReport&, Happenings&) override {
    Mishaps mishaps;
    look_at(look, mishaps);
  }
  void sample(const Look& look, double, Happenings& out) override {
    constexpr int kEvery = 25;  // samples between looks, which are dear: twice a second
    if (++m_sample % kEvery != 0) return;
    Mishaps mishaps;
    m_watch.look_at_spread(look.model, look.state, mishaps);
    pass(mishaps, Mishap::spread, out);
  }

 private:
  int m_sample = 0;
};

class Activated final : public Noticer {
 public:
  Activated(const sim::Model&, const Arguments&) {}
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    for (size_t h = 0; h < look.state.electrodes.size(); ++h) {
      const sim::ElectrodeHand& e = look.state.electrodes[h];
      const bool on = e.current.now.mode != tissue::EnergyMode::off;
      if (on && !m_on[h]) out.add({std::int32_t(h), e.body, -1, name_of_body(look.model, e.body), e.at, e.at});
      m_on[h] = on;
    }
  }

 private:
  std::array<bool, sim::kMaxTools> m_on{};
};

Value under_liquid(const Look& look, const Happening& h) {
  return look.model.wet.there && drowned(look.model, look.state, tip_of(look.model, look.state, size_t(h.hand)));
}
Value critical(const Look&, const Happening& h) { return h.number == kCritical; }

}  // namespace

const EventKind kActivated{"activated",
                           {},
                           {{"under_liquid", "the pool stood over its tip", under_liquid, 0, 1, true}},
                           "A pedal was pressed.",
                           needs_energy,
                           &noticing<Activated>,
                           true};
const EventKind kIdleActivation{"idle_activation",
                                {{"lasting_s", ArgumentKind::number, "for longer than this", true, 0, 60}},
                                {},
                                "A pedal is pressed while the electrode touches nothing; once an activation.",
                                needs_energy,
                                &noticing<Idle>};
const EventKind kEnergyOffTarget{
    "energy_off_target",
    {{"targets", ArgumentKind::bodies, "bodies that may be treated beside what bleeds", false},
     {"never", ArgumentKind::bodies, "bodies where it is critical", false}},
    {{"critical", "it is one of those where current never may go", critical, 0, 1, true}},
    "Current goes through tissue that was not to be treated; once an activation.",
    needs_energy,
    &noticing<OffTarget>};
const EventKind kHotTip{"hot_tip_touched",
                        {{"targets", ArgumentKind::bodies, "bodies that may be touched beside what bleeds", false}},
                        {},
                        "A tip that is still hot touches tissue that was not to be treated; once a touch.",
                        needs_energy,
                        &noticing<HotTip>};
const EventKind kHeatSpread{"heat_spread",
                            {{"hook_mm", ArgumentKind::number, "from a monopolar electrode's edge", true, 0, 100},
                             {"bipolar_mm", ArgumentKind::number, "from bipolar jaws", true, 0, 100}},
                            {},
                            "Tissue has died farther than that from where it was treated; once a body.",
                            needs_energy,
                            &noticing<SpreadWatch>};

}  // namespace trocar::training
