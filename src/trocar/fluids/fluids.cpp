#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/poison.hpp>
#include <trocar/core/require.hpp>
#include <trocar/fluids/fluids.hpp>

namespace trocar::fluids {
namespace {

using core::require;

double valve(double opened) { return opened > 0 ? std::min(opened, 1.0) : 0.0; }

double irrigation_flow(const Lines& l, const SuctionIrrigator& tool) {
  return line_flow(l.irrigation_flow, l.bag_pressure, l.bag_pressure, valve(tool.irrigation));
}

/// The nozzles as openings, in places of their own so that a tool keeps what is forming at it.
int open_nozzles(const FluidsModel& m, const FluidsInput& in, FluidsState& s, FluidsWork& w) {
  const std::size_t tools = std::min(in.tools.size(), std::size_t(kMostTools));
  for (std::size_t k = 0; k < kMostTools; ++k) {
    Outlet& o = w.openings[k];
    o = Outlet{};
    if (k >= tools || !(valve(in.tools[k].irrigation) > 0)) continue;
    const SuctionIrrigator& tool = in.tools[k];
    o.position = tool.tip, o.direction = tool.direction, o.velocity = tool.velocity;
    o.area = m.lines.nozzle_area;
    o.source = Source::kIrrigated;
    o.flow.saline = whole_picolitres(irrigation_flow(m.lines, tool), m.tick, s.irrigation_carry[k]);
  }
  const std::size_t bleeding = std::min(in.openings.size(), std::size_t(kMostOpenings - kMostTools));
  for (std::size_t k = 0; k < bleeding; ++k) w.openings[kMostTools + k] = in.openings[k];
  return int(kMostTools + bleeding);
}

/// What is liquid within the capture radius, drops first, then the pool; the line's remaining flow draws gas.
ToolResult suck(const FluidsModel& m, const FluidsInput& in, std::size_t k, FluidsState& s) {
  const SuctionIrrigator& tool = in.tools[k];
  const Lines& l = m.lines;
  ToolResult out;
  const double irrigated = irrigation_flow(l, tool);
  out.thrust = jet_force(m.droplets.density.saline, irrigated, irrigated / l.nozzle_area);
  const double opened = valve(tool.suction);
  if (!(opened > 0)) return out;
  if (tool.blocked) {
    out.clogged = true;
    return out;
  }
  const double flow = line_flow(l.liquid_flow, l.vacuum, l.vacuum, opened);
  const std::int64_t most = whole_picolitres(flow, m.tick, s.suction_carry[k]);
  const Mix drops = draw_drops(m.droplets, tool.tip, float(l.capture_radius), most, s.droplets);
  const Mix pool =
      draw_off(m.pool, in.floor, vec_cast<double>(tool.tip), l.capture_radius, most - drops.total(), s.pool);
  move(s.ledger, Place::kDroplets, Place::kSucked, drops);
  move(s.ledger, Place::kPool, Place::kSucked, pool);
  out.sucked = drops + pool;
  const double unused = most > 0 ? 1 - double(out.sucked.total()) / double(most) : 1.0;
  out.gas_flow = l.gas_flow * opened * unused;
  return out;
}

}  // namespace

FluidsModel build(const FluidsDescription& d, double tick) {
  const Lines& l = d.lines;
  require(l.irrigation_flow >= 0 && l.irrigation_flow < 1e-2 && l.liquid_flow >= 0 && l.liquid_flow < 1e-2,
          "lines: flows from 0 to 10 L/s");
  require(l.gas_flow >= 0 && l.nozzle_area > 1e-9 && l.capture_radius >= 0 && l.capture_radius < 0.1,
          "lines: gas flow, nozzle area, capture radius");
  require(l.bag_pressure > 0 && l.vacuum > 0, "lines: pressures");
  const Insufflator& gas = d.insufflator;
  require(gas.set >= 0 && gas.set < 1e4 && gas.flow >= 0 && gas.flow < 1e-2 && gas.band > 0 && gas.compliance > 1e-9,
          "insufflator: pressures, flow, compliance");
  return {build(d.pool, tick), build(d.droplets, tick), build(d.smoke, tick), l, d.insufflator, tick};
}

FluidsState initial_state(const FluidsModel& m) {
  FluidsState s;
  s.pool = empty_pool(m.pool);
  s.droplets = no_droplets(m.droplets);
  s.smoke = clear_air(m.smoke);
  s.gas = full(m.insufflator);
  return s;
}

FluidsWork make_work(const FluidsModel& m) {
  return {make_work(m.pool), make_work(m.droplets), make_work(m.smoke), std::vector<Outlet>(kMostOpenings)};
}

FluidReport begin_tick(const FluidsModel& m, const FluidsInput& in, FluidsState& s, FluidsWork& w) noexcept {
  const int openings = open_nozzles(m, in, s, w);
  Below below{m.pool, in.floor, s.pool, s.ledger};
  FluidReport report =
      plan(m.droplets, std::span(w.openings.data(), std::size_t(openings)), s.droplets, w.droplets, below);
  if (in.openings.size() > kMostOpenings - kMostTools)
    report.note(FluidReport::kBadOpening, kMostOpenings - kMostTools);
  for (std::size_t i = 0; i < in.boiled.size(); ++i)
    if (!boil(m.smoke, in.boiled[i].at, in.boiled[i].kilograms, s.smoke))
      report.note(FluidReport::kBadOpening, std::int32_t(i));
  return report;
}

FluidsReport finish_tick(const FluidsModel& m, const FluidsInput& in, FluidsState& s, FluidsWork& w) noexcept {
  FluidsReport out;
  Below below{m.pool, in.floor, s.pool, s.ledger};
  out.report = resolve(m.droplets, in.capsules, s.droplets, w.droplets, below);
  SmokeInput smoke = in.smoke;
  double gas = 0;  // sucked [m^3/s]
  for (std::size_t k = 0; k < std::min(in.tools.size(), std::size_t(kMostTools)); ++k) {
    out.tools[k] = suck(m, in, k, s);
    smoke.sucked = smoke.sucked || out.tools[k].gas_flow > 0;
    gas += out.tools[k].gas_flow;
  }
  const PoolInput pool{.floor = in.floor, .capsules = in.capsules, .drains = in.drains};
  out.report = out.report | advance(m.pool, pool, s.pool, w.pool, s.ledger);
  advance(m.smoke, smoke, s.smoke, w.smoke);
  advance(m.insufflator, gas, m.tick, s.gas);
  return out;
}

bool audit(const FluidsModel& m, const FluidsState& s) noexcept {
  return balanced(s.ledger) && drops_content(s.droplets) == at(s.ledger, Place::kDroplets) &&
         film_content(s.droplets) == at(s.ledger, Place::kFilm) &&
         content(m.pool, s.pool) == at(s.ledger, Place::kPool);
}

void add_to_hash(core::Hasher& h, const FluidsState& s) noexcept { core::add_fields(h, s); }

void poison(FluidsWork& w) noexcept { core::poison_fields(w); }

}  // namespace trocar::fluids
