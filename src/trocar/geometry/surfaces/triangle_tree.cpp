#include <algorithm>
#include <numeric>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/surfaces/triangle_tree.hpp>

namespace trocar::geometry {
namespace {

constexpr int kTreeLeaf = 4;  ///< triangles

double distance2_to_box(Vec3d p, const Bounds& box) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
    sum += d * d;
  }
  return sum;
}

}  // namespace

TriangleTree::TriangleTree(const TriMesh& mesh) : m_mesh(mesh), m_order(mesh.triangles.size()) {
  std::iota(m_order.begin(), m_order.end(), 0);
  for (const auto& [a, b, c] : mesh.triangles)
    m_middle.push_back(mesh.positions[a] + mesh.positions[b] + mesh.positions[c]);
  m_nodes.reserve(m_order.size());
  grow(0, int(m_order.size()));
}

NearestTriangle TriangleTree::nearest(Vec3d p) const {
  NearestTriangle best;
  const auto look = [&](int t) {
    const auto& [a, b, c] = m_mesh.triangles[t];
    const auto found = closest_on_triangle(p, m_mesh.positions[a], m_mesh.positions[b], m_mesh.positions[c]);
    if (best.triangle < 0 || found.distance2 < best.distance2) best = {t, found.point, found.distance2};
  };
  look(m_order[0]);
  std::array<int, 64> waiting{};  // the tree is balanced: 32 levels are more than an int counts
  int count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const Node& node = m_nodes[waiting[--count]];
    if (!(distance2_to_box(p, node.box) < best.distance2)) continue;
    if (node.right < 0) {
      for (int k = node.first; k < node.last; ++k) look(m_order[k]);
      continue;
    }
    const int left = int(&node - m_nodes.data()) + 1;  // a node's first half follows it
    const bool left_first = distance2_to_box(p, m_nodes[left].box) < distance2_to_box(p, m_nodes[node.right].box);
    waiting[count++] = left_first ? node.right : left;
    waiting[count++] = left_first ? left : node.right;
  }
  return best;
}

Bounds TriangleTree::box_of(int triangle) const {
  const auto& [a, b, c] = m_mesh.triangles[triangle];
  const Vec3d p = m_mesh.positions[a], q = m_mesh.positions[b], r = m_mesh.positions[c];
  return {{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y}), std::min({p.z, q.z, r.z})},
          {std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y}), std::max({p.z, q.z, r.z})}};
}

Bounds TriangleTree::box_around(int first, int last) const {
  Bounds all = box_of(m_order[first]);
  for (int k = first + 1; k < last; ++k) {
    const Bounds one = box_of(m_order[k]);
    for (int axis = 0; axis < 3; ++axis) {
      all.low[axis] = std::min(all.low[axis], one.low[axis]);
      all.high[axis] = std::max(all.high[axis], one.high[axis]);
    }
  }
  return all;
}

int TriangleTree::grow(int first, int last) {
  const int number = int(m_nodes.size());
  m_nodes.push_back({box_around(first, last), first, last, -1});
  if (last - first <= kTreeLeaf) return number;
  const Vec3d side = m_nodes[number].box.high - m_nodes[number].box.low;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : (side.y >= side.z ? 1 : 2);
  const int half = (first + last) / 2;
  std::sort(m_order.begin() + first, m_order.begin() + last, [&](int a, int b) {
    return m_middle[a][axis] != m_middle[b][axis] ? m_middle[a][axis] < m_middle[b][axis] : a < b;
  });
  grow(first, half);
  const int right = grow(half, last);
  m_nodes[number].right = right;
  return number;
}

}  // namespace trocar::geometry
