// Meshes on the GPU: one buffer for what moves (position, normal), one for paint, one for what never changes.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <trocar/render/gl/gl_objects.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>

namespace trocar::render {

class GlMeshes {
 public:
  void store(std::uint32_t id, const MeshArrays& mesh);
  void update(std::uint32_t id, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
              std::span<const Paint> paint);
  void destroy(std::uint32_t id) { m_meshes.erase(id); }
  /// @param level  0: all triangles; k: the k-th coarser list, or the last that there is
  void draw(std::uint32_t id, std::size_t level = 0) const;
  /// The edges of its triangles. @param indices  of the triangles; looked at the first time
  void draw_edges(std::uint32_t id, std::span<const std::uint32_t> indices);
  /// Keeps where its vertices are, as attribute 5 of draw() until the next time.
  void remember(std::uint32_t id);
  bool remembers(std::uint32_t id) const { return bool(m_meshes.at(id).before); }
  bool is_lines(std::uint32_t id) const { return m_meshes.at(id).mode == GL_LINES; }

 private:
  struct Mesh {
    GlVertexArray layout;
    GlBuffer moving, paint, fixed, indices, edges, before;
    struct List {
      std::size_t first = 0;  ///< of the indices
      GLsizei count = 0;
    };
    std::size_t vertices = 0;
    std::vector<List> lists;  ///< all triangles (or lines), then coarser ones
    GLsizei edge_count = 0;
    GLenum mode = GL_TRIANGLES;
  };
  std::unordered_map<std::uint32_t, Mesh> m_meshes;
};

}  // namespace trocar::render
