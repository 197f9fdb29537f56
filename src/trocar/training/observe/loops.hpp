// Loops of slings, as judged.
#pragma once

#include <array>
#include <optional>

#include <trocar/sim/bodies/sling.hpp>

namespace trocar::training {

/// A loop around a strand.
struct LoopSeen {
  sim::LoopClosure closure;
  double stump = 0;  ///< along the strand to its next free end [m]; 1e9: there is none
  double pull = 0;   ///< towards the tube, less what the knot pushes back [N]
  double tension = 0;
  bool off = false;  ///< its tail has been cut, it stays
  bool closes() const noexcept { return closure.cover >= kCloses; }

  static constexpr double kCloses = 0.98;  ///< share of the lumen, as of clips
};
/// Of those around the strand the one nearest to `s` [m]; nothing where there is none.
std::optional<LoopSeen> loop_on(const sim::Model& model, const sim::State& state, int strand, double s);
/// Where loops lie around a strand that close it and whose tails have been cut, from its beginning [m].
struct SecuredLoops {
  std::array<double, sim::kMostLoops> at{};
  int count = 0;
};
SecuredLoops secured_loops(const sim::Model& model, const sim::State& state, int strand);
/// The sling that this hand holds, or, where it holds none, the last one that it left; -1: neither.
int sling_of_hand(const sim::State& state, int hand);

}  // namespace trocar::training
