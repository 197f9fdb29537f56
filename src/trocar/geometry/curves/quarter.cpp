#include <algorithm>
#include <cstdint>
#include <map>

#include <trocar/geometry/curves/quarter.hpp>

namespace trocar::geometry {

Quartered quartered(std::span<const std::array<int, 3>> triangles, int vertices) {
  Quartered finer;
  std::map<std::uint64_t, int> middles;
  finer.triangles.reserve(4 * triangles.size());
  const auto middle = [&](int i, int j) {
    const auto [low, high] = std::minmax(i, j);
    const std::uint64_t edge = std::uint64_t(low) << 32 | std::uint32_t(high);
    const auto [found, anew] = middles.try_emplace(edge, vertices + int(finer.halved.size()));
    if (anew) finer.halved.push_back({low, high});
    return found->second;
  };
  for (const auto& [a, b, c] : triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.triangles.insert(finer.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace trocar::geometry
