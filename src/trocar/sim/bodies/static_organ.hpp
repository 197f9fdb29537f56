// What a step does with organs that answer at once (sim/model/static_organ.hpp): their solver's tick instead of the
// network's, and the handing over.
//
// It is handed over when blades or current part it, when heat scars it, when it is stretched beyond what it bears, and
// where its file says so when it has turned too far. Its network then continues from where the nodes are. Its forces
// are not in balance there, by as much as both solvers differ; so that nothing jumps, a tick of the network moves nodes
// by a share of the way only, which grows from nothing to all of it in 100 ms.
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Does its elastostatic solver move it in this tick?
bool is_quasi_static(const StepContext& context, std::size_t organ) noexcept;

/// The solver's tick. @return whether the organ is such a one: its network is not to be advanced then
bool advance_at_once(StepContext& context, SolidRef solid) noexcept;
bool advance_at_once(StepContext& context, CuttableRef organ) noexcept;

/// Rows of inner nodes as they are now; before something looks at springs. Nothing for other organs.
void place_inner_nodes(StepContext& context, SolidRef solid) noexcept;
void place_inner_nodes(StepContext& context, CuttableRef organ) noexcept;
/// To its network, for good. Nothing for other organs.
void switch_to_dynamic(StepContext& context, SolidRef solid) noexcept;
void switch_to_dynamic(StepContext& context, CuttableRef organ) noexcept;

/// Around a tick of the network of an organ that has just been handed over.
void before_network(StepContext& context, SolidRef solid) noexcept;
void before_network(StepContext& context, CuttableRef organ) noexcept;
void after_network(StepContext& context, SolidRef solid) noexcept;
void after_network(StepContext& context, CuttableRef organ) noexcept;

}  // namespace trocar::sim
