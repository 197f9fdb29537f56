#include <algorithm>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/current_cut.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

using interactions::ElectrodeTouch;

constexpr double kEach = 0.0008;   // [m] of way between two cuts.                             Our choice
constexpr double kLeast = 0.0015;  // [m] half of a cut's length; of lattices 0.6 cells, as tears.
constexpr double kSlow = 1e-6;     // [m] in a tick: which way a wire goes that is slower nobody knows

/// Across the surface, along the way that the wire goes; from above the surface to below the wire.
geometry::Blade blade_at(const StepContext& c, size_t t, const ElectrodeTouch& touch, double half) noexcept {
  const interactions::ToolShape &now = c.work.shapes[t], &was = c.work.shapes_before[t];
  const Vec3d n = touch.normal;
  const auto along_surface = [&n](Vec3d v) { return v - dot(v, n) * n; };
  Vec3d way = along_surface(now.frame.tip - was.frame.tip);
  if (length(way) < kSlow) way = along_surface(now.frame.opening());
  way = normalised(way, any_perpendicular(n));
  geometry::Blade blade;
  for (const auto& [along, up] : {std::array{-1, 1}, std::array{1, 1}, std::array{1, -1}, std::array{-1, -1}})
    blade.corner[size_t(blade.corners++)] = touch.place + half * (double(along) * way + double(up) * n);
  return blade;
}

bool part_solid(StepContext& c, size_t t, const ElectrodeTouch& touch, size_t i) noexcept {
  const SolidModel& solid = c.model.solids[i];
  const geometry::Blade blade = blade_at(c, t, touch, std::max(kLeast, 0.6 * solid.cell));
  const int severed =
      interactions::cut_organ(blade, solid.network, solid.fine, c.state.solids[i], c.state.parted[i], c.work.parts);
  if (severed > 0) open_vessels(c, blade, {Carriers::organ, std::int32_t(i)}, int(t));
  return severed > 0;
}

bool part_cuttable(StepContext& c, size_t t, const ElectrodeTouch& touch, size_t i) noexcept {
  const CuttableOrgan& organ = c.model.cuttables[i];
  const geometry::Blade blade = blade_at(c, t, touch, std::max(kLeast, 0.6 * organ.cell));
  const geometry::CutResult book = tissue::cut(organ.body, blade, c.state.cuttables[i], c.work.cuttable_work[i]);
  if (book.full) c.report.flags |= StepReport::kBookFull;
  if (book.parted > 0) open_vessels(c, blade, {Carriers::organ, std::int32_t(c.model.solids.size() + i)}, int(t));
  return book.parted > 0;
}

bool part_fold(StepContext& c, size_t t, const ElectrodeTouch& touch, size_t i) noexcept {
  const MembraneBody& m = c.model.membranes[i];
  if (!m.cuttable) return false;
  const geometry::Blade blade = blade_at(c, t, touch, kLeast);
  const int severed =
      interactions::cut_membrane(blade, m.sheet, m.depth, c.state.membranes[i], c.state.torn[i], c.work.parts).severed;
  if (severed > 0) open_vessels(c, blade, {Carriers::membrane, std::int32_t(i)}, int(t));
  return severed > 0;
}

/// Has the section burst: its middle and four places around it, but for one?
bool burst_across(const StepContext& c, std::int32_t strand, int element, double s) noexcept {
  const Section section = section_of(c, strand, element, s);
  int burst = has_burst(c, strand, section.middle);
  for (const Vec3d at : section.around) burst += has_burst(c, strand, at);
  return burst >= 4;
}

bool part_strand(StepContext& c, size_t t, const ElectrodeTouch& touch) noexcept {
  const std::int32_t strand = touch.contact.body;
  const interactions::StrandBody& body = c.model.strand_bodies[size_t(strand)];
  tissue::StrandState& state = c.state.strands[size_t(strand)];
  if (!body.cuttable || !state.alive[size_t(touch.point.element)]) return false;
  if (!burst_across(c, strand, touch.point.element, touch.contact.a.x)) return false;
  tissue::cut_element(state, touch.point.element);
  open_vessels_within(c, strand, touch.point.element, int(t));
  return true;
}

bool part_body(StepContext& c, size_t t, const ElectrodeTouch& touch) noexcept {
  using interactions::kMembraneBase, interactions::kSolidBase;
  const std::int32_t body = touch.contact.body;
  const size_t solids = c.model.solids.size();
  if (body >= kMembraneBase) return part_fold(c, t, touch, size_t(body - kMembraneBase));
  if (body < kSolidBase) return part_strand(c, t, touch);
  const size_t organ = size_t(body - kSolidBase);
  return organ < solids ? part_solid(c, t, touch, organ) : part_cuttable(c, t, touch, organ - solids);
}

}  // namespace

Section section_of(const StepContext& c, std::int32_t strand, int element, double s) noexcept {
  const double r = 0.6 * c.model.strand_bodies[size_t(strand)].model.radius[size_t(element)];
  return {r, {s, 0, 0}, {Vec3d{s, r, 0}, Vec3d{s, -r, 0}, Vec3d{s, 0, r}, Vec3d{s, 0, -r}}};
}

bool has_burst(const StepContext& c, std::int32_t body, Vec3d at) noexcept {
  return tissue::reading(c.model.energy.heat, c.state.heat, body, at).parted > 0.5f;
}

void part_tissue(StepContext& c, size_t t, const ElectrodeTouch& touch) noexcept {
  ElectrodeHand& hand = c.state.electrodes[t];
  const std::int32_t body = touch.contact.body;
  if (body >= interactions::kSolidBase) {  // a strand parts when its section has burst, wherever the wire is in it
    const bool done = hand.parted_body == body && length(hand.parted - touch.contact.a) < kEach;
    // The wire is at the bottom of what has burst: what it has just come through lies behind it.
    const Vec3d behind = touch.contact.a - c.model.energy.heat.cell * touch.inwards;
    if (done || !(has_burst(c, body, touch.contact.a) || has_burst(c, body, behind))) return;
  }
  hand.parted_body = body;
  hand.parted = touch.contact.a;
  if (part_body(c, t, touch)) tell(c, Event::parted, int(t), body);
}

}  // namespace trocar::sim
