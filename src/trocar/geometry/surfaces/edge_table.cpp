#include <algorithm>

#include <trocar/geometry/surfaces/edge_table.hpp>

namespace trocar::geometry {

EdgeTable::EdgeTable(const TriMesh& mesh) : m_across(mesh.triangles.size(), {kOpen, kOpen, kOpen}) {
  m_uses.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    const auto& corners = mesh.triangles[t];
    if (corner_twice(corners)) continue;
    for (int k = 0; k < 3; ++k) {
      const int from = corners[k], to = corners[(k + 1) % 3];
      m_uses.push_back({std::min(from, to), std::max(from, to), t, static_cast<signed char>(k), from < to});
    }
  }
  std::sort(m_uses.begin(), m_uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    if (a.low != b.low) return a.low < b.low;
    return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  for_each([&](std::span<const EdgeUse> uses) {
    for (const EdgeUse& use : uses) {
      int& across = m_across[use.triangle][use.side];
      if (uses.size() == 2)
        across = uses[uses[0].triangle == use.triangle ? 1 : 0].triangle;
      else if (uses.size() > 2)
        across = kCrowded;
    }
  });
}

}  // namespace trocar::geometry
