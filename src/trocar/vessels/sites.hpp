// Openings and clips of one tick: where they lie, what still feeds them, and the cells they stand in. Part of advance()
// (flow.hpp); a cell with sites in it is a chain of pieces between places that hold no volume, and is eliminated down
// to its two ends before the whole system is.
#pragma once

#include <trocar/vessels/flow.hpp>

namespace trocar::vessels {

inline constexpr double kPicolitre = 1e-15;  ///< [m^3]

/// What a cell's terms are at present.
struct CellTerms {
  double inertia = 0;     ///< per its whole length [Pa s/m^3]
  double resistance = 0;  ///< [Pa s/m^3]
};

/// Sorts the tick's sites into w.sites and w.chains by their places; starts new slots, forgets unused ones.
void gather_sites(const FlowModel& m, const FlowInput& in, FlowState& s, FlowWork& w, FlowReport& report) noexcept;

/// By connectivity alone: which sides of the openings a source still leads to, and which are open at all.
void find_fed(const FlowModel& m, FlowState& s, FlowWork& w) noexcept;

/// What a chain meets at an end of its cell, if what lies beyond the next rows stood still for this tick.
struct ChainEnd {
  double pressure = 0;     ///< if nothing flowed in the chain [Pa]
  double conductance = 0;  ///< flow that moves it by one pascal [m^3/Pa s]
};

/// The chain's places as functions of the pressures at the cell's ends. Orifices become straight lines through the flow
/// that they would have with those ends.
/// @param again  not the first time in this tick: the lines are those that guess_again() has found
void reduce_chain(const FlowState& s, FlowChain& chain, const CellTerms& terms, const ChainEnd& a, const ChainEnd& b,
                  bool again, FlowWork& w) noexcept;

/// With the ends' mean pressures of this tick: is an orifice's flow far from its law? If so, better lines for all.
bool guess_again(const FlowChain& chain, double end_a, double end_b, FlowWork& w) noexcept;

/// With the ends' mean pressures known: flows of pieces and openings, books, clots.
void finish_chain(const FlowModel& m, const FlowChain& chain, double end_a, double end_b, std::span<OpeningFlow> flows,
                  FlowState& s, FlowWork& w) noexcept;

/// sqrt(A / A_ref) at a pressure: the wall law, which ends at half and at one and a half times the drawn radius.
inline constexpr double kNarrowest = 0.5, kWidest = 1.5;
inline double widening(double rest, double give, double p) noexcept {
  const double x = rest + give * p;
  return x > kNarrowest ? (x < kWidest ? x : kWidest) : kNarrowest;
}

/// Cell and place in it (0 .. 1) of a segment's place s.
inline int cell_at(const FlowSegment& segment, double s, double* at) noexcept {
  const double x = s * segment.cells;
  int number = int(x);
  if (number > segment.cells - 1) number = segment.cells - 1;
  *at = x - number;
  return segment.first + number;
}

}  // namespace trocar::vessels
