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
  std::string name, kind;        ///< "solid", "strand", "membrane", "pouch", "fat", "wall", "vessels"
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
/// What an organ that answers at once was made with.
struct ComplianceReport {
  std::string organ;
  int nodes = 0, kept = 0;  ///< all; those with a compliance
  double bytes = 0;         ///< of what is kept in memory and on disk
  double most_bytes = 0;    ///< that making it takes, roughly
  double seconds = 0;       ///< that making or reading it took
  bool computed = false;    ///< else it was in the cache
  std::string file;         ///< in the cache; empty: it could not be kept there
  std::string note;         ///< what was wrong with the cache
};
struct CompileReport {
  std::vector<BodyReport> bodies;
  std::vector<ComplianceReport> compliances;
  /// Told of what takes long: which organ, and the share that is done, 0 to 1. From the compiling thread; may be empty.
  std::function<void(const std::string& organ, double share)> said;
  std::vector<core::Fault> warnings;  ///< what can be built and is hardly meant: see compile_warnings.hpp
};

/// Throws core::BadInput where the Description, although well formed, cannot be built (an organ that nothing holds, a
/// strand's end that hangs on nothing near it).
sim::Model compile(const Description& description, CompileReport* report = nullptr);

}  // namespace trocar::scene
