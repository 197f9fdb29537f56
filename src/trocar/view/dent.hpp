// Drawn organs beside instruments: finer than the mechanics resolve, the skin gives way to each of them, and dips
// around one that touches it. And whether an organ has moved at all since it was drawn.
#pragma once

#include <span>
#include <vector>

#include <trocar/collision/rods.hpp>
#include <trocar/tissue/skin.hpp>

namespace trocar::view {

/// Might one of the instruments dent what is in the box?
bool near(const tissue::Box& box, std::span<const collision::Capsule> rods);

/// Moves the vertices; true where any was close enough. Normals are those before.
bool dent(std::span<const collision::Capsule> rods, std::span<Vec3f> positions, std::span<const Vec3f> normals);

/// Remembers places of nodes.
class MovedNodes {
 public:
  /// Is any node elsewhere than at the call before?
  bool operator()(std::span<const tissue::NodeState> nodes);

 private:
  std::vector<tissue::NodeState> m_drawn;
};

}  // namespace trocar::view
