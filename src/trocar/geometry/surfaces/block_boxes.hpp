// Which triangles of a deforming surface are near a capsule, or first on a ray: the triangles are cut once, at rest,
// into blocks of neighbours (halving across the longest side), and each block's box is refitted to the positions of the
// moment. A linear pass over a few hundred boxes costs a microsecond or two and, unlike a tree, never degrades.
//
//   const TriangleBlocks blocks = cut_into_blocks(mesh.positions, mesh.triangles);     // at compile
//   std::vector<Box> boxes(blocks.count());                                            // Work
//   refit(blocks, positions, boxes);                                                   // each tick
//   visit_near_capsule(blocks, boxes, positions, a, b, r, [&](int t, const SegmentTriangle<float>& c) noexcept {...});
//
// Queries and refit do not allocate. Triangle numbers are those of the mesh that was given.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/geometry/surfaces/nearest.hpp>

namespace trocar::geometry {

struct Box {
  Vec3f low, high;
};

/// Constant after the cut.
struct TriangleBlocks {
  std::vector<std::array<int, 3>> triangles;  ///< in block order
  std::vector<int> number;                    ///< of each in the mesh
  std::vector<int> start;                     ///< first triangle of each block, and the end: blocks + 1
  std::vector<int> vertices;                  ///< those that each block uses, ascending within the block
  std::vector<int> vertex_start;              ///< first of each block, and the end
  int count() const noexcept { return static_cast<int>(start.size()) - 1; }
};

TriangleBlocks cut_into_blocks(std::span<const Vec3d> rest_positions, std::span<const std::array<int, 3>> triangles,
                               int triangles_per_block = 64);

/// boxes: blocks.count() of them, overwritten.
void refit(const TriangleBlocks& blocks, std::span<const Vec3f> positions, std::span<Box> boxes) noexcept;

/// Whether the ray meets the box at some t in [0, t_end].
bool ray_meets_box(Vec3f origin, Vec3f direction, float t_end, const Box& box) noexcept;
/// The box of that part of the segment ab that can be within `radius` of anything in `box`, grown by the radius; false
/// where there is none.
bool reach_into_box(Vec3f a, Vec3f b, float radius, const Box& box, Box& reach) noexcept;
inline bool overlap(const Box& a, const Box& b) noexcept {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}
inline Box box_of(Vec3f p, Vec3f q, Vec3f r) noexcept {
  return {{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y}), std::min({p.z, q.z, r.z})},
          {std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y}), std::max({p.z, q.z, r.z})}};
}

/// Calls visit(triangle, closest) for every triangle closer to the segment ab than `radius`, in a fixed order;
/// `closest` is a SegmentTriangle<float>.
template <class Visit>
void visit_near_capsule(const TriangleBlocks& blocks, std::span<const Box> boxes, std::span<const Vec3f> positions,
                        Vec3f a, Vec3f b, float radius, Visit&& visit) noexcept {
  for (int block = 0; block < blocks.count(); ++block) {
    Box reach;
    if (!reach_into_box(a, b, radius, boxes[block], reach)) continue;
    for (int k = blocks.start[block]; k < blocks.start[block + 1]; ++k) {
      const auto& t = blocks.triangles[k];
      const Vec3f p = positions[t[0]], q = positions[t[1]], r = positions[t[2]];
      if (!overlap(reach, box_of(p, q, r))) continue;
      const SegmentTriangle<float> closest = closest_segment_triangle(a, b, p, q, r);
      if (closest.distance2 < radius * radius) visit(blocks.number[k], closest);
    }
  }
}

struct SurfaceHit {
  int triangle = -1;  ///< -1: nothing hit
  float t = 0.0f;     ///< in units of the direction's length
  Vec3f weights{};    ///< of the triangle's corners
};
/// The nearest hit with 0 <= t <= t_end; of equal ones that in the lowest triangle.
SurfaceHit first_hit(const TriangleBlocks& blocks, std::span<const Box> boxes, std::span<const Vec3f> positions,
                     Vec3f origin, Vec3f direction, float t_end) noexcept;
/// Whether anything is hit with 0 <= t <= t_end.
bool any_hit(const TriangleBlocks& blocks, std::span<const Box> boxes, std::span<const Vec3f> positions, Vec3f origin,
             Vec3f direction, float t_end) noexcept;

}  // namespace trocar::geometry
