// Simple closed meshes for the tests.
#pragma once

#include <algorithm>
#include <map>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// The box from the origin to `size`, 12 triangles facing outwards.
inline TriMesh box_mesh(Vec3d size) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? size.x : 0, i & 2 ? size.y : 0, i & 4 ? size.z : 0});
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// An octahedron whose triangles are split in four `levels` times, pushed out to the radius.
inline TriMesh sphere_mesh(double radius, int levels) {
  TriMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, int(mesh.positions.size()));
      if (fresh) mesh.positions.push_back(normalised(mesh.positions[a] + mesh.positions[b]));
      return at->second;
    };
    std::vector<std::array<int, 3>> split;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      split.insert(split.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = split;
  }
  for (Vec3d& p : mesh.positions) p = radius * p;
  return mesh;
}

}  // namespace trocar::geometry
