// A fold of a scene becomes a membrane: a grid between the strand and the base, what its borders ride on, its sheet.
// So do pouches and leaves, with what they are tied to.
#pragma once

#include <string>
#include <vector>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {

inline constexpr double kFoldDrag = 1;  ///< [1/s] against space, as solids: more would be honey
inline constexpr int kMostFoldNodes = 20'000;
inline constexpr double kPinchReach = 0.5;  ///< of the spacing of nodes: so far before them jaws take up what lies flat

/// Appends to Model::membranes. Solids and strands must be compiled before.
void compile_membrane(const Membrane& membrane, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                      std::vector<core::Fault>& faults, CompileReport* report);

/// A closed wall. Appends to Model::membranes, as above.
/// @param scene  that it is of: its gravity, and what its bonds tie it to, which may be weaker than they are
void compile_pouch(const Pouch& pouch, const Tissue& tissue, const Description& scene, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report);

/// What a fold is made of; its nodes are yet to come.
tissue::MembraneDescription fold_of(const Tissue& tissue, double thickness, Vec3d gravity);

/// A membrane, and the loose tissue between it and what it lies on.
struct BondedMembrane {
  const std::string& name;
  const tissue::MembraneDescription& of;
  const std::vector<BondSetting>& settings;
};

/// Nodes within the places. A fault where a place holds none.
std::vector<std::uint8_t> nodes_within(const std::vector<Anchor>& places, const std::string& membrane,
                                       const std::vector<Vec3d>& positions, std::vector<core::Fault>& faults);

/// Which nodes are tied, and to what. A node that is held, or tied already, stays so. Of the membrane that is compiled
/// next.
std::vector<interactions::BondSet> bonds_of(const BondedMembrane& membrane, const Description& scene,
                                            const sim::DrawnBodies& drawn, std::vector<core::Fault>& faults);

/// The membrane as it hangs with its bonds whole, which bear what it does to them there.
/// @param tied  per node: 1 = in a hand
tissue::MembraneModel build_bonded(const tissue::MembraneDescription& d, std::vector<std::uint8_t> tied,
                                   std::vector<interactions::BondSet>& sets);

/// The sheet's nodes as a skin: one vertex a node.
tissue::Skin skin_of(const tissue::MembraneModel& sheet);
/// What the sheet does to its holders in the drawn shape.
void note_drawn_pulls(sim::MembraneBody& membrane);
void add_report(const sim::MembraneBody& membrane, CompileReport& report);

}  // namespace trocar::scene
