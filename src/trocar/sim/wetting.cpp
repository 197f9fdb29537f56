#include <trocar/sim/stage.hpp>
#include <trocar/sim/wetting.hpp>

namespace trocar::sim {
namespace {

/// Bodies as fluids meet them: skins as posed in this tick, nodes as they move now.
interactions::WetBodies wet_bodies(StepContext& c) noexcept {
  for (size_t i = 0; i < size_t(c.model.organs()); ++i) c.work.surfaces[i].nodes = c.work.nodes[i];
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    c.work.sheets[i].surface.nodes = view_of(c.model.membranes[i].sheet.network, c.state.membranes[i].network);
  return {c.work.surfaces, c.work.sheets, c.model.bodies, c.state.strands, c.model.wet.film};
}

/// An opening's side keeps its number for as long as it is there.
void lay_out_bleeding(StepContext& c) noexcept {
  for (fluids::Opening& o : c.work.wounds) o = {};
  for (int i = 0; i < c.work.bleed_count; ++i) {
    const Bleed& b = c.work.bleeds[size_t(i)];
    fluids::Opening& o = c.work.wounds[size_t(2 * b.opening + b.side)];
    o.position = vec_cast<float>(b.place);
    o.direction = vec_cast<float>(b.direction);
    o.area = b.area;
    o.flow.blood = b.picolitres;
  }
}

/// @param bodies  of tissue, whose numbers come first
int lay_out_instruments(StepContext& c, int bodies) noexcept {
  int n = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t)
    for (int k = 0; k < interactions::kToolParts; ++k) {
      const collision::Capsule &now = c.work.shapes[t].part[k], &was = c.work.shapes_before[t].part[k];
      fluids::Capsule& out = c.work.wet_tools[size_t(n)];
      out.a = vec_cast<float>(now.a);
      out.b = vec_cast<float>(now.b);
      out.radius = float(now.radius);
      out.va = vec_cast<float>((now.a - was.a) / kTick);
      out.vb = vec_cast<float>((now.b - was.b) / kTick);
      out.body = bodies + n++;
    }
  return n;
}

}  // namespace

void move_fluids(StepContext& c) noexcept {
  if (!c.model.wet.there) return;
  lay_out_bleeding(c);
  const interactions::WetBodies bodies = wet_bodies(c);
  const int tools = lay_out_instruments(c, bodies.count());
  fluids::FluidsInput input;
  input.openings = c.work.wounds;
  input.capsules = {c.work.wet_tools.data(), size_t(tools)};
  input.floor = c.model.wet.floor;
  if (c.work.steam.kilograms > 0) input.boiled = {&c.work.steam, 1};
  input.smoke.coagulating = c.work.current_flows;
  begin_tick(c.model.wet.model, input, c.state.fluids, c.work.fluids);
  answer_drops(bodies, normalised(c.model.gravity, {0, 0, -1}), c.state.fluids.droplets, c.work.fluids.droplets);
  const fluids::FluidsReport report = finish_tick(c.model.wet.model, input, c.state.fluids, c.work.fluids);
  if (report.report.flags & fluids::FluidReport::kDropletsFull) c.report.flags |= StepReport::kDropsFull;
}

}  // namespace trocar::sim
