// Only the voxels around the shape are kept, with a border of voxels outside, so that points beyond them are outside.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <trocar/geometry/volumes/field.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {
namespace {

using VoxelPlace = std::array<int, 3>;

/// The part of a volume that a field needs, as numbers that are above 0 inside.
struct Crop {
  VoxelPlace low{}, size{};
  std::vector<float> values;

  std::size_t index(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(size[0]) * (std::size_t(j) + std::size_t(size[1]) * std::size_t(k));
  }
};

/// Calls f(i, j, k, value) for all voxels, in their order.
template <class F>
void for_each_voxel(const Voxels& v, F&& f) {
  std::visit(
      [&](const auto& values) {
        std::size_t n = 0;
        for (int k = 0; k < v.size[2]; ++k)
          for (int j = 0; j < v.size[1]; ++j)
            for (int i = 0; i < v.size[0]; ++i) f(i, j, k, double(values[n++]));
      },
      v.values);
}

/// Room for the voxels that `wanted` says yes to and `border` more on every side; no values yet.
template <class Wanted>
Crop room_around(const Voxels& voxels, int border, Wanted&& wanted) {
  constexpr int none = std::numeric_limits<int>::max();
  VoxelPlace low{none, none, none}, high{-1, -1, -1};
  for_each_voxel(voxels, [&](int i, int j, int k, double value) {
    if (!wanted(value)) return;
    const VoxelPlace p{i, j, k};
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  });
  if (high[0] < 0) return {};
  Crop crop;
  constexpr std::size_t most = std::size_t(1) << 28;  // a long thin label with a wide border is more than its file
  std::size_t count = 1;
  for (int a = 0; a < 3; ++a) {
    crop.low[a] = low[a] - border;
    crop.size[a] = high[a] - low[a] + 1 + 2 * border;
    if (std::size_t(crop.size[a]) > most / count)
      throw std::invalid_argument("expected a label within at most " + std::to_string(most) + " voxels, got more");
    count *= std::size_t(crop.size[a]);
  }
  crop.values.assign(count, 0.0f);
  return crop;
}

/// Calls f(place in the crop, value) for the voxels that the crop holds.
template <class F>
void for_each_voxel_of(const Crop& crop, const Voxels& v, F&& f) {
  const auto first = [&](int a) { return std::max(0, crop.low[a]); };
  const auto last = [&](int a) { return std::min(v.size[a], crop.low[a] + crop.size[a]); };
  std::visit(
      [&](const auto& values) {
        for (int k = first(2); k < last(2); ++k)
          for (int j = first(1); j < last(1); ++j)
            for (int i = first(0); i < last(0); ++i)
              f(crop.index(i - crop.low[0], j - crop.low[1], k - crop.low[2]), double(values[v.index(i, j, k)]));
      },
      v.values);
}

/// The weights 1 2 1 along one axis; beyond the crop's ends its values continue.
void smooth_along(Crop& crop, int axis) {
  const std::size_t strides[3] = {1, std::size_t(crop.size[0]), std::size_t(crop.size[0]) * crop.size[1]};
  const std::size_t stride = strides[axis];
  const int length = crop.size[axis], u = (axis + 1) % 3, w = (axis + 2) % 3;
  for (int b = 0; b < crop.size[w]; ++b)
    for (int a = 0; a < crop.size[u]; ++a) {
      float* line = crop.values.data() + a * strides[u] + b * strides[w];
      float before = line[0];
      for (int i = 0; i < length; ++i) {
        const float here = line[i * stride], after = line[std::min(i + 1, length - 1) * stride];
        line[i * stride] = 0.25f * (before + 2.0f * here + after);
        before = here;
      }
    }
}

/// Trilinear between the centres of a crop's voxels; beyond them, as on the border.
struct Trilinear {
  Crop crop;
  Vec3d origin;
  Mat3d to_voxels;

  double operator()(Vec3d p) const {
    const Vec3d q = to_voxels * (p - origin);
    VoxelPlace low{};
    Vec3d share;
    for (int a = 0; a < 3; ++a) {
      const double at = std::clamp(q[a], 0.0, double(crop.size[a] - 1));
      low[a] = std::min(int(at), crop.size[a] - 2);
      share[a] = at - low[a];
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= corner >> a & 1 ? share[a] : 1 - share[a];
      sum +=
          weight *
          double(
              crop.values[crop.index(low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2 & 1))]);
    }
    return sum;
  }
};

Field field_of_crop(const Voxels& voxels, Crop crop) {
  if (!(std::fabs(determinant(voxels.step)) > 0)) throw std::invalid_argument("voxels with a volume expected");
  const Vec3d first{double(crop.low[0]), double(crop.low[1]), double(crop.low[2])};
  const Vec3d last = first + Vec3d{double(crop.size[0] - 1), double(crop.size[1] - 1), double(crop.size[2] - 1)};
  std::vector<Vec3d> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(voxels.centre({c & 1 ? last.x : first.x, c & 2 ? last.y : first.y, c & 4 ? last.z : first.z}));
  const auto trilinear =
      std::make_shared<const Trilinear>(Trilinear{std::move(crop), voxels.centre(first), inverse(voxels.step)});
  return {[trilinear](Vec3d p) { return (*trilinear)(p); }, bounds(corners), std::numeric_limits<double>::infinity()};
}

double mean_step(const Voxels& v) {
  return (length(v.step.column(0)) + length(v.step.column(1)) + length(v.step.column(2))) / 3;
}

/// How steep a flat face is after smoothing, per voxel: the middle of the binomial weights.
double slope_after(int smoothing) {
  double slope = 1;
  for (int pass = 1; pass <= smoothing; ++pass) slope *= (2.0 * pass - 1) / (2.0 * pass);
  return slope;
}

}  // namespace

Field field_of_label(const Voxels& voxels, int label, int smoothing) {
  if (smoothing < 0 || smoothing > kMostSmoothing) throw std::invalid_argument("0 to 16 passes of smoothing expected");
  Crop crop = room_around(voxels, smoothing + 1, [&](double value) { return value == label; });
  if (crop.values.empty())
    throw std::invalid_argument("voxels with the label " + std::to_string(label) + " expected, got none");
  for_each_voxel_of(crop, voxels, [&](std::size_t n, double value) { crop.values[n] = value == label ? 1.0f : 0.0f; });
  for (int pass = 0; pass < smoothing; ++pass)
    for (int axis = 0; axis < 3; ++axis) smooth_along(crop, axis);
  const auto scale = float(mean_step(voxels) / slope_after(smoothing));  // to metres at a flat face
  for (float& value : crop.values) value = scale * (value - 0.5f);
  return field_of_crop(voxels, std::move(crop));
}

Field field_above(const Voxels& voxels, double threshold) {
  Crop crop = room_around(voxels, 1, [&](double value) { return value > threshold; });
  if (crop.values.empty())
    throw std::invalid_argument("voxels above " + std::to_string(threshold) + " expected, got none");
  float most = 0;
  for_each_voxel_of(crop, voxels, [&](std::size_t, double value) { most = std::max(most, float(value - threshold)); });
  std::fill(crop.values.begin(), crop.values.end(), -most);  // beyond the volume's border
  for_each_voxel_of(crop, voxels, [&](std::size_t n, double value) { crop.values[n] = float(value - threshold); });
  return field_of_crop(voxels, std::move(crop));
}

}  // namespace trocar::geometry
