#include <stdexcept>
#include <string>

#include <trocar/scene/compile/compile_energy.hpp>
#include <trocar/sim/verbs/heat_bodies.hpp>

namespace trocar::scene {

void compile_energy(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  if (!d.energy || !faults.empty()) return;
  const EnergySetting& e = *d.energy;
  sim::EnergyModel& out = model.energy;
  tissue::HeatDescription heat;
  heat.cell = e.cell;
  heat.bricks = e.bricks;
  heat.awake = e.awake;
  try {
    out.heat = tissue::build(heat, sim::kTick);
  } catch (const std::invalid_argument& wrong) {
    faults.push_back({e.at, std::string("expected heat that can be computed, got: ") + wrong.what()});
    return;
  }
  out.panel.yellow = e.blend ? tissue::EnergyMode::blend : tissue::EnergyMode::cut;
  out.panel.yellow_watts = e.yellow_watts;
  out.panel.blue_watts = e.blue_watts;
  out.panel.bipolar_watts = e.bipolar_watts;
  sim::note_heat_bodies(model);
  out.there = true;
}

}  // namespace trocar::scene
