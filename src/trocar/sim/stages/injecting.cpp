#include <algorithm>

#include <trocar/fluids/mix.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/static_organ.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

using interactions::NeedleLine;

constexpr double kPlungerRamp = 0.3;       // [s] in which a thumb comes to the flow that it has in mind.     Our choice
constexpr std::uint64_t kShareTicks = 10;  // ticks between two looks at what has flowed
constexpr std::uint64_t kAbsorbTicks = 100;  // ... at what vessels take up
constexpr double kAbsorbTime = 600;    // [s] tau of that.                                                Our choice
constexpr double kSamePlace = 0.003;   // [m] a plunger that was drawn there was drawn here
constexpr double kTrackCloses = 8;     // [s] tau of a needle's way that closes.                          Our choice
constexpr double kTrackOver = 60;      // [s]
constexpr double kTrackLeaks = 1e-12;  // [m^3/Pa s] when it has just been left: at 25 kPa 0.2 mL get out.  Our choice
constexpr double kTrackWide = 0.004;   // [m] what is around it is what leaks
constexpr double kTrackDeep = 0.003;   // [m] where its pressure is asked for
constexpr double kFillsFrom = 0.8;     // share of what tissue can hold from which on it resists.          Our choice
constexpr double kFillsAt =
    10e-6 / 60;                   // [m^3/s] that take the opening pressure once more half way from there. Our choice
constexpr double kGapes = 4e-11;  // [m^3/Pa s] around a needle beyond the opening pressure: 80 um wide, 3.5 mm long
constexpr double kDrains = 0.01;  // of what lies at a tear, in kShareTicks.                                Our choice
constexpr double kTearFound = 0.03;  // [m] how far from there skin is looked for
constexpr double kTearArea = 1e-5;   // [m^2] of one that has no skin near it.                              Our choice

NeedleLine line_of(const StepContext& c, size_t hand) noexcept {
  return interactions::needle_of(c.model.tool(c.state, hand), c.work.shapes[hand]);
}

bool takes_up(const StepContext& c, size_t organ) noexcept { return c.model.injection.organs[organ].infusion.there(); }

void let_into_open(StepContext& c, const NeedleOutlet& outlet) noexcept {
  if (c.work.needle_outlet_count < std::int32_t(c.work.needle_outlets.size()))
    c.work.needle_outlets[size_t(c.work.needle_outlet_count++)] = outlet;
}

bool is_full(const StepContext& c) noexcept {
  return c.work.needle_outlet_count == std::int32_t(c.work.needle_outlets.size());
}

/// Out of the skin where a needle is or was in.
void leak_at(StepContext& c, const interactions::MaterialPoint& at, std::int64_t picolitres) noexcept {
  if (picolitres <= 0) return;
  c.state.injection.account.leaked += picolitres;
  const interactions::SkinPoint skin = skin_at(bodies_of(c), at);
  NeedleOutlet out;
  out.place = skin.point;
  out.direction = skin.normal;
  out.picolitres = picolitres;
  size_t most = 0;
  for (size_t k = 1; k < 3; ++k)
    if (skin.weights[int(k)] > skin.weights[int(most)]) most = k;
  if (c.model.wet.there) out.film = c.model.wet.film[at.body.index()] + skin.vertex[most];
  let_into_open(c, out);
}

/// How tissue resists of which that share is full: 0 up to kFillsFrom, without a bound towards 1.          [back flow]
double resistance_of(double opening, double filled) noexcept {
  const double more = std::max(0.0, std::min(filled, 0.999) - kFillsFrom);
  return opening / kFillsAt * more / (1 - kFillsFrom - more);
}

