// A mesh under construction, and a mesh that lives in a backend as long as its owner.
//   MeshBuffer b;
//   const auto ring = add_ring(b, ...);
//   OwnedMesh mesh(backend, b.data());
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <trocar/render/backend/backend.hpp>

namespace trocar::view {

using render::Paint;

/// Arrays as render::MeshData wants them. `normals` and `rest` may stay empty (computed, equal to the positions).
struct MeshBuffer {
  std::vector<Vec3f> positions, normals, rest;
  std::vector<Paint> paint;
  std::vector<std::uint32_t> indices;
  std::vector<std::vector<std::uint32_t>> coarser;  ///< see render::MeshData

  std::uint32_t size() const { return std::uint32_t(positions.size()); }
  std::uint32_t add(Vec3f p, Paint colour = {}) {
    positions.push_back(p);
    paint.push_back(colour);
    return size() - 1;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  render::MeshData data() const {
    return {.positions = positions,
            .normals = normals,
            .rest = rest,
            .paint = paint,
            .indices = indices,
            .coarser = coarser};
  }
};

/// Adds a part, moved by a rotation (columns = images of the axes) and a translation. A reflection turns its faces.
void append(MeshBuffer& to, const MeshBuffer& part, const Mat3f& rotation, Vec3f translation);

/// Joins two rows of vertices into a band of quads. Counter-clockwise outside when `low` to `high` is the tube's
/// direction and the rows run counter-clockwise seen from its end. @param closed joins the last with the first
void join_rows(MeshBuffer& b, std::uint32_t low, std::uint32_t high, std::uint32_t count, bool closed);
/// Joins a closed row with one vertex: `beyond` = the vertex lies at the high end.
void join_pole(MeshBuffer& b, std::uint32_t row, std::uint32_t count, std::uint32_t pole, bool beyond);

/// A backend mesh that is destroyed with its owner.
class OwnedMesh {
 public:
  OwnedMesh() = default;
  OwnedMesh(render::Backend& backend, const render::MeshData& data)
      : m_backend(&backend), m_handle(backend.create_mesh(data)) {}
  OwnedMesh(OwnedMesh&& other) noexcept
      : m_backend(std::exchange(other.m_backend, nullptr)), m_handle(other.m_handle) {}
  OwnedMesh& operator=(OwnedMesh&& other) noexcept {
    std::swap(m_backend, other.m_backend);
    std::swap(m_handle, other.m_handle);
    return *this;
  }
  ~OwnedMesh() {
    if (m_backend) m_backend->destroy_mesh(m_handle);
  }

  render::MeshHandle handle() const { return m_handle; }
  void update(const MeshBuffer& b) { m_backend->update_mesh(m_handle, b.positions, b.normals, b.paint); }
  void move(std::span<const Vec3f> positions, std::span<const Vec3f> normals) {
    m_backend->update_mesh(m_handle, positions, normals, {});
  }
  void repaint(std::span<const Vec3f> positions, std::span<const Vec3f> normals, std::span<const Paint> paint) {
    m_backend->update_mesh(m_handle, positions, normals, paint);
  }
  void replace(const render::MeshData& data) { m_backend->replace_mesh(m_handle, data); }

 private:
  render::Backend* m_backend = nullptr;
  render::MeshHandle m_handle;
};

/// 0..1, smooth, for x from `a` to `b` (a > b falls).
inline double smooth(double a, double b, double x) {
  double t = (x - a) / (b - a);
  t = t < 0 ? 0 : (t > 1 ? 1 : t);
  return t * t * (3 - 2 * t);
}
inline std::uint8_t to_byte(double x) { return std::uint8_t(x <= 0 ? 0 : (x >= 1 ? 255 : int(255 * x + 0.5))); }
/// A fixed number in 0..1 for a pair of integers: variety without a random generator.
double varied(int i, int k);

}  // namespace trocar::view
