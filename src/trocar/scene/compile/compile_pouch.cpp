#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {
namespace {

constexpr double kPouchBendingDamping = 0.0001;  // [s] times stiffness: more would ask for steps of its own

tissue::Enclosure enclosure_of(const Contents& c) {
  tissue::Enclosure e;
  e.kind = c.kind == Contents::liquid     ? tissue::Enclosure::liquid
           : c.kind == Contents::gas      ? tissue::Enclosure::gas
           : c.kind == Contents::constant ? tissue::Enclosure::constant
                                          : tissue::Enclosure::none;
  e.pressure = c.pressure;
  e.bulk = c.bulk;
  e.density = c.density;
  return e;
}

/// What is held in space within reach of a hand that begins with this pouch between its jaws is left to that hand.
/// @return per node: 1 = so left
std::vector<std::uint8_t> leave_to_hands(const Pouch& pouch, const Description& scene, const sim::DrawnBodies& drawn,
                                         sim::Model& model, tissue::MembraneDescription& d,
                                         std::vector<core::Fault>& faults) {
  constexpr double kJaws = 0.025;  // [m] of a tip: a jaw's length and some
  std::vector<std::uint8_t> left(d.positions.size(), 0);
  for (size_t h = 0; h < model.hands.size(); ++h) {
    const Placement& placed = scene.placements[h];
    if (placed.holds != pouch.name) continue;
    sim::HandModel& hand = model.hands[h];
    hand.membrane = std::int32_t(model.membranes.size());
    for (size_t i = 0; i < left.size(); ++i) {
      if (!d.held[i] || length(d.positions[i] - placed.tip) > kJaws) continue;
      if (!attach_near(drawn, pouch.held_on, pouch.held_reach, d.positions[i]).point.in_space()) continue;
      d.held[i] = 0, left[i] = 1;
      hand.held.push_back(std::int32_t(i));
    }
    if (hand.held.empty() || hand.held.size() > size_t(interactions::kMaxHolds))
      faults.push_back({placed.at, tr("expected 1 to {} nodes of '{}' that are held in space within {} mm of the "
                                      "tip, got {}",
                                      interactions::kMaxHolds, pouch.name, 1000 * kJaws, hand.held.size())});
  }
  return left;
}

/// The duct opens into it with the end that is nearer to its wall.
void find_duct(const Pouch& pouch, const std::vector<Vec3d>& wall, const sim::Model& model, sim::MembraneBody& out) {
  if (pouch.duct.empty()) return;
  out.duct = model.strand_index(pouch.duct);
  if (out.duct < 0) return;
  const std::vector<Vec3d>& rest = model.strand_bodies[size_t(out.duct)].model.rest;
  const auto away = [&wall](Vec3d end) {
    double least = 1e9;
    for (const Vec3d& p : wall) least = std::min(least, length(p - end));
    return least;
  };
  out.duct_at_start = away(rest.front()) < away(rest.back());
}

}  // namespace

void compile_pouch(const Pouch& pouch, const Tissue& tissue, const Description& scene, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) try {
  const geometry::TriMesh wall = surface_of_body(pouch).with_edges(pouch.spacing).mesh;
  tissue::MembraneDescription d;
  d.positions = wall.positions;
  d.triangles = wall.triangles;
  d.held = nodes_within(pouch.held, pouch.name, d.positions, faults);
  if (!pouch.free && std::count(d.held.begin(), d.held.end(), 1) == 0) {
    faults.push_back({pouch.at, "expected '" + pouch.name + "' to be held somewhere, or to be free, got no held node"});
    return;
  }
  d.thickness = pouch.thickness;
  d.youngs_modulus = tissue.young;
  d.law = {tissue.p1, tissue.p2, tissue.strain_cap};
  d.stiffness = painted(pouch.regions);
  d.density = tissue.density;
  const tissue::NetworkDescription springs = tissue::network_of(d);
  check_regions(pouch.regions, pouch.name, springs, faults);
  d.damping_time = damping_time(springs, tissue.damping_ms * 1e-3);
  d.bending_damping_time = kPouchBendingDamping;
  d.global_damping = kFoldDrag;
  d.gravity = scene.gravity;
  d.enclosure = enclosure_of(pouch.contents);
  const sim::DrawnBodies drawn(model);
  const std::vector<std::uint8_t> in_hands = leave_to_hands(pouch, scene, drawn, model, d, faults);
  std::vector<interactions::BondSet> bonds = bonds_of({pouch.name, d, pouch.bonds}, scene, drawn, faults);
  sim::MembraneBody out;
  out.name = pouch.name;
  out.look = pouch.look;
  out.tissue = pouch.tissue;
  out.cuttable = pouch.cuttable;
  out.failure_strain = tissue.failure_strain;
  out.sheet = build_bonded(d, in_hands, bonds);
  for (int node : out.sheet.held_nodes)
    out.holds.push_back({attach_near(drawn, pouch.held_on, pouch.held_reach, d.positions[size_t(node)]).point});
  note_drawn_pulls(out);
  out.skin = skin_of(out.sheet);
  out.pinch_reach = kPinchReach * pouch.spacing;
  out.depth.assign(size_t(out.sheet.nodes()), 0.0f);
  find_duct(pouch, d.positions, model, out);
  if (report) add_report(out, *report);
  model.membranes.push_back(std::move(out));
  std::move(bonds.begin(), bonds.end(), std::back_inserter(model.bonds));
} catch (const std::invalid_argument& e) {
  faults.push_back({pouch.at, "pouch '" + pouch.name + "': expected a wall that can be built, got: " + e.what()});
}

}  // namespace trocar::scene
