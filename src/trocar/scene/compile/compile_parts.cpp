#include <algorithm>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/tissue/network/stability.hpp>

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

}  // namespace

std::vector<int> along_curve(const std::vector<Vec3d>& points) {
  const geometry::Bounds box = geometry::bounds(points);
  const Vec3d size = box.high - box.low;
  const double extent = std::max({size.x, size.y, size.z, 1e-9});
  std::vector<std::pair<std::uint64_t, int>> order;
  for (size_t i = 0; i < points.size(); ++i) order.push_back({morton(points[i], box.low, extent), int(i)});
  std::sort(order.begin(), order.end());
  std::vector<int> numbers;
  for (const auto& place : order) numbers.push_back(place.second);
  return numbers;
}

std::vector<tissue::Anchor> anchor_nodes(const Solid& solid, const std::vector<Vec3d>& positions,
                                         std::vector<std::uint8_t>& fixed, std::vector<core::Fault>& faults) {
  std::vector<tissue::Anchor> hung;
  fixed.assign(positions.size(), tissue::kFree);
  for (const Anchor& a : solid.anchors) {
    std::vector<int> inside;
    for (size_t i = 0; i < positions.size(); ++i)
      if (length(positions[i] - a.centre) < a.radius) inside.push_back(int(i));
    if (inside.empty()) {
      faults.push_back({a.at, "expected an anchor that reaches '" + solid.name + "', got none of its nodes within " +
                                  std::to_string(a.radius * 1e3) + " mm"});
      continue;
    }
    for (int i : inside) {
      if (a.stiffness > 0)
        hung.push_back({i, a.stiffness / double(inside.size()), positions[size_t(i)]});
      else
        fixed[size_t(i)] = tissue::kHeld;
    }
  }
  return hung;
}

tissue::StiffnessField painted(const std::vector<StiffnessRegion>& regions) {
  if (regions.empty()) return {};
  return [&regions](Vec3d place) { return stiffness_at(regions, place); };
}

void check_regions(const std::vector<StiffnessRegion>& regions, const std::string& body,
                   const tissue::NetworkDescription& network, std::vector<core::Fault>& faults) {
  for (const StiffnessRegion& r : regions) {
    const bool any = std::any_of(network.springs.begin(), network.springs.end(), [&](const auto& s) {
      return weight_at(r, 0.5 * (network.positions[size_t(s.a)] + network.positions[size_t(s.b)])) > 0;
    });
    if (!any)
      faults.push_back({r.at, "expected a region that reaches '" + body + "', got none of its springs within " +
                                  std::to_string(r.radius * 1e3) + " mm"});
  }
}

double damping_time(const tissue::NetworkDescription& undamped, double wanted) {
  tissue::NetworkDescription springs = undamped;
  springs.kappa = 0;  // its impulses take long to find, and do not matter here
  return std::min(wanted, tissue::build(springs, sim::kTick).dt_limit / 7);
}

double printed_limit(const tissue::NetworkDescription& n, Dominating dominating) {
  std::vector<double> k(n.mass.size()), d(n.mass.size());
  for (const tissue::SpringDescription& s : n.springs)
    for (int end : {s.a, s.b}) {
      const bool sum = dominating == Dominating::all_springs;
      k[size_t(end)] = sum ? k[size_t(end)] + s.k : std::max(k[size_t(end)], s.k);
      d[size_t(end)] = sum ? d[size_t(end)] + s.damping : std::max(d[size_t(end)], s.damping);
    }
  double least = 1e9;
  for (size_t i = 0; i < k.size(); ++i)
    if (k[i] > 0) least = std::min(least, tissue::dt_limit_as_printed(n.mass[i], k[i], d[i]));
  return least;
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

std::optional<sim::SolidModel> hung(const Solid& solid, const Tissue& tissue, Vec3d gravity,
                                    tissue::NetworkDescription network, double volume, std::vector<core::Fault>& faults,
                                    CompileReport* report) {
  network.gravity = gravity;
  network.global_damping = 1.0;
  check_regions(solid.regions, solid.name, network, faults);
  tissue::stiffen(network, painted(solid.regions));
  const double damping = damping_time(network, tissue.damping_ms * 1e-3);
  for (tissue::SpringDescription& s : network.springs) s.damping = damping * s.k;
  sim::SolidModel out;
  out.name = solid.name;
  out.look = solid.look;
  out.tissue = solid.tissue;
  out.cell = solid.cell;
  out.failure_strain = tissue.failure_strain;
  out.anchors = anchor_nodes(solid, network.positions, network.fixed, faults);
  const tissue::PrestressReport prestress = tissue::prestress(network, out.anchors);
  if (!prestress.converged || prestress.failed_springs > 0) {
    faults.push_back({solid.at, "expected '" + solid.name + "' to be held against gravity by its anchors, got " +
                                    std::to_string(prestress.failed_springs) + " springs that cannot support it"});
    return {};
  }
  out.network = tissue::build(network, sim::kTick);
  if (!few_substeps(solid, out.network.substeps, faults)) return {};
  if (report) {
    BodyReport r;
    r.name = solid.name;
    r.kind = "solid";
    r.nodes = out.network.nodes;
    r.springs = out.network.springs;
    r.substeps = out.network.substeps;
    r.dt_limit = out.network.dt_limit;
    r.dt_printed = printed_limit(network, Dominating::stiffest_spring);
    r.dt_printed_summed = printed_limit(network, Dominating::all_springs);
    for (double m : network.mass) r.mass += m;
    r.volume = volume;
    r.residual = prestress.residual;
    r.prestrain = prestress.largest_strain;
    report->bodies.push_back(r);
  }
  return out;
}

bool few_substeps(const Solid& solid, int substeps, std::vector<core::Fault>& faults) {
  if (substeps <= tissue::kMostSubsteps) return true;
  faults.push_back({solid.at, "expected '" + solid.name + "' to need at most " + std::to_string(tissue::kMostSubsteps) +
                                  " sub-steps a tick, got " + std::to_string(substeps) +
                                  (solid.tets && solid.tets->label == 0 && !(solid.tets->refill > 0)
                                       ? " (\"refill_mm\" fills its surface with cells that need fewer)"
                                       : " (larger cells, a softer tissue or a smaller strain_cap need fewer)")});
  return false;
}

}  // namespace trocar::scene
