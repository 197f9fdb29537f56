// Meshes with a known fault each, for the tests of examine() and of the repairs.
#pragma once

#include <cmath>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

#include "shapes.hpp"

namespace trocar::geometry {

inline TriMesh moved(TriMesh mesh, Vec3d by) {
  for (Vec3d& p : mesh.positions) p += by;
  return mesh;
}
inline TriMesh turned_inside_out(TriMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}
inline TriMesh together(TriMesh a, const TriMesh& b) {
  append(a, b);
  return a;
}
/// Every triangle with corners of its own, as STL has them.
inline TriMesh soup_of(const TriMesh& mesh) {
  TriMesh out;
  for (const auto& t : mesh.triangles) {
    const int n = int(out.positions.size());
    for (const int v : t) out.positions.push_back(mesh.positions[v]);
    out.triangles.push_back({n, n + 1, n + 2});
  }
  return out;
}
/// Without the triangles whose middle is where `gone` says.
template <class Gone>
TriMesh without(TriMesh mesh, Gone&& gone) {
  std::erase_if(mesh.triangles, [&](const std::array<int, 3>& t) {
    return gone((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0);
  });
  return mesh;
}
/// A tube along z with two open ends; `rounds` of quads of `around` sides.
inline TriMesh open_tube(double radius, double length, int around, int rounds) {
  TriMesh mesh;
  for (int j = 0; j <= rounds; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * 3.14159265358979 * i / around;
      mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), length * j / rounds});
    }
  for (int j = 0; j < rounds; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
  return mesh;
}
/// Two boxes of which one corner edge is the same: four triangles at it.
inline TriMesh boxes_at_an_edge() {
  TriMesh mesh = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {1, 1, 0}));
  for (auto& t : mesh.triangles)
    for (int& v : t) v = v == 8 ? 3 : (v == 12 ? 7 : v);
  return mesh;
}
/// Two boxes with one corner in common.
inline TriMesh boxes_at_a_corner() {
  TriMesh mesh = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {1, 1, 1}));
  for (auto& t : mesh.triangles)
    for (int& v : t) v = v == 8 ? 7 : v;
  return mesh;
}

/// A strip of quads around a ring with a half turn: it has one side only.
inline TriMesh moebius_strip(int around) {
  TriMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * 3.14159265358979 * i / around;
    const Vec3d out{std::cos(angle), std::sin(angle), 0};
    const Vec3d across = 0.3 * (std::cos(angle / 2) * out + Vec3d{0, 0, std::sin(angle / 2)});
    mesh.positions.push_back(out - across);
    mesh.positions.push_back(out + across);
  }
  for (int i = 0; i < around; ++i) {
    const bool last = i + 1 == around;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
  return mesh;
}
/// A wall: an outer and an inner tube, each open at both ends, the inner one facing the lumen.
inline TriMesh open_wall(double radius, double inner, double length, int around, int rounds) {
  return together(open_tube(radius, length, around, rounds),
                  turned_inside_out(open_tube(inner, length, around + 3, rounds)));
}

}  // namespace trocar::geometry