/// What has flowed since the last time finds its place; what finds none comes out beside the needle.
void share_out_pending(StepContext& c, size_t hand, NeedleHand& n, bool drugged) noexcept {
  if (n.pending == 0 || !n.in()) return;
  const size_t organ = n.entry.body.index();
  std::int64_t in = 0;
  if (takes_up(c, organ)) {
    visit_organ(c.model, organ, [&c](auto body) { switch_to_dynamic(c, body); });
    const tissue::InfusionModel& infusion = c.model.injection.organs[organ].infusion;
    tissue::InfusionState& fluid = c.state.injection.organs[organ];
    const double spread = tissue::spread_of(fluids::kM3PerPicolitre * double(n.here));
    in = tissue::infuse(infusion, c.work.organs[organ].nodes, n.at, n.pending, spread, drugged,
                        std::uint32_t(c.state.tick + 1), fluid, c.work.infusion[organ]);
    c.state.injection.fills[hand] = resistance_of(
        infusion.opening, tissue::filled_about(infusion, c.work.organs[organ].nodes, n.at, spread, fluid));
    loosen_bonds(c, n.at, fluids::kM3PerPicolitre * double(in), spread);
  }
  c.state.injection.given[organ] -= n.pending - in;
  leak_at(c, n.entry, n.pending - in);
  n.pending = 0;
}

void leave_track(StepContext& c, const NeedleHand& n) noexcept {
  InjectionState& s = c.state.injection;
  if (s.track_count == kMaxTracks) {
    std::move(s.tracks.begin() + 1, s.tracks.end(), s.tracks.begin());
    --s.track_count;
  }
  s.tracks[size_t(s.track_count++)] = {n.entry, 0, c.state.tick, 0, 0};
}

void draw_out(StepContext& c, size_t hand, NeedleHand& n, bool drugged) noexcept {
  share_out_pending(c, hand, n, drugged);
  leave_track(c, n);
  c.state.injection.fills[hand] = 0;
  n.entry = {};
  n.anchor = n.depth = n.drawn_for = 0;
  n.here = n.blood = 0;
  n.vessel = -1;
}

void go_in(StepContext& c, size_t hand, NeedleHand& n) noexcept {
  n.entry = n.touch;
  n.touch = {};
  n.anchor = 0;
  n.press = 0;
  n.here = n.blood = 0;
  n.drawn_for = 0;
  ++n.punctures;
  emit_event(c, Event::on_body(Event::pierced, int(hand), n.entry.body));
}

/// The point at a skin that it has not pierced.
void dent_skins(StepContext& c, size_t hand, const NeedleLine& line, NeedleHand& n) noexcept {
  n.press = 0;
  const interactions::Bodies bodies = bodies_of(c);
  if (n.touch.body.exists() && !(sunk_into(bodies, n.touch, line) > 0)) n.touch = {};
  if (!(line.out > 0)) n.touch = {};
  for (size_t i = 0; i < size_t(c.model.organs()) && line.out > 0 && !n.touch.body.exists(); ++i)
    n.touch = interactions::caught_at(bodies, i, line);
  if (!n.touch.body.exists()) return;
  const size_t organ = n.touch.body.index();
  n.press = interactions::press_skin(bodies, n.touch, line, std::int32_t(hand));
  const double gives = interactions::kGroundBevel * c.model.injection.organs[organ].puncture;
  if (gives > 0 && n.press >= gives) go_in(c, hand, n);
}

/// Is the pierced skin's point still somewhere on the needle?
bool still_in(const StepContext& c, const NeedleHand& n, const NeedleLine& line) noexcept {
  const Vec3d entry = place_of(bodies_of(c), n.entry);
  const double deep = dot(line.point - entry, line.axis);
  return deep > 0 && length(line.point - deep * line.axis - entry) < interactions::kTornOut;
}

