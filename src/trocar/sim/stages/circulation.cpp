#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/sealing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

using interactions::VesselHold;
using interactions::VesselPath;
using interactions::VesselPiece;

using CutPlaces = std::array<double, interactions::kMaxOpenings>;

const VesselPath& path_of(const StepContext& c, size_t v) noexcept { return c.model.vessels.list[v].path; }

/// What lies between two cuts of a vessel within this way is not cut again.                          [m]  Our choice
constexpr double kSliver = 0.001;

/// The opening there already, or a new one; null where there is no room.
interactions::VesselOpening* opening_at(StepContext& c, int vessel, double s) noexcept {
  const double reach = kSliver / path_of(c, size_t(vessel)).length;
  for (int i = 0; i < c.state.opening_count; ++i) {
    interactions::VesselOpening& o = c.state.openings[size_t(i)];
    if (o.vessel == vessel && std::fabs(o.s - s) < reach) return &o;
  }
  if (c.state.opening_count == interactions::kMaxOpenings) return nullptr;
  interactions::VesselOpening& fresh = c.state.openings[size_t(c.state.opening_count++)];
  fresh = {};
  fresh.s = s;
  fresh.vessel = vessel;
  return &fresh;
}

/// The vessel that opens by itself, in its tick.
void open_bleeder(StepContext& c) noexcept {
  const Bleeder& b = c.model.vessels.bleeder;
  if (b.vessel < 0 || c.state.tick != b.tick) return;
  interactions::VesselOpening* o = opening_at(c, b.vessel, b.s);
  if (!o || o->through) return;
  o->area = std::max(o->area, b.area);
  o->tool = -1;
  o->tick = c.state.tick;
}

/// @param share  of the lumen's width; 1: through
void open_vessel(StepContext& c, int vessel, double s, double share, int hand) noexcept {
  interactions::VesselOpening* o = opening_at(c, vessel, s);
  if (!o) {
    c.report.flags |= StepReport::kBookFull;
    return;
  }
  const vessels::FlowSegment& segment = c.model.vessels.flow.segments[size_t(vessel)];
  const double radius = segment.radius + segment.taper * s;
  const double area = share * portable::pi * radius * radius;
  if (o->through || area <= o->area) return;
  o->area = area;
  o->through = share >= 1;
  o->tool = hand;
  o->tick = c.state.tick;
}

bool rides_on(const StepContext& c, const VesselHold& hold, BodyId carrier) noexcept {
  const bool flesh = hold.kind == VesselHold::cell ||
                     (hold.kind == VesselHold::membrane && c.model.membranes[size_t(hold.index)].sheet.closed());
  return carrier.exists() ? hold.carrier() == carrier : !flesh;
}

bool out_of_reach(const VesselPath& path, int i) noexcept {
  return path.points[size_t(i)].covered() && path.points[size_t(i) + 1].covered();
}

bool near(const geometry::Blade& blade, Vec3d p, double reach) noexcept {
  return length(p - blade.corner[0]) < reach || length(p - blade.corner[size_t(blade.corners / 2)]) < reach;
}

}  // namespace

// The others wait until somebody asks.
void pose_vessels(StepContext& c) noexcept {
  if (!c.model.vessels.there()) return;
  const interactions::VesselHosts hosts = look_at_hosts_of_all(c.model, c.state, c.work.hosts);
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    c.work.vessel_posed[v] = c.model.vessels.list[v].pulses();
    if (c.work.vessel_posed[v] != 0) pose_vessel(path_of(c, v), hosts, c.work.vessel_points[v]);
  }
}

const std::vector<Vec3d>& points_of(StepContext& c, size_t v) noexcept {
  std::vector<Vec3d>& points = c.work.vessel_points[v];
  if (c.work.vessel_posed[v] == 0) pose_vessel(path_of(c, v), look_at_hosts(c.model, c.state, c.work.hosts), points);
  c.work.vessel_posed[v] = 1;
  return points;
}

void open_vessels(StepContext& c, const geometry::Blade& blade, BodyId carrier, int hand) noexcept {
  const geometry::BladePlane plane(blade);
  if (!plane.flat) return;
  double reach = 0.006;  // a piece may be so long
  for (int i = 1; i < blade.corners; ++i) reach += length(blade.corner[size_t(i)] - blade.corner[size_t(i) - 1]);
  CutPlaces places;
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    const VesselPath& path = path_of(c, v);
    const std::vector<Vec3d>& points = points_of(c, v);
    for (int i = 0; i + 1 < int(points.size()); ++i) {
      if (out_of_reach(path, i) || !near(blade, points[size_t(i)], reach)) continue;
      if (!rides_on(c, path.points[size_t(i)].hold, carrier) &&
          !rides_on(c, path.points[size_t(i) + 1].hold, carrier))
        continue;
      VesselPiece piece[2];
      const int pieces = pieces_of(path, points, cuts_of(c.state, int(v), places), i, piece);
      for (int k = 0; k < pieces; ++k) {
        const interactions::VesselWound wound =
            wound_of(plane, piece[k], vessel_radius(path, path.points[size_t(i)].s));
        if (wound.share > 0) open_vessel(c, int(v), wound.s, wound.share, hand);
      }
    }
  }
}

