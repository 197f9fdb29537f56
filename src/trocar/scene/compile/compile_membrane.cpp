#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {
namespace {

constexpr double kStretchDamping = 0.0004;      // [s] times stiffness; a fold is wet, but sub-steps pay for more
constexpr double kFoldBendingDamping = 0.0005;  // [s] times stiffness

struct Grid {
  int columns = 0, rows = 0;
  std::vector<Vec3d> top, base;  // (columns) both borders
  std::vector<double> arc;       // (columns) of the strand
};

Grid grid_of(const Membrane& membrane, const interactions::StrandBody& body) {
  Grid g;
  const double from = std::min(membrane.from, body.length()), to = std::min(membrane.to, body.length());
  g.columns = std::max(3, int((to - from) / membrane.spacing + 0.5) + 1);
  g.base = geometry::sampled_by_arc(geometry::interpolated(membrane.base), g.columns);
  double height = 0;
  for (int c = 0; c < g.columns; ++c) {
    const double s = from + (to - from) * c / (g.columns - 1);
    const interactions::StrandPlace p = interactions::place_at(body, s);
    const Vec3d a = body.model.rest[size_t(p.element)], b = body.model.rest[size_t(p.element) + 1];
    g.arc.push_back(s);
    g.top.push_back(a + p.w * (b - a));
    height += length(g.base[size_t(c)] - g.top.back()) / g.columns;
  }
  g.rows = std::max(3, int(std::min(1e6, height / membrane.spacing) + 0.5) + 1);
  return g;
}

}  // namespace

tissue::MembraneDescription fold_of(const Tissue& tissue, double thickness, Vec3d gravity) {
  tissue::MembraneDescription d;
  d.thickness = thickness;
  d.youngs_modulus = tissue.young;
  d.law = {tissue.p1, tissue.p2, tissue.strain_cap};
  d.density = tissue.density;
  d.damping_time = kStretchDamping;
  d.bending_damping_time = kFoldBendingDamping;
  d.global_damping = kFoldDrag;
  d.gravity = gravity;
  return d;
}

tissue::Skin skin_of(const tissue::MembraneModel& sheet) {
  tissue::Skin skin;
  const int n = sheet.nodes();
  skin.triangles = sheet.triangles;
  for (int i = 0; i < n; ++i) {
    skin.weights.push_back(tissue::SkinWeights::at(i, sheet.network.row_of_node[size_t(i)]));
    skin.rest.push_back(vec_cast<float>(sheet.network.rest[size_t(i)]));
  }
  std::vector<Vec3d> normal(size_t(n), Vec3d{});
  for (const auto& t : skin.triangles) {
    const Vec3d a = vec_cast<double>(skin.rest[size_t(t[0])]), b = vec_cast<double>(skin.rest[size_t(t[1])]),
                c = vec_cast<double>(skin.rest[size_t(t[2])]);
    for (int v : t) normal[size_t(v)] += cross(b - a, c - a);
  }
  for (const Vec3d& v : normal) skin.rest_normal.push_back(vec_cast<float>(normalised(v, Vec3d{0, 0, 1})));
  index_skin(skin);
  return skin;
}

namespace {

/// Way of each node from the strand's surface along its column, in the drawn shape.
std::vector<float> depth_of(const tissue::MembraneModel& sheet, const interactions::StrandBody& body, const Grid& g) {
  std::vector<float> depth(size_t(sheet.nodes()));
  for (int c = 0; c < g.columns; ++c) {
    double way = -body.model.radius[size_t(interactions::place_at(body, g.arc[size_t(c)]).element)];
    for (int r = 0; r < g.rows; ++r) {
      const size_t i = size_t(r * g.columns + c);
      if (r > 0) way += length(sheet.network.rest[i] - sheet.network.rest[i - size_t(g.columns)]);
      depth[i] = float(way);
    }
  }
  return depth;
}

}  // namespace

void note_drawn_pulls(sim::MembraneBody& m) {
  tissue::MembraneWork work = tissue::make_work(m.sheet);
  std::vector<tissue::BorderPull> pulls(m.holds.size());
  tissue::border_pulls(m.sheet, tissue::rest_state(m.sheet), work, pulls);
  for (size_t h = 0; h < m.holds.size(); ++h) m.holds[h].drawn_pull = pulls[h].force;
}

void add_report(const sim::MembraneBody& m, CompileReport& report) {
  BodyReport r;
  r.name = m.name;
  r.kind = m.sheet.closed() ? "pouch" : "membrane";
  r.nodes = m.sheet.nodes();
  r.springs = m.sheet.network.springs;
  r.substeps = m.sheet.bend_steps * m.sheet.network.substeps;
  r.dt_limit = m.sheet.network.dt_limit;
  for (double each : m.sheet.network.mass) r.mass += each;
  r.residual = m.sheet.settled_residual;
  if (m.sheet.enclosure.kind != tissue::Enclosure::none) {
    r.volume = m.sheet.enclosure.volume;
    r.pressure = m.sheet.enclosure.pressure;
  }
  report.bodies.push_back(r);
}

void compile_membrane(const Membrane& membrane, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                      std::vector<core::Fault>& faults, CompileReport* report) {
  sim::MembraneBody out;
  out.name = membrane.name;
  out.look = membrane.look;
  out.tissue = membrane.tissue;
  out.strand = model.strand_index(membrane.strand);
  out.cuttable = membrane.cuttable;
  out.failure_strain = tissue.failure_strain;
  if (out.strand < 0) return;
  const interactions::StrandBody& body = model.strand_bodies[size_t(out.strand)];
  const Grid g = grid_of(membrane, body);
  if (double(g.rows) * g.columns > kMostFoldNodes) {  // a fold far wider than long: only now is its width known
    faults.push_back({membrane.spacing_at, tr("membrane '{}': expected a spacing that gives at most {} nodes, "
                                              "got {:.3g}",
                                              membrane.name, kMostFoldNodes, double(g.rows) * g.columns)});
    return;
  }
  out.from = g.arc.front();
  out.to = g.arc.back();
  tissue::MembraneDescription d = fold_of(tissue, membrane.thickness, gravity);
  d.columns = g.columns;
  d.rows = g.rows;
  for (int r = 0; r < g.rows; ++r)
    for (int c = 0; c < g.columns; ++c) {
      const double v = double(r) / (g.rows - 1);
      d.positions.push_back(g.top[size_t(c)] + v * (g.base[size_t(c)] - g.top[size_t(c)]));
      d.held.push_back(r == 0 || r + 1 == g.rows);
    }
  try {
    out.sheet = tissue::build(d, sim::kTick);
  } catch (const std::invalid_argument& e) {
    faults.push_back(
        {membrane.at, "membrane '" + membrane.name + "': expected a fold that can be built, got: " + e.what()});
    return;
  }
  const sim::DrawnBodies drawn(model);
  for (int node : out.sheet.held_nodes) {
    const int c = node % g.columns;
    if (node >= g.columns) {
      out.holds.push_back({attach_near(drawn, membrane.base_on, membrane.base_reach, d.positions[size_t(node)]).point});
      continue;
    }
    const interactions::StrandPlace at = interactions::place_at(body, g.arc[size_t(c)]);
    out.holds.push_back({at_element(drawn.all(), size_t(out.strand), at.element, at.w, {})});
  }
  note_drawn_pulls(out);
  out.skin = skin_of(out.sheet);
  out.depth = depth_of(out.sheet, body, g);
  if (report) add_report(out, *report);
  model.membranes.push_back(std::move(out));
}

}  // namespace trocar::scene
