#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/geometry/volumes/embed.hpp>
#include <trocar/geometry/volumes/lattice.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile_control.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/scene/compile/compile_solid.hpp>
#include <trocar/scene/description/fibres.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

namespace trocar::scene {
namespace {

tissue::Skin embedded_skin(const EvenSurface& shape, const geometry::Lattice& lattice,
                           const tissue::NetworkModel& network) {
  tissue::Skin skin = bare_skin(shape.mesh);
  const geometry::Embedding places = geometry::embed(lattice, shape.mesh.positions, shape.along);
  for (size_t i = 0; i < places.nodes.size(); ++i)
    for (size_t k = 0; k < 8; ++k) {
      const int node = places.nodes[i][k];
      skin.weights[i].node[k] = node;
      skin.weights[i].row[k] = network.row_of_node[size_t(node)];
      skin.weights[i].weight[k] = float(places.weights[i][k]);
    }
  return skin;
}

std::vector<Vec3d> middles_of(const geometry::Lattice& lattice) {
  std::vector<Vec3d> middles;
  for (const auto& cell : lattice.cells) {
    Vec3d sum;
    for (const int node : cell) sum += lattice.nodes[size_t(node)];
    middles.push_back(sum / double(cell.size()));
  }
  return middles;
}

/// Cells at the border weigh at least min_fill, some slivers were left away: the body as a whole weighs what its shape
/// does.
void weigh(tissue::NetworkDescription& network, double mass) {
  double sum = 0;
  for (const double m : network.mass) sum += m;
  for (double& m : network.mass) m *= mass / sum;
}

std::string too_thin(const geometry::TriMesh& mesh, double cell) {
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const Vec3d size = 1e3 * (box.high - box.low);
  return tr(
      "one of {:.3g} x {:.3g} x {:.3g} mm, which holds no cell of {:g} mm: make \"cell_mm\" smaller, or correct "
      "\"unit_mm\" of its file",
      size.x, size.y, size.z, 1e3 * cell);
}

}  // namespace

void compile_solid(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) try {
  if (solid.at_control_points()) return compile_control(solid, tissue, gravity, model, faults, report);
  const BodySurface shape = surface_of_body(solid);
  const EvenSurface skin = skin_surface(shape, solid.skin_edge), fine = skin_surface(shape, solid.fine_edge);
  geometry::LatticeOptions options;
  options.along = fine.along;
  options.apart = shape.apart();
  const geometry::Lattice lattice = geometry::make_lattice(fine.mesh, solid.cell, options);
  if (lattice.nodes.empty()) throw std::invalid_argument(too_thin(fine.mesh, solid.cell));

  tissue::LatticeMaterial material;
  const tissue::BulkShare share = tissue::bulk_share(tissue.young, tissue.poisson);
  material.youngs_modulus = share.spring_modulus;
  material.density = tissue.density;
  material.p1 = tissue.p1;
  material.p2 = tissue.p2;
  material.cap = tissue.strain_cap;
  material.min_fill = 0.15;
  material.fibre = solid.fibre;
  material.fibre_ratio = solid.fibre_ratio;
  tissue::LatticeNetwork net = tissue::lattice_network(lattice.nodes, lattice.cells, lattice.cell_fill, material,
                                                       fibres_in(solid, middles_of(lattice)));
  weigh(net.network, tissue.density * geometry::volume(fine.mesh));
  if (tissue.poisson > 0.25) net.network.kappa = share.kappa;
  std::optional<sim::SolidModel> out =
      hung(solid, tissue, gravity, std::move(net.network), geometry::volume(fine.mesh), faults, report);
  if (!out) return;
  out->skin = embedded_skin(skin, lattice, out->network);
  out->fine = embedded_skin(fine, lattice, out->network);
  model.solids.push_back(std::move(*out));
} catch (const std::invalid_argument& e) {
  faults.push_back({solid.at, "organ '" + solid.name + "': expected a body that can be built, got: " + e.what()});
}

void compile_wall(const Wall& wall, sim::Model& model, CompileReport* report) {
  // A uniform clamped bicubic patch over the control net, sampled evenly.
  geometry::NurbsSurface s;
  const geometry::nurbs::Knots u = knots_of(wall, 0), v = knots_of(wall, 1);
  s.degree_u = u.degree;
  s.degree_v = v.degree;
  s.count_u = wall.columns;
  s.count_v = wall.rows;
  s.control = wall.net;
  s.weights = wall.weights;
  s.knots_u = u.values;
  s.knots_v = v.values;
  double along_u = 0, along_v = 0;  // longest control rows decide how many samples
  for (int r = 0; r < wall.rows; ++r) {
    double sum = 0;
    for (int c = 1; c < wall.columns; ++c)
      sum += length(wall.net[size_t(r * wall.columns + c)] - wall.net[size_t(r * wall.columns + c - 1)]);
    along_u = std::max(along_u, sum);
  }
  for (int c = 0; c < wall.columns; ++c) {
    double sum = 0;
    for (int r = 1; r < wall.rows; ++r)
      sum += length(wall.net[size_t(r * wall.columns + c)] - wall.net[size_t((r - 1) * wall.columns + c)]);
    along_v = std::max(along_v, sum);
  }
  const int nu = std::clamp(int(along_u / wall.edge) + 1, 2, 400),
            nv = std::clamp(int(along_v / wall.edge) + 1, 2, 400);
  geometry::TriMesh mesh;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.positions.push_back(s.point(double(i) / nu, double(j) / nv));
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const int a = j * (nu + 1) + i, b = a + 1, c = a + nu + 1, e = c + 1;
      // normal = d/drow x d/dcolumn
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, e});
    }
  sim::WallModel out;
  out.name = wall.name;
  out.look = wall.look;
  out.skin = bare_skin(in_order(mesh, along_curve(mesh.positions)));
  out.pose = tissue::make_pose(out.skin);
  for (int i = 0; i < out.skin.size(); ++i) {
    const Vec3f p = out.skin.rest[size_t(i)];
    out.pose.position[size_t(i)] = p;
    out.pose.block[size_t(i / tissue::kSkinBlock)].add(p);
    out.pose.patch[size_t(i / tissue::kSkinPatch)].add(p);
    out.pose.bounds.add(p);
  }
  if (report) {
    BodyReport r;
    r.name = wall.name;
    r.kind = "wall";
    r.nodes = out.skin.size();
    r.springs = int(out.skin.triangles.size());
    report->bodies.push_back(r);
  }
  model.walls.push_back(std::move(out));
}

}  // namespace trocar::scene