namespace {

/// A place of a strand, within the interval of a vessel's line that runs inside it there.
struct Within {
  bool there = false;
  double s = 0;  ///< of the vessel
};
/// @param arc  of the strand [m]
Within within_strand(const interactions::StrandBody& body, int strand, const VesselPath& path, size_t i,
                     double arc) noexcept {
  const VesselHold &a = path.points[i].hold, &b = path.points[i + 1].hold;
  if (a.kind != VesselHold::strand || b.kind != VesselHold::strand || a.index != strand || b.index != strand) return {};
  const double from = arc_at(body, {a.element, a.w}), to = arc_at(body, {b.element, b.w});
  if ((from > arc) == (to > arc)) return {};
  const double w = (arc - from) / (to - from);
  const Vec3d off = a.offset + w * (b.offset - a.offset);
  if (length(off) > body.model.radius[size_t(interactions::place_at(body, arc).element)]) return {};
  return {true, path.points[i].s + w * (path.points[i + 1].s - path.points[i].s)};
}

}  // namespace

void open_vessels_within(StepContext& c, int strand, int element, int hand) noexcept {
  const interactions::StrandBody& body = c.model.strand_bodies[size_t(strand)];
  const double middle = 0.5 * (body.arc[size_t(element)] + body.arc[size_t(element) + 1]);
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v)
    for (size_t i = 0; i + 1 < path_of(c, v).points.size(); ++i)
      if (const Within at = within_strand(body, strand, path_of(c, v), i, middle); at.there)
        open_vessel(c, int(v), at.s, 1, hand);
}

void open_vessels(StepContext& c, BodyId body, const Parting& parting, int hand) noexcept {
  if (!parting.parted) return;
  if (body.is(BodyKind::strand)) return open_vessels_within(c, int(body.index()), parting.element, hand);
  open_vessels(c, parting.blade, body, hand);
}

namespace {

bool close_vessel(StepContext& c, const interactions::VesselClip& closed) noexcept {
  if (c.state.vessel_clip_count == interactions::kMaxVesselClips) {
    c.report.flags |= StepReport::kBookFull;
    return false;
  }
  c.state.vessel_clips[size_t(c.state.vessel_clip_count++)] = closed;
  return true;
}

/// What runs inside a strand is squeezed with it, wherever between the legs it lies.
void clip_within(StepContext& c, int number) noexcept {
  const interactions::Clip& clip = c.state.clips[size_t(number)];
  if (clip.strand < 0) return;
  const interactions::StrandBody& body = c.model.strand_bodies[size_t(clip.strand)];
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v)
    for (size_t i = 0; i + 1 < path_of(c, v).points.size(); ++i) {
      const Within at = within_strand(body, clip.strand, path_of(c, v), i, clip.s);
      if (at.there && !close_vessel(c, {at.s, clip.cover, c.state.tick, std::int32_t(v), number})) return;
    }
}

/// Has this clip closed the vessel already?
bool has_closed(const StepContext& c, int number, size_t vessel) noexcept {
  for (int i = 0; i < c.state.vessel_clip_count; ++i)
    if (c.state.vessel_clips[size_t(i)].clip == number && c.state.vessel_clips[size_t(i)].vessel == int(vessel))
      return true;
  return false;
}

}  // namespace

void clip_vessels(StepContext& c, size_t hand, int number) noexcept {
  interactions::Clip& clip = c.state.clips[size_t(number)];
  const interactions::ToolModel& tool = c.model.tool(c.state, hand);
  const interactions::ToolShape& shape = c.work.shapes[hand];
  double nearest = 1;
  CutPlaces places;
  clip_within(c, number);
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    if (has_closed(c, number, v)) continue;
    const VesselPath& path = path_of(c, v);
    const std::vector<Vec3d>& points = points_of(c, v);
    const std::span<const double> cuts = cuts_of(c.state, int(v), places);
    for (int i = 0; i + 1 < int(points.size()); ++i) {
      if (out_of_reach(path, i)) continue;
      VesselPiece piece[2];
      const int pieces = pieces_of(path, points, cuts, i, piece);
      for (int k = 0; k < pieces; ++k) {
        interactions::VesselCatch found;
        if (!catch_vessel(tool, shape, piece[k], vessel_radius(path, piece[k].s_a), found)) continue;
        if (!close_vessel(c, {found.s, found.cover, c.state.tick, std::int32_t(v), number})) return;
        if (clip.strand >= 0 || std::fabs(found.local.x) >= nearest) continue;
        nearest = std::fabs(found.local.x);
        put_on_vessel(tool, shape, path, vessel_spot(path, points, cuts, found.s), int(v), found, clip);
      }
    }
  }
}

