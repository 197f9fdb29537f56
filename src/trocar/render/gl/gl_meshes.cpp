#include <algorithm>
#include <cstddef>
#include <utility>

#include <trocar/render/gl/gl_meshes.hpp>

namespace trocar::render {

namespace {

enum Attribute : GLuint { kPosition, kNormal, kPaint, kRest, kRestNormal, kBefore };

void attribute(GLuint index, GLint components, GLenum type, bool normalised, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, components, type, normalised ? GL_TRUE : GL_FALSE, GLsizei(stride),
                        reinterpret_cast<const void*>(offset));
}

template <class T>
void fill(GLenum target, const GlBuffer& buffer, std::span<const T> data, GLenum usage) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, GLsizeiptr(data.size_bytes()), data.data(), usage);
}

}  // namespace

void GlMeshes::store(std::uint32_t id, const MeshArrays& data) {
  Mesh mesh;
  mesh.vertices = data.positions.size();
  std::vector<std::uint32_t> indices = data.indices;
  mesh.lists.push_back({0, GLsizei(indices.size())});
  for (const std::vector<std::uint32_t>& list : data.coarser) {
    mesh.lists.push_back({indices.size(), GLsizei(list.size())});
    indices.insert(indices.end(), list.begin(), list.end());
  }
  mesh.mode = data.primitive == Primitive::triangles ? GL_TRIANGLES : GL_LINES;
  mesh.layout = new_vertex_array();
  mesh.moving = new_buffer();
  mesh.paint = new_buffer();
  mesh.fixed = new_buffer();
  mesh.indices = new_buffer();

  // Positions then normals, rest then rest normals: blocks, so that each uploads straight from the caller's array.
  const std::size_t block = mesh.vertices * sizeof(Vec3f);
  glBindVertexArray(mesh.layout.id());
  glBindBuffer(GL_ARRAY_BUFFER, mesh.moving.id());
  attribute(kPosition, 3, GL_FLOAT, false, sizeof(Vec3f), 0);
  attribute(kNormal, 3, GL_FLOAT, false, sizeof(Vec3f), block);
  glBindBuffer(GL_ARRAY_BUFFER, mesh.paint.id());
  attribute(kPaint, 4, GL_UNSIGNED_BYTE, true, sizeof(Paint), 0);
  glBindBuffer(GL_ARRAY_BUFFER, mesh.fixed.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(2 * block), nullptr, GL_STATIC_DRAW);
  glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(block), data.rest.data());
  glBufferSubData(GL_ARRAY_BUFFER, GLintptr(block), GLsizeiptr(block), data.rest_normals.data());
  attribute(kRest, 3, GL_FLOAT, false, sizeof(Vec3f), 0);
  attribute(kRestNormal, 3, GL_FLOAT, false, sizeof(Vec3f), block);
  fill(GL_ELEMENT_ARRAY_BUFFER, mesh.indices, std::span<const std::uint32_t>(indices), GL_STATIC_DRAW);
  glBindVertexArray(0);

  m_meshes[id] = std::move(mesh);
  update(id, data.positions, data.normals, data.paint);
}

void GlMeshes::update(std::uint32_t id, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                      std::span<const Paint> paint) {
  const Mesh& mesh = m_meshes.at(id);
  const std::size_t block = mesh.vertices * sizeof(Vec3f);
  glBindBuffer(GL_ARRAY_BUFFER, mesh.moving.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(2 * block), nullptr, GL_STREAM_DRAW);  // orphan: no wait for the GPU
  glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(block), positions.data());
  glBufferSubData(GL_ARRAY_BUFFER, GLintptr(block), GLsizeiptr(block), normals.data());
  if (!paint.empty()) fill(GL_ARRAY_BUFFER, mesh.paint, paint, GL_DYNAMIC_DRAW);
}

void GlMeshes::remember(std::uint32_t id) {
  Mesh& mesh = m_meshes.at(id);
  const auto block = GLsizeiptr(mesh.vertices * sizeof(Vec3f));
  if (!mesh.before) {
    mesh.before = new_buffer();
    glBindVertexArray(mesh.layout.id());
    glBindBuffer(GL_ARRAY_BUFFER, mesh.before.id());
    glBufferData(GL_ARRAY_BUFFER, block, nullptr, GL_DYNAMIC_DRAW);
    attribute(kBefore, 3, GL_FLOAT, false, sizeof(Vec3f), 0);
    glBindVertexArray(0);
  }
  glBindBuffer(GL_COPY_READ_BUFFER, mesh.moving.id());
  glBindBuffer(GL_COPY_WRITE_BUFFER, mesh.before.id());
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, block);
}

void GlMeshes::draw_edges(std::uint32_t id, std::span<const std::uint32_t> indices) {
  Mesh& mesh = m_meshes.at(id);
  glBindVertexArray(mesh.layout.id());
  if (!mesh.edges) {
    const std::vector<std::uint32_t> edges = edges_of(indices);
    mesh.edges = new_buffer();
    mesh.edge_count = GLsizei(edges.size());
    fill(GL_ELEMENT_ARRAY_BUFFER, mesh.edges, std::span(edges), GL_STATIC_DRAW);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.edges.id());
  glDrawElements(GL_LINES, mesh.edge_count, GL_UNSIGNED_INT, nullptr);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.id());  // which the layout remembers
}

void GlMeshes::draw(std::uint32_t id, std::size_t level) const {
  const Mesh& mesh = m_meshes.at(id);
  const Mesh::List list = mesh.lists[std::min(level, mesh.lists.size() - 1)];
  glBindVertexArray(mesh.layout.id());
  glDrawElements(mesh.mode, list.count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(list.first * sizeof(std::uint32_t)));
}

}  // namespace trocar::render
