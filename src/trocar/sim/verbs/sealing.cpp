#include <algorithm>
#include <cmath>

#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/model/vessel_cuts.hpp>
#include <trocar/sim/verbs/sealing.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

namespace trocar::sim {
namespace {

using interactions::ElectrodeTouch;
using interactions::VesselPath;
using interactions::VesselPiece;
using interactions::VesselSeal;

using CutPlaces = std::array<double, interactions::kMaxOpenings>;

constexpr double kReach = 0.0025;        // [m] from a wire to the middle of a stump that it heats.        Our choice
constexpr double kBehindStump = 0.0005;  // [m] so far behind its end a stump is shut.                      Our choice
constexpr double kFirmPinch = 5;         // [N] shuts a vessel of the calibre that the forceps are for.    Our choice
constexpr double kHot = 60;              // [C] below it nothing fuses in minutes

/// How hot what the electrode is at is, and how charred.
struct Wall {
  double celsius = tissue::kBodyHeat, char_ = 0, compression = 0;
};

/// The seal there already, or a new one; null where there is no room.
VesselSeal* seal_at(StepContext& c, int vessel, double from, double to, int opening) noexcept {
  for (int i = 0; i < c.state.seal_count; ++i) {
    VesselSeal& s = c.state.seals[size_t(i)];
    if (s.vessel != vessel || s.opening != opening || (s.to > s.from) != (to > from)) continue;
    if (std::fabs(s.from - from) <= 0.5 * (to - from)) return &s;  // jaws move a little while they hold
  }
  if (c.state.seal_count == interactions::kMaxSeals) {
    c.report.flags |= StepReport::kRecordsFull;
    return nullptr;
  }
  VesselSeal& fresh = c.state.seals[size_t(c.state.seal_count++)];
  fresh = {};
  fresh.from = from;
  fresh.to = to;
  fresh.vessel = vessel;
  fresh.opening = opening;
  return &fresh;
}

void heat_seal(StepContext& c, size_t t, const Wall& wall, VesselSeal& s) noexcept {
  tissue::SealInput in;
  in.diameter = 2 * vessel_radius(c.model.vessels.list[size_t(s.vessel)].path, 0.5 * (s.from + s.to));
  in.compression = wall.compression;
  in.temperature = wall.celsius;
  in.char_ = wall.char_;
  tissue::seal(c.model.energy.heat, c.model.tool(c.state, t).electrode.seal, in, c.model.energy.heat.step, s.state);
  s.tick = c.state.tick;
}

/// Vessels that cross the jaws.
void seal_between_jaws(StepContext& c, size_t t, const Wall& wall) noexcept {
  const interactions::ToolModel& tool = c.model.tool(c.state, t);
  CutPlaces places;
  for (size_t v = 0; v < c.model.vessels.list.size(); ++v) {
    const VesselPath& path = c.model.vessels.list[v].path;
    const std::vector<Vec3d>& points = points_of(c, v);
    const std::span<const double> cuts = cuts_of(c.state, int(v), places);
    for (int i = 0; i + 1 < int(points.size()); ++i) {
      VesselPiece piece[2];
      const int pieces = pieces_of(path, points, cuts, i, piece);
      for (int k = 0; k < pieces; ++k) {
        const interactions::BetweenJaws at =
            between_jaws(tool, c.work.shapes[t], piece[k].a, piece[k].b, vessel_radius(path, piece[k].s_a));
        if (!at.inside) continue;
        const double s = piece[k].s_a + at.w * (piece[k].s_b - piece[k].s_a), half = 0.5 * tool.jaw_width / path.length;
        if (VesselSeal* seal = seal_at(c, int(v), std::max(s - half, 0.0), std::min(s + half, 1.0), -1))
          heat_seal(c, t, wall, *seal);
      }
    }
  }
}

/// Stumps and holes at the wire.
void seal_at_wire(StepContext& c, size_t t, const ElectrodeTouch& touch, const Wall& wall) noexcept {
  CutPlaces places;
  for (int i = 0; i < c.state.opening_count; ++i) {
    const interactions::VesselOpening& o = c.state.openings[size_t(i)];
    const VesselPath& path = c.model.vessels.list[size_t(o.vessel)].path;
    const std::vector<Vec3d>& points = points_of(c, size_t(o.vessel));
    const std::span<const double> cuts = cuts_of(c.state, o.vessel, places);
    for (int side = 0; side < (o.through ? 2 : 1); ++side) {
      const Vec3d place = vessel_spot(path, points, cuts, o.s, side).place;
      if (length(place - touch.place) > kReach + vessel_radius(path, o.s)) continue;
      const double off = o.through ? (side == 0 ? -1 : 1) * kBehindStump / path.length : 0.0;
      const double s = std::clamp(o.s + off, 0.0, 1.0);
      if (VesselSeal* seal = seal_at(c, o.vessel, s, s, o.through ? -1 : i)) heat_seal(c, t, wall, *seal);
    }
  }
}

}  // namespace

void seal_vessels(StepContext& c, size_t t, const ElectrodeTouch& touch) noexcept {
  if (!c.model.vessels.there() || touch.contact.gap > 0) return;
  const tissue::HeatReading r =
      tissue::reading(c.model.energy.heat, c.state.heat, touch.contact.body, 0.5 * (touch.contact.a + touch.contact.b));
  if (r.temperature < kHot) return;
  Wall wall;
  wall.celsius = double(r.temperature);
  wall.char_ = double(tissue::look(r).char_);
  if (c.model.tool(c.state, t).electrode.current.bipolar) {
    wall.compression = std::clamp(c.state.tools[t].pinch / kFirmPinch, 0.0, 1.0);
    seal_between_jaws(c, t, wall);
  } else {
    seal_at_wire(c, t, touch, wall);
  }
}

double sealed_share(const State& s, int opening) noexcept {
  for (int i = 0; i < s.seal_count; ++i)
    if (s.seals[size_t(i)].opening == opening && holds(s.seals[size_t(i)])) return 1;
  return 0;
}

void lay_out_seals(const State& s, std::span<vessels::Occlusion> out) noexcept {
  for (vessels::Occlusion& clip : out) clip = {};
  for (int i = 0; i < s.seal_count; ++i) {
    const VesselSeal& seal = s.seals[size_t(i)];
    if (seal.opening >= 0 || !holds(seal)) continue;
    out[size_t(2 * i)] = {seal.vessel, seal.from, 1};
    if (seal.to > seal.from) out[size_t(2 * i + 1)] = {seal.vessel, seal.to, 1};
  }
}

}  // namespace trocar::sim
