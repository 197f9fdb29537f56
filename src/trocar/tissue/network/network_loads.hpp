// What bodies of nodes share in a sub-step: reading a node, moving it in the kernel's own arithmetic, and loads taken
// implicitly. Private to tissue.
//
//   ImplicitLoads pull(body, loads, scratch);          // once a tick: what each node's loads add up to
//   pull.apply(in, out);                               // after each sub-step
//   pull.report(reactions);                            // when the tick is done
#pragma once

#include <span>

#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

inline Vec3f place(const NodeState& n) { return {n.x, n.y, n.z}; }
inline Vec3f speed(const NodeState& n) { return {n.vx, n.vy, n.vz}; }

/// x0 + dt v.
inline void move_to(NodeState& out, const NodeState& in, Vec3f v, float dt) {
  out.vx = v.x, out.vy = v.y, out.vz = v.z;
  out.x = in.x + dt * v.x, out.y = in.y + dt * v.y, out.z = in.z + dt * v.z;
}

/// What loads need to know of a body.
struct LoadedBody {
  int nodes = 0;
  double dt = 0, gamma = 0;  ///< of a sub-step [s]; [1/s]
  int substeps = 1;
  Vec3d origin;
  std::span<const double> mass;         ///< (nodes) [kg]
  std::span<const std::uint8_t> fixed;  ///< (nodes) Held bits
  std::span<const int> row_of_node;     ///< (nodes)
};
inline LoadedBody loaded_body(const NetworkModel& m) noexcept {
  return {m.nodes, m.dt, m.gamma, m.substeps, m.origin, m.mass, m.fixed, m.row_of_node};
}

/// kBadLoad with the first load that is unsound or out of order.
StepReport check_loads(const LoadedBody& body, std::span<const NodeLoad> loads) noexcept;

/// The loads of one tick. Those of a node are linear in its place and velocity and in time: neither what their sum
/// grows by changes from sub-step to sub-step, nor the matrix that it is solved with, and each load's mean force
/// follows from the node's mean place and velocity.
class ImplicitLoads {
 public:
  /// @param scratch  (nodes)
  ImplicitLoads(const LoadedBody& body, std::span<const NodeLoad> loads, std::span<LoadedNode> scratch) noexcept;

  /// After the kernel has moved all nodes from `in` to `out`: moves those that carry loads as these ask. False where a
  /// result is not finite.
  bool apply(const NodeState* in, NodeState* out) noexcept;
  /// The force that each load exerted on its node, averaged over the tick [N]. (loads), or empty
  void report(std::span<Vec3f> reactions) const noexcept;

 private:
  void add(int first, int last, LoadedNode& into) const noexcept;
  void add_plain(LoadedNode& into) const noexcept;
  void add_matrices(LoadedNode& into) const noexcept;

  const LoadedBody& m;
  std::span<const NodeLoad> m_loads;
  std::span<LoadedNode> m_nodes;
};

}  // namespace trocar::tissue
