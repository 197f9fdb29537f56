// Which nodes of a graph hang together: each part is a tree of pointers to parents, and is named by the node at its
// top.
#pragma once

#include <cstdint>
#include <span>

namespace trocar::vessels {

/// Representative of a node's connected part; halves the way for the next question.
inline std::int32_t root(std::span<std::int32_t> parent, std::int32_t node) {
  while (parent[node] != node) node = parent[node] = parent[parent[node]];
  return node;
}

}  // namespace trocar::vessels
