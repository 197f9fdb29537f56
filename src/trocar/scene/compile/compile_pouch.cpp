#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>
#include <trocar/scene/compile/compile_parts.hpp>

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

/// Nodes within the held places.
std::vector<std::uint8_t> held_nodes(const Pouch& pouch, const std::vector<Vec3d>& positions,
                                     std::vector<core::Fault>& faults) {
  std::vector<std::uint8_t> held(positions.size(), 0);
  for (const Anchor& place : pouch.held) {
    bool any = false;
    for (size_t i = 0; i < positions.size(); ++i)
      if (length(positions[i] - place.centre) <= place.radius) held[i] = 1, any = true;
    if (!any)
      faults.push_back(
          {place.at, fmt::format("expected a place that holds at least one node of '{}', got none", pouch.name)});
  }
  return held;
}

}  // namespace

void compile_pouch(const Pouch& pouch, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) try {
  std::vector<geometry::Section> sections;
  for (const Section& s : pouch.sections) sections.push_back({s.centre, s.across, s.deep, s.squareness});
  const geometry::TriMesh wall = geometry::tessellate(geometry::loft(sections), pouch.spacing);
  tissue::MembraneDescription d;
  d.positions = wall.positions;
  d.triangles = wall.triangles;
  d.held = held_nodes(pouch, d.positions, faults);
  if (std::count(d.held.begin(), d.held.end(), 1) == 0) {
    faults.push_back({pouch.at, "expected '" + pouch.name + "' to be held somewhere, got no held node"});
    return;
  }
  d.thickness = pouch.thickness;
  d.youngs_modulus = tissue.young;
  d.law = {tissue.p1, tissue.p2, tissue.strain_cap};
  d.density = tissue.density;
  d.damping_time = damping_time(tissue::network_of(d), tissue.damping_ms * 1e-3);
  d.bending_damping_time = kPouchBendingDamping;
  d.global_damping = kFoldDrag;
  d.gravity = gravity;
  d.enclosure = enclosure_of(pouch.contents);
  sim::MembraneBody out;
  out.name = pouch.name;
  out.look = pouch.look;
  out.tissue = pouch.tissue;
  out.cuttable = pouch.cuttable;
  out.failure_strain = tissue.failure_strain;
  out.sheet = tissue::build(d, sim::kTick);
  for (int node : out.sheet.held_nodes)
    out.holds.push_back(hold_near(pouch.held_on, pouch.held_reach, d.positions[size_t(node)], model));
  note_drawn_pulls(out);
  out.skin = skin_of(out.sheet);
  out.pinch_reach = kPinchReach * pouch.spacing;
  out.depth.assign(size_t(out.sheet.nodes()), 0.0f);
  if (report) add_report(out, *report);
  model.membranes.push_back(std::move(out));
} catch (const std::invalid_argument& e) {
  faults.push_back({pouch.at, "pouch '" + pouch.name + "': expected a wall that can be built, got: " + e.what()});
}

}  // namespace trocar::scene
