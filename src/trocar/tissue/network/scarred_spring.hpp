// A spring that heat has made shorter and stiffer, and scratch of those that a body has. Filled and read by
// network_scars.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

/// Nodes are numbered as described.
struct ScarredSpring {
  int a = 0, b = 0;
  double k = 0;      ///< as it was [N/m]
  double l = 0;      ///< rest length as it was [m]
  double share = 1;  ///< of l that is left
  double stiff = 1;  ///< factor on k, >= 1
};

/// A node at which such springs end.
struct ScarredNode {
  int node, row;
  float share;   ///< of what would move it that does
  Vec3f before;  ///< its velocity before it was pushed [m/s]
};

struct ScarWork {
  std::vector<double> inertia;     ///< (nodes) [kg]
  std::vector<ScarredNode> nodes;  ///< (nodes)

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("inertia", s.inertia), v("nodes", s.nodes);
  }
};

}  // namespace trocar::tissue
