#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/raster.hpp>

namespace trocar::volumes {
namespace {

constexpr double kMostPlace = 1e6, kLeastStep = 1e-4, kMostStep = 1e4;  // [mm]
constexpr double kMostValue = 1e30;  // beyond, differences of values are no numbers any more

bool machine_is_big() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const char*>(&one) == 0;
}

template <class T>
T element_at(const char* from, bool swapped) {
  char own[sizeof(T)];
  std::memcpy(own, from, sizeof(T));
  if (swapped) std::reverse(own, own + sizeof(T));
  T value;
  std::memcpy(&value, own, sizeof(T));
  return value;
}

/// Calls f(voxel, value after slope and intercept) for all voxels of a slice.
template <class T, class F>
void slice_values(const Raster& raster, int slice, F&& f) {
  const std::size_t in_slice = std::size_t(raster.grid.size[0]) * std::size_t(raster.grid.size[1]);
  const bool swapped = sizeof(T) > 1 && raster.big_endian != machine_is_big();
  Rescale r;
  if (!raster.rescale.empty()) r = raster.rescale[raster.rescale.size() == 1 ? 0 : std::size_t(slice)];
  const char* data = raster.data();
  for (std::size_t i = in_slice * std::size_t(slice), end = i + in_slice; i < end; ++i) {
    const auto number = double(element_at<T>(data + i * raster.stride * sizeof(T), swapped));
    f(i, r.intercept + r.slope * number);
  }
}
template <class F>
void each_value(const Raster& raster, const Progress& progress, F&& f) {
  for (int k = 0; k < raster.grid.size[2]; ++k) {
    tell(progress, double(k) / raster.grid.size[2]);
    switch (raster.element) {
      case Element::int8:
        slice_values<std::int8_t>(raster, k, f);
        break;
      case Element::uint8:
        slice_values<std::uint8_t>(raster, k, f);
        break;
      case Element::int16:
        slice_values<std::int16_t>(raster, k, f);
        break;
      case Element::uint16:
        slice_values<std::uint16_t>(raster, k, f);
        break;
      case Element::int32:
        slice_values<std::int32_t>(raster, k, f);
        break;
      case Element::uint32:
        slice_values<std::uint32_t>(raster, k, f);
        break;
      case Element::int64:
        slice_values<std::int64_t>(raster, k, f);
        break;
      case Element::uint64:
        slice_values<std::uint64_t>(raster, k, f);
        break;
      case Element::real32:
        slice_values<float>(raster, k, f);
        break;
      case Element::real64:
        slice_values<double>(raster, k, f);
        break;
    }
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

std::size_t width_of(Element element) {
  constexpr std::size_t kWidths[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kWidths[std::size_t(element)];
}
const char* name_of(Element element) {
  constexpr const char* kNames[] = {"int8",   "uint8", "int16",  "uint16", "int32",
                                    "uint32", "int64", "uint64", "float",  "double"};
  return kNames[std::size_t(element)];
}

void refuse(const std::string& file, std::string message) {
  throw core::BadInput({{{file, 0, 0}, std::move(message)}});
}

std::optional<std::string> size_fault(const std::array<std::int64_t, 3>& announced, std::size_t most_voxels) {
  std::uint64_t room = most_voxels;
  for (const std::int64_t size : announced) {
    if (size < 1) return tr("expected sizes of at least 1, got {} x {} x {}", announced[0], announced[1], announced[2]);
    if (size > std::numeric_limits<int>::max() || std::uint64_t(size) > room)
      return tr("expected at most {} voxels, got {} x {} x {}", most_voxels, announced[0], announced[1], announced[2]);
    room /= std::uint64_t(size);
  }
  return {};
}

std::optional<std::string> place_fault(Vec3d origin, const Mat3d& step) {
  for (int k = 0; k < 3; ++k) {
    if (!(std::fabs(origin[k]) <= kMostPlace))
      return tr("expected an origin within 1e6 mm, got {} on axis {}", origin[k], k);
    const double size = length(step.column(k));
    if (!(size >= kLeastStep && size <= kMostStep))
      return tr("expected voxels from 1e-4 to 1e4 mm apart, got {} along axis {}", size, k);
  }
  const double box = length(step.column(0)) * length(step.column(1)) * length(step.column(2));
  if (!(std::fabs(determinant(step)) > 1e-3 * box)) return "expected three axes that span a voxel, got a flat one";
  return {};
}

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
