#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/vessel_cuts.hpp>

namespace trocar::sim {
namespace {

using interactions::VesselPath;
using interactions::VesselPiece;

using CutPlaces = std::array<double, interactions::kMaxOpenings>;

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

/// @param share  of the lumen's width; 1: through
void open_vessel(StepContext& c, int vessel, double s, double share, int hand) noexcept {
  interactions::VesselOpening* o = opening_at(c, vessel, s);
  if (!o) {
    c.report.flags |= StepReport::kRecordsFull;
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

bool rides_on(const StepContext& c, BodyId on, BodyId carrier) noexcept {
  const bool flesh =
      is_tetrahedral(bodies_of(c), on) || (on.is(BodyKind::membrane) && c.model.membranes[on.index()].sheet.closed());
  return carrier.exists() ? on == carrier : !flesh;
}

bool out_of_reach(const VesselPath& path, int i) noexcept {
  return path.points[size_t(i)].covered() && path.points[size_t(i) + 1].covered();
}

bool near(const geometry::Blade& blade, Vec3d p, double reach) noexcept {
  return length(p - blade.corner[0]) < reach || length(p - blade.corner[size_t(blade.corners / 2)]) < reach;
}

}  // namespace

void open_bleeder(StepContext& c) noexcept {
  const Bleeder& b = c.model.vessels.bleeder;
  if (b.vessel < 0 || c.state.tick != b.tick) return;
  interactions::VesselOpening* o = opening_at(c, b.vessel, b.s);
  if (!o) c.report.flags |= StepReport::kRecordsFull;
  if (!o || o->through) return;
  o->area = std::max(o->area, b.area);
  o->tool = -1;
  o->tick = c.state.tick;
}

const std::vector<Vec3d>& points_of(StepContext& c, size_t v) noexcept {
  std::vector<Vec3d>& points = c.work.vessel_points[v];
  if (c.work.vessel_posed[v] == 0) pose_vessel(path_of(c, v), bodies_of(c), points);
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
      if (!rides_on(c, path.points[size_t(i)].rides.body, carrier) &&
          !rides_on(c, path.points[size_t(i) + 1].rides.body, carrier))
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
  const interactions::MaterialPoint &a = path.points[i].rides, &b = path.points[i + 1].rides;
  const BodyId on = BodyId::maybe(BodyKind::strand, strand);
  if (a.body != on || b.body != on) return {};
  const double from = arc_at(body, place_on_rod(a)), to = arc_at(body, place_on_rod(b));
  if ((from > arc) == (to > arc)) return {};
  const double w = (arc - from) / (to - from);
  const Vec3d off = offset_of(a) + w * (offset_of(b) - offset_of(a));
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

double place_within(const StepContext& c, int strand, size_t vessel, double arc) noexcept {
  const VesselPath& path = path_of(c, vessel);
  for (size_t i = 0; i + 1 < path.points.size(); ++i)
    if (const Within at = within_strand(c.model.strand_bodies[size_t(strand)], strand, path, i, arc); at.there)
      return at.s;
  return -1;
}

void open_vessels(StepContext& c, BodyId body, const Parting& parting, int hand) noexcept {
  if (!parting.parted) return;
  if (body.is(BodyKind::strand)) return open_vessels_within(c, int(body.index()), parting.element, hand);
  open_vessels(c, parting.blade, body, hand);
}

namespace {

bool close_vessel(StepContext& c, const interactions::VesselClip& closed) noexcept {
  if (c.state.vessel_clip_count == interactions::kMaxVesselClips) {
    c.report.flags |= StepReport::kRecordsFull;
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

}  // namespace trocar::sim
