#include <algorithm>
#include <array>

#include <trocar/render/meshes/mesh_arrays.hpp>

namespace trocar::render {

void vertex_normals(std::span<const Vec3f> x, std::span<const std::uint32_t> triangles, std::vector<Vec3f>& normals) {
  normals.assign(x.size(), Vec3f{});
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const auto a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
    const Vec3f area = cross(x[b] - x[a], x[c] - x[a]);
    normals[a] += area;
    normals[b] += area;
    normals[c] += area;
  }
  for (Vec3f& n : normals) n = normalised(n, Vec3f{0, 0, 1});
}

MeshArrays complete(const MeshData& data) {
  MeshArrays r;
  const std::size_t n = data.positions.size();
  r.primitive = data.primitive;
  r.positions.assign(data.positions.begin(), data.positions.end());
  r.indices.assign(data.indices.begin(), data.indices.end());
  r.coarser.assign(data.coarser.begin(), data.coarser.end());
  const auto rest = data.rest.empty() ? data.positions : data.rest;
  r.rest.assign(rest.begin(), rest.end());
  r.paint.assign(data.paint.begin(), data.paint.end());
  r.paint.resize(n);
  const auto triangles = data.primitive == Primitive::triangles ? data.indices : std::span<const std::uint32_t>{};
  vertex_normals(rest, triangles, r.rest_normals);
  if (data.normals.empty())
    vertex_normals(data.positions, triangles, r.normals);
  else
    r.normals.assign(data.normals.begin(), data.normals.end());
  return r;
}

Bounds bounds_of(std::span<const Vec3f> positions) {
  Bounds b{positions.front(), positions.front()};
  for (const Vec3f& p : positions)
    for (int i = 0; i < 3; ++i) {
      b.low[i] = std::min(b.low[i], p[i]);
      b.high[i] = std::max(b.high[i], p[i]);
    }
  return b;
}

std::vector<std::uint32_t> edges_of(std::span<const std::uint32_t> triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(triangles.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t + k], b = triangles[t + (k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * edges.size());
  for (const auto& e : edges) ends.insert(ends.end(), e.begin(), e.end());
  return ends;
}

}  // namespace trocar::render
