#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/volumes/embed.hpp>
#include <trocar/geometry/volumes/lattice.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/scene/compile/compile_solid.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

namespace trocar::scene {
namespace {

/// Replaces vertices along a Morton curve, so that blocks of neighbours in memory are compact in space.
/// @param place  (vertices) what each is called after that
geometry::TriMesh ordered(const geometry::TriMesh& mesh, std::vector<int>& place) {
  const std::vector<int> order = along_curve(mesh.positions);
  place.resize(order.size());
  geometry::TriMesh out;
  for (size_t i = 0; i < order.size(); ++i) {
    place[size_t(order[i])] = int(i);
    out.positions.push_back(mesh.positions[size_t(order[i])]);
  }
  for (const auto& t : mesh.triangles)
    out.triangles.push_back({place[size_t(t[0])], place[size_t(t[1])], place[size_t(t[2])]});
  std::sort(out.triangles.begin(), out.triangles.end(), [](const auto& a, const auto& b) {
    const int la = std::min({a[0], a[1], a[2]}), lb = std::min({b[0], b[1], b[2]});
    return la != lb ? la < lb : a < b;
  });
  return out;
}

geometry::TriMesh ordered(const geometry::TriMesh& mesh) {
  std::vector<int> place;
  return ordered(mesh, place);
}

/// A loft's surface with edges of a length, and how far along the body its vertices are.
struct LoftSkin {
  geometry::TriMesh mesh;
  std::vector<double> along;  ///< (vertices) [m]
};
LoftSkin loft_skin(const geometry::NurbsSurface& surface, double edge, double length_along) {
  const geometry::Tessellation drawn = geometry::tessellate_with_parameters(surface, edge);
  std::vector<int> place;
  LoftSkin out{ordered(drawn.mesh, place), std::vector<double>(drawn.parameters.size())};
  const double start = surface.start_v(), way = surface.end_v() - surface.start_v();
  for (size_t i = 0; i < place.size(); ++i)
    out.along[size_t(place[i])] = length_along * (drawn.parameters[i][1] - start) / way;
  return out;
}

/// Of a body from its first section to its last [m].
double length_of(const std::vector<geometry::Section>& sections) {
  double way = 0;
  for (size_t i = 1; i < sections.size(); ++i) way += length(sections[i].centre - sections[i - 1].centre);
  return way;
}
/// Two parts of a body hang together where their ways along it differ by less than this [m]: a hairpin's legs, one
/// against the other, are half pi of its width apart; more than two widths are two loops.
double width_of_bends(const std::vector<geometry::Section>& sections) {
  constexpr double kLoops = 2.25;
  double widest = 0;
  for (const geometry::Section& s : sections) widest = std::max({widest, length(s.across), length(s.deep)});
  return kLoops * 2 * widest;
}

tissue::Skin bare_skin(const geometry::TriMesh& mesh) {
  tissue::Skin skin;
  skin.triangles = mesh.triangles;
  skin.weights.resize(mesh.positions.size());
  const std::vector<Vec3d> normals = geometry::vertex_normals(mesh);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    skin.rest.push_back(vec_cast<float>(mesh.positions[i]));
    skin.rest_normal.push_back(vec_cast<float>(normals[i]));
  }
  tissue::index_skin(skin);
  return skin;
}

tissue::Skin embedded_skin(const LoftSkin& loft, const geometry::Lattice& lattice,
                           const tissue::NetworkModel& network) {
  tissue::Skin skin = bare_skin(loft.mesh);
  const geometry::Embedding places = geometry::embed(lattice, loft.mesh.positions, loft.along);
  for (size_t i = 0; i < places.nodes.size(); ++i)
    for (size_t k = 0; k < 8; ++k) {
      const int node = places.nodes[i][k];
      skin.weights[i].node[k] = node;
      skin.weights[i].row[k] = network.row_of_node[size_t(node)];
      skin.weights[i].weight[k] = float(places.weights[i][k]);
    }
  return skin;
}

/// Cells at the border weigh at least min_fill, some slivers were left away: the body as a whole weighs what its shape
/// does.
void weigh(tissue::NetworkDescription& network, double mass) {
  double sum = 0;
  for (const double m : network.mass) sum += m;
  for (double& m : network.mass) m *= mass / sum;
}

}  // namespace

