#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/embed.hpp>
#include <trocar/geometry/lattice.hpp>
#include <trocar/geometry/loft.hpp>
#include <trocar/scene/compile_solid.hpp>
#include <trocar/tissue/lattice_springs.hpp>
#include <trocar/tissue/stability.hpp>

namespace trocar::scene {
namespace {

/// Position on a Morton curve through the box: vertices near each other get near numbers.
std::uint64_t morton(Vec3d p, Vec3d low, double extent) {
  std::uint64_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const double f = std::clamp((p[k] - low[k]) / extent, 0.0, 1.0);
    const auto cell = std::uint64_t(f * 1023.0);
    for (int b = 0; b < 10; ++b) code |= ((cell >> b) & 1u) << (3 * b + k);
  }
  return code;
}

/// Renumbers vertices along a Morton curve, so that blocks of neighbours in memory are compact in space.
geometry::TriMesh ordered(const geometry::TriMesh& mesh) {
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const Vec3d size = box.high - box.low;
  const double extent = std::max({size.x, size.y, size.z, 1e-9});
  std::vector<std::pair<std::uint64_t, int>> order;
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    order.push_back({morton(mesh.positions[i], box.low, extent), int(i)});
  std::sort(order.begin(), order.end());
  std::vector<int> place(order.size());
  geometry::TriMesh out;
  for (size_t i = 0; i < order.size(); ++i) {
    place[size_t(order[i].second)] = int(i);
    out.positions.push_back(mesh.positions[size_t(order[i].second)]);
  }
  for (const auto& t : mesh.triangles)
    out.triangles.push_back({place[size_t(t[0])], place[size_t(t[1])], place[size_t(t[2])]});
  std::sort(out.triangles.begin(), out.triangles.end(), [](const auto& a, const auto& b) {
    const int la = std::min({a[0], a[1], a[2]}), lb = std::min({b[0], b[1], b[2]});
    return la != lb ? la < lb : a < b;
  });
  return out;
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

tissue::Skin embedded_skin(const geometry::TriMesh& mesh, const geometry::Lattice& lattice,
                           const tissue::NetworkModel& network) {
  tissue::Skin skin = bare_skin(mesh);
  const geometry::Embedding places = geometry::embed(lattice, mesh.positions);
  for (size_t i = 0; i < places.nodes.size(); ++i)
    for (size_t k = 0; k < 8; ++k) {
      const int node = places.nodes[i][k];
      skin.weights[i].node[k] = node;
      skin.weights[i].row[k] = network.row_of_node[size_t(node)];
      skin.weights[i].weight[k] = float(places.weights[i][k]);
    }
  return skin;
}

/// Nodes within the anchors: held, or hung from space by springs whose stiffnesses add up to the anchor's.
std::vector<tissue::Anchor> anchor_nodes(const Solid& solid, tissue::NetworkDescription& network,
                                         std::vector<core::Fault>& faults) {
  std::vector<tissue::Anchor> hung;
  network.fixed.assign(network.positions.size(), tissue::kFree);
  for (const Anchor& a : solid.anchors) {
    std::vector<int> inside;
    for (size_t i = 0; i < network.positions.size(); ++i)
      if (length(network.positions[i] - a.centre) < a.radius) inside.push_back(int(i));
    if (inside.empty()) {
      faults.push_back({a.at, "expected an anchor that reaches '" + solid.name + "', got none of its nodes within " +
                                  std::to_string(a.radius * 1e3) + " mm"});
      continue;
    }
    for (int i : inside) {
      if (a.stiffness > 0)
        hung.push_back({i, a.stiffness / double(inside.size()), network.positions[size_t(i)]});
      else
        network.fixed[size_t(i)] = tissue::kHeld;
    }
  }
  return hung;
}

/// Spring damping that costs the time step little: a seventh of the undamped limit, but no more than the tissue's own.
double damping_time(const tissue::NetworkDescription& undamped, double wanted) {
  return std::min(wanted, tissue::build(undamped, sim::kTick).dt_limit / 7);
}

/// What (4b) as printed allows at each node's stiffest spring, for the record.     [KCM99 eq.4]
double printed_limit(const tissue::NetworkDescription& n) {
  std::vector<double> k(n.mass.size()), d(n.mass.size());
  for (const tissue::SpringDescription& s : n.springs)
    for (int end : {s.a, s.b}) {
      k[size_t(end)] = std::max(k[size_t(end)], s.k);
      d[size_t(end)] = std::max(d[size_t(end)], s.damping);
    }
  double least = 1e9;
  for (size_t i = 0; i < k.size(); ++i)
    if (k[i] > 0) least = std::min(least, tissue::dt_limit_as_printed(n.mass[i], k[i], d[i]));
  return least;
}

}  // namespace

void compile_solid(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) try {
  std::vector<geometry::Section> sections;
  for (const Section& s : solid.sections) sections.push_back({s.centre, s.across, s.deep, s.squareness});
  const geometry::NurbsSurface surface = geometry::loft(sections);
  const geometry::TriMesh skin = ordered(geometry::tessellate(surface, solid.skin_edge));
  const geometry::TriMesh fine = ordered(geometry::tessellate(surface, solid.fine_edge));
  const geometry::Lattice lattice = geometry::make_lattice(fine, solid.cell);

  tissue::LatticeMaterial material;
  material.youngs_modulus = tissue.young;
  material.density = tissue.density;
  material.p1 = tissue.p1;
  material.p2 = tissue.p2;
  material.cap = tissue.strain_cap;
  material.min_fill = 0.15;
  tissue::LatticeNetwork net = tissue::lattice_network(lattice.nodes, lattice.cells, lattice.cell_fill, material);
  net.network.gravity = gravity;
  net.network.global_damping = 1.0;
  material.damping_time = damping_time(net.network, tissue.damping_ms * 1e-3);
  for (tissue::SpringDescription& s : net.network.springs) s.damping = material.damping_time * s.k;

  sim::SolidModel out;
  out.name = solid.name;
  out.look = solid.look;
  out.tissue = solid.tissue;
  out.cell = solid.cell;
  out.anchors = anchor_nodes(solid, net.network, faults);
  const tissue::PrestressReport prestress = tissue::prestress(net.network, out.anchors);
  if (!prestress.converged || prestress.failed_springs > 0) {
    faults.push_back({solid.at, "expected '" + solid.name + "' to be held against gravity by its anchors, got " +
                                    std::to_string(prestress.failed_springs) + " springs that cannot bear it"});
    return;
  }
  out.network = tissue::build(net.network, sim::kTick);
  if (out.network.substeps > tissue::kMostSubsteps) {
    faults.push_back({solid.at, "expected '" + solid.name + "' to need at most " +
                                    std::to_string(tissue::kMostSubsteps) + " sub-steps a tick, got " +
                                    std::to_string(out.network.substeps) +
                                    " (larger cells, a softer tissue or a smaller strain_cap need fewer)"});
    return;
  }
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
    r.dt_printed = printed_limit(net.network);
    for (double m : net.network.mass) r.mass += m;
    r.volume = geometry::volume(fine);
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
