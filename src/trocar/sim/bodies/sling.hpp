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
  std::int32_t strand = -1;
  double s = 0;       ///< along it, in the drawn shape [m]
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
      const interactions::StrandBody& body = model.strand_bodies[std::size_t(a.strand)];
      const std::size_t e = std::size_t(a.element);
      f(LoopClosure{std::int32_t(i), a.strand, interactions::arc_at(body, {a.element, a.w}),
                    interactions::cover_of_loop(body.model.radius[e], body.model.lumen[e], a.radius), a.radius});
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
