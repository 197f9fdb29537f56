#include <algorithm>

#include <trocar/interactions/verbs/irrigate.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/pool_floor.hpp>
#include <trocar/sim/stages/stage.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/sim/stages/wetting.hpp>

namespace trocar::sim {
namespace {

/// Bodies as fluids meet them: skins as posed in this tick, nodes as they move now.
interactions::WetGround wet_ground(StepContext& c) noexcept {
  for (size_t i = 0; i < size_t(c.model.organs()); ++i) c.work.surfaces[i].nodes = c.work.organs[i].nodes;
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    c.work.membranes[i].sheet.surface.nodes = view_of(c.model.membranes[i].sheet.network, c.state.membranes[i].network);
  return {bodies_of(c), c.model.wet.film, c.model.wet.grids};
}

/// An opening's side keeps its number for as long as it is there.
void lay_out_bleeding(StepContext& c) noexcept {
  for (fluids::Outlet& o : c.work.wounds) o = {};
  for (int i = 0; i < c.work.bleed_count; ++i) {
    const Bleed& b = c.work.bleeds[size_t(i)];
    fluids::Outlet& o = c.work.wounds[size_t(2 * b.opening + b.side)];
    o.position = vec_cast<float>(b.place);
    o.direction = vec_cast<float>(b.direction);
    o.area = b.area;
    o.flow.blood = b.picolitres;
    o.venous = b.vein ? 1 : 0;
  }
}

// What follows are in the last places: with so many wounds that they are taken it leaves with those, and with more
// outlets than places several share one. Nothing that is on its way is left out.

/// @param place  taken last, counted down
fluids::Outlet& next_outlet(StepContext& c, size_t& place) noexcept {
  if (place == 0) place = c.work.wounds.size();
  return c.work.wounds[--place];
}

/// What runs out of pouches by their walls and by their ducts, as bile. @return the place taken last, counted down
size_t lay_out_leaks(StepContext& c, size_t place) noexcept {
  const size_t membranes = c.model.membranes.size();
  for (size_t i = 0; i < 2 * membranes; ++i) {
    const MembraneBody& m = c.model.membranes[i % membranes];
    if (m.sheet.enclosure.kind == tissue::Enclosure::none || (i >= membranes && m.duct < 0)) continue;
    fluids::Outlet& o = next_outlet(c, place);
    const tissue::Leak& leak = i < membranes ? c.work.membranes[i].by_wall : c.work.membranes[i - membranes].by_duct;
    if (leak.picolitres == 0 || m.sheet.enclosure.kind == tissue::Enclosure::gas) continue;
    o.flow.bile += leak.picolitres;
    if (o.area > 0) continue;
    o.position = vec_cast<float>(leak.place);
    o.direction = vec_cast<float>(leak.direction);
    o.area = leak.area;
  }
  return place;
}

/// What oozes where bonds were. @return as above
size_t lay_out_oozing(StepContext& c, size_t place) noexcept {
  for (size_t i = 0; i < c.model.bonds.size(); ++i) {
    if (!(c.model.bonds[i].oozes > 0) && !(c.model.bonds[i].bleeds > 0)) continue;
    fluids::Outlet& o = next_outlet(c, place);
    const Ooze ooze = ooze_from_bonds(c, i);
    if (ooze.picolitres == 0) continue;
    o.flow.blood += ooze.picolitres;
    c.state.flow.bled += ooze.picolitres;
    if (o.area > 0) continue;
    o.position = vec_cast<float>(ooze.place);
    o.film = ooze.film;
  }
  return place;
}

/// What needles spill and what runs back along their ways.
void lay_out_needles(StepContext& c, size_t place) noexcept {
  if (!c.model.injection.there()) return;
  for (std::int32_t i = 0; i < c.work.needle_outlet_count; ++i) {
    const NeedleOutlet& needle = c.work.needle_outlets[size_t(i)];
    fluids::Outlet& o = next_outlet(c, place);
    o.flow.saline += needle.picolitres;
    if (o.area > 0) continue;  // it leaves with a wound
    o.source = fluids::Source::kIrrigated;
    o.position = vec_cast<float>(needle.place);
    o.direction = vec_cast<float>(needle.direction);
    o.area = needle.area;
    o.film = needle.film;
  }
}

fluids::Capsule part_of(const collision::Capsule& now, const collision::Capsule& was) noexcept {
  fluids::Capsule out;
  out.a = vec_cast<float>(now.a);
  out.b = vec_cast<float>(now.b);
  out.radius = float(now.radius);
  out.va = vec_cast<float>((now.a - was.a) / kTick);
  out.vb = vec_cast<float>((now.b - was.b) / kTick);
  return out;
}

/// @param bodies  of tissue, whose numbers come first
int lay_out_instruments(StepContext& c, int bodies) noexcept {
  size_t n = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    const interactions::ToolShape &now = c.work.shapes[t], &was = c.work.shapes_before[t];
    for (int k = 0; k < interactions::kToolParts; ++k) {
      if (tool.can().irrigate && k != interactions::kShaft) continue;
      fluids::Capsule& out = c.work.wet_tools[n++];
      out = tool.can().irrigate ? tube_of(tool, now, was, kTick) : part_of(now.part[k], was.part[k]);
      out.body = bodies + int(t) * interactions::kToolParts + k;
    }
  }
  return int(n);
}

/// Valves of the instruments that have them. While a hand puts its instrument away nothing flows.
void lay_out_valves(StepContext& c, const interactions::WetGround& ground) noexcept {
  c.work.valves = {};
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    if (!tool.can().irrigate || c.input.tools[t].instrument != c.state.tools[t].instrument) continue;
    const interactions::Bore bore = bore_of(tool, c.work.shapes[t], c.work.shapes_before[t], kTick);
    fluids::SuctionIrrigator& out = c.work.valves[t];
    out.tip = vec_cast<float>(bore.end);
    out.direction = vec_cast<float>(bore.axis);
    out.velocity = vec_cast<float>(bore.velocity);
    out.irrigation = (c.input.pedals & irrigates(int(t))) != 0 ? 1 : 0;
    out.suction = (c.input.pedals & sucks(int(t))) != 0 ? 1 : 0;
    out.blocked = out.suction > 0 && covered(ground, bore.end, interactions::kPlugs);
  }
}

