#include <algorithm>
#include <iterator>
#include <limits>
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
constexpr double kPinchReach = 0.5;              // of the spacing of nodes

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

/// Nodes within the places.
std::vector<std::uint8_t> nodes_within(const std::vector<Anchor>& places, const std::string& pouch,
                                       const std::vector<Vec3d>& positions, std::vector<core::Fault>& faults) {
  std::vector<std::uint8_t> within(positions.size(), 0);
  for (const Anchor& place : places) {
    bool any = false;
    for (size_t i = 0; i < positions.size(); ++i)
      if (length(positions[i] - place.centre) <= place.radius) within[i] = 1, any = true;
    if (!any)
      faults.push_back({place.at, tr("expected a place that holds at least one node of '{}', got none", pouch)});
  }
  return within;
}

/// A third of its triangles' areas [m^2].
std::vector<double> areas_of_nodes(const std::vector<Vec3d>& positions,
                                   const std::vector<std::array<int, 3>>& triangles) {
  std::vector<double> area(positions.size(), 0.0);
  for (const auto& t : triangles) {
    const Vec3d a = positions[size_t(t[0])], b = positions[size_t(t[1])], c = positions[size_t(t[2])];
    for (int i : t) area[size_t(i)] += length(cross(b - a, c - a)) / 6;
  }
  return area;
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

constexpr double kMillilitrePerMinuteAndSquareCentimetre = 1e-6 / 60 / 1e-4;  // [m/s]

/// What it takes to tear the weakest organ of those named [J/m^2]; infinite where none can be torn.
double fracture_of(const std::vector<std::string>& on, const Description& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const Solid& solid : scene.solids) {
    if (std::find(on.begin(), on.end(), solid.name) == on.end()) continue;
    for (const Tissue& t : scene.tissues)
      if (t.name == solid.tissue && t.fracture > 0) least = std::min(least, t.fracture);
  }
  return least;
}

/// The sets of bonds of a pouch that is yet to be built: which nodes they tie, and to what. A node that is held, or
/// tied already, stays so.
std::vector<interactions::BondSet> bonds_of(const Pouch& pouch, const tissue::MembraneDescription& d,
                                            const Description& scene, const sim::DrawnBodies& drawn,
                                            std::vector<core::Fault>& faults) {
  const sim::Model& model = drawn.model();
  std::vector<interactions::BondSet> sets;
  std::vector<std::uint8_t> taken = d.held;
  const std::vector<double> area = areas_of_nodes(d.positions, d.triangles);
  for (const BondSetting& setting : pouch.bonds) {
    interactions::BondSet set;
    set.name = setting.name;
    set.of = BodyId::membrane(model.membranes.size());
    const double base = fracture_of(setting.on, scene);
    set.breaches = base < setting.toughness;
    set.law = tissue::CohesiveLaw::of(std::min(base, setting.toughness), setting.opens);
    set.oozes = setting.oozes * kMillilitrePerMinuteAndSquareCentimetre;
    set.bleeds = setting.bleeds * kMillilitrePerMinuteAndSquareCentimetre;
    const std::vector<std::uint8_t> within = nodes_within(setting.places, pouch.name, d.positions, faults);
    for (size_t i = 0; i < within.size(); ++i) {
      if (!within[i] || taken[i]) continue;
      const sim::Attached on = attach_near(drawn, setting.on, setting.reach, d.positions[i]);
      if (on.point.in_space()) continue;
      taken[i] = 1;
      set.bonds.push_back({interactions::at_node(drawn.all(), set.of, std::int32_t(i)), on.point, area[i], on.vertex});
    }
    if (set.bonds.empty())
      faults.push_back({setting.at, tr("expected a node of '{}' in the places of \"{}\" that is free and at "
                                       "most {} mm from what it is tied to, got none",
                                       pouch.name, setting.name, 1000 * setting.reach)});
    if (model.bonds_index(setting.name) >= 0)
      faults.push_back({setting.at, tr("expected every name of bonds once, got \"{}\" again", setting.name)});
    sets.push_back(std::move(set));
  }
  return sets;
}

/// The wall as it hangs with its bonds whole, which bear what the wall does to them there.
/// @param tied  per node: 1 = in a hand
tissue::MembraneModel build_wall(const tissue::MembraneDescription& d, std::vector<std::uint8_t> tied,
                                 std::vector<interactions::BondSet>& sets) {
  for (const interactions::BondSet& set : sets)
    for (const interactions::Bond& bond : set.bonds) tied[size_t(bond.node())] = 1;
  if (std::count(tied.begin(), tied.end(), 1) == 0) return tissue::build(d, sim::kTick);
  tissue::TiedMembrane wall = tissue::build_tied(d, tied, sim::kTick);
  std::vector<Vec3d> pull(d.positions.size());
  for (size_t i = 0, k = 0; i < tied.size(); ++i)
    if (tied[i]) pull[i] = wall.pull[k++];
  for (interactions::BondSet& set : sets)
    for (interactions::Bond& bond : set.bonds) bond.drawn_pull = pull[size_t(bond.node())];
  return std::move(wall.model);
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
  std::vector<interactions::BondSet> bonds = bonds_of(pouch, d, scene, drawn, faults);
  sim::MembraneBody out;
  out.name = pouch.name;
  out.look = pouch.look;
  out.tissue = pouch.tissue;
  out.cuttable = pouch.cuttable;
  out.failure_strain = tissue.failure_strain;
  out.sheet = build_wall(d, in_hands, bonds);
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
