// What compiling lattices and compiling tetrahedra have in common. Private to the folder.
#pragma once

#include <optional>
#include <vector>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/tissue/network/stiffness_field.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

namespace trocar::scene {

/// Null: there is none of that name.
const Tissue* find_tissue(const Description& d, const std::string& name);

/// The points' numbers along a Morton curve: what is near each other in this order is near in space.
std::vector<int> along_curve(const std::vector<Vec3d>& points);

/// Nodes within the solid's anchors: held (in `fixed`, tissue::Held bits, one for each of the positions), or hung from
/// space by the springs returned, whose stiffnesses add up to the anchor's.
std::vector<tissue::Anchor> anchor_nodes(const Solid& solid, const std::vector<Vec3d>& positions,
                                         std::vector<std::uint8_t>& fixed, std::vector<core::Fault>& faults);

/// What was painted on a body as a field; empty where nothing was. It must not outlive the regions.
tissue::StiffnessField painted(const std::vector<StiffnessRegion>& regions);
/// A fault for each region within which no spring of the body has its middle.
void check_regions(const std::vector<StiffnessRegion>& regions, const std::string& body,
                   const tissue::NetworkDescription& network, std::vector<core::Fault>& faults);

/// The tissue's law for tetrahedra, without fibres and undamped.
tissue::TetMaterial tet_material(const Tissue& tissue) noexcept;

/// Spring damping that costs the time step little: a seventh of the undamped limit, but no more than the tissue's own.
double damping_time(const tissue::NetworkDescription& undamped, double wanted);

/// Which k and d (4b) is given at a node: of its stiffest spring ("the dominating spring"), or of all its springs.
enum class Dominating { stiffest_spring, all_springs };
/// What (4b) as printed allows, for the record.                                    [KCM99 eq.4]
double printed_limit(const tissue::NetworkDescription& network, Dominating dominating);

/// A skin without weights: triangles and their tables, drawn places and normals.
tissue::Skin bare_skin(const geometry::TriMesh& mesh);

/// A solid organ without skins, of a network that is yet to be damped: hung up in its anchors so that it is at rest as
/// drawn. Nothing, and a fault, where they cannot bear it or it would need too many sub-steps.
/// @param volume  of what it weighs, for the report [m^3]
std::optional<sim::SolidModel> hung(const Solid& solid, const Tissue& tissue, Vec3d gravity,
                                    tissue::NetworkDescription network, double volume, std::vector<core::Fault>& faults,
                                    CompileReport* report);

/// False, and a fault, where the organ would need too many.
bool few_substeps(const Solid& solid, int substeps, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
