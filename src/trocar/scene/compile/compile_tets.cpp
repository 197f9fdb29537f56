#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/scene/compile/compile_tets.hpp>
#include <trocar/scene/description/fibres.hpp>
#include <trocar/tissue/tets/face_skin.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

namespace trocar::scene {
namespace {

constexpr double kSplineEdge = 0.7;  // of a cell: triangles of a loft or another spline that is filled
constexpr double kSpareShare = 0.5;  // of a body's nodes, for cuts to double
constexpr int kLeastSpare = 512;

/// What is thinner than a cell and a half is lost: some of it is reported, and much of it refused.
void tell_loss(const Solid& solid, double kept, CompileReport* report) {
  constexpr double kTold = 0.95, kRefused = 0.6;  // of the shape's volume
  const std::string words = tr("cells of {:.3g} mm keep {:.0f} % of its volume", 1e3 * solid.cell, 100 * kept);
  if (kept < kRefused) throw std::invalid_argument(words + ": smaller ones expected");
  if (kept < kTold && report)
    report->warnings.push_back({solid.at, tr("'{}' has thin parts: {}, smaller ones more", solid.name, words)});
}

/// Cells end in chords of a curved surface and lose what is beyond them: their outer nodes go outwards by as much as
/// gives the volume back, where that is far less than a cell. What is lost in thin parts stays lost.
void give_volume_back(geometry::TetMesh& cells, double volume, double cell) {
  constexpr double kMost = 0.05;  // of a cell
  const geometry::TetSurface surface = geometry::surface_of(cells);
  const double lacking = volume - geometry::volume(cells), area = geometry::area(surface.mesh);
  const double outwards = std::clamp(lacking / area, -kMost * cell, kMost * cell);
  const std::vector<Vec3d> normals = geometry::vertex_normals(surface.mesh);
  for (std::size_t i = 0; i < surface.node.size(); ++i)
    cells.points[std::size_t(surface.node[i])] += outwards * normals[i];
}

geometry::TetMesh cells_of(const Solid& solid, CompileReport* report) {
  if (solid.tets) return solid.tets->mesh;
  const geometry::TriMesh shape = surface_of_body(solid).as_given(kSplineEdge * solid.cell);
  geometry::TetMesh cells = geometry::stuffed(shape, solid.cell, {.largest_part = true});
  if (solid.shape.any()) {
    tell_loss(solid, geometry::volume(cells) / geometry::volume(shape), report);
    give_volume_back(cells, geometry::volume(shape), solid.cell);
  }
  return cells;
}

/// Nodes along a Morton curve, so that blocks of the skin's vertices are compact.
geometry::TetMesh ordered(const geometry::TetMesh& mesh) {
  const std::vector<int> order = along_curve(mesh.points);
  std::vector<int> place(order.size());
  geometry::TetMesh out;
  for (size_t i = 0; i < order.size(); ++i) {
    place[size_t(order[i])] = int(i);
    out.points.push_back(mesh.points[size_t(order[i])]);
  }
  for (const auto& c : mesh.cells)
    out.cells.push_back({place[size_t(c[0])], place[size_t(c[1])], place[size_t(c[2])], place[size_t(c[3])]});
  return out;
}

double mean_edge(const geometry::TetMesh& mesh) {
  double sum = 0;
  for (const auto& c : mesh.cells)
    for (const auto& e : tissue::kCellEdges)
      sum += length(mesh.points[size_t(c[size_t(e[0])])] - mesh.points[size_t(c[size_t(e[1])])]);
  return sum / (6.0 * double(mesh.cells.size()));
}

tissue::TetMaterial material_of(const Solid& solid, const Tissue& tissue) {
  tissue::TetMaterial m = tet_material(tissue);
  m.fibre = solid.fibre;
  m.fibre_ratio = solid.fibre_ratio;
  return m;
}

/// The skin's vertices are the nodes on the surface, under numbers of their own.
tissue::Skin node_skin(const geometry::TetMesh& mesh, const tissue::NetworkModel& network) {
  const geometry::TetSurface surface = geometry::surface_of(mesh);
  tissue::Skin skin;
  skin.triangles = surface.mesh.triangles;
  const std::vector<Vec3d> normals = geometry::vertex_normals(surface.mesh);
  for (size_t i = 0; i < surface.node.size(); ++i) {
    const int node = surface.node[i];
    skin.weights.push_back(tissue::SkinWeights::at(node, network.row_of_node[size_t(node)]));
    skin.rest.push_back(vec_cast<float>(surface.mesh.positions[i]));
    skin.rest_normal.push_back(vec_cast<float>(normals[i]));
  }
  tissue::index_skin(skin);
  return skin;
}

std::vector<Vec3d> middles_of(const geometry::TetMesh& mesh) {
  std::vector<Vec3d> middles;
  for (const auto& c : mesh.cells) {
    Vec3d sum;
    for (const int node : c) sum += mesh.points[size_t(node)];
    middles.push_back(sum / double(c.size()));
  }
  return middles;
}

/// What both kinds of body are made from.
struct Draft {
  geometry::TetMesh mesh;
  tissue::TetMaterial material;
  std::vector<Vec3d> fibres;  // per cell, or empty
  tissue::TetNetwork undamped;
  std::vector<tissue::Anchor> anchors;
  double cell = 0, failure_strain = 0;
};

Draft draft_of(const Solid& solid, const Tissue& tissue, Vec3d gravity, std::vector<core::Fault>& faults,
               CompileReport* report) {
  Draft d;
  d.mesh = ordered(cells_of(solid, report));
  d.cell = solid.cell > 0 ? solid.cell : mean_edge(d.mesh);
  d.failure_strain = tissue.failure_strain;
  d.material = material_of(solid, tissue);
  d.fibres = fibres_in(solid, middles_of(d.mesh));
  d.undamped = tissue::tet_network(d.mesh.points, d.mesh.cells, d.material, d.fibres);
  tissue::NetworkDescription& n = d.undamped.network;
  check_regions(solid.regions, solid.name, n, faults);
  tissue::stiffen(n, painted(solid.regions));
  n.gravity = gravity;
  n.global_damping = 1.0;
  d.material.damping_time = damping_time(n, tissue.damping_ms * 1e-3);
  d.anchors = anchor_nodes(solid, n.positions, n.fixed, faults);
  return d;
}

BodyReport report_on(const Solid& solid, const Draft& d, const tissue::NetworkDescription& damped) {
  BodyReport r;
  r.name = solid.name;
  r.kind = solid.cuttable ? "cuttable" : "solid";
  r.nodes = int(d.mesh.points.size());
  r.springs = int(damped.springs.size());
  r.dt_printed = printed_limit(damped, Dominating::stiffest_spring);
  r.dt_printed_summed = printed_limit(damped, Dominating::all_springs);
  for (double m : damped.mass) r.mass += m;
  r.volume = geometry::volume(d.mesh);
  return r;
}

void add_network(const Solid& solid, Draft& d, tissue::NetworkDescription& n, sim::Model& model,
                 std::vector<core::Fault>& faults, BodyReport& report) {
  const tissue::PrestressReport prestress = tissue::prestress(n, d.anchors);
  if (!prestress.converged || prestress.failed_springs > 0) {
    faults.push_back({solid.at, "expected '" + solid.name + "' to be held against gravity by its anchors, got " +
                                    std::to_string(prestress.failed_springs) + " springs that cannot support it"});
    return;
  }
  sim::SolidModel out;
  out.network = tissue::build(n, sim::kTick);
  if (!few_substeps(solid, out.network.substeps, faults)) return;
  out.name = solid.name;
  out.look = solid.look;
  out.tissue = solid.tissue;
  out.cell = d.cell;
  out.failure_strain = d.failure_strain;
  out.anchors = std::move(d.anchors);
  out.skin = node_skin(d.mesh, out.network);
  const geometry::CuttableTets tets = geometry::cuttable(d.mesh.points, d.mesh.cells, 0);
  out.fine = tissue::face_skin(tets, tets.across, out.network.row_of_node, tissue::kDrawnParts).skin;
  report.substeps = out.network.substeps;
  report.dt_limit = out.network.dt_limit;
  report.residual = prestress.residual;
  report.prestrain = prestress.largest_strain;
  model.solids.push_back(std::move(out));
}

void add_cuttable(const Solid& solid, Draft& d, sim::Model& model, std::vector<core::Fault>& faults,
                  BodyReport& report) {
  tissue::CuttableDescription c;
  c.points = d.mesh.points;
  c.cells = d.mesh.cells;
  c.material = d.material;
  c.fibres = d.fibres;
  c.stiffness = painted(solid.regions);
  c.fixed = d.undamped.network.fixed;
  c.anchors = d.anchors;
  c.gravity = d.undamped.network.gravity;
  c.global_damping = d.undamped.network.global_damping;
  c.spare_nodes = std::max(kLeastSpare, int(kSpareShare * double(c.points.size())));
  sim::CuttableOrgan out;
  out.body = tissue::build(c, sim::kTick);
  if (!few_substeps(solid, out.body.substeps, faults)) return;
  out.name = solid.name;
  out.look = solid.look;
  out.tissue = solid.tissue;
  out.cell = d.cell;
  out.failure_strain = d.failure_strain;
  out.skin = tissue::make_skin(out.body);
  report.substeps = out.body.substeps;
  report.dt_limit = out.body.dt_limit;
  report.residual = out.body.residual;
  model.cuttables.push_back(std::move(out));
}

}  // namespace

tissue::TetMaterial tet_material(const Tissue& tissue) noexcept {
  tissue::TetMaterial m;
  m.youngs_modulus = tissue.young;
  m.poisson = tissue.poisson;
  m.density = tissue.density;
  m.p1 = tissue.p1;
  m.p2 = tissue.p2;
  m.cap = tissue.strain_cap;
  return m;
}

void compile_tets(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                  std::vector<core::Fault>& faults, CompileReport* report) try {
  const size_t before = faults.size();
  Draft d = draft_of(solid, tissue, gravity, faults, report);
  if (faults.size() > before) return;
  tissue::NetworkDescription damped = d.undamped.network;
  for (tissue::SpringDescription& s : damped.springs) s.damping = d.material.damping_time * s.k;
  BodyReport r = report_on(solid, d, damped);
  if (solid.cuttable)
    add_cuttable(solid, d, model, faults, r);
  else
    add_network(solid, d, damped, model, faults, r);
  if (report) report->bodies.push_back(r);
} catch (const std::invalid_argument& e) {
  faults.push_back({solid.at, "organ '" + solid.name + "': expected a body that can be built, got: " + e.what()});
}

}  // namespace trocar::scene
