// What a backend derives from a MeshData before it is stored: every optional array filled, normals where none came.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/render/frame/mesh_data.hpp>

namespace trocar::render {

/// Area-weighted vertex normals; vertices without a triangle get +z.
/// @param normals out (n), unit
void vertex_normals(std::span<const Vec3f> positions, std::span<const std::uint32_t> triangles,
                    std::vector<Vec3f>& normals);

/// A mesh with no array missing. (n) each, rest_normals from the rest shape (patterns are projected along them).
struct MeshArrays {
  std::vector<Vec3f> positions, normals, rest, rest_normals;
  std::vector<Paint> paint;
  std::vector<std::uint32_t> indices;
  std::vector<std::vector<std::uint32_t>> coarser;  ///< see MeshData
  Primitive primitive = Primitive::triangles;
};
MeshArrays complete(const MeshData& data);

struct Bounds {
  Vec3f low, high;
  Vec3f middle() const { return 0.5f * (low + high); }
};
Bounds bounds_of(std::span<const Vec3f> positions);

/// Both ends of every edge of the triangles, each edge once.
std::vector<std::uint32_t> edges_of(std::span<const std::uint32_t> triangles);

}  // namespace trocar::render
