// What a mesh of tetrahedra costs as a body, and what it would cost filled again. A flat cell, a sliver, has a stiff
// short way through it: one in a thousand cells sets the time step of all. Isosurface stuffing leaves none, so that a
// body of as many nodes takes a tenth of the sub-steps or less.
//
//   const MeshCost now = cost_of(mesh, tissue);
//   if (const std::optional<Refill> better = refill_of(mesh, tissue, now)) say(in_words(mesh, now, *better));
#pragma once

#include <optional>
#include <string>

#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Cells with a smaller angle between two faces are slivers [degrees]: stuffing leaves none (stuffing.hpp).
inline constexpr double kSliver = 9;
/// From so many sub-steps a tick on, it is asked whether slivers are why (our estimate).
inline constexpr int kManySubsteps = 20;

struct MeshCost {
  int nodes = 0, springs = 0, substeps = 0;
  double tick = 0;  ///< about, on one core [s]
};
/// Of all its springs in all of a tick's sub-steps [s].
double tick_of(int springs, int substeps) noexcept;

/// As a body of this tissue without anchors. Throws std::invalid_argument for a mesh that is not sound.
MeshCost cost_of(const geometry::TetMesh& mesh, const Tissue& tissue);

struct Refill {
  double cube = 0;  ///< "refill_mm": about as many nodes as the mesh has [m]
  MeshCost cost;
};
/// Nothing where the mesh has no slivers, its surface cannot be filled, or that would not spare half of the sub-steps.
std::optional<Refill> refill_of(const geometry::TetMesh& mesh, const Tissue& tissue, const MeshCost& now);

/// What is wrong with the mesh, what that costs, and the key that mends it.
std::string in_words(const geometry::TetMesh& mesh, const MeshCost& now, const Refill& refill);

}  // namespace trocar::scene
