#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {
namespace {

template <class List>
int find_name(const List& list, const std::string& name) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

/// Raised where vessels, fluids or heat go another way with the same figures: recordings of before are of another
/// physics.
constexpr std::uint32_t kPhysics = 3;

}  // namespace

int Model::free_nodes() const {
  int n = 0;
  for (const SolidModel& s : solids)
    for (std::uint8_t held : s.network.fixed) n += held != tissue::kHeld;
  for (const CuttableOrgan& c : cuttables)
    for (int i = 0; i < c.body.own_nodes; ++i) n += c.body.fixed[size_t(i)] != tissue::kHeld;
  for (const interactions::StrandBody& b : strand_bodies) n += b.nodes() - int(b.model.prescribed_nodes.size());
  for (const MembraneBody& m : membranes) n += m.sheet.nodes() - int(m.sheet.held_nodes.size());
  return n;
}

int Model::organ_index(const std::string& organ) const {
  for (int i = 0; i < organs(); ++i)
    if (organ_name(i) == organ) return i;
  return -1;
}

int Model::membrane_index(const std::string& membrane) const { return find_name(membranes, membrane); }
int Model::strand_index(const std::string& strand) const { return find_name(strands, strand); }
int Model::vessel_index(const std::string& vessel) const { return find_name(vessels.list, vessel); }
int Model::bonds_index(const std::string& of) const { return find_name(bonds, of); }
int Model::hand_index(const std::string& trocar) const { return find_name(hands, trocar); }
int HandModel::find(const std::string& instrument) const { return find_name(rack, instrument); }

const interactions::ToolModel& Model::tool(const State& state, size_t hand) const noexcept {
  return hands[hand].rack[size_t(state.tools[hand].instrument)];
}

bool Model::bends() const noexcept {
  const auto can = [](const interactions::ToolModel& t) { return t.bends.bends(); };
  const auto in_rack = [&](const HandModel& h) { return std::any_of(h.rack.begin(), h.rack.end(), can); };
  return std::any_of(hands.begin(), hands.end(), in_rack);
}

bool Model::ports_move() const noexcept {
  return std::any_of(hands.begin(), hands.end(), [](const HandModel& h) { return h.give.moves(); });
}

bool Model::irrigates() const noexcept {
  const auto has_bore = [](const interactions::ToolModel& t) { return t.can().irrigate; };
  const auto in_rack = [&](const HandModel& h) { return std::any_of(h.rack.begin(), h.rack.end(), has_bore); };
  return wet.there && std::any_of(hands.begin(), hands.end(), in_rack);
}

double Model::syringe_of(size_t hand) const noexcept {
  for (const interactions::ToolModel& tool : hands[hand].rack)
    if (tool.can().inject) return tool.needle.holds;
  return 0;
}

int Model::target_index(const std::string& target) const { return find_name(targets, target); }

void add_to_hash(core::Hasher& h, const VesselsModel& vessels) noexcept {
  core::add_fields(h, vessels);
  h.add(kPhysics);
}

void add_to_hash(core::Hasher& h, const WetModel& wet) noexcept {
  core::add_fields(h, wet);
  h.add(kPhysics);
  const fluids::FluidsModel& f = wet.model;
  if (f.droplets.fly_period > 1)
    h.add(f.droplets.fly_period), h.add(f.droplets.run_period), h.add(f.droplets.pair_parts), h.add(f.pool.first);
}

void add_to_hash(core::Hasher& h, const EnergyModel& energy) noexcept {
  const tissue::GeneratorPanel& panel = energy.panel;
  core::add_fields(h, energy.heat);
  h.add(kPhysics);
  h.add(std::int32_t(panel.yellow));
  h.add(panel.yellow_watts), h.add(panel.blue_watts), h.add(panel.bipolar_watts);
  for (const auto* masks : {&energy.organs, &energy.folds})
    for (const geometry::CellMask& mask : *masks) core::add_fields(h, mask);
}

void seal(Model& model) {
  core::Hasher h;
  core::add_fields(h, model);
  model.hash = h.value();
}

}  // namespace trocar::sim
