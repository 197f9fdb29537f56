// Numbers in text have the fewest digits that read back as the same bits.
#include <cstdint>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

#include <trocar/geometry/surface_files/surface_writer.hpp>

namespace trocar::geometry {
namespace {

void add_vertex(std::string& out, const char* before, Vec3d p, double scale) {
  fmt::format_to(std::back_inserter(out), "{}{} {} {}\n", before, p.x / scale, p.y / scale, p.z / scale);
}

/// Names end with their line.
std::string on_one_line(const std::string& name) {
  std::string out = name;
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\') c = ' ';
  return out;
}

void add_object(std::string& out, const TriMesh& mesh, double scale, std::size_t before) {
  for (const Vec3d& p : mesh.positions) add_vertex(out, "v ", p, scale);
  for (const auto& [a, b, c] : mesh.triangles)
    fmt::format_to(std::back_inserter(out), "f {} {} {}\n", before + std::size_t(a) + 1, before + std::size_t(b) + 1,
                   before + std::size_t(c) + 1);
}

/// The bytes of a number, little-endian.
template <class T>
void add_bytes(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}
template <class T>
void add_point(std::string& out, Vec3d p) {
  for (int k = 0; k < 3; ++k) add_bytes(out, T(p[k]));
}

}  // namespace

std::string to_obj(std::span<const SurfacePart> parts, double scale) {
  std::string out;
  std::size_t before = 0;
  for (const SurfacePart& part : parts) {
    out += "o " + on_one_line(part.name) + '\n';
    add_object(out, part.mesh, scale, before);
    before += part.mesh.positions.size();
  }
  return out;
}

std::string to_obj(const TriMesh& mesh, double scale) {
  std::string out;
  add_object(out, mesh, scale, 0);
  return out;
}

std::string to_stl(const TriMesh& mesh, double scale) {
  std::string out = "surface of triangles";  // not "solid": some programs believe that more than the size
  out.resize(80, ' ');
  out.reserve(84 + 50 * mesh.triangles.size());
  add_bytes(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    add_point<float>(out, normalised(area_vector(mesh, t), Vec3d{}));
    for (const int v : mesh.triangles[t]) add_point<float>(out, mesh.positions[v] / scale);
    add_bytes(out, std::uint16_t(0));
  }
  return out;
}

std::string to_ply(const TriMesh& mesh, double scale) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles.size());
  out.reserve(out.size() + 24 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (const Vec3d& p : mesh.positions) add_point<double>(out, p / scale);
  for (const auto& t : mesh.triangles) {
    add_bytes(out, std::uint8_t(3));
    for (const int v : t) add_bytes(out, std::int32_t(v));
  }
  return out;
}

std::string to_polydata(const TriMesh& mesh, double scale) {
  std::string out = fmt::format("# vtk DataFile Version 4.2\nsurface\nASCII\nDATASET POLYDATA\nPOINTS {} double\n",
                                mesh.positions.size());
  for (const Vec3d& p : mesh.positions) add_vertex(out, "", p, scale);
  fmt::format_to(std::back_inserter(out), "POLYGONS {} {}\n", mesh.triangles.size(), 4 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) fmt::format_to(std::back_inserter(out), "3 {} {} {}\n", a, b, c);
  return out;
}

}  // namespace trocar::geometry
