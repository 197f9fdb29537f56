// Where the nodes of a body are and how fast, whatever kind of body it is: what others need to touch, hold and draw it.
// Nodes have the numbers of the body's description; their State lies in rows, in the order that suits its kernel.
#pragma once

#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/network/network_layout.hpp>

namespace trocar::tissue {

/// Of a State as it is now: valid until the body's next tick. view_of(model, state) makes one.
struct NodeView {
  std::span<const NodeState> rows;  ///< positions relative to origin
  std::span<const int> row_of_node;
  Vec3d origin{0, 0, 0};  ///< [m]

  bool empty() const noexcept { return rows.empty(); }
  const NodeState& at(int node) const noexcept { return rows[std::size_t(row_of_node[std::size_t(node)])]; }
  /// World frame [m].
  Vec3d position(int node) const noexcept {
    const NodeState& n = at(node);
    return origin + Vec3d{n.x, n.y, n.z};
  }
  /// [m/s]
  Vec3d velocity(int node) const noexcept {
    const NodeState& n = at(node);
    return {n.vx, n.vy, n.vz};
  }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rows", s.rows), v("row_of_node", s.row_of_node), v("origin", s.origin);
  }
};

}  // namespace trocar::tissue
