// What others read from the State of the flow: walls, lumens, pressures, hashes.
#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/sites.hpp>

namespace trocar::vessels {
namespace {

/// What separates places of a cell: the nearest cut or closed clip on either side of `at`.
struct Barriers {
  bool before = false, after = false;
  double flow = 0;
  double next = 2;  ///< place of the first site after `at`

  void add(double place, bool closes, double flow_before, double at) {
    if (closes) (place <= at ? before : after) = true;
    if (place > at && place < next) next = place, flow = flow_before;
  }
};

Barriers barriers(const FlowState& state, int cell, double at) {
  Barriers b;
  b.flow = state.q[cell];
  for (const ClipState& c : state.clips)
    if (c.cell == cell) b.add(c.at, c.closed != 0, c.before, at);
  for (const OpeningState& o : state.openings)
    if (o.cell == cell) b.add(o.at, o.kind == int(Opening::Kind::cut), o.before, at);
  return b;
}

struct Place {
  double pressure, flow;
};

/// @param free  there is neither opening nor clip in the segment
Place read_place(const FlowModel& m, const FlowState& state, int segment, double s, bool free) {
  double at;
  const int cell = cell_at(m.segments[segment], s, &at);
  const FlowCell& c = m.cells[cell];
  Barriers b;
  if (free)
    b.flow = state.q[cell];
  else
    b = barriers(state, cell, at);
  const double w = b.before == b.after ? at : b.before ? 1 : 0;
  return {(1 - w) * state.p[c.a] + w * state.p[c.b], b.flow};
}

double clamped(double s) { return s > 0 ? (s < 1 ? s : 1) : 0; }

WallReading read(const FlowModel& m, const FlowState& state, int segment, double s, double gain, bool free) {
  WallReading r;
  const FlowSegment& v = m.segments[segment];
  const Place place = read_place(m, state, segment, clamped(s), free);
  const double drawn = v.radius + v.taper * clamped(s);
  r.pressure = place.pressure, r.flow = place.flow;
  r.radius = drawn * widening(v.rest, v.give, place.pressure);
  r.shift = gain * (r.radius - drawn);
  r.push = gain * (place.pressure - v.reference);
  return r;
}

}  // namespace

WallReading read_wall(const FlowModel& m, const FlowState& state, int segment, double s, double gain) noexcept {
  if (segment < 0 || segment >= int(m.segments.size())) return {};
  return read(m, state, segment, s, gain, false);
}

void read_middles(const FlowModel& m, const FlowState& state, std::span<WallReading> walls,
                  std::span<std::uint8_t> busy) noexcept {
  std::fill(busy.begin(), busy.end(), std::uint8_t(0));
  std::size_t segment = 0;
  const auto note = [&](int cell) {
    if (cell < 0) return;
    for (segment = 0; segment + 1 < m.segments.size() && m.segments[segment + 1].first <= cell;) ++segment;
    busy[segment] = 1;
  };
  for (const ClipState& c : state.clips) note(c.cell);
  for (const OpeningState& o : state.openings) note(o.cell);
  for (std::size_t i = 0; i < m.segments.size(); ++i) walls[i] = read(m, state, int(i), 0.5, 1, busy[i] == 0);
}

double lumen_area(const FlowModel& m, const FlowState& state, int segment, double s) noexcept {
  const double r = read_wall(m, state, segment, s).radius;
  return portable::pi * r * r;
}

double node_pressure(const FlowModel& m, const FlowState& state, int node) noexcept {
  return node >= 0 && node < m.nodes ? state.p[m.plan.row_of[node]] : 0;
}

void add_to_hash(core::Hasher& h, const FlowModel& m) noexcept { core::add_fields(h, m); }

void add_to_hash(core::Hasher& h, const FlowState& s) noexcept { core::add_fields(h, s); }

}  // namespace trocar::vessels
