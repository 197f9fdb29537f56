// The compliance of an organ's surface: of the inverse of K the rows and columns of the nodes that are kept
// (interior-free)                                                                             [KCM99 eq.7] [KCM99 eq.8]
//
// Inner nodes are eliminated first, piece by piece (nested dissection of the nodes in space, multifrontal), what is
// kept last, and the dense rest, K_oo - K_oi K_ii^-1 K_io, is inverted in place. All of it is our own arithmetic in a
// fixed order, a product and a sum at a time, in double: every machine, compiler, instruction set and number of threads
// makes the same bits, so that the matrix need not travel with scenes and recordings. A library's factorisation
// (CHOLMOD on BLAS) differs in its last bits from processor to processor.
#pragma once

#include <functional>
#include <span>
#include <stdexcept>
#include <vector>

#include <trocar/core/parallel.hpp>
#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::tissue {

/// What makes K singular, or nearly so.
struct NotHeld : std::invalid_argument {
  NotHeld(const std::string& what, int at) : std::invalid_argument(what), node(at) {}
  int node;  ///< where it was found
};

/// Says so. @throws NotHeld
[[noreturn]] void refuse_unheld(int node);

struct Condensed {
  int kept = 0;                    ///< nodes
  std::vector<double> compliance;  ///< (3 kept x 3 kept) symmetric, whole, by columns; 0 on held axes [m/N]
  std::vector<double> fields;      ///< (loads x 3 kept) displacements of the kept nodes under each load [m]
};

/// @param kept   nodes, ascending, each once
/// @param loads  (loads x 3 nodes) forces on all nodes [N]; may be empty
/// @param said   receives the share that is done, 0 to 1, from this thread; may be empty
/// @throws NotHeld where K is not positive definite: nothing holds a part of the body, its springs have no stiffness,
/// it
///         buckles under what presses it, or K is no number; std::invalid_argument of nodes or loads that are unsound
Condensed condense(const Stiffness& k, std::span<const int> kept, std::span<const double> loads = {},
                   core::ThreadPool* pool = nullptr, const std::function<void(double)>& said = {});

/// What that takes at most, roughly [B]; before anything is allocated.
double memory_to_condense(int nodes, int kept) noexcept;

/// The same by unit forces on each kept node and conjugate gradients, as the paper does it: slow, for comparison.
Condensed condense_by_unit_forces(const Stiffness& k, std::span<const int> kept);

}  // namespace trocar::tissue
