// Tetrahedral meshes for tests.
#pragma once

#include <trocar/geometry/tets/tet_mesh.hpp>

namespace trocar::geometry {

/// The corner of the unit cube: volume 1/6, dihedral angles of 90 degrees and acos(1/sqrt 3) = 54.7356.
inline TetMesh corner_tet() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}}; }

/// n x n x n cubes of this side, each of six upright tetrahedra around its diagonal [Freudenthal 1942]: all dihedral
/// angles are 45, 60 or 90 degrees, neighbours share faces.
inline TetMesh block_of_tets(int n, double side) {
  TetMesh mesh;
  for (int z = 0; z <= n; ++z)
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) mesh.points.push_back({x * side, y * side, z * side});
  const int step[3] = {1, n + 1, (n + 1) * (n + 1)};
  constexpr int kWays[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (int way = 0; way < 6; ++way) {
          const int a = x * step[0] + y * step[1] + z * step[2];
          const int b = a + step[kWays[way][0]], c = b + step[kWays[way][1]], d = c + step[kWays[way][2]];
          // The first three ways are even permutations of the axes, the others odd.
          if (way < 3)
            mesh.cells.push_back({a, b, c, d});
          else
            mesh.cells.push_back({a, b, d, c});
        }
  return mesh;
}

}  // namespace trocar::geometry
