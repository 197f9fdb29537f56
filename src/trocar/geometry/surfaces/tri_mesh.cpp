#include <algorithm>
#include <limits>
#include <map>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

// One side of a triangle: its edge as (lower, higher) vertex and whether the triangle runs along it upwards.
struct Side {
  int low, high;
  bool upwards;
  friend bool operator<(const Side& a, const Side& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.upwards < b.upwards;
  }
};

std::vector<Side> sorted_sides(const TriMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

Csr from_pairs(int rows, std::vector<std::array<int, 2>> pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Csr csr;
  csr.start.assign(rows + 1, 0);
  csr.items.reserve(pairs.size());
  for (const auto& pair : pairs) {
    ++csr.start[pair[0] + 1];
    csr.items.push_back(pair[1]);
  }
  for (int i = 0; i < rows; ++i) csr.start[i + 1] += csr.start[i];
  return csr;
}

}  // namespace

Vec3d area_vector(const TriMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const Vec3d p = mesh.positions[a];
  return cross(mesh.positions[b] - p, mesh.positions[c] - p);
}

std::vector<Vec3d> vertex_normals(const TriMesh& mesh) {
  std::vector<Vec3d> normals(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = mesh.positions[t[k]];
      const Vec3d to_next = mesh.positions[t[(k + 1) % 3]] - p, to_last = mesh.positions[t[(k + 2) % 3]] - p;
      const double weight = dot(to_next, to_next) * dot(to_last, to_last);
      if (weight > 0.0) normals[t[k]] += cross(to_next, to_last) / weight;
    }
  for (Vec3d& n : normals) n = normalised(n, Vec3d{});
  return normals;
}

double area(const TriMesh& mesh) {
  double sum = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) sum += 0.5 * length(area_vector(mesh, t));
  return sum;
}

double least_angle_deg(const TriMesh& mesh, int t) {
  const auto& corners = mesh.triangles[t];
  const double twice = length(area_vector(mesh, t));
  double least = portable::pi;
  for (int k = 0; k < 3; ++k) {
    const Vec3d p = mesh.positions[corners[k]];
    least = std::min(least, portable::atan2(twice, dot(mesh.positions[corners[(k + 1) % 3]] - p,
                                                       mesh.positions[corners[(k + 2) % 3]] - p)));
  }
  return least * 180 / portable::pi;
}

double volume(const TriMesh& mesh) {
  if (mesh.positions.empty()) return 0.0;
  const Vec3d origin = mesh.positions.front();  // near the mesh: less cancellation
  double sum = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    sum += dot(area_vector(mesh, t), mesh.positions[mesh.triangles[t][0]] - origin);
  return sum / 6.0;
}

Vec3d centre_of_volume(const TriMesh& mesh) {
  if (mesh.positions.empty()) return {};
  const Vec3d origin = mesh.positions.front();
  Vec3d moment{};
  double total = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d pa = mesh.positions[a] - origin, pb = mesh.positions[b] - origin, pc = mesh.positions[c] - origin;
    const double six_volumes = dot(pa, cross(pb, pc));
    moment += six_volumes * (pa + pb + pc);
    total += six_volumes;
  }
  return total == 0.0 ? origin : origin + moment / (4.0 * total);
}

Bounds bounds(std::span<const Vec3d> points) {
  constexpr double big = std::numeric_limits<double>::max();
  Bounds box{{big, big, big}, {-big, -big, -big}};
  for (const Vec3d& p : points)
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  return box;
}

EdgeReport check_edges(const TriMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  EdgeReport report;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    ++report.edges;
    if (end - i == 1) ++report.open;
    if (end - i > 2) ++report.crowded;
    if (end - i == 2 && sides[i].upwards == sides[i + 1].upwards) ++report.inconsistent;
    i = end;
  }
  return report;
}

std::vector<std::array<int, 2>> edges(const TriMesh& mesh) {
  std::vector<std::array<int, 2>> result;
  for (const Side& side : sorted_sides(mesh))
    if (result.empty() || result.back() != std::array<int, 2>{side.low, side.high})
      result.push_back({side.low, side.high});
  return result;
}

Csr vertex_neighbours(const TriMesh& mesh) {
  std::vector<std::array<int, 2>> pairs;
  pairs.reserve(6 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      pairs.push_back({t[k], t[(k + 1) % 3]});
      pairs.push_back({t[(k + 1) % 3], t[k]});
    }
  return from_pairs(static_cast<int>(mesh.positions.size()), std::move(pairs));
}

Csr vertex_triangles(const TriMesh& mesh) {
  std::vector<std::array<int, 2>> pairs;
  pairs.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int vertex : mesh.triangles[t]) pairs.push_back({vertex, t});
  return from_pairs(static_cast<int>(mesh.positions.size()), std::move(pairs));
}

void append(TriMesh& mesh, const TriMesh& other) {
  const int shift = int(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
}

TriMesh merged_vertices(const TriMesh& mesh, double distance) {
  TriMesh result;
  std::map<std::array<long long, 3>, int> known;  // ordered: the numbering follows the first use only
  std::vector<int> renamed(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    std::array<long long, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = static_cast<long long>(std::floor(mesh.positions[i][k] / distance + 0.5));
    const auto [at, fresh] = known.try_emplace(key, static_cast<int>(result.positions.size()));
    if (fresh) result.positions.push_back(mesh.positions[i]);
    renamed[i] = at->second;
  }
  for (const auto& t : mesh.triangles) {
    const std::array<int, 3> r{renamed[t[0]], renamed[t[1]], renamed[t[2]]};
    if (r[0] != r[1] && r[1] != r[2] && r[2] != r[0]) result.triangles.push_back(r);
  }
  return result;
}

}  // namespace trocar::geometry
