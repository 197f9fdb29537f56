#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/crossings.hpp>
#include <trocar/geometry/surfaces/orientation.hpp>
#include <trocar/geometry/surfaces/triangle_tree.hpp>

namespace trocar::geometry {
namespace {

/// The two axes along which a triangle that has an area is seen from its flattest side.
struct FlatAxes {
  int first, second;
};
bool flat_axes(const TriangleCorners& t, FlatAxes& axes) {
  const Vec3d n = cross(t[1] - t[0], t[2] - t[0]), size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const int thin = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  for (int k = 0; k < 3; ++k) {  // rounding may have chosen one in which it is a line
    axes = {(thin + k + 1) % 3, (thin + k + 2) % 3};
    if (side_of_line(t[0], t[1], t[2], axes.first, axes.second) != 0) return true;
  }
  return false;
}

bool point_in_flat(Vec3d p, const TriangleCorners& t, FlatAxes axes) {
  const int a = side_of_line(t[0], t[1], p, axes.first, axes.second);
  const int b = side_of_line(t[1], t[2], p, axes.first, axes.second);
  const int c = side_of_line(t[2], t[0], p, axes.first, axes.second);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Of segments in a plane: do they have a point in common?
bool flat_segments_meet(Vec3d p, Vec3d q, Vec3d a, Vec3d b, FlatAxes axes) {
  const int pa = side_of_line(p, q, a, axes.first, axes.second), pb = side_of_line(p, q, b, axes.first, axes.second);
  const int ap = side_of_line(a, b, p, axes.first, axes.second), aq = side_of_line(a, b, q, axes.first, axes.second);
  if (pa * pb > 0 || ap * aq > 0) return false;
  if (pa != 0 || pb != 0 || ap != 0 || aq != 0) return true;
  for (const int axis : {axes.first, axes.second}) {  // on one line
    const auto [low, high] = std::minmax(p[axis], q[axis]);
    if (std::max(a[axis], b[axis]) < low || std::min(a[axis], b[axis]) > high) return false;
  }
  return true;
}

/// Has the segment pq a point in common with the triangle?
bool segment_meets(Vec3d p, Vec3d q, const TriangleCorners& t) {
  const int above = side_of_plane(t[0], t[1], t[2], p), below = side_of_plane(t[0], t[1], t[2], q);
  if (above * below > 0) return false;
  if (above == 0 && below == 0) {
    FlatAxes axes{};
    if (!flat_axes(t, axes)) return false;
    if (point_in_flat(p, t, axes) || point_in_flat(q, t, axes)) return true;
    for (int k = 0; k < 3; ++k)
      if (flat_segments_meet(p, q, t[std::size_t(k)], t[std::size_t(k + 1) % 3], axes)) return true;
    return false;
  }
  const int a = side_of_plane(p, q, t[0], t[1]), b = side_of_plane(p, q, t[1], t[2]),
            c = side_of_plane(p, q, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool edges_meet(const TriangleCorners& of, const TriangleCorners& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segment_meets(of[k], of[(k + 1) % 3], t)) return true;
  return false;
}

/// Two that share an edge vw cross only where they lie in one plane, on the same side of it.
bool folded_onto(Vec3d v, Vec3d w, Vec3d p, Vec3d q) {
  if (side_of_plane(v, w, p, q) != 0) return false;
  FlatAxes axes{};
  if (!flat_axes({v, w, p}, axes)) return false;
  return side_of_line(v, w, p, axes.first, axes.second) == side_of_line(v, w, q, axes.first, axes.second);
}

bool has_area(const TriangleCorners& t) {
  FlatAxes axes{};
  return flat_axes(t, axes);
}

}  // namespace

bool triangles_cross(const TriangleCorners& p, const TriangleCorners& q) {
  std::array<std::size_t, 3> in_p{}, in_q{};
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (p[i] == q[j] && shared < 3) in_p[shared] = i, in_q[shared] = j, ++shared;
  if (shared > 2) return false;
  if (shared == 2) return folded_onto(p[in_p[0]], p[in_p[1]], p[3 - in_p[0] - in_p[1]], q[3 - in_q[0] - in_q[1]]);
  if (shared == 1)
    return segment_meets(p[(in_p[0] + 1) % 3], p[(in_p[0] + 2) % 3], q) ||
           segment_meets(q[(in_q[0] + 1) % 3], q[(in_q[0] + 2) % 3], p);
  return edges_meet(p, q) || edges_meet(q, p);
}

Crossings self_crossings(const TriMesh& mesh) {
  Crossings found;
  TriMesh sound{mesh.positions, {}};
  std::vector<int> number;
  const auto corners = [&mesh](int t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return TriangleCorners{mesh.positions[a], mesh.positions[b], mesh.positions[c]};
  };
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    const TriangleCorners p = corners(t);
    if (!finite(p[0]) || !finite(p[1]) || !finite(p[2]) || !has_area(p)) continue;
    sound.triangles.push_back(mesh.triangles[t]);
    number.push_back(t);
  }
  if (number.empty()) return found;
  const TriangleTree tree(sound);
  long long tests = 0;
  const long long most = std::max(kMostCrossingTests, kMostCrossingTestsEach * static_cast<long long>(number.size()));
  for (int i = 0; i < int(number.size()) && found.all; ++i) {
    const TriangleCorners p = corners(number[i]);
    tree.visit(tree.box_of(i), [&](int j) {
      if (j <= i || !found.all) return;
      if (triangles_cross(p, corners(number[j]))) found.pairs.push_back({number[i], number[j]});
      found.all = ++tests < most && int(found.pairs.size()) < kMostCrossings;
    });
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

}  // namespace trocar::geometry