/// A pedal that stays down wipes again and again.
fluids::SmokeInput what_the_lens_meets(const StepContext& c) noexcept {
  fluids::SmokeInput out;
  out.wipe = (c.input.pedals & kWipe) != 0 && !(c.state.fluids.smoke.wipe_left > 0);
  out.lens = scope_of(c.model, c.state).eye;
  return out;
}

void note_valves(StepContext& c, const fluids::FluidsReport& report) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const fluids::SuctionIrrigator& v = c.work.valves[t];
    const fluids::ToolResult& r = report.tools[t];
    c.state.valves[t] = std::uint8_t((v.irrigation > 0 ? kIrrigates : 0) | (v.suction > 0 ? kSucks : 0) |
                                     (r.clogged ? kPlugged : 0) | (r.gas_flow > 0 ? kSucksGas : 0));
  }
}

/// What hits one place, as one. Where nothing is known of the place it is a body that nothing pushes.
void sum_up_impacts(std::span<const fluids::Impact> all, StepContext& c) noexcept {
  for (const fluids::Impact& hit : all)
    if (hit.film >= 0) c.work.impact_at[size_t(hit.film)] = -1;
  int& count = c.state.impact_count = 0;
  for (const fluids::Impact& hit : all) {
    if (hit.film < 0) continue;
    std::int32_t& at = c.work.impact_at[size_t(hit.film)];
    if (at < 0) {
      at = count;
      c.state.impacts[size_t(count++)] = hit;
      continue;
    }
    c.state.impacts[size_t(at)].impulse += hit.impulse;
    c.state.impacts[size_t(at)].mass += hit.mass;
  }
}

/// For the next tick: fluids move when the bodies have moved. Crowds of drops push together where they hit one place.
void keep_impacts(StepContext& c) noexcept {
  const fluids::DropletWork& drops = c.work.fluids.droplets;
  const std::span<const fluids::Impact> all(drops.impacts.data(), size_t(drops.impact_count));
  if (drops.ways > 1) return sum_up_impacts(all, c);
  c.state.impact_count = drops.impact_count;
  std::copy(all.begin(), all.end(), c.state.impacts.begin());
}

/// A drop pushes what it hits and continues with it, as in an inelastic collision: with the force alone a few
/// milligrams of fold would be thrown ahead of the drop.
///   f dt = P + m (v - v')      P the drop's momentum relative to the surface, m its mass, v before, v' after
struct Push {
  Vec3d impulse, dir;
  double mass = 0;
  explicit Push(const fluids::Impact& hit) noexcept
      : impulse(vec_cast<double>(hit.impulse)), dir(normalised(impulse)), mass(double(hit.mass)) {}
  Vec3d force(Vec3d velocity) const noexcept { return (1 / kTick) * (impulse + (mass * dot(velocity, dir)) * dir); }
  double drag() const noexcept { return mass / kTick; }
};

}  // namespace

void apply_drop_impacts(StepContext& c) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  const interactions::WetOrder order{size_t(c.model.surfaces()), c.model.membranes.size()};
  for (int i = 0; i < c.state.impact_count; ++i) {
    const fluids::Impact& hit = c.state.impacts[size_t(i)];
    const interactions::MaterialPoint at = film_point(bodies, c.model.wet.film, order, hit.body, hit.film);
    const Push push(hit);
    put_load(bodies, at, {.f0 = push.force(velocity_of(bodies, at)), .d = push.drag(), .dir = push.dir}, {});
  }
}

void move_fluids(StepContext& c) noexcept {
  if (!c.model.wet.there) return;
  lay_out_bleeding(c);
  lay_out_needles(c, lay_out_oozing(c, lay_out_leaks(c, c.work.wounds.size())));
  const interactions::WetGround ground = wet_ground(c);
  const int tools = lay_out_instruments(c, ground.count());
  lay_out_valves(c, ground);
  fluids::FluidsInput input;
  input.openings = c.work.wounds;
  input.capsules = {c.work.wet_tools.data(), size_t(tools)};
  input.tools = {c.work.valves.data(), c.model.hands.size()};
  follow_floor(c.model, c.work.surfaces, c.state);
  input.floor = c.state.pool_floor;
  input.smoke = what_the_lens_meets(c);
  if (c.work.steam.kilograms > 0) input.boiled = {&c.work.steam, 1};
  input.smoke.coagulating = c.work.current_flows;
  begin_tick(c.model.wet.model, input, c.state.fluids, c.work.fluids);
  answer_drops(ground, normalised(c.model.gravity, {0, 0, -1}), c.state.fluids.droplets, c.work.fluids.droplets,
               c.work.wet);
  const fluids::FluidsReport report = finish_tick(c.model.wet.model, input, c.state.fluids, c.work.fluids);
  if (report.report.flags & fluids::FluidReport::kDropletsFull) c.report.flags |= StepReport::kDropsFull;
  if (c.state.impacts.empty()) return;
  note_valves(c, report);
  keep_impacts(c);
}

}  // namespace trocar::sim
