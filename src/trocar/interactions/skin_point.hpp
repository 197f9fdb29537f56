// Where a vertex of a skin is now, straight from the network that carries it: for those who need a few vertices, not
// the posed surface.
#pragma once

#include <trocar/tissue/network.hpp>
#include <trocar/tissue/skin.hpp>

namespace trocar::interactions {

/// @return [m], in the scene's frame
inline Vec3d skin_point(const tissue::NetworkModel& network, const tissue::Skin& skin,
                        const tissue::NetworkState& state, int vertex) noexcept {
  const tissue::SkinWeights& w = skin.weights[std::size_t(vertex)];
  Vec3d p = network.origin;
  for (std::size_t j = 0; j < 8; ++j) {
    const tissue::NodeState& n = state.nodes[std::size_t(w.row[j])];
    p += double(w.weight[j]) * Vec3d{n.x, n.y, n.z};
  }
  return p;
}

}  // namespace trocar::interactions
