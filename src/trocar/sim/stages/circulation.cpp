#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/model/vessel_cuts.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/sim/stages/pulse_feel.hpp>
#include <trocar/sim/stages/stage.hpp>
#include <trocar/sim/verbs/sealing.hpp>

namespace trocar::sim {
namespace {

using interactions::VesselPath;

using CutPlaces = std::array<double, interactions::kMaxOpenings>;

}  // namespace

// The others wait until somebody asks.
void pose_vessels(StepContext& c) noexcept {
  if (!c.model.vessels.there()) return;
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    c.work.vessel_posed[v] = c.model.vessels.list[v].pulses();
    if (c.work.vessel_posed[v] != 0) pose_vessel(path_of(c, v), bodies, c.work.vessel_points[v]);
  }
}

namespace {

/// A wall that a pulse drives outwards pushes what palpates it, and is pushed back: pressure above the mean on the
/// vessel's width times the length that a point of its line stands for, less the more tissue lies between.
void push_hands(StepContext& c, const interactions::VesselPoint& p, Vec3d at, double force, double radius) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    if (!presses(c.state, t)) continue;
    const PulseTouch touch = pulse_touch(c.work.shapes[t], at, radius);
    if (touch.share > 0)
      put_load(bodies_of(c), p.rides, {.f0 = (-force * touch.share) * touch.towards},
               {interactions::Owner::tool_contact, std::int32_t(t), 0});
  }
}

}  // namespace

// Bends count in the drawn shape: arteries are held taut lengthwise, a pulse does not buckle them.
void apply_pulse_loads(StepContext& c) noexcept {
  if (!c.model.vessels.there()) return;
  // A wave is through a vessel within a tick or two: its middle speaks for all of it.
  read_middles(c.model.vessels.flow, c.state.flow, c.work.walls, c.work.busy);
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    const Vessel& vessel = c.model.vessels.list[v];
    if (!vessel.pulses()) continue;
    const std::vector<Vec3d>& x = c.work.vessel_points[v];
    const vessels::FlowSegment& segment = c.model.vessels.flow.segments[v];
    const vessels::WallReading& wall = c.work.walls[v];
    const double over = vessel.gain * (wall.pressure - vessel.mean_pressure);
    const double wide = wall.radius / (segment.radius + 0.5 * segment.taper);
    for (size_t i = 1; i + 1 < x.size(); ++i) {
      const interactions::VesselPoint& p = vessel.path.points[i];
      if (p.rides.in_space()) continue;
      const double radius = wide * (segment.radius + segment.taper * p.s);
      const Vec3d force = (over * portable::pi * radius * radius) * turn_at(vessel.path, x, int(i));
      put_load(bodies_of(c), p.rides, {.f0 = force}, {interactions::Owner::anchor, 0, 0});
      if (over > 0) push_hands(c, p, x[i], over * 2 * radius * stands_for(vessel.path, i), radius);
    }
  }
}

namespace {

constexpr double kConstricts = 0.0005;  // [m] radius: what is no wider is narrowed by a drug
constexpr double kResists = 4;          // times what it resists as it was comes on top: R_up x 5            Our choice

/// Small vessels in blanched tissue: a partial clip at either end, which resists R (1 / (1 - cover)^2 - 1).
void lay_out_blanching(const StepContext& c, std::span<vessels::Occlusion> out) noexcept {
  for (vessels::Occlusion& narrow : out) narrow = {};
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    const interactions::VesselPath& path = path_of(c, v);
    if (interactions::vessel_radius(path, 0.5) > kConstricts) continue;
    const double share = blanched_around(c.model, c.state, path);
    if (!(share > 0)) continue;
    const double cover = 1 - 1 / std::sqrt(1 + kResists * share);
    out[2 * v] = {std::int32_t(v), 0, cover};
    out[2 * v + 1] = {std::int32_t(v), 1, cover};
  }
}

