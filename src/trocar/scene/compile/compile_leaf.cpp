#include <algorithm>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>
#include <trocar/scene/compile/compile_parts.hpp>

namespace trocar::scene {
namespace {

int nodes_along(double way, double spacing) { return std::max(3, int(std::min(1e6, way / spacing) + 0.5) + 1); }

/// Columns run along the lines, rows from line to line.
void span_over(const LeafSetting& leaf, tissue::MembraneDescription& d, std::vector<core::Fault>& faults) {
  double along = 0, across = 0;
  for (const std::vector<Vec3d>& line : leaf.lines) along = std::max(along, length(geometry::interpolated(line)));
  d.columns = nodes_along(along, leaf.spacing);
  if (d.columns > kMostFoldNodes) d.columns = 3, across = 1e6;  // too many: said below
  std::vector<std::vector<Vec3d>> lines;
  for (const std::vector<Vec3d>& line : leaf.lines)
    lines.push_back(geometry::sampled_by_arc(geometry::interpolated(line), d.columns));
  std::vector<geometry::NurbsCurve> down;
  for (size_t c = 0; c < size_t(d.columns); ++c) {
    std::vector<Vec3d> points;
    for (const std::vector<Vec3d>& line : lines) points.push_back(line[c]);
    down.push_back(geometry::interpolated(points));
    across = std::max(across, length(down.back()));
  }
  d.rows = nodes_along(across, leaf.spacing);
  if (double(d.rows) * d.columns > kMostFoldNodes) {
    faults.push_back({leaf.at, tr("leaf '{}': expected a spacing that gives at most {} nodes, got {:.3g}", leaf.name,
                                  kMostFoldNodes, along / leaf.spacing * (across / leaf.spacing))});
    return;
  }
  std::vector<std::vector<Vec3d>> columns;
  for (const geometry::NurbsCurve& curve : down) columns.push_back(geometry::sampled_by_arc(curve, d.rows));
  for (size_t r = 0; r < size_t(d.rows); ++r)
    for (const std::vector<Vec3d>& column : columns) d.positions.push_back(column[r]);
}

void compile_one(const LeafSetting& leaf, const Tissue& tissue, const Description& scene, sim::Model& model,
                 std::vector<core::Fault>& faults) try {
  tissue::MembraneDescription d = fold_of(tissue, leaf.thickness, scene.gravity);
  span_over(leaf, d, faults);
  if (d.positions.empty()) return;
  d.held = nodes_within(leaf.held, leaf.name, d.positions, faults);
  const sim::DrawnBodies drawn(model);
  std::vector<interactions::BondSet> bonds = bonds_of({leaf.name, d, leaf.bonds}, scene, drawn, faults);
  sim::MembraneBody out;
  out.name = leaf.name;
  out.look = leaf.look;
  out.tissue = leaf.tissue;
  out.cuttable = leaf.cuttable;
  out.failure_strain = tissue.failure_strain;
  out.sheet = build_bonded(d, std::vector<std::uint8_t>(d.positions.size(), 0), bonds);
  for (const int node : out.sheet.held_nodes)
    out.holds.push_back({attach_near(drawn, leaf.held_on, leaf.held_reach, d.positions[size_t(node)]).point});
  note_drawn_pulls(out);
  out.skin = skin_of(out.sheet);
  out.to = length(geometry::interpolated(leaf.lines.front()));
  out.pinch_reach = kPinchReach * leaf.spacing;
  out.depth.assign(size_t(out.sheet.nodes()), 0.0f);
  model.membranes.push_back(std::move(out));
  std::move(bonds.begin(), bonds.end(), std::back_inserter(model.bonds));
} catch (const std::invalid_argument& e) {
  faults.push_back({leaf.at, "leaf '" + leaf.name + "': expected a sheet that can be built, got: " + e.what()});
}

}  // namespace

void LeafScene::compile(const std::vector<Setting>& settings, const Description& scene, sim::Model& model,
                        std::vector<core::Fault>& faults) {
  for (const LeafSetting& leaf : settings)
    if (const Tissue* tissue = find_tissue(scene, leaf.tissue)) compile_one(leaf, *tissue, scene, model, faults);
}

}  // namespace trocar::scene
