#include <algorithm>

#include <trocar/core/hash.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {
namespace {

template <class List>
int find_name(const List& list, const std::string& name) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

void add_patch(core::Hasher& h, const StrandEndModel& end) {
  h.add(std::int32_t(end.kind));
  h.add(end.organ);
  h.add(end.patch.node);
  h.add(end.patch.weight);
  h.add(end.patch.offset);
  h.add(end.patch.drawn_pull);
}

void add_electrode(core::Hasher& h, const interactions::ElectrodeModel& e) {
  const tissue::ElectrodeDescription& c = e.current;
  h.add(std::int32_t(c.bipolar));
  for (double v :
       {c.radius, c.efficiency, c.back, c.wet, c.tip_capacity, c.tip_contact, c.tip_air, c.tip_share, c.sticks_from,
        c.sticks_fully, c.stick_force, e.seal.bare, e.seal.pressed, e.seal.needed, e.seal.brittle, e.seal.strongest})
    h.add(v);
}

void add_tool(core::Hasher& h, const interactions::ToolModel& t) {
  h.add(std::int32_t(t.kind));
  h.add(t.port);
  h.add(t.limits);
  for (double v : {t.shaft_radius, t.shaft_length, t.jaw_length, t.jaw_width, t.jaw_thickness, t.opening,
                   t.parallel_gap, t.pinch_max, t.friction, t.rubbing, t.clip_length})
    h.add(v);
  h.add(t.clips);
  if (t.electrode.there) add_electrode(h, t.electrode);
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

const std::string& Model::organ_name(int organ) const {
  const size_t i = size_t(organ), n = solids.size();
  return i < n ? solids[i].name : cuttables[i - n].name;
}
const std::string& Model::organ_look(int organ) const {
  const size_t i = size_t(organ), n = solids.size();
  return i < n ? solids[i].look : cuttables[i - n].look;
}
const tissue::Skin& Model::skin(int organ) const {
  const size_t i = size_t(organ), n = solids.size();
  return i < n ? solids[i].skin : cuttables[i - n].skin.skin;
}
int Model::organ_index(const std::string& organ) const {
  for (int i = 0; i < organs(); ++i)
    if (organ_name(i) == organ) return i;
  return -1;
}

int Model::membrane_index(const std::string& membrane) const { return find_name(membranes, membrane); }
int Model::strand_index(const std::string& strand) const { return find_name(strands, strand); }
int Model::vessel_index(const std::string& vessel) const { return find_name(vessels.list, vessel); }
int Model::hand_index(const std::string& trocar) const { return find_name(hands, trocar); }
int HandModel::find(const std::string& instrument) const { return find_name(rack, instrument); }

const interactions::ToolModel& Model::tool(const State& state, size_t hand) const noexcept {
  return hands[hand].rack[size_t(state.tools[hand].instrument)];
}

bool Model::irrigates() const noexcept {
  const auto has_bore = [](const interactions::ToolModel& t) {
    return t.kind == interactions::ToolKind::suction_irrigator;
  };
  const auto in_rack = [&](const HandModel& h) { return std::any_of(h.rack.begin(), h.rack.end(), has_bore); };
  return wet.there && std::any_of(hands.begin(), hands.end(), in_rack);
}

int Model::target_index(const std::string& target) const { return find_name(targets, target); }

void seal(Model& model) {
  core::Hasher h;
  h.add(model.gravity);
  for (const SolidModel& s : model.solids) {
    add_to_hash(h, s.network);
    add_to_hash(h, s.skin);
    add_to_hash(h, s.fine);
    h.add(s.failure_strain);
    for (const tissue::Anchor& a : s.anchors) {
      h.add(a.node);
      h.add(a.k);
      h.add(a.x0);
    }
  }
  for (const CuttableOrgan& c : model.cuttables) {
    tissue::add_to_hash(h, c.body);
    h.add(c.failure_strain);
  }
  for (const interactions::StrandBody& b : model.strand_bodies) interactions::add_to_hash(h, b);
  for (const StrandAnatomy& s : model.strands) {
    add_patch(h, s.start);
    add_patch(h, s.end);
    h.add(s.failure_strain);
  }
  for (const WallModel& w : model.walls) add_to_hash(h, w.skin);
  for (const MembraneBody& m : model.membranes) {
    add_to_hash(h, m.sheet);
    add_to_hash(h, m.skin);
    h.add(m.strand);
    h.add(std::int32_t(m.cuttable));
    h.add(m.depth);
    h.add(m.pinch_reach);
    h.add(m.failure_strain);
    for (const interactions::BorderHold& hold : m.holds) interactions::add_to_hash(h, hold);
  }
  for (const HandModel& hand : model.hands) {
    h.add(std::int32_t(hand.rack.size()));
    for (const interactions::ToolModel& t : hand.rack) add_tool(h, t);
  }
  h.add(model.scope.port);
  h.add(model.scope.limits);
  h.add(model.scope.angle);
  h.add(model.scope.field_of_view);
  h.add(model.start);
  h.add(model.cavity.low), h.add(model.cavity.high);
  for (const interactions::SurfacePair& p : model.surface_pairs) {
    h.add(p.strand);
    h.add(p.solid);
    h.add(p.membrane);
    h.add(p.surface);
    h.add(p.sample);
    h.add(p.radius);
    h.add(p.overlap);
  }
  for (const interactions::StrandPair& p : model.strand_pairs) {
    h.add(p.a);
    h.add(p.b);
    h.add(p.overlap);
  }
  for (const interactions::SelfPair& p : model.self_pairs) {
    h.add(p.organ);
    h.add(p.sample);
    h.add(p.overlap);
    h.add(p.others);
  }
  for (const VisibilitySample& s : model.samples) {
    h.add(s.target);
    h.add(s.where);
    h.add(s.w);
  }
  if (model.vessels.there()) {
    add_to_hash(h, model.vessels.flow);
    for (const Vessel& v : model.vessels.list) {
      interactions::add_to_hash(h, v.path);
      h.add(v.gain);
      h.add(v.mean_pressure);
      h.add(std::int32_t(v.vein));
    }
    const Bleeder& b = model.vessels.bleeder;
    if (b.vessel >= 0) h.add(b.vessel), h.add(b.s), h.add(b.area), h.add(b.tick);
    h.add(kPhysics);
  }
  if (model.wet.there) {
    const fluids::FluidsModel& f = model.wet.model;
    h.add(f.pool.origin), h.add(f.pool.u), h.add(f.pool.v), h.add(f.pool.nx), h.add(f.pool.ny), h.add(f.pool.cell);
    h.add(f.droplets.capacity), h.add(f.droplets.film_cells), h.add(f.droplets.film_capacity);
    h.add(model.wet.floor), h.add(model.wet.floor_organs), h.add(model.wet.film), h.add(kPhysics);
    if (f.droplets.fly_period > 1)
      h.add(f.droplets.fly_period), h.add(f.droplets.run_period), h.add(f.droplets.pair_parts), h.add(f.pool.first);
  }
  if (model.energy.there) {
    const tissue::GeneratorPanel& panel = model.energy.panel;
    add_to_hash(h, model.energy.heat);
    h.add(kPhysics);
    h.add(std::int32_t(panel.yellow));
    h.add(panel.yellow_watts), h.add(panel.blue_watts), h.add(panel.bipolar_watts);
    for (const auto* masks : {&model.energy.organs, &model.energy.folds})
      for (const geometry::CellMask& mask : *masks) h.add(mask.bits);
  }
  if (model.motion.there()) add_to_hash(h, model.motion);
  model.hash = h.value();
}

}  // namespace trocar::sim
