#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>

namespace trocar::scene {
namespace {

/// Of a closed surface, or of a grid's cells.
std::vector<std::array<int, 3>> triangles_of(const tissue::MembraneDescription& d) {
  std::vector<std::array<int, 3>> all = d.triangles;
  for (int r = 0; r + 1 < d.rows; ++r)
    for (int c = 0; c + 1 < d.columns; ++c) {
      const int a = r * d.columns + c, below = a + d.columns;
      all.push_back({a, a + 1, below});
      all.push_back({a + 1, below + 1, below});
    }
  return all;
}

/// A third of its triangles' areas [m^2].
std::vector<double> areas_of_nodes(const tissue::MembraneDescription& d) {
  std::vector<double> area(d.positions.size(), 0.0);
  for (const auto& t : triangles_of(d)) {
    const Vec3d a = d.positions[size_t(t[0])], b = d.positions[size_t(t[1])], c = d.positions[size_t(t[2])];
    for (int i : t) area[size_t(i)] += length(cross(b - a, c - a)) / 6;
  }
  return area;
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

}  // namespace

std::vector<std::uint8_t> nodes_within(const std::vector<Anchor>& places, const std::string& membrane,
                                       const std::vector<Vec3d>& positions, std::vector<core::Fault>& faults) {
  std::vector<std::uint8_t> within(positions.size(), 0);
  for (const Anchor& place : places) {
    bool any = false;
    for (size_t i = 0; i < positions.size(); ++i)
      if (length(positions[i] - place.centre) <= place.radius) within[i] = 1, any = true;
    if (!any)
      faults.push_back({place.at, tr("expected a place that holds at least one node of '{}', got none", membrane)});
  }
  return within;
}

std::vector<interactions::BondSet> bonds_of(const BondedMembrane& membrane, const Description& scene,
                                            const sim::DrawnBodies& drawn, std::vector<core::Fault>& faults) {
  const tissue::MembraneDescription& d = membrane.of;
  const sim::Model& model = drawn.model();
  std::vector<interactions::BondSet> sets;
  std::vector<std::uint8_t> taken = d.held;
  const std::vector<double> area = areas_of_nodes(d);
  for (const BondSetting& setting : membrane.settings) {
    interactions::BondSet set;
    set.name = setting.name;
    set.of = BodyId::membrane(model.membranes.size());
    const double base = fracture_of(setting.on, scene);
    set.breaches = base < setting.toughness;
    set.law = tissue::CohesiveLaw::of(std::min(base, setting.toughness), setting.opens);
    set.oozes = setting.oozes * kMillilitrePerMinuteAndSquareCentimetre;
    set.bleeds = setting.bleeds * kMillilitrePerMinuteAndSquareCentimetre;
    const std::vector<std::uint8_t> within = nodes_within(setting.places, membrane.name, d.positions, faults);
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
                                       membrane.name, setting.name, 1000 * setting.reach)});
    if (model.bonds_index(setting.name) >= 0)
      faults.push_back({setting.at, tr("expected every name of bonds once, got \"{}\" again", setting.name)});
    sets.push_back(std::move(set));
  }
  return sets;
}

tissue::MembraneModel build_bonded(const tissue::MembraneDescription& d, std::vector<std::uint8_t> tied,
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

}  // namespace trocar::scene