void pierce_with(StepContext& c, size_t hand) noexcept {
  const interactions::ToolModel& tool = c.model.tool(c.state, hand);
  NeedleHand& n = c.state.injection.hands[hand];
  const NeedleLine line = line_of(c, hand);
  n.at = line.point;
  if (n.in() && (!tool.can().inject || n.changes != c.state.tools[hand].changes || !still_in(c, n, line)))
    draw_out(c, hand, n, tool.needle.drugged());
  n.changes = c.state.tools[hand].changes;
  if (!tool.can().inject) {
    n.touch = {};
    return;
  }
  if (!n.in()) return dent_skins(c, hand, line, n);
  const size_t organ = n.entry.body.index();
  interactions::carry_skin(bodies_of(c), n.entry, line, n.anchor, std::int32_t(hand));
  n.depth = interactions::depth_below(c.work.surfaces[organ], n.at);
}

// ---- plungers

/// The vessel whose lumen a place lies in; -1: none.
std::int32_t vessel_around(StepContext& c, Vec3d place) noexcept {
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    const std::vector<interactions::VesselPoint>& path = path_of(c, v).points;
    const std::vector<Vec3d>& x = points_of(c, v);
    for (size_t i = 1; i < x.size(); ++i) {
      const double w = geometry::closest_on_segment(place, x[i - 1], x[i]);
      const double radius = path[i - 1].radius + w * (path[i].radius - path[i - 1].radius);
      if (geometry::distance2(place, x[i - 1] + w * (x[i] - x[i - 1])) < radius * radius) return std::int32_t(v);
    }
  }
  return -1;
}

interactions::AtTip at_tip(const StepContext& c, size_t hand, const NeedleHand& n) noexcept {
  interactions::AtTip at;
  if (!n.in()) return at;
  if (n.vessel >= 0) {
    at.pressure = std::max(0.0, c.work.walls[size_t(n.vessel)].pressure);
    return at;
  }
  const size_t organ = n.entry.body.index();
  if (!takes_up(c, organ)) return at;
  at.opening = c.model.injection.organs[organ].infusion.opening;
  at.pressure = tissue::pressure_at(c.work.organs[organ].nodes, n.at, c.state.injection.organs[organ]);
  at.fills = c.state.injection.fills[hand];
  at.gapes = kGapes;
  return at;
}

/// Picolitres that have left the needle go where its point is. @param back  of them: along the needle
void book(StepContext& c, size_t hand, std::int64_t picolitres, std::int64_t back,
          const interactions::NeedleModel& needle, NeedleHand& n) noexcept {
  InjectionState& s = c.state.injection;
  n.left -= picolitres;
  s.account.injected += picolitres;
  if (needle.drugged()) s.account.drugged += picolitres;
  if (n.vessel >= 0) {
    s.account.vessel += picolitres;
  } else if (n.in()) {
    n.pending += picolitres - back;
    n.here += picolitres - back;
    s.given[n.entry.body.index()] += picolitres - back;
    leak_at(c, n.entry, back);
  } else if (picolitres > 0) {
    s.account.spilled += picolitres;
    NeedleOutlet out;
    out.place = n.at;
    out.direction = line_of(c, hand).axis;
    out.area = 0.25 * portable::pi * needle.bore * needle.bore;
    out.picolitres = picolitres;
    let_into_open(c, out);
  }
}

void push(StepContext& c, size_t hand, const interactions::NeedleModel& needle, NeedleHand& n) noexcept {
  n.rate = std::min(needle.flow, n.rate + needle.flow * kTick / kPlungerRamp);
  if (n.left == 0) return;
  const interactions::PlungerPush p = interactions::push_plunger(needle, at_tip(c, hand, n), n.rate);
  n.flow = p.flow;
  n.tip_pressure = p.tip;
  n.plunger = p.force;
  const std::int64_t out = std::min(n.left, fluids::whole_picolitres(p.flow, kTick, n.carry));
  book(c, hand, out, p.back > 0 ? std::int64_t(double(out) * (p.back / p.flow)) : 0, needle, n);
  if (n.in() && p.flow > 0 && !n.pushing) emit_event(c, Event::on_body(Event::injected, int(hand), n.entry.body));
  n.pushing = p.flow > 0 ? 1 : 0;
}