void compile_solid(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) try {
  std::vector<geometry::Section> sections;
  for (const Section& s : solid.sections) sections.push_back({s.centre, s.across, s.deep, s.squareness});
  const geometry::NurbsSurface surface = geometry::loft(sections);
  const double way = length_of(sections);
  const LoftSkin skin = loft_skin(surface, solid.skin_edge, way), fine = loft_skin(surface, solid.fine_edge, way);
  geometry::LatticeOptions options;
  options.along = fine.along;
  options.apart = width_of_bends(sections);
  const geometry::Lattice lattice = geometry::make_lattice(fine.mesh, solid.cell, options);

  tissue::LatticeMaterial material;
  const tissue::BulkShare share = tissue::bulk_share(tissue.young, tissue.poisson);
  material.youngs_modulus = share.spring_modulus;
  material.density = tissue.density;
  material.p1 = tissue.p1;
  material.p2 = tissue.p2;
  material.cap = tissue.strain_cap;
  material.min_fill = 0.15;
  tissue::LatticeNetwork net = tissue::lattice_network(lattice.nodes, lattice.cells, lattice.cell_fill, material);
  weigh(net.network, tissue.density * geometry::volume(fine.mesh));
  if (tissue.poisson > 0.25) net.network.kappa = share.kappa;
  net.network.gravity = gravity;
  net.network.global_damping = 1.0;
  material.damping_time = damping_time(net.network, tissue.damping_ms * 1e-3);
  for (tissue::SpringDescription& s : net.network.springs) s.damping = material.damping_time * s.k;

  sim::SolidModel out;
  out.name = solid.name;
  out.look = solid.look;
  out.tissue = solid.tissue;
  out.cell = solid.cell;
  out.failure_strain = tissue.failure_strain;
  out.anchors = anchor_nodes(solid, net.network.positions, net.network.fixed, faults);
  const tissue::PrestressReport prestress = tissue::prestress(net.network, out.anchors);
  if (!prestress.converged || prestress.failed_springs > 0) {
    faults.push_back({solid.at, "expected '" + solid.name + "' to be held against gravity by its anchors, got " +
                                    std::to_string(prestress.failed_springs) + " springs that cannot bear it"});
    return;
  }
  out.network = tissue::build(net.network, sim::kTick);
  if (!few_substeps(solid, out.network.substeps, faults)) return;
  out.skin = embedded_skin(skin, lattice, out.network);
  out.fine = embedded_skin(fine, lattice, out.network);
  if (report) {
    BodyReport r;
    r.name = solid.name;
    r.kind = "solid";
    r.nodes = out.network.nodes;
    r.springs = out.network.springs;
    r.substeps = out.network.substeps;
    r.dt_limit = out.network.dt_limit;
    r.dt_printed = printed_limit(net.network, Dominating::stiffest_spring);
    r.dt_printed_summed = printed_limit(net.network, Dominating::all_springs);
    for (double m : net.network.mass) r.mass += m;
    r.volume = geometry::volume(fine.mesh);
    r.residual = prestress.residual;
    r.prestrain = prestress.largest_strain;
    report->bodies.push_back(r);
  }
  model.solids.push_back(std::move(out));
} catch (const std::invalid_argument& e) {
  faults.push_back({solid.at, "organ '" + solid.name + "': expected a body that can be built, got: " + e.what()});
}

void compile_wall(const Wall& wall, sim::Model& model, CompileReport* report) {
  // A uniform clamped bicubic patch over the control net, sampled evenly.
  geometry::NurbsSurface s;
  s.degree_u = std::min(3, wall.columns - 1);
  s.degree_v = std::min(3, wall.rows - 1);
  s.count_u = wall.columns;
  s.count_v = wall.rows;
  s.control = wall.net;
  const auto clamped_knots = [](int count, int degree) {
    std::vector<double> knots(size_t(count + degree + 1));
    const int inner = count - degree;
    for (int i = 0; i < count + degree + 1; ++i) knots[size_t(i)] = double(std::clamp(i - degree, 0, inner)) / inner;
    return knots;
  };
  s.knots_u = clamped_knots(s.count_u, s.degree_u);
  s.knots_v = clamped_knots(s.count_v, s.degree_v);
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
  out.skin = bare_skin(ordered(mesh));
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
