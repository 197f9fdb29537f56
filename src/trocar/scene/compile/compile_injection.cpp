#include <algorithm>

#include <trocar/scene/compile/compile_hands.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

const Tissue* tissue_named(const Description& d, const std::string& name) {
  const auto found = std::find_if(d.tissues.begin(), d.tissues.end(), [&](const Tissue& t) { return t.name == name; });
  return found == d.tissues.end() ? nullptr : &*found;
}

}  // namespace

bool has_needle(const sim::Model& model) {
  for (std::size_t t = 0; t < model.hands.size(); ++t)
    if (model.syringe_of(t) > 0) return true;
  return false;
}

void compile_injection(const Description& d, sim::Model& model) {
  if (!has_needle(model)) return;
  model.injection.organs.resize(std::size_t(model.organs()));
  // What has no cells, or cells that blades change, takes nothing up: no needle gets in.
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const sim::SolidModel& solid = model.solids[i];
    const Tissue* tissue = tissue_named(d, solid.tissue);
    if (!tissue || solid.network.tets.empty()) continue;
    model.injection.organs[i].puncture = tissue->puncture;
    model.injection.organs[i].infusion = tissue::infusion_of(solid.network, tissue->young);
  }
}

}  // namespace trocar::scene
