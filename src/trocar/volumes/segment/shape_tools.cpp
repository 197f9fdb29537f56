#include <algorithm>
#include <cmath>

#include <trocar/core/require.hpp>
#include <trocar/volumes/segment/distance.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>

namespace trocar::volumes {
namespace {

Index3 voxels_within(double millimetres, const Grid& grid) {
  Index3 out{};
  for (int k = 0; k < 3; ++k) out[std::size_t(k)] = int(std::clamp(std::ceil(millimetres / grid.spacing[k]), 0.0, 1e6));
  return out;
}

/// Mean over 2 radius + 1 values along each axis, twice: near to a bell. Beyond the box are zeros.
class Blur {
 public:
  Blur(const Index3& size, const Index3& radius) : m_size(size), m_radius(radius) {}

  void run(std::vector<float>& values) {
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (m_radius[axis] > 0) along(values, axis);
  }

 private:
  Index3 m_size, m_radius;
  std::vector<float> m_line;

  void along(std::vector<float>& values, std::size_t axis) {
    const std::size_t n[] = {std::size_t(m_size[0]), std::size_t(m_size[1]), std::size_t(m_size[2])};
    const std::size_t stride[] = {1, n[0], n[0] * n[1]};
    const std::size_t a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    for (std::size_t j = 0; j < n[b]; ++j)
      for (std::size_t i = 0; i < n[a]; ++i)
        line(values.data() + i * stride[a] + j * stride[b], stride[axis], m_size[axis], m_radius[axis]);
  }
  void line(float* values, std::size_t stride, int count, int radius) {
    m_line.resize(std::size_t(count));
    for (int i = 0; i < count; ++i) m_line[std::size_t(i)] = values[std::size_t(i) * stride];
    const float share = 1.0f / float(2 * radius + 1);
    double sum = 0;
    for (int i = 0; i < std::min(radius, count); ++i) sum += double(m_line[std::size_t(i)]);
    for (int i = 0; i < count; ++i) {
      if (i + radius < count) sum += double(m_line[std::size_t(i + radius)]);
      if (i - radius - 1 >= 0) sum -= double(m_line[std::size_t(i - radius - 1)]);
      values[std::size_t(i) * stride] = share * float(sum);
    }
  }
};

/// How much of the label is around each voxel of its box, 0 .. 1.
std::vector<float> share_around(const VoxelSet& set, const Index3& radius) {
  std::vector<float> out(set.in.begin(), set.in.end());
  Blur(set.size(), radius).run(out);
  return out;
}

/// Each pass reaches as far as the radius: two reach twice as far.
Index3 half_of(const Index3& radius) {
  Index3 out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = (radius[k] + 1) / 2;
  return out;
}
Index3 twice(const Index3& radius) { return {2 * radius[0], 2 * radius[1], 2 * radius[2]}; }

/// The share at which as many voxels as wanted are above; nearest to that where shares are equal.
float cut_for_count(std::vector<float> shares, std::size_t wanted) {
  std::sort(shares.begin(), shares.end(), std::greater<>());
  if (wanted == 0 || wanted >= shares.size()) return shares.empty() ? 1.0f : shares.back();
  const float level = shares[wanted - 1];
  const auto range = std::equal_range(shares.begin(), shares.end(), level, std::greater<>());
  const std::size_t without = std::size_t(range.first - shares.begin()),
                    with = std::size_t(range.second - shares.begin());
  if (wanted - without < with - wanted && without > 0) return shares[without - 1];
  return level;
}

void require_axis(int axis) { core::require(axis >= 0 && axis <= 2, "an axis is 0, 1 or 2"); }

/// How deep inside, or below 0 how far outside, the voxels of a slice are [mm].
std::vector<float> depth_in_slice(const VoxelSet& slice, Vec3d spacing) {
  const std::vector<float> out_of = squared_distance(slice, spacing, false);
  std::vector<float> out = squared_distance(slice, spacing, true, false);
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = slice.in[n] != 0 ? std::sqrt(out[n]) : -std::sqrt(out_of[n]);
  return out;
}

}  // namespace

LabelChange margin_moved(const Volume& volume, const Labels& labels, std::uint16_t label, double millimetres,
                         const EditRules& rules) {
  VoxelSet set = voxels_of(labels, label, voxels_within(std::max(millimetres, 0.0), labels.grid));
  if (set.box.empty()) return {};
  if (millimetres < 0) set = voxels_of(labels, label, Index3{1, 1, 1});
  const bool grow = millimetres >= 0;
  const std::vector<float> squared = squared_distance(set, labels.grid.spacing, !grow);
  const float limit = float(millimetres * millimetres);
  for (std::size_t n = 0; n < set.in.size(); ++n)
    set.in[n] = grow ? squared[n] <= limit : (set.in[n] != 0 && squared[n] > limit);
  return grow ? labelled(volume, labels, set, label, rules) : replaced(volume, labels, label, set, rules);
}

LabelChange hollowed(const Volume& volume, const Labels& labels, std::uint16_t label, double millimetres,
                     const EditRules& rules) {
  VoxelSet set = voxels_of(labels, label, Index3{1, 1, 1});
  if (set.box.empty()) return {};
  const std::vector<float> squared = squared_distance(set, labels.grid.spacing, true);
  const float limit = float(millimetres * millimetres);
  for (std::size_t n = 0; n < set.in.size(); ++n) set.in[n] = set.in[n] != 0 && squared[n] <= limit;
  return replaced(volume, labels, label, set, rules);
}

SmoothLabel smoothed(const Volume& volume, const Labels& labels, std::uint16_t label, double radius_mm, Smoothing how,
                     const EditRules& rules) {
  const Index3 radius = half_of(voxels_within(radius_mm, labels.grid));
  VoxelSet set = voxels_of(labels, label, twice(radius));
  if (set.box.empty()) return {};
  const std::size_t before = set.count();
  const std::vector<float> shares = share_around(set, radius);
  const float cut = how == Smoothing::median ? 0.5f : cut_for_count(shares, before);
  for (std::size_t n = 0; n < set.in.size(); ++n)
    set.in[n] = how == Smoothing::median ? shares[n] > cut : shares[n] >= cut && shares[n] > 0;
  SmoothLabel out{replaced(volume, labels, label, set, rules), double(before) * labels.grid.voxel_ml(), 0};
  out.ml = out.ml_before + gained_ml(out.change, label, labels.grid);
  return out;
}

LabelChange smoothed_together(const Volume& volume, const Labels& labels, std::span<const std::uint16_t> together,
                              double radius_mm, const EditRules& rules) {
  require_same_size(volume, labels);
  const Index3 radius = half_of(voxels_within(radius_mm, labels.grid));
  Box box;
  for (const std::uint16_t label : together) {
    const Box one = box_of(labels, label);
    if (one.empty()) continue;
    if (box.empty()) box = one;
    for (std::size_t k = 0; k < 3; ++k)
      box.low[k] = std::min(box.low[k], one.low[k]), box.high[k] = std::max(box.high[k], one.high[k]);
  }
  if (box.empty()) return {};
  box = widened(box, twice(radius), labels.grid);
  std::vector<float> most(box.count(), 0);
  std::vector<std::uint16_t> winner(box.count(), 0);
  // What carries none of the labels takes part, as one.
  VoxelSet rest(box);
  rest.each(labels.grid, [&](std::size_t n, std::size_t at) {
    rest.in[n] = std::find(together.begin(), together.end(), labels.at[at]) == together.end() ? 1 : 0;
  });
  const auto compete = [&](const VoxelSet& set, std::uint16_t label) {
    const std::vector<float> shares = share_around(set, radius);
    for (std::size_t n = 0; n < shares.size(); ++n)
      if (shares[n] > most[n]) most[n] = shares[n], winner[n] = label;
  };
  compete(rest, 0);
  for (const std::uint16_t label : together) compete(voxels_of(labels, label, box), label);
  ChangeWriter out(labels);
  rest.each(labels.grid, [&](std::size_t n, std::size_t at) {
    const bool other = rest.in[n] != 0 && labels.at[at] != 0;  // a label that does not take part
    if (other && (!rules.overwrite || winner[n] == 0)) return;
    if (rules.inside && labels.at[at] != *rules.inside) return;
    if (rules.values) {
      const double value = volume.value_of(volume.stored[at]);
      if (value < (*rules.values)[0] || value > (*rules.values)[1]) return;
    }
    out.set(at, winner[n]);
  });
  return out.taken();
}

LabelChange filled_between_slices(const Volume& volume, const Labels& labels, std::uint16_t label, int axis,
                                  const EditRules& rules) {
  require_axis(axis);
  VoxelSet set = voxels_of(labels, label, Index3{1, 1, 1});
  if (set.box.empty()) return {};
  const std::size_t a = std::size_t(axis);
  const auto slice = [&](int at) {
    Box box = set.box;
    box.low[a] = at, box.high[a] = at + 1;
    return voxels_of(labels, label, box);
  };
  Vec3d flat = labels.grid.spacing;
  int last = -1;
  std::vector<float> depth_last;
  for (int at = set.box.low[a]; at < set.box.high[a]; ++at) {
    const VoxelSet here = slice(at);
    if (here.count() == 0) continue;
    std::vector<float> depth = depth_in_slice(here, flat);
    for (int between = last + 1; last >= 0 && between < at; ++between) {
      const float share = float(between - last) / float(at - last);
      VoxelSet filled = slice(between);
      std::size_t n = 0;
      for (int k = filled.box.low[2]; k < filled.box.high[2]; ++k)
        for (int j = filled.box.low[1]; j < filled.box.high[1]; ++j)
          for (int i = filled.box.low[0]; i < filled.box.high[0]; ++i, ++n)
            if ((1 - share) * depth_last[n] + share * depth[n] > 0) set.in[set.number({i, j, k})] = 1;
    }
    last = at;
    depth_last = std::move(depth);
  }
  return labelled(volume, labels, set, label, rules);
}

LabelChange combined(const Volume& volume, const Labels& labels, std::uint16_t label, Logic how, const VoxelSet& other,
                     const EditRules& rules) {
  if (how == Logic::clear) return replaced(volume, labels, label, VoxelSet(Box{}), rules);
  if (how == Logic::copy) return replaced(volume, labels, label, other, rules);
  if (how == Logic::add) return labelled(volume, labels, other, label, rules);
  VoxelSet set = voxels_of(labels, label, whole(labels.grid));
  if (how == Logic::invert) {
    for (std::size_t at = 0; at < set.in.size(); ++at) set.in[at] = labels.at[at] == 0 ? 1 : 0;
    return replaced(volume, labels, label, set, rules);
  }
  for (std::size_t at = 0; at < set.in.size(); ++at)
    if (set.in[at] != 0) set.in[at] = other.has(labels.grid.place(at)) == (how == Logic::intersect) ? 1 : 0;
  return replaced(volume, labels, label, set, rules);
}

}  // namespace trocar::volumes
