// A mesh as the renderer sees it: arrays. Topology and rest coordinates stay, positions, normals and paint may change
// every frame. Patterns (mottling, lobules, vessels, film) are sampled in REST coordinates, so nothing swims when
// tissue deforms; two meshes of one organ that share a rest frame continue each other's pattern.
//
//   MeshData pear{.positions = x, .normals = n, .rest = x0, .paint = paint, .indices = triangles};
//   const MeshHandle mesh = backend.create_mesh(pear);
//   backend.update_mesh(mesh, x, n, paint);          // each frame that it moved
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::render {

/// What varies over a surface, 0..255 each.
///   Shading::tissue, metal, fluid: the meanings below. Shading::vertex_colour and lines: r g b a (sRGB, alpha).
struct Paint {
  std::uint8_t openness = 255;  ///< baked ambient occlusion: 255 open, 0 deep crevice (turns red-brown, not black)
  std::uint8_t blood = 0;       ///< blood film: 0 none, 255 opaque pool; darkens, reddens, makes glossy
  std::uint8_t burn = 0;        ///< heat: 0 none, ~100 blanched, ~180 tan crust, 255 char; dries the surface
  std::uint8_t tint = 0;        ///< mix towards Material::tint (a fimbria's pink, a pale edge, a stain); fluid: depth

  friend bool operator==(Paint a, Paint b) {
    return a.openness == b.openness && a.blood == b.blood && a.burn == b.burn && a.tint == b.tint;
  }
};
static_assert(sizeof(Paint) == 4);

enum class Primitive : std::uint8_t { triangles, lines };

/// Spans are read during the call only. n = number of vertices.
struct MeshData {
  std::span<const Vec3f> positions;        ///< (n) [m]
  std::span<const Vec3f> normals;          ///< (n) unit; empty = computed from the triangles (not for lines)
  std::span<const Vec3f> rest;             ///< (n) [m] undeformed coordinates; empty = positions
  std::span<const Paint> paint;            ///< (n); empty = Paint{} everywhere
  std::span<const std::uint32_t> indices;  ///< (3 per triangle, counter-clockwise outside) or (2 per line), < n
  Primitive primitive = Primitive::triangles;
  std::span<const std::vector<std::uint32_t>> coarser = {};  ///< fewer triangles over the same vertices, a list a level
};

/// Names a mesh of one backend. 0 is no mesh. A destroyed mesh's handle is never used again.
struct MeshHandle {
  std::uint32_t id = 0;
  friend bool operator==(MeshHandle a, MeshHandle b) { return a.id == b.id; }
};

}  // namespace trocar::render