void draw(StepContext& c, size_t hand, const interactions::NeedleModel& needle, NeedleHand& n) noexcept {
  n.plunger = -interactions::kVacuum * needle.area();
  if (!n.in()) return;
  if (length(n.at - n.checked) > kSamePlace) {
    n.drawn_for = 0;
    n.checked = n.at;
  }
  n.drawn_for += kTick;
  if (n.vessel >= 0)
    n.blood +=
        fluids::whole_picolitres(interactions::drawn_flow(needle, at_tip(c, hand, n).pressure), kTick, n.carry_drawn);
}

void work_plunger(StepContext& c, size_t hand) noexcept {
  const interactions::ToolModel& tool = c.model.tool(c.state, hand);
  NeedleHand& n = c.state.injection.hands[hand];
  n.flow = n.tip_pressure = n.plunger = 0;
  if (!tool.can().inject) return;
  const bool in_hand = c.input.tools[hand].instrument == c.state.tools[hand].instrument;
  const bool pushes = in_hand && (c.input.pedals & irrigates(int(hand))) != 0;
  const bool draws = in_hand && !pushes && (c.input.pedals & sucks(int(hand))) != 0;
  const std::int32_t was = n.vessel;
  if (!n.in())
    n.vessel = -1;
  else if (c.model.vessels.there() && (c.state.tick % kShareTicks == 0 || n.vessel >= 0))
    n.vessel = vessel_around(c, n.at);
  if (n.vessel >= 0 && n.vessel != was) n.pushing = 0;  // to be reported again
  if (!pushes) n.rate = 0, n.pushing = 0;
  if (pushes) push(c, hand, tool.needle, n);
  if (draws) draw(c, hand, tool.needle, n);
  c.state.tools[hand].pinch = n.plunger < 0 ? -n.plunger : n.plunger;  // what the hand feels on its handle
  if (c.state.tick % kShareTicks == 0) share_out_pending(c, hand, n, tool.needle.drugged());
}

/// What runs back out of the ways that needles have left.
void leak_tracks(StepContext& c) noexcept {
  InjectionState& s = c.state.injection;
  std::int32_t kept = 0;
  for (std::int32_t i = 0; i < s.track_count; ++i) {
    NeedleTrack track = s.tracks[size_t(i)];
    const double age = kTick * double(c.state.tick - track.tick);
    const size_t organ = track.at.body.index();
    if (age > kTrackOver || !takes_up(c, organ)) continue;
    if (is_full(c)) {  // it leaks the next time
      s.tracks[size_t(kept++)] = track;
      continue;
    }
    const interactions::SkinPoint skin = skin_at(bodies_of(c), track.at);
    const Vec3d inside = skin.point - kTrackDeep * skin.normal;
    const double pressure = tissue::pressure_at(c.work.organs[organ].nodes, inside, s.organs[organ]);
    const double flow = kTrackLeaks * portable::exp(-age / kTrackCloses) * pressure;
    const std::int64_t wants = fluids::whole_picolitres(flow, double(kShareTicks) * kTick, track.carry);
    const std::int64_t out = tissue::let_out(c.model.injection.organs[organ].infusion, c.work.organs[organ].nodes,
                                             inside, wants, kTrackWide, s.organs[organ], c.work.infusion[organ]);
    leak_at(c, track.at, out);
    track.leaked += out;
    s.tracks[size_t(kept++)] = track;
  }
  s.track_count = kept;
}

/// Where a tear of an organ opens to the outside: the skin that is nearest to that node.
NeedleOutlet tear_at(const StepContext& c, size_t organ, std::int32_t row) noexcept {
  const tissue::NodeView& nodes = c.work.organs[organ].nodes;
  const tissue::NodeState& node = nodes.rows[size_t(row)];
  NeedleOutlet out;
  out.place = Vec3d{double(node.x), double(node.y), double(node.z)} + nodes.origin;
  out.direction = normalised(-c.model.gravity, {0, 0, 1});
  out.area = kTearArea;
  const int vertex = interactions::nearest_vertex_near(c.work.surfaces[organ], out.place, kTearFound);
  if (vertex < 0) return out;
  out.place = c.work.surfaces[organ].position(vertex);
  if (!c.model.wet.there) return out;
  out.film = c.model.wet.film[organ] + vertex;
  out.area = 0;
  return out;
}