/// Openings and clips of the State as the flow wants them.
void lay_out(StepContext& c) noexcept {
  const State& s = c.state;
  const double outside = c.model.wet.there ? s.fluids.gas.pressure : c.model.vessels.flow.settings.cavity_pressure;
  for (size_t i = 0; i < c.work.open.size(); ++i) {
    vessels::Opening& out = c.work.open[i];
    out = {};
    if (int(i) >= s.opening_count) continue;
    const interactions::VesselOpening& o = s.openings[i];
    out.segment = o.vessel;
    out.s = o.s;
    out.kind = o.through ? vessels::Opening::Kind::cut : vessels::Opening::Kind::hole;
    out.area = o.area;
    out.sealed = sealed_share(s, int(i));
    out.outside = outside;
  }
  // One after the other: clips, what heat sealed, what a drug narrows, loops.
  std::span<vessels::Occlusion> rest = std::span(c.work.closed).subspan(interactions::kMaxVesselClips);
  const auto take_last = [&rest](size_t count) {
    const std::span<vessels::Occlusion> taken = rest.last(count);
    rest = rest.first(rest.size() - count);
    return taken;
  };
  if (has_slings(c.model)) lay_out_loops(c, take_last(kMostLoops));
  if (c.model.injection.there()) lay_out_blanching(c, take_last(2 * c.model.vessels.list.size()));
  lay_out_seals(s, rest);
  for (size_t i = 0; i < size_t(interactions::kMaxVesselClips); ++i) {
    vessels::Occlusion& out = c.work.closed[i];
    out = {};
    if (int(i) >= s.vessel_clip_count) continue;
    const interactions::VesselClip& clip = s.vessel_clips[i];
    out.segment = clip.vessel;
    out.s = clip.s;
    out.cover = cover_at(clip, kTick * double(s.tick - clip.tick));
  }
}

/// A hole's jet leaves upwards, as far as the vessel's direction lets it.
Vec3d upwards(const StepContext& c, Vec3d along) noexcept {
  const Vec3d up = normalised(-1.0 * c.model.gravity, {0, 0, 1});
  return normalised(up - dot(up, along) * along, any_perpendicular(along));
}

/// Where blood leaves, now that tissue is where it is at the end of the tick.
void note_bleeds(StepContext& c) noexcept {
  c.work.bleed_count = 0;
  if (c.state.opening_count == 0) return;
  const interactions::Bodies bodies = bodies_of(c);
  CutPlaces places;
  int posed = -1;
  for (int i = 0; i < c.state.opening_count; ++i) {
    const interactions::VesselOpening& o = c.state.openings[size_t(i)];
    const VesselPath& path = path_of(c, size_t(o.vessel));
    std::vector<Vec3d>& points = c.work.vessel_points[size_t(o.vessel)];
    if (posed != o.vessel) pose_vessel(path, bodies, points);
    posed = o.vessel;
    const std::span<const double> cuts = cuts_of(c.state, o.vessel, places);
    const vessels::OpeningFlow& flow = c.work.flows[size_t(i)];
    for (int side = 0; side < (o.through ? 2 : 1); ++side) {
      const interactions::VesselSpot spot = vessel_spot(path, points, cuts, o.s, side);
      Bleed& b = c.work.bleeds[size_t(c.work.bleed_count++)];
      b.place = spot.place;
      b.direction = o.through ? (side == 0 ? 1.0 : -1.0) * spot.along : upwards(c, spot.along);
      b.area = o.area * (1 - flow.clot);
      b.speed = b.area > 0 ? flow.flow[side] / b.area : 0;
      b.picolitres = flow.picolitres[side];
      b.opening = i;
      b.side = side;
      b.vein = c.model.vessels.list[size_t(o.vessel)].vein;
      b.fed = flow.fed[side];
    }
  }
}

}  // namespace

void update_blood_flow(StepContext& c) noexcept {
  if (!c.model.vessels.there()) return;
  open_bleeder(c);
  lay_out(c);
  vessels::FlowInput input;
  input.openings = c.work.open;
  input.clips = c.work.closed;
  const vessels::FlowReport report = advance(c.model.vessels.flow, input, c.work.flows, c.state.flow, c.work.flow);
  if (!report.fine()) c.report.flags |= StepReport::kBloodFlow;
  note_bleeds(c);
}

}  // namespace trocar::sim
