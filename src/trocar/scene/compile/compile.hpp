// Turns a Description into a Model: splines into lattices, springs, strands and skins; names into indices; the drawn
// shape into an equilibrium under gravity. Deterministic to the bit on every machine. Takes a second or two.
//
//   const sim::Model model = compile(read_scene(path));
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// What a body compiled to, for `trocar check`.
struct BodyReport {
  std::string name, kind;        ///< "solid", "strand", "membrane", "pouch", "wall", "vessels"
  int nodes = 0, springs = 0;    ///< elements for a strand, triangles for a wall; of vessels: cells of flow, segments
  int substeps = 0;              ///< per tick; 0: implicit or fixed
  double dt_limit = 0;           ///< sufficient stability limit [s]
  double dt_printed = 0;         ///< what the paper's (4b) allows with each node's stiffest spring, for comparison [s]
  double dt_printed_summed = 0;  ///< and with all its springs [s]
  double mass = 0;               ///< [kg]
  double volume = 0;             ///< of the surface [m^3]
  double pressure = 0;           ///< with which a pouch is filled [Pa]
  double residual = 0;           ///< unbalanced force left in the drawn shape [N]
  double prestrain = 0;          ///< largest strain that the prestress put in
};
struct CompileReport {
  std::vector<BodyReport> bodies;
  std::vector<core::Fault> doubts;  ///< what can be built and is hardly meant: see compile_doubts.hpp
};

/// Throws core::BadInput where the Description, although well formed, cannot be built (an organ that nothing holds, a
/// strand's end that hangs on nothing near it).
sim::Model compile(const Description& description, CompileReport* report = nullptr);

}  // namespace trocar::scene