/// What lies where tissue has torn runs out of it.
void drain_tears(StepContext& c) noexcept {
  InjectionState& s = c.state.injection;
  for (size_t organ = 0; organ < s.organs.size() && !is_full(c); ++organ) {
    if (!takes_up(c, organ) || c.work.infusion[organ].tears == 0) continue;
    std::int32_t row = -1;
    const std::int64_t out = tissue::drain_tears(kDrains, c.work.infusion[organ], s.organs[organ], row);
    if (row < 0) continue;
    s.account.leaked += out;
    NeedleOutlet tear = tear_at(c, organ, row);
    tear.picolitres = out;
    let_into_open(c, tear);
  }
}

void absorb_all(StepContext& c) noexcept {
  for (tissue::InfusionState& organ : c.state.injection.organs)
    c.state.injection.account.absorbed += tissue::absorb(double(kAbsorbTicks) * kTick / kAbsorbTime, organ);
}

}  // namespace

void pierce_tissue(StepContext& c) noexcept {
  if (!c.model.injection.there()) return;
  c.work.needle_outlet_count = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) pierce_with(c, t);
}

void swell_tissue(StepContext& c) noexcept {
  if (!c.model.injection.there()) return;
  visit_solids(c.model, [&c](SolidRef r) {
    const PiercedOrgan& organ = c.model.injection.organs[r.organ()];
    c.work.infusion[r.organ()].pushes = c.work.infusion[r.organ()].tears = 0;
    if (!organ.infusion.there()) return;
    const tissue::NetworkState& network = c.state.solids[r.index];
    std::span<const std::uint8_t> phase;
    if (network.version != 0) phase = network.tet_phase;
    tissue::swell(organ.infusion, model_of(c.model, r).network, network.nodes, kTick,
                  c.state.injection.organs[r.organ()], c.work.infusion[r.organ()], phase);
  });
}

void inject(StepContext& c) noexcept {
  if (!c.model.injection.there()) return;
  for (size_t t = 0; t < c.model.hands.size(); ++t) work_plunger(c, t);
  if (c.state.tick % kShareTicks == 0) leak_tracks(c), drain_tears(c);
  if (c.state.tick % kAbsorbTicks == 0) absorb_all(c);
}

double blanched_at(const State& s, std::size_t organ, const tissue::Skin& skin, int vertex) noexcept {
  if (!s.injection.there() || s.injection.organs[organ].since.empty()) return 0;
  double sum = 0;
  skin.each_carrier(vertex, [&](int, int row, float weight) {
    if (weight > 0) sum += double(weight) * tissue::blanched(s.injection.organs[organ], size_t(row), s.tick);
  });
  return sum;
}

double blanched_around(const Model& model, const State& s, const interactions::VesselPath& path) noexcept {
  double sum = 0;
  for (const interactions::VesselPoint& p : path.points) {
    const size_t organ = p.rides.body.index();
    if (!p.rides.body.is(BodyKind::organ) || organ >= model.solids.size() || s.injection.organs[organ].since.empty())
      continue;
    for (size_t k = 0; k < size_t(p.rides.count); ++k) {
      const size_t row = size_t(model.solids[organ].network.row_of_node[size_t(p.rides.node[k])]);
      if (p.rides.weight[k] > 0)
        sum += double(p.rides.weight[k]) * tissue::blanched(s.injection.organs[organ], row, s.tick);
    }
  }
  return sum / double(path.points.size());
}

}  // namespace trocar::sim
