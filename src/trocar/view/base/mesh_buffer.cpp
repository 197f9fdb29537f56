#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

void append(MeshBuffer& to, const MeshBuffer& part, const Mat3f& rotation, Vec3f translation) {
  const std::uint32_t first = to.size();
  for (std::size_t i = 0; i < part.positions.size(); ++i)
    to.add(rotation * part.positions[i] + translation, part.paint[i]);
  const bool mirrored = dot(cross(rotation.column(0), rotation.column(1)), rotation.column(2)) < 0;
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const std::uint32_t a = part.indices[i], b = part.indices[i + 1], c = part.indices[i + 2];
    to.triangle(first + a, first + (mirrored ? c : b), first + (mirrored ? b : c));
  }
}

void join_rows(MeshBuffer& b, std::uint32_t low, std::uint32_t high, std::uint32_t count, bool closed) {
  for (std::uint32_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    b.quad(low + i, low + j, high + j, high + i);
  }
}

void join_pole(MeshBuffer& b, std::uint32_t row, std::uint32_t count, std::uint32_t pole, bool beyond) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    if (beyond)
      b.triangle(row + i, row + j, pole);
    else
      b.triangle(row + j, row + i, pole);
  }
}

double varied(int i, int k) {
  std::uint32_t h = std::uint32_t(i) * 0x9E3779B1u ^ (std::uint32_t(k) + 0x7F4A7C15u) * 0x85EBCA6Bu;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  h ^= h >> 15;
  return double(h & 0xFFFFFFu) / double(0xFFFFFF);
}

}  // namespace trocar::view
