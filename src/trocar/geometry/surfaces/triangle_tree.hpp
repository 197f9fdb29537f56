// Halves of halves of a mesh's triangles, each with its box: the triangle nearest to a place, and those whose boxes
// meet a box. For what is done once to a mesh that does not move; what deforms has block_boxes.hpp.
//
//   const TriangleTree tree(mesh);                  // the mesh must stay as long as the tree
//   const NearestTriangle near = tree.nearest(p);
//   tree.visit(box, [&](int triangle) { ... });
//
// The same bits from every compiler.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct NearestTriangle {
  int triangle = -1;  ///< of equally near ones the first that was looked at, always the same
  Vec3d point{};      ///< on it
  double distance2 = 0;
};

class TriangleTree {
 public:
  /// @param mesh  with at least one triangle
  explicit TriangleTree(const TriMesh& mesh);

  double distance2(Vec3d p) const { return nearest(p).distance2; }
  NearestTriangle nearest(Vec3d p) const;

  /// Calls each(triangle) for all triangles whose boxes meet the box, borders included, in a fixed order.
  template <class Each>
  void visit(const Bounds& box, Each&& each) const {
    std::array<int, 64> waiting{};
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const int number = waiting[--count];
      const Node& node = m_nodes[number];
      if (!boxes_meet(node.box, box)) continue;
      if (node.right < 0) {
        for (int k = node.first; k < node.last; ++k)
          if (boxes_meet(box_of(m_order[k]), box)) each(m_order[k]);
        continue;
      }
      waiting[count++] = node.right;
      waiting[count++] = number + 1;  // a node's first half follows it
    }
  }

  Bounds box_of(int triangle) const;
  static bool boxes_meet(const Bounds& a, const Bounds& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
           a.low.z <= b.high.z && b.low.z <= a.high.z;
  }

 private:
  struct Node {
    Bounds box;
    int first, last;
    int right;  ///< the second half; -1 for a leaf
  };
  const TriMesh& m_mesh;
  std::vector<int> m_order;
  std::vector<Vec3d> m_middle;
  std::vector<Node> m_nodes;

  int grow(int first, int last);
  Bounds box_around(int first, int last) const;
};

}  // namespace trocar::geometry
