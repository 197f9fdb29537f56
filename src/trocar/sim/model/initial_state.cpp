#include <trocar/fluids/pool_fill.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/pool_floor.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {
namespace {

/// Room for the counters of bodies that may tear.
void make_counters(const Model& model, State& s) {
  const auto counters = [](double failure, size_t size) { return std::vector<std::uint8_t>(failure > 0 ? size : 0); };
  for (const SolidModel& m : model.solids)
    s.overstretched_organs.push_back(counters(m.failure_strain, size_t(m.network.rows)));
  for (const CuttableOrgan& m : model.cuttables)
    s.overstretched_organs.push_back(counters(m.failure_strain, size_t(m.body.rows)));
  for (const MembraneBody& m : model.membranes)
    s.overstretched_membranes.push_back(counters(m.failure_strain, size_t(m.sheet.network.rows)));
  for (size_t i = 0; i < model.strands.size(); ++i)
    s.overstretched_strands.push_back(
        counters(model.strands[i].failure_strain, size_t(model.strand_bodies[i].nodes())));
}

/// What a hand holds from the start lies between its jaws in the drawn shape; they close on it in the first tick.
void take_hold(const Model& model, const State& s, const HandModel& hand, interactions::ToolState& tool) {
  if (hand.membrane < 0) return;
  const interactions::ToolShape shape = interactions::shape_of(hand.rack.front(), tool.pose(), tool.aperture);
  const tissue::NetworkModel& sheet = model.membranes[size_t(hand.membrane)].sheet.network;
  for (const std::int32_t node : hand.held) {
    interactions::Hold& hold = tool.hold[tool.holds++];
    hold.at = at_node(bodies_of(model, s), BodyId::membrane(size_t(hand.membrane)), node);
    const Vec3d local = interactions::to_jaw(shape, sheet.rest[size_t(node)]);
    hold.local[0] = float(local.x), hold.local[1] = float(local.y), hold.local[2] = float(local.z);
  }
}

void take_needles(const Model& model, size_t hand, State& s) {
  const auto& sutures = interactions::part_of<interactions::Suture>(model).list;
  for (size_t i = 0; i < sutures.size(); ++i)
    if (sutures[i].hand == std::int32_t(hand))
      interactions::hold_from_start(sutures[i], s.objects.sutures[i], BodyId(BodyKind::suture, i), model.placed(hand),
                                    interactions::shape_of(model.placed(hand), s.tools[hand].pose(), 0.1),
                                    s.tools[hand]);
}

}  // namespace

State drawn_bodies(const Model& model) {
  State s;
  for (const SolidModel& solid : model.solids) {
    s.solids.push_back(tissue::rest_state(solid.network));
    s.parted.emplace_back(solid.fine.triangles.size(), std::uint8_t(0));
  }
  for (const CuttableOrgan& c : model.cuttables) s.cuttables.push_back(tissue::rest_state(c.body));
  for (const interactions::StrandBody& body : model.strand_bodies) s.strands.push_back(tissue::rest_state(body.model));
  for (const MembraneBody& m : model.membranes) {
    s.membranes.push_back(tissue::rest_state(m.sheet));
    s.torn.emplace_back(m.sheet.triangles.size(), std::uint8_t(0));
  }
  for (const StaticOrgan& o : model.statics) s.statics.push_back({tissue::rest_state(o.solver), 0});
  for (const interactions::BondSet& set : model.bonds) s.bonds.emplace_back(set.bonds.size());
  interactions::start_objects(model, s);
  return s;
}

State initial_state(const Model& model) {
  State s = drawn_bodies(model);
  for (size_t t = 0; t < model.hands.size(); ++t) {
    interactions::ToolState& tool = s.tools[t];
    const ToolInput& in = model.start.tools[t];
    tool.yaw = in.yaw;
    tool.pitch = in.pitch;
    tool.roll = in.roll;
    tool.depth = in.depth;
    tool.handle = in.handle;
    tool.aperture = interactions::aperture_of(model.placed(t).linkage, double(in.handle));
    tool.clips_left = model.placed(t).clips;
    take_hold(model, s, model.hands[t], tool);
    take_needles(model, t, s);
    for (size_t i = 0; i < model.hands[t].rack.size(); ++i)
      s.magazine[t * size_t(kMaxRack) + i] = model.hands[t].rack[i].clips;
  }
  s.scope = model.start.scope;
  s.nearest = model.nearest_at_start;
  for (const interactions::CarriedPair& p : model.carried_pairs) s.carried.emplace_back(p.overlap.size(), -1);
  size_t sides = 0;
  for (const interactions::StrandPair& p : model.strand_pairs) sides += p.overlap.size();
  s.strand_side.resize(sides);
  size_t elements = 0;
  for (const interactions::StrandBody& body : model.strand_bodies) elements += size_t(body.nodes() - 1);
  const bool bends = model.bends();
  if (bends) s.joints.resize(model.hands.size());
  if (model.ports_move()) s.ports.resize(model.hands.size());
  s.tool_side.resize(model.hands.size() * elements *
                     size_t(bends ? interactions::kMostParts : interactions::kToolParts));
  size_t triangles = 0;
  for (const MembraneBody& m : model.membranes) triangles += m.sheet.triangles.size();
  s.sheet_side.resize(model.hands.size() * triangles *
                      size_t(bends ? interactions::kMostParts : interactions::kSheetParts));
  s.sheet_bond.resize(model.hands.size() * model.membranes.size());
  s.touches.resize(model.hands.size());
  for (size_t t = 0; t < model.hands.size(); ++t) interactions::start_here(s.tools[t], joints_of(s, t), s.touches[t]);
  s.seen.resize(model.samples.size());
  if (model.vessels.there()) {
    s.flow = model.vessels.start;
    s.openings.resize(interactions::kMaxOpenings);
    s.vessel_clips.resize(interactions::kMaxVesselClips);
  }
  if (model.energy.there) {
    s.heat = tissue::cold(model.energy.heat);
    s.panel = model.energy.panel;
    s.electrodes.resize(model.hands.size());
    s.seals.resize(interactions::kMaxSeals);
    s.scarred.resize(size_t(kMaxScarred));
    for (tissue::StrandState& strand : s.strands) strand.shrunk.assign(strand.alive.size(), 1.0);
  }
  if (model.wet.there) {
    s.fluids = fluids::initial_state(model.wet.model);
    lay_floor(model, s);
    const fluids::Mix poured =
        fluids::fill_level(model.wet.model.pool, s.pool_floor, model.wet.pool_at_start, s.fluids.pool);
    fluids::receive(s.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, poured);
  }
  if (model.injection.there()) {
    s.injection.hands.resize(model.hands.size());
    s.injection.fills.resize(model.hands.size());
    s.injection.tracks.resize(size_t(kMaxTracks));
    s.injection.given.resize(size_t(model.organs()));
    for (const PiercedOrgan& o : model.injection.organs) s.injection.organs.push_back(tissue::dry(o.infusion));
    for (size_t t = 0; t < model.hands.size(); ++t)
      s.injection.hands[t].left = std::int64_t(model.syringe_of(t) / fluids::kM3PerPicolitre + 0.5);
  }
  if (model.irrigates()) s.impacts.resize(size_t(model.wet.model.droplets.capacity));
  make_counters(model, s);
  return s;
}

}  // namespace trocar::sim
