// Springs that heat has made shorter and stiffer, in a body's own sub-steps. Beside each, which stays as it is, a
// second one pulls its ends together or apart, so that both are as one of q times the stiffness k and s times the rest
// length l:
//   pull of the second = (q - 1) k |r| - (q s - 1) k l
// The sub-steps bear the stiffness that was compiled, not this one. So the ends speed up as if they were heavier by
// what is wanted of them, dt^2 (q - 1) k / 2 for each spring (stability.hpp), and weigh what they did: constant, the
// same in all directions and of one node alone, so that it neither drives nor damps what swings. Private to tissue.
//
//   ScarredSprings scars(body, springs, scratch);   // once a tick
//   scars.mark(nodes), push(nodes), scars.ease(nodes);   // whatever pushes nodes as if they were as light as before
//   scars.apply(in, out);                           // after each sub-step, before the loads
#pragma once

#include <trocar/tissue/network/network_loads.hpp>

namespace trocar::tissue {

class ScarredSprings {
 public:
  /// @param scratch  (nodes), unless there are no springs
  ScarredSprings(LoadedBody& body, std::span<const ScarredSpring> springs, ScarWork& scratch) noexcept;

  void mark(const std::vector<NodeState>& nodes) noexcept;
  void ease(std::vector<NodeState>& nodes) const noexcept;
  /// After the kernel has moved all nodes from `in` to `out`.
  void apply(const NodeState* in, NodeState* out) const noexcept;

 private:
  void pull(const ScarredSpring& spring, const NodeState* in, NodeState* out) const noexcept;
  void push(int node, Vec3d impulse, NodeState& out) const noexcept;

  const LoadedBody& m;
  std::span<const ScarredSpring> m_springs;
  std::span<ScarredNode> m_nodes;
};

}  // namespace trocar::tissue
