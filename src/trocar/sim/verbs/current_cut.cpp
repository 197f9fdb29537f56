#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/verbs/current_cut.hpp>

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

/// Has the section burst: its middle and four places around it, but for one?
bool burst_across(const StepContext& c, BodyId strand, int element, double s) noexcept {
  const Section section = section_of(c, strand, element, s);
  int burst = has_burst(c, strand, section.middle);
  for (const Vec3d at : section.around) burst += has_burst(c, strand, at);
  return burst >= 4;
}

bool part(StepContext& c, size_t t, const ElectrodeTouch& touch, StrandRef strand) noexcept {
  if (!c.model.strand_bodies[strand.index].cuttable) return false;
  if (!c.state.strands[strand.index].alive[size_t(touch.point.element)]) return false;
  if (!burst_across(c, strand.id(), touch.point.element, touch.contact.a.x)) return false;
  open_vessels(c, strand.id(), cut(c, strand, touch.point.element), int(t));
  return true;
}

bool is_for_blades(const Model&, SolidRef) noexcept { return true; }
bool is_for_blades(const Model&, CuttableRef) noexcept { return true; }
bool is_for_blades(const Model& m, MembraneRef r) noexcept { return model_of(m, r).cuttable; }

template <class Body>
bool part(StepContext& c, size_t t, const ElectrodeTouch& touch, Body body) noexcept {
  if (!is_for_blades(c.model, body)) return false;
  const Parting parting = cut(c, body, blade_at(c, t, touch, std::max(kLeast, wire_cut(c.model, body))));
  open_vessels(c, body.id(), parting, int(t));
  return parting.parted;
}

}  // namespace

Section section_of(const StepContext& c, BodyId strand, int element, double s) noexcept {
  const double r = 0.6 * c.model.strand_bodies[strand.index()].model.radius[size_t(element)];
  return {r, {s, 0, 0}, {Vec3d{s, r, 0}, Vec3d{s, -r, 0}, Vec3d{s, 0, r}, Vec3d{s, 0, -r}}};
}

bool has_burst(const StepContext& c, BodyId body, Vec3d at) noexcept {
  return tissue::reading(c.model.energy.heat, c.state.heat, body, at).parted > 0.5f;
}

void part_tissue(StepContext& c, size_t t, const ElectrodeTouch& touch) noexcept {
  ElectrodeHand& hand = c.state.electrodes[t];
  const BodyId body = touch.contact.body;
  if (!body.is(BodyKind::strand)) {  // a strand parts when its section has burst, wherever the wire is in it
    const bool done = hand.parted_body == body && length(hand.parted - touch.contact.a) < kEach;
    // The wire is at the bottom of what has burst: what it has just come through lies behind it.
    const Vec3d behind = touch.contact.a - c.model.energy.heat.cell * touch.inwards;
    if (done || !(has_burst(c, body, touch.contact.a) || has_burst(c, body, behind))) return;
  }
  hand.parted_body = body;
  hand.parted = touch.contact.a;
  if (visit(c.model, body, false, [&](auto ref) { return part(c, t, touch, ref); }))
    emit_event(c, Event::on_body(Event::parted, int(t), body));
}

}  // namespace trocar::sim