namespace {

/// A node of the cell that a point rides in.
std::int32_t corner_of(const StepContext& c, const VesselHold& hold, size_t corner) noexcept {
  return visit_organ(c.model, size_t(hold.index), Overloaded{
    [&](SolidRef) { return std::int32_t(-1); },
    [&](CuttableRef organ) { return c.state.cuttables[organ.index].tets.cells[size_t(hold.element)][corner]; }});
}

/// Puts a force on what carries a point.
void push(StepContext& c, const interactions::VesselPoint& p, Vec3d force, interactions::Tag tag = {}) noexcept {
  const size_t i = size_t(p.hold.index);
  tissue::NodeLoad load;
  load.f0 = vec_cast<float>(force);
  load.node = p.node;
  switch (p.hold.kind) {
    case VesselHold::strand: {
      tissue::StrandLoad on;
      on.element = p.hold.element;
      on.w = p.hold.w;
      on.f0 = force;
      c.work.strand_loads[i].add(on, tag);
      return;
    }
    case VesselHold::organ:
      return c.work.organ_loads[i].add(load, tag);
    case VesselHold::membrane:
      return c.work.membrane_loads[i].add(load, tag);
    case VesselHold::cell: {
      size_t most = 0;
      for (size_t k = 1; k < 4; ++k)
        if (p.hold.share[k] > p.hold.share[most]) most = k;
      load.node = corner_of(c, p.hold, most);
      return c.work.organ_loads[i].add(load, tag);
    }
    case VesselHold::space:
      return;
  }
}

constexpr double kFelt =
    0.003;  // [m] of tissue between a vessel's wall and an instrument that still feels it. Our choice

Vec3d on_segment(Vec3d p, Vec3d a, Vec3d b) noexcept { return a + geometry::closest_on_segment(p, a, b) * (b - a); }
double away(Vec3d p, Vec3d a, Vec3d b) noexcept { return length(p - on_segment(p, a, b)); }

/// Does the hand's instrument press on tissue?
bool presses(const StepContext& c, size_t t) noexcept {
  const double(&f)[3] = c.state.tools[t].contact_force;
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

/// A wall that a pulse drives outwards pushes what palpates it, and is pushed back: pressure above the mean on the
/// vessel's width times the length that a point of its line stands for, less the more tissue lies between.
void push_hands(StepContext& c, const interactions::VesselPoint& p, Vec3d at, double force, double radius) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    if (!presses(c, t) || away(at, shape.part[interactions::kShaft].a, shape.frame.tip) > kNearSheet) continue;
    double nearest = kFelt;
    Vec3d towards;
    for (const collision::Capsule& part : shape.part) {
      const Vec3d axis = on_segment(at, part.a, part.b);
      const double between = std::max(length(axis - at) - part.radius - radius, 0.0);
      if (between >= nearest) continue;
      nearest = between;
      towards = normalised(axis - at, {0, 0, 0});
    }
    if (nearest < kFelt)
      push(c, p, (-force * (1 - nearest / kFelt)) * towards, {interactions::Owner::tool_contact, std::int32_t(t), 0});
  }
}

}  // namespace

// Bends count as drawn: arteries are held taut lengthwise, a pulse does not buckle them.
void beat(StepContext& c) noexcept {
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
      if (p.hold.kind == VesselHold::space) continue;
      const double radius = wide * (segment.radius + segment.taper * p.s);
      push(c, p, (over * portable::pi * radius * radius) * turn_at(vessel.path, x, int(i)));
      const double stands_for = 0.5 * vessel.path.length * (vessel.path.points[i + 1].s - vessel.path.points[i - 1].s);
      if (over > 0) push_hands(c, p, x[i], over * 2 * radius * stands_for, radius);
    }
  }
}

namespace {

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
  lay_out_seals(s, std::span(c.work.closed).subspan(interactions::kMaxVesselClips));
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
  const interactions::VesselHosts hosts = look_at_hosts(c.model, c.state, c.work.hosts);
  CutPlaces places;
  int posed = -1;
  for (int i = 0; i < c.state.opening_count; ++i) {
    const interactions::VesselOpening& o = c.state.openings[size_t(i)];
    const VesselPath& path = path_of(c, size_t(o.vessel));
    std::vector<Vec3d>& points = c.work.vessel_points[size_t(o.vessel)];
    if (posed != o.vessel) pose_vessel(path, hosts, points);
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

void let_blood_flow(StepContext& c) noexcept {
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
