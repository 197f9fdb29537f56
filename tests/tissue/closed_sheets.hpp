// Closed walls to fill: spheres and tubes of triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

namespace trocar::tissue::test {

inline constexpr double kRadius = 0.02;

/// A sphere of triangles: an icosahedron whose triangles are split `times` times, as many times finer each.
inline geometry::TriMesh sphere(int times) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  geometry::TriMesh m{{{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}},
                      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<int, int>, int> middle;
    const auto between = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto found = middle.find(key);
      if (found != middle.end()) return found->second;
      m.positions.push_back(0.5 * (m.positions[size_t(a)] + m.positions[size_t(b)]));
      return middle[key] = int(m.positions.size()) - 1;
    };
    std::vector<std::array<int, 3>> next;
    for (const auto& t : m.triangles) {
      const int a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
      for (const auto& each : {std::array<int, 3>{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}})
        next.push_back(each);
    }
    m.triangles = next;
    for (Vec3d& p : m.positions) p = normalised(p);
  }
  for (Vec3d& p : m.positions) p = kRadius * normalised(p);
  return m;
}

/// A tube along z from -half to half with round ends.
inline geometry::TriMesh tube(double radius, double half, double edge) {
  std::vector<geometry::Section> s;
  for (int k = -4; k <= 4; ++k) s.push_back({{0, 0, half * k / 4}, {radius, 0, 0}, {0, radius, 0}, 2});
  return geometry::tessellate(geometry::loft(s), edge);
}

inline MembraneDescription wall(const geometry::TriMesh& mesh) {
  MembraneDescription d;
  d.positions = mesh.positions;
  d.triangles = mesh.triangles;
  d.thickness = 0.0002;  // thin: what bends it is little beside what stretches it
  d.youngs_modulus = 250e3;
  d.density = 5000;
  d.damping_time = 5e-5;
  d.bending_damping_time = 1e-3;
  return d;
}

inline MembraneDescription filled(const geometry::TriMesh& mesh, double pressure, double bulk) {
  MembraneDescription d = wall(mesh);
  d.enclosure.kind = Enclosure::liquid;
  d.enclosure.pressure = pressure;
  d.enclosure.bulk = bulk;
  return d;
}

}  // namespace trocar::tissue::test
