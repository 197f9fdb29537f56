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
    const bool padding = number >= r.padding_from && number <= r.padding_to;
    f(i, padding ? NAN : r.intercept + r.slope * number);
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

bool is_exact(const Raster& raster, const Range& range) {
  return (range.whole && range.greatest - range.least <= 65535) || exact_by_slope(raster);
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

/// Where a few voxels lie so far away that the steps between all others become coarse, those few are clipped.
void clip_outliers(const Raster& raster, Range& range, std::vector<std::string>& notes, const Progress& progress) {
  constexpr std::size_t kMostSamples = std::size_t(1) << 20;
  constexpr double kFewest = 1000;  // steps that the range of nearly all voxels has at least
  const std::size_t each = raster.grid.count() / kMostSamples + 1;
  std::vector<double> samples;
  each_value(raster, part(progress, 0, 0.4), [&](std::size_t i, double v) {
    if (i % each == 0 && usable(v)) samples.push_back(v);
  });
  const std::size_t trimmed = samples.size() / 2000 + 1;  // of 99.9 % on each side
  if (samples.size() < 10 * trimmed) return;
  std::sort(samples.begin(), samples.end());
  const double low = samples[trimmed], high = samples[samples.size() - 1 - trimmed], most = high - low;
  if (!(most > 0) || (range.greatest - range.least) / 65535 <= most / kFewest) return;
  // Values a little beyond are the patient's, too.
  Range kept;
  std::size_t clipped = 0;
  each_value(raster, part(progress, 0.4, 1), [&](std::size_t, double v) {
    if (v >= low - most && v <= high + most)
      kept.add(v);
    else if (usable(v))
      ++clipped;
  });
  // What is clipped stays apart from the values of the others.
  const double width = kept.greatest - kept.least;
  if (range.least < kept.least) kept.least -= width;
  if (range.greatest > kept.greatest) kept.greatest += width;
  kept.unusable = range.unusable;
  range = kept;
  notes.push_back(
      tr("{} voxels far beyond the others were clipped to the range from {:g} to {:g}: else the values would "
         "be kept in very coarse steps",
         clipped, range.least, range.greatest));
}

/// What voxels become that hold no number: the least of all others, or something below where all others are the same.
double outside_of(const Range& range) {
  if (range.greatest > range.least) return range.least;
  return range.least > 0 ? 0 : range.least - 1;
}

/// The range contains it afterwards.
double add_outside(const Raster& raster, Range& range, std::vector<std::string>& notes) {
  if (range.unusable == 0) return range.least;
  const double outside = outside_of(range);
  const bool padding =
      std::any_of(raster.rescale.begin(), raster.rescale.end(), [](const Rescale& r) { return r.has_padding(); });
  notes.push_back(padding
                      ? tr("{} voxels are padding around the patient (Pixel Padding Value): they became {}",
                           range.unusable, outside)
                      : tr("{} voxels hold no number (nan) or one beyond 1e30: they count as outside of the patient "
                           "and became {}",
                           range.unusable, outside));
  range.add(outside);
  return outside;
}

}  // namespace

Volume packed_volume(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress) {
  if (raster.size() < raster.wanted())
    refuse(file, tr("expected {} bytes of voxels, got {}", raster.wanted(), raster.size()));
  Range range;
  each_value(raster, part(progress, 0, 0.3), [&](std::size_t, double v) { range.add(v); });
  if (range.least > range.greatest) refuse(file, tr("expected voxels with numbers, got none that is one"));
  Volume volume{raster.grid, {}, 1, 0, 0, raster.unit};
  if (!is_exact(raster, range)) clip_outliers(raster, range, notes, part(progress, 0.3, 0.5));
  const double outside = add_outside(raster, range, notes);
  choose_numbers(raster, range, volume);
  if (volume.error > 0) notes.push_back(tr("values are kept in steps of {:.3g}, not exactly", volume.scale));
  volume.stored.resize(raster.grid.count());
  each_value(raster, part(progress, 0.5, 1), [&](std::size_t i, double v) {
    volume.stored[i] = volume.number_of(usable(v) ? std::clamp(v, range.least, range.greatest) : outside);
  });
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
