#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/scene/compile/mesh_cost.hpp>

namespace trocar::scene {
namespace {

constexpr double kSpringTime = 4e-9;  // [s] of a spring in a sub-step; 3.3 to 4.7 were measured

double volume_of_cells(const geometry::TetMesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) sum += std::fabs(geometry::volume(mesh, int(c)));
  return sum;
}

/// Two nodes to a cube: rounded to tenths of a millimetre.
double cube_for(const geometry::TetMesh& mesh) {
  const double exact = portable::exp(portable::log(2 * volume_of_cells(mesh) / double(mesh.points.size())) / 3);
  return std::max(1.0, std::round(1e4 * exact)) * 1e-4;
}

}  // namespace

double tick_of(int springs, int substeps) noexcept { return kSpringTime * double(springs) * double(substeps); }

MeshCost cost_of(const geometry::TetMesh& mesh, const Tissue& tissue) {
  tissue::NetworkDescription n = tissue::tet_network(mesh.points, mesh.cells, tet_material(tissue)).network;
  n.global_damping = 1.0;
  const double damping = damping_time(n, tissue.damping_ms * 1e-3);
  for (tissue::SpringDescription& s : n.springs) s.damping = damping * s.k;
  MeshCost cost{int(mesh.points.size()), int(n.springs.size()), tissue::build(n, sim::kTick).substeps, 0};
  cost.tick = tick_of(cost.springs, cost.substeps);
  return cost;
}

std::optional<Refill> refill_of(const geometry::TetMesh& mesh, const Tissue& tissue, const MeshCost& now) try {
  if (!(geometry::inspect(mesh).smallest_dihedral < kSliver)) return {};
  Refill refill;
  refill.cube = cube_for(mesh);
  const geometry::TetMesh filled =
      geometry::stuffed(geometry::surface_of(mesh).mesh, refill.cube, {.largest_part = true});
  refill.cost = cost_of(filled, tissue);
  if (2 * refill.cost.substeps > now.substeps) return {};
  return refill;
} catch (const std::invalid_argument&) {
  return {};
}

std::string in_words(const geometry::TetMesh& mesh, const MeshCost& now, const Refill& refill) {
  const auto time = [](double tick) {
    return tick < 1e-3 ? fmt::format("{:.0f} us", 1e6 * tick) : fmt::format("{:.2g} ms", 1e3 * tick);
  };
  return tr(
      "slivers (cells of {:.2g} degrees): {} sub-steps, about {} a tick; \"refill_mm\": {:g} fills its surface with "
      "new cells: "
      "{} "
      "nodes, {} sub-steps, about {} a tick",
      geometry::inspect(mesh).smallest_dihedral, now.substeps, time(now.tick), 1e3 * refill.cube, refill.cost.nodes,
      refill.cost.substeps, time(refill.cost.tick));
}

}  // namespace trocar::scene
