#include <algorithm>
#include <numeric>

#include <trocar/volumes/segment/islands.hpp>

namespace trocar::volumes {
namespace {

/// Calls f(number) for the neighbours by faces within a box.
template <class F>
void each_neighbour(std::size_t voxel, const Index3& size, bool (&axes)[3], F&& f) {
  const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
  const std::size_t place[] = {voxel % nx, voxel / nx % ny, voxel / nx / ny};
  const std::size_t stride[] = {1, nx, nx * ny};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!axes[axis]) continue;
    if (place[axis] > 0) f(voxel - stride[axis]);
    if (place[axis] + 1 < std::size_t(size[axis])) f(voxel + stride[axis]);
  }
}

LabelChange kept(const Volume& volume, const Labels& labels, std::uint16_t label, VoxelSet set, const Islands& islands,
                 const EditRules& rules, std::size_t least, std::int32_t only) {
  for (std::size_t n = 0; n < set.in.size(); ++n) {
    const std::int32_t island = islands.of[n];
    if (island < 0) continue;
    if (only >= 0 ? island != only : islands.voxels[std::size_t(island)] < least) set.in[n] = 0;
  }
  return replaced(volume, labels, label, set, rules);
}

}  // namespace

Islands islands_of(const VoxelSet& set) {
  Islands out;
  out.of.assign(set.in.size(), -1);
  bool axes[] = {true, true, true};
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < set.in.size(); ++first) {
    if (set.in[first] == 0 || out.of[first] >= 0) continue;
    const std::int32_t island = std::int32_t(out.voxels.size());
    out.voxels.push_back(0);
    out.of[first] = island;
    open.push_back(first);
    while (!open.empty()) {
      const std::size_t voxel = open.back();
      open.pop_back();
      ++out.voxels.back();
      each_neighbour(voxel, set.size(), axes, [&](std::size_t next) {
        if (set.in[next] == 0 || out.of[next] >= 0) return;
        out.of[next] = island;
        open.push_back(next);
      });
    }
  }
  std::vector<std::int32_t> order(out.voxels.size()), rank(out.voxels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return out.voxels[std::size_t(a)] > out.voxels[std::size_t(b)];
  });
  for (std::size_t r = 0; r < order.size(); ++r) rank[std::size_t(order[r])] = std::int32_t(r);
  for (std::int32_t& island : out.of)
    if (island >= 0) island = rank[std::size_t(island)];
  std::sort(out.voxels.begin(), out.voxels.end(), std::greater<>());
  return out;
}

LabelChange largest_kept(const Volume& volume, const Labels& labels, std::uint16_t label, const EditRules& rules) {
  const VoxelSet set = voxels_of(labels, label);
  const Islands islands = islands_of(set);
  return kept(volume, labels, label, set, islands, rules, 0, 0);
}
LabelChange small_removed(const Volume& volume, const Labels& labels, std::uint16_t label, std::size_t least_voxels,
                          const EditRules& rules) {
  const VoxelSet set = voxels_of(labels, label);
  return kept(volume, labels, label, set, islands_of(set), rules, least_voxels, -1);
}
LabelChange chosen_kept(const Volume& volume, const Labels& labels, std::uint16_t label, const Index3& voxel,
                        const EditRules& rules) {
  const VoxelSet set = voxels_of(labels, label);
  if (!set.has(voxel)) return {};
  const Islands islands = islands_of(set);
  return kept(volume, labels, label, set, islands, rules, 0, islands.of[set.number(voxel)]);
}

LabelChange split(const Volume& volume, const Labels& labels, std::uint16_t label, std::uint16_t first_new,
                  std::size_t least_voxels) {
  require_same_size(volume, labels);
  const VoxelSet set = voxels_of(labels, label);
  const Islands islands = islands_of(set);
  ChangeWriter out(labels);
  set.each(labels.grid, [&](std::size_t n, std::size_t at) {
    const std::int32_t island = islands.of[n];
    if (island < 1 || islands.voxels[std::size_t(island)] < least_voxels) return;
    const int becomes = first_new + island - 1;
    if (becomes <= 65535) out.set(at, std::uint16_t(becomes));
  });
  return out.taken();
}

LabelChange holes_filled(const Volume& volume, const Labels& labels, std::uint16_t label, int axis,
                         const EditRules& rules) {
  VoxelSet set = voxels_of(labels, label);
  if (set.box.empty()) return {};
  bool axes[] = {axis != 0, axis != 1, axis != 2};
  const Index3 size = set.size();
  // What is reached from the box's faces is outside; the rest is enclosed.
  std::vector<std::uint8_t> outside(set.in.size());
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < set.in.size(); ++n) {
    const Index3 v{int(n % std::size_t(size[0])), int(n / std::size_t(size[0]) % std::size_t(size[1])),
                   int(n / std::size_t(size[0]) / std::size_t(size[1]))};
    bool border = false;
    for (std::size_t k = 0; k < 3; ++k) border = border || (axes[k] && (v[k] == 0 || v[k] == size[k] - 1));
    if (!border || set.in[n] != 0) continue;
    outside[n] = 1;
    open.push_back(n);
  }
  while (!open.empty()) {
    const std::size_t voxel = open.back();
    open.pop_back();
    each_neighbour(voxel, size, axes, [&](std::size_t next) {
      if (set.in[next] != 0 || outside[next] != 0) return;
      outside[next] = 1;
      open.push_back(next);
    });
  }
  for (std::size_t n = 0; n < set.in.size(); ++n) set.in[n] = outside[n] == 0 ? 1 : 0;
  return labelled(volume, labels, set, label, rules);
}

}  // namespace trocar::volumes
