// One surface in every format, written by hand: a tetrahedron with corners on the axes, at 1, 2 and 3.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

#include "mesh_bytes.hpp"

namespace trocar::geometry {

inline TriMesh axes_mesh() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

inline const std::string kAxesObj =
    "# a tetrahedron\nmtllib none.mtl\no axes\nv 0 0 0\nv 1 0 0 1.0\nv 0 2 0\nv 0 0 3\nvn 0 0 1\nusemtl red\n"
    "f 1//1 3//1 2//1\nf -4 -3 -1\ng more\nf 1/1 4/2 \\\n 3/3\ng\nl 1 2\nf 2 3 4\n";

inline const std::string kAxesStl =
    "solid axes\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 2 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 0 3\n endloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0.0e0 0 3\nvertex 0 2 -0\nendloop\nendfacet\n"
    "FACET NORMAL 1 1 1\nOUTER LOOP\nVERTEX 1 0 0\nVERTEX 0 2 0\nVERTEX 0 0 3\nENDLOOP\nENDFACET\nendsolid axes\n";

inline std::string axes_stl_binary() {
  MeshBytes f;
  f.text("solid, says the head of this binary file" + std::string(40, ' ')).all<std::uint32_t>(4);
  const TriMesh mesh = axes_mesh();
  for (const auto& t : mesh.triangles) {
    f.all<float>(0, 0, 1);
    for (const int v : t) f.all<float>(mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z);
    f.all<std::uint16_t>(7);
  }
  return f.bytes;
}

inline const std::string kAxesPly =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty uchar red\n"
    "property double z\nelement material 1\nproperty list uchar float gloss\nproperty int kind\n"
    "element face 4\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n"
    "0 0 9 0\n1 0 9 0\n0 2 9 0\n0 0 9 3\n3 0.5 nan 1 4\n3 0 2 1 0\n3 0 1 3 0\n3 0 3 2 0\n3 1 2 3 0\n";

inline std::string axes_ply_binary(bool swapped) {
  MeshBytes f{swapped};
  f.text(std::string("ply\nformat ") + (swapped ? "binary_big_endian" : "binary_little_endian") +
         " 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nelement vertex 4\nproperty short flag\n"
         "property float x\nproperty double y\nproperty uchar z\nelement face 2\n"
         "property list uint8 uint16 vertex_index\nproperty list uchar double weights\nend_header\n");
  f.all<std::int32_t>(7, 0, 2, 1, -1, 0, 1, 3);
  const auto vertex = [&f](float x, double y, int z) {
    f.all<std::int16_t>(-5).all<float>(x).all<double>(y).all<std::uint8_t>(z);
  };
  vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 2, 0), vertex(0, 0, 3);
  f.all<std::uint8_t>(3).all<std::uint16_t>(0, 3, 2).all<std::uint8_t>(1).all<double>(0.5);
  f.all<std::uint8_t>(3).all<std::uint16_t>(1, 2, 3).all<std::uint8_t>(0);
  return f.bytes;
}

inline const std::string kAxesVtk =
    "# vtk DataFile Version 3.0\nany title\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 2 0 0 0 3\n"
    "LINES 1 3\n2 0 1\nPOLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\nCELL_DATA 5\nSCALARS s int\n"
    "LOOKUP_TABLE default\n1 2 3 4 5\nPOINT_DATA 4\nNORMALS n float\n0 0 nan 0 0 0 0 0 0 0 0 0\n";
inline std::string axes_vtk_binary() {
  MeshBytes f{true};
  f.text("# vtk DataFile Version 5.1\nany title\nBINARY\nDATASET POLYDATA\nPOINTS 4 double\n");
  f.all<double>(0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3).text("\nPOLYGONS 5 12\nOFFSETS vtktypeint64\n");
  f.all<std::int64_t>(0, 3, 6, 9, 12).text("\nCONNECTIVITY vtktypeint64\n");
  return f.all<std::int64_t>(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3).text("\n").bytes;
}

/// The tetrahedron as a glTF buffer: 48 bytes of positions, 24 of indices.
inline std::string axes_buffer() {
  MeshBytes f;
  for (const Vec3d& p : axes_mesh().positions) f.all<float>(p.x, p.y, p.z);
  for (const auto& t : axes_mesh().triangles) f.all<std::uint16_t>(t[0], t[1], t[2]);
  return f.bytes;
}
/// @param buffer  what stands in the only buffer besides its length
inline std::string axes_gltf(const std::string& buffer) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"name": "axes", "mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 99}, "indices": 1, "material": 3}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 3]},
               {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
 "buffers": [{"byteLength": 72)" +
         buffer + "}]}\n";
}
inline std::string glb_of(std::string json, const std::string& binary) {
  while (json.size() % 4 != 0) json += ' ';
  MeshBytes f;
  f.text("glTF").all<std::uint32_t>(2, 12 + 8 + json.size() + 8 + binary.size());
  f.all<std::uint32_t>(json.size()).text("JSON").text(json);
  return f.all<std::uint32_t>(binary.size()).text(std::string("BIN\0", 4)).text(binary).bytes;
}
inline std::string to_base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}
inline std::string axes_gltf_embedded() {
  return axes_gltf(R"(, "uri": "data:application/octet-stream;base64,)" + to_base64(axes_buffer()) + '"');
}
inline std::string axes_glb() { return glb_of(axes_gltf(""), axes_buffer()); }

inline std::vector<std::string> axes_in_all_formats() {
  return {kAxesObj, kAxesStl,          axes_stl_binary(),    kAxesPly,  axes_ply_binary(false), axes_ply_binary(true),
          kAxesVtk, axes_vtk_binary(), axes_gltf_embedded(), axes_glb()};
}

}  // namespace trocar::geometry
