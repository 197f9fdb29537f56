#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/liquid.hpp>

namespace trocar::training {
namespace {

class Activated final : public EventDetector {
 public:
  Activated(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    for (size_t h = 0; h < snapshot.state.electrodes.size(); ++h) {
      const sim::ElectrodeHand& e = snapshot.state.electrodes[h];
      const bool on = e.current.now.mode != tissue::EnergyMode::off;
      if (on && !m_on[h]) out.add({std::int32_t(h), e.body, -1, name_of_body(snapshot.model, e.body), e.at, e.at});
      m_on[h] = on;
    }
  }

 private:
  std::array<bool, sim::kMaxTools> m_on{};
};

Value under_liquid(const Snapshot& snapshot, const EventInstance& h) {
  return snapshot.model.wet.there &&
         drowned(snapshot.model, snapshot.state, tip_of(snapshot.model, snapshot.state, size_t(h.hand)));
}

}  // namespace

const EventKind kActivated{
    "activated",
    {},
    {{"under_liquid", "the tip was under the surface of pooled fluid", under_liquid, 0, 1, true}},
    "A pedal was pressed.",
    needs_energy,
    &make_detector<Activated>,
    true};

}  // namespace trocar::training
