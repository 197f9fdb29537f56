#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/volumes/files/raster.hpp>

namespace trocar::volumes {
namespace {

constexpr double kMostValue = 1e30;  // beyond, differences of values are no numbers any more

/// Calls f(voxel, value after slope and intercept) for all voxels of a slice.
template <class T, class F>
void slice_values(const Raster& raster, int slice, F&& f) {
  const std::size_t in_slice = std::size_t(raster.grid.size[0]) * std::size_t(raster.grid.size[1]);
  const bool swapped = raster.big_endian != geometry::machine_is_big();
  Rescale r;
  if (!raster.rescale.empty()) r = raster.rescale[raster.rescale.size() == 1 ? 0 : std::size_t(slice)];
  const char* data = raster.data();
  for (std::size_t i = in_slice * std::size_t(slice), end = i + in_slice; i < end; ++i) {
    const auto number = double(geometry::number_at<T>(data + i * raster.stride * sizeof(T), swapped));
    f(i, r.intercept + r.slope * number);
  }
}
template <class F>
void each_value(const Raster& raster, const Progress& progress, F&& f) {
  for (int k = 0; k < raster.grid.size[2]; ++k) {
    tell(progress, double(k) / raster.grid.size[2]);
    geometry::with_type(raster.element, [&](auto zero) { slice_values<decltype(zero)>(raster, k, f); });
  }
}

bool usable(double value) { return std::fabs(value) <= kMostValue; }

/// What values a volume has, and what 16 bits can make of them.
struct Range {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  bool whole = true;
  std::size_t unusable = 0;

  void add(double v) {
    if (!usable(v)) return void(++unusable);
    least = std::min(least, v);
    greatest = std::max(greatest, v);
    whole = whole && v == std::floor(v);
  }
};

/// The slope that all slices share makes every value exact, whatever it is.
bool exact_by_slope(const Raster& raster) {
  return raster.rescale.size() == 1 && raster.element <= Element::uint16 && raster.rescale[0].slope > 0;
}

void choose_numbers(const Raster& raster, const Range& range, Volume& volume) {
  if (range.whole && range.least >= -32768 && range.greatest <= 32767) return;
  if (range.whole && range.greatest - range.least <= 65535) {
    volume.offset = range.least >= 0 && range.greatest <= 65535 ? 32768 : range.least + 32768;
    return;
  }
  if (exact_by_slope(raster)) {
    const double zero = raster.element == Element::uint16 ? 32768 : 0;
    volume.scale = raster.rescale[0].slope;
    volume.offset = raster.rescale[0].intercept + volume.scale * zero;
    return;
  }
  volume.scale = std::max((range.greatest - range.least) / 65535, std::numeric_limits<double>::min());
  volume.offset = range.least + 32768 * volume.scale;
  volume.error = volume.scale / 2;
}

}  // namespace

Volume packed_volume(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress) {
  if (raster.size() < raster.wanted())
    refuse(file, tr("expected {} bytes of voxels, got {}", raster.wanted(), raster.size()));
  Range range;
  each_value(raster, part(progress, 0, 0.4), [&](std::size_t, double v) { range.add(v); });
  if (range.least > range.greatest) refuse(file, "expected voxels with numbers, got none that is one");
  if (range.unusable > 0)
    notes.push_back(tr("{} voxels hold no number or one beyond 1e30: they became the least value, {}", range.unusable,
                       range.least));
  Volume volume{raster.grid, {}, 1, 0, 0, raster.unit};
  choose_numbers(raster, range, volume);
  if (volume.error > 0) notes.push_back(tr("values are kept in steps of {:.3g}, not exactly", volume.scale));
  volume.stored.resize(raster.grid.count());
  each_value(raster, part(progress, 0.4, 1),
             [&](std::size_t i, double v) { volume.stored[i] = volume.number_of(usable(v) ? v : range.least); });
  return volume;
}

Labels packed_labels(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress) {
  if (raster.size() < raster.wanted())
    refuse(file, tr("expected {} bytes of voxels, got {}", raster.wanted(), raster.size()));
  Labels labels{raster.grid, std::vector<std::uint16_t>(raster.grid.count()), raster.segments};
  std::size_t wrong = 0, first_wrong = 0;
  double got = 0;
  each_value(raster, progress, [&](std::size_t i, double v) {
    if (v >= 0 && v <= 65535 && v == std::floor(v)) {
      labels.at[i] = std::uint16_t(v);
    } else if (wrong++ == 0) {
      first_wrong = i;
      got = v;
    }
  });
  if (wrong > 0) {
    const Index3 v = raster.grid.place(first_wrong);
    refuse(file, tr("expected labels, whole numbers from 0 to 65535, got {} in voxel ({}, {}, {}){}", got, v[0], v[1],
                    v[2], wrong > 1 ? tr(" and {} more that are none", wrong - 1) : ""));
  }
  name_all(labels);
  notes.push_back(fmt::format("{} labels", labels.segments.size()));
  return labels;
}

}  // namespace trocar::volumes
