#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <trocar/geometry/surfaces/block_boxes.hpp>

namespace trocar::geometry {
namespace {

// Orders `numbers` so that each run of `size` lies together: halves at a whole number of runs, across the longest side,
// again and again. Ties go by number: a total order.
void order_by_halving(std::span<int> numbers, std::span<const Vec3d> centroids, int size) {
  const int runs = (static_cast<int>(numbers.size()) + size - 1) / size;
  if (runs < 2) return;
  Vec3d low = centroids[numbers[0]], high = low;
  for (int n : numbers)
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], centroids[n][k]);
      high[k] = std::max(high[k], centroids[n][k]);
    }
  const Vec3d side = high - low;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : (side.y >= side.z ? 1 : 2);
  std::sort(numbers.begin(), numbers.end(), [&](int a, int b) {
    const double at_a = centroids[a][axis], at_b = centroids[b][axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  const std::size_t half = static_cast<std::size_t>(runs / 2) * size;
  order_by_halving(numbers.first(half), centroids, size);
  order_by_halving(numbers.subspan(half), centroids, size);
}

void grow(Box& box, Vec3f p) noexcept {
  box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
  box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
}

// Narrows [enter, leave] to where origin + t direction lies between the two planes.
bool clip_to_slab(float origin, float direction, float low, float high, float& enter, float& leave) noexcept {
  if (direction == 0.0f) return origin >= low && origin <= high;
  float first = (low - origin) / direction, second = (high - origin) / direction;
  if (first > second) std::swap(first, second);
  enter = std::max(enter, first);
  leave = std::min(leave, second);
  return true;
}

// Narrows [enter, leave] to where the ray is inside the box; false where that is nowhere.
bool clip_to_box(Vec3f origin, Vec3f direction, const Box& box, float& enter, float& leave) noexcept {
  return clip_to_slab(origin.x, direction.x, box.low.x, box.high.x, enter, leave) &&
         clip_to_slab(origin.y, direction.y, box.low.y, box.high.y, enter, leave) &&
         clip_to_slab(origin.z, direction.z, box.low.z, box.high.z, enter, leave) &&
         enter <= leave * 1.0000004f;  // two roundings of slack: flat boxes have enter == leave
}

// Which vertices each block uses, so that a refit looks at each but once a block.
void list_vertices(TriangleBlocks& blocks) {
  blocks.vertex_start.push_back(0);
  for (int block = 0; block < blocks.count(); ++block) {
    std::vector<int> used;
    for (int k = blocks.start[block]; k < blocks.start[block + 1]; ++k)
      used.insert(used.end(), blocks.triangles[k].begin(), blocks.triangles[k].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    blocks.vertices.insert(blocks.vertices.end(), used.begin(), used.end());
    blocks.vertex_start.push_back(static_cast<int>(blocks.vertices.size()));
  }
}

}  // namespace

TriangleBlocks cut_into_blocks(std::span<const Vec3d> rest_positions, std::span<const std::array<int, 3>> triangles,
                               int triangles_per_block) {
  std::vector<Vec3d> centroids;
  centroids.reserve(triangles.size());
  for (const auto& t : triangles)
    centroids.push_back((rest_positions[t[0]] + rest_positions[t[1]] + rest_positions[t[2]]) / 3.0);
  std::vector<int> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  order_by_halving(order, centroids, triangles_per_block);

  TriangleBlocks blocks;
  const int total = static_cast<int>(triangles.size());
  for (int t : order) blocks.triangles.push_back(triangles[t]);
  blocks.number = order;
  for (int first = 0; first < total; first += triangles_per_block) blocks.start.push_back(first);
  blocks.start.push_back(total);
  list_vertices(blocks);
  return blocks;
}

void refit(const TriangleBlocks& blocks, std::span<const Vec3f> positions, std::span<Box> boxes) noexcept {
  for (int block = 0; block < blocks.count(); ++block) {
    constexpr float big = std::numeric_limits<float>::max();
    Box box{{big, big, big}, {-big, -big, -big}};
    for (int k = blocks.vertex_start[block]; k < blocks.vertex_start[block + 1]; ++k)
      grow(box, positions[blocks.vertices[k]]);
    boxes[block] = box;
  }
}

bool ray_meets_box(Vec3f origin, Vec3f direction, float t_end, const Box& box) noexcept {
  float enter = 0.0f, leave = t_end;
  return clip_to_box(origin, direction, box, enter, leave);
}

bool reach_into_box(Vec3f a, Vec3f b, float radius, const Box& box, Box& reach) noexcept {
  const float generous = 1.0001f * radius;  // rounding must not lose what is barely within the radius
  const Vec3f margin{generous, generous, generous};
  const Box grown{box.low - margin, box.high + margin};
  float enter = 0.0f, leave = 1.0f;
  if (!clip_to_box(a, b - a, grown, enter, leave)) return false;
  const Vec3f first = a + enter * (b - a), last = a + leave * (b - a);
  reach = box_of(first, last, first);
  reach.low -= margin;
  reach.high += margin;
  return true;
}

SurfaceHit first_hit(const TriangleBlocks& blocks, std::span<const Box> boxes, std::span<const Vec3f> positions,
                     Vec3f origin, Vec3f direction, float t_end) noexcept {
  SurfaceHit best;
  best.t = t_end;
  for (int block = 0; block < blocks.count(); ++block) {
    if (!ray_meets_box(origin, direction, best.t, boxes[block])) continue;
    for (int k = blocks.start[block]; k < blocks.start[block + 1]; ++k) {
      const auto& t = blocks.triangles[k];
      const auto hit = ray_triangle(origin, direction, positions[t[0]], positions[t[1]], positions[t[2]]);
      if (!hit.hit || hit.t > best.t) continue;
      if (hit.t == best.t && best.triangle >= 0 && best.triangle < blocks.number[k]) continue;
      best = {blocks.number[k], hit.t, hit.weights};
    }
  }
  return best;
}

bool any_hit(const TriangleBlocks& blocks, std::span<const Box> boxes, std::span<const Vec3f> positions, Vec3f origin,
             Vec3f direction, float t_end) noexcept {
  for (int block = 0; block < blocks.count(); ++block) {
    if (!ray_meets_box(origin, direction, t_end, boxes[block])) continue;
    for (int k = blocks.start[block]; k < blocks.start[block + 1]; ++k) {
      const auto& t = blocks.triangles[k];
      const auto hit = ray_triangle(origin, direction, positions[t[0]], positions[t[1]], positions[t[2]]);
      if (hit.hit && hit.t <= t_end) return true;
    }
  }
  return false;
}

}  // namespace trocar::geometry
