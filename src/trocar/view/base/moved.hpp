// Has a body moved since it was drawn, by so much that it can be seen? What has not is not drawn again, nor what only
// follows it.
//
//   Moved moved;
//   if (!moved(state.nodes)) return;
#pragma once

#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::view {

/// [m] A quarter of a pixel of a picture 600 px high, 30 mm before the lens.
inline constexpr double kSeenToMove = 1e-5;

/// Remembers where nodes were when they were drawn.
class Moved {
 public:
  /// Is any node further than kSeenToMove from where it was when this was last true? Then they are remembered.
  bool operator()(std::span<const tissue::NodeState> nodes);
  bool operator()(std::span<const Vec3d> nodes);

 private:
  std::vector<Vec3f> m_drawn;
};

}  // namespace trocar::view
