// Slings in a step: which hand has which, what their loops do to strands, and what they close.
#pragma once

#include <span>

#include <trocar/interactions/objects/suture_strangle.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

inline constexpr int kMostLoops = 8;        ///< that close vessels at a time
inline constexpr double kCutsAfter = 0.05;  ///< [s] that a loop is pulled at too hard until it cuts through

bool has_slings(const Model& model) noexcept;

/// What a loop leaves of a strand's lumen.
struct LoopClosure {
  std::int32_t suture = -1;
  interactions::MaterialPoint at;
  double s = 0;       ///< along the strand, in the drawn shape [m]
  double cover = 0;   ///< share of the lumen's width that it takes
  double radius = 0;  ///< within it, drawn round [m]
};
/// f(LoopClosure) of every loop around every strand.
template <class F>
void visit_loops(const Model& model, const State& state, F&& f) {
  const auto& states = interactions::part_of<interactions::Suture>(state);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const interactions::SlingState& sling = states[i].sling;
    for (std::int32_t k = 0; k < sling.around_count; ++k) {
      const interactions::SlingAround& a = sling.around[std::size_t(k)];
      f(LoopClosure{std::int32_t(i), a.at, arc_of(model, a.at), cover_of_loop(model, a), a.radius});
    }
  }
}

/// In rest_sutures() and sew(): what loops press on, what hands do, and what came of it.
void rest_slings(StepContext& context) noexcept;
void lead_slings(StepContext& context) noexcept;
void watch_slings(StepContext& context) noexcept;

/// Its loop lies around something: the instrument can neither be drawn out nor exchanged before the tail is cut.
bool bound_by_sling(const StepContext& context, std::size_t hand) noexcept;
/// What loops close of vessels within strands.
void lay_out_loops(const StepContext& context, std::span<vessels::Occlusion> out) noexcept;

}  // namespace trocar::sim
