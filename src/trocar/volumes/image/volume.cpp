#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/core/require.hpp>
#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>

namespace trocar::volumes {
namespace {

struct Sums {
  std::size_t count = 0;
  double sum = 0, squares = 0;
  int least = 32767, greatest = -32768;

  void add(std::int16_t v) {
    ++count;
    sum += v;
    squares += double(v) * v;
    least = std::min<int>(least, v);
    greatest = std::max<int>(greatest, v);
  }
  Statistics of(const Volume& volume) const {
    if (count == 0) return {};
    const double mean = sum / double(count);
    const double variance = std::max(0.0, squares / double(count) - mean * mean);
    return {count, volume.offset + volume.scale * least, volume.offset + volume.scale * greatest,
            volume.offset + volume.scale * mean, volume.scale * std::sqrt(variance)};
  }
};

/// Between two neighbours on an axis, or twice the border.
struct Between {
  int low, high;
  double share;
};
Between between(double at, int size) {
  const double inside = std::clamp(at, 0.0, double(size - 1));
  const int low = std::min(int(inside), std::max(size - 2, 0));
  return {low, std::min(low + 1, size - 1), inside - low};
}

/// Within half a voxel of the centres: the voxels' own extent.
bool within_voxels(Vec3d ijk, const Index3& size) {
  for (int k = 0; k < 3; ++k)
    if (!(ijk[k] >= -0.5 && ijk[k] <= size[std::size_t(k)] - 0.5)) return false;
  return true;
}

}  // namespace

std::int16_t Volume::number_of(double wanted) const {
  return std::int16_t(std::floor(std::clamp((wanted - offset) / scale, -32768.0, 32767.0) + 0.5));
}

double Volume::at(Vec3d ijk) const {
  const Between x = between(ijk.x, grid.size[0]), y = between(ijk.y, grid.size[1]), z = between(ijk.z, grid.size[2]);
  const auto row = [&](int j, int k) {
    const double a = stored[grid.index(x.low, j, k)], b = stored[grid.index(x.high, j, k)];
    return a + x.share * (b - a);
  };
  const auto face = [&](int k) {
    const double a = row(y.low, k), b = row(y.high, k);
    return a + y.share * (b - a);
  };
  const double a = face(z.low), b = face(z.high);
  return offset + scale * (a + z.share * (b - a));
}

Statistics statistics(const Volume& volume) {
  Sums sums;
  for (const std::int16_t v : volume.stored) sums.add(v);
  return sums.of(volume);
}

Statistics statistics(const Volume& volume, const Labels& labels, int label) {
  core::require(volume.grid.size == labels.grid.size, "labels and volume must have the same number of voxels");
  Sums sums;
  for (std::size_t i = 0; i < volume.stored.size(); ++i)
    if (labels.at[i] == label) sums.add(volume.stored[i]);
  return sums.of(volume);
}

double quantile(const Volume& volume, double share) {
  std::vector<std::size_t> histogram(65536);
  for (const std::int16_t v : volume.stored) ++histogram[std::size_t(v + 32768)];
  const double wanted = std::clamp(share, 0.0, 1.0) * double(volume.stored.size());
  double so_far = 0;
  std::size_t bin = 0, last = 0;
  for (; bin < histogram.size(); ++bin) {
    if (histogram[bin] == 0) continue;
    last = bin;
    so_far += double(histogram[bin]);
    if (so_far >= wanted) break;
  }
  return volume.offset + volume.scale * (double(last) - 32768);
}

Volume resampled(const Volume& volume, const Grid& onto, double outside, const Progress& progress) {
  Volume out{onto, {}, volume.scale, volume.offset, volume.error, volume.unit};
  out.stored.resize(onto.count());
  const std::int16_t nothing =
      std::isfinite(outside) ? out.number_of(outside) : *std::min_element(volume.stored.begin(), volume.stored.end());
  const Mat3d back = inverse(volume.grid.step());
  const Mat3d step = back * onto.step();
  const Vec3d start = back * (onto.origin - volume.grid.origin);
  std::size_t at = 0;
  for (int k = 0; k < onto.size[2]; ++k) {
    tell(progress, double(k) / onto.size[2]);
    for (int j = 0; j < onto.size[1]; ++j)
      for (int i = 0; i < onto.size[0]; ++i, ++at) {
        const Vec3d p = start + step * Vec3d{double(i), double(j), double(k)};
        out.stored[at] = within_voxels(p, volume.grid.size) ? out.number_of(volume.at(p)) : nothing;
      }
  }
  return out;
}

Labels resampled(const Labels& labels, const Grid& onto, const Progress& progress) {
  Labels out{onto, {}, labels.segments};
  out.at.resize(onto.count());
  const Mat3d back = inverse(labels.grid.step());
  const Mat3d step = back * onto.step();
  const Vec3d start = back * (onto.origin - labels.grid.origin);
  std::size_t at = 0;
  for (int k = 0; k < onto.size[2]; ++k) {
    tell(progress, double(k) / onto.size[2]);
    for (int j = 0; j < onto.size[1]; ++j)
      for (int i = 0; i < onto.size[0]; ++i, ++at) {
        const Vec3d p = start + step * Vec3d{double(i), double(j), double(k)};
        // A grid that differs only by rounding must not lose its border: a thousandth of a voxel is no distance.
        const Index3 v{int(std::floor(p.x + 0.501)), int(std::floor(p.y + 0.501)), int(std::floor(p.z + 0.501))};
        if (within_voxels(p, labels.grid.size) && labels.grid.has(v)) out.at[at] = labels.at[labels.grid.index(v)];
      }
  }
  return out;
}

}  // namespace trocar::volumes
