#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/volumes/files/raster.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

namespace trocar::volumes {
namespace {

constexpr double kSamePosition = 0.01;  // [mm]
constexpr double kUneven = 0.1;         // of the spacing: scanners round positions to a tenth of a millimetre
constexpr int kMostNamed = 8;

struct Level {
  double along = 0;  // the normal [mm]
  int image = 0;
};

/// One image a position, with the position.
std::vector<Level> single_levels(std::span<const SlicePlace> places, Vec3d normal, const std::string& file) {
  std::vector<Level> out;
  for (const std::vector<int>& images : levels_of(places, normal)) {
    const double along = dot(places[std::size_t(images[0])].position, normal);
    if (images.size() != 1)
      refuse(file, tr("expected one image at each position, got {} at {:.2f} mm", images.size(), along));
    out.push_back({along, images[0]});
  }
  return out;
}

double median_gap(const std::vector<Level>& levels) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < levels.size(); ++i) gaps.push_back(levels[i].along - levels[i - 1].along);
  std::nth_element(gaps.begin(), gaps.begin() + std::ptrdiff_t(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2];
}

/// One distance up to somewhere and another one behind it, each at least twice.
void refuse_two_spacings(const std::vector<Level>& levels, const std::string& file) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < levels.size(); ++i) gaps.push_back(levels[i].along - levels[i - 1].along);
  if (gaps.size() < 4) return;
  const double first = gaps.front(), last = gaps.back();
  const auto is = [](double gap, double wanted) { return std::fabs(gap - wanted) <= kUneven * wanted + kSamePosition; };
  if (is(first, last) || is(last, first)) return;
  std::size_t change = 0;
  while (change < gaps.size() && is(gaps[change], first)) ++change;
  const bool only_two =
      std::all_of(gaps.begin() + std::ptrdiff_t(change), gaps.end(), [&](double gap) { return is(gap, last); });
  if (change < 2 || gaps.size() - change < 2 || !only_two) return;
  refuse(file, tr("expected slices evenly apart, got {:.4g} mm up to {:.2f} mm along the slices' normal and {:.4g} mm "
                  "behind it: open one of the parts alone, or resample them first, for instance in 3D Slicer",
                  first, levels[change].along, last));
}

void require_none_missing(const std::vector<Level>& levels, double spacing, const std::string& file) {
  std::string missing;
  int count = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double from = levels[i - 1].along, gap = levels[i].along - from;
    if (gap < 1.5 * spacing) continue;
    const int steps = int(std::lround(std::min(gap / spacing, 1e6)));
    for (int s = 1; s < steps && count < kMostNamed; ++s)
      missing += fmt::format("{}{:.2f}", missing.empty() ? "" : ", ", from + gap * s / steps), ++count;
    if (count == kMostNamed) break;
  }
  if (count > 0)
    refuse(file, tr("expected slices {:.3g} mm apart without gaps, got {} positions; missing at {}{} mm along "
                    "the slices' normal",
                    spacing, levels.size(), missing, count == kMostNamed ? ", ..." : ""));
}

}  // namespace

std::vector<std::vector<int>> levels_of(std::span<const SlicePlace> places, Vec3d normal) {
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  const auto along = [&](int i) { return dot(places[std::size_t(i)].position, normal); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return along(a) < along(b); });
  std::vector<std::vector<int>> out;
  for (const int i : order) {
    if (out.empty() || along(i) - along(out.back().back()) > kSamePosition) out.emplace_back();
    out.back().push_back(i);
  }
  return out;
}

SliceStack stack_slices(std::span<const SlicePlace> places, Vec3d row, Vec3d column, const std::string& file,
                        std::vector<std::string>& notes) {
  const Vec3d normal = normalised(cross(row, column));
  const std::vector<Level> levels = single_levels(places, normal, file);
  SliceStack out;
  out.slices = int(levels.size());
  for (const Level& level : levels) out.order.push_back(level.image);
  out.origin = places[std::size_t(levels[0].image)].position;
  if (levels.size() == 1) {
    const double thickness = places[0].thickness;
    out.step = (thickness > 0 ? thickness : 1) * normal;
    notes.push_back(tr("a single slice: taken as {:.3g} mm thick", thickness > 0 ? thickness : 1));
    return out;
  }
  refuse_two_spacings(levels, file);
  require_none_missing(levels, median_gap(levels), file);
  out.step = (places[std::size_t(levels.back().image)].position - out.origin) / double(levels.size() - 1);
  const double spacing = dot(out.step, normal);
  double worst = 0;
  for (std::size_t k = 0; k < levels.size(); ++k)
    worst =
        std::max(worst, length(places[std::size_t(levels[k].image)].position - (out.origin + double(k) * out.step)));
  if (worst > kUneven * spacing + kSamePosition)
    refuse(file, tr("expected slices evenly {:.3g} mm apart in a straight line, got one {:.3g} mm from its place",
                    spacing, worst));
  const double thickness = places[0].thickness;
  if (thickness > 0 && std::fabs(thickness - spacing) > 0.01 * spacing)
    notes.push_back(
        tr("slices are {:.4g} mm apart by their positions, which counts, and {:.4g} mm thick", spacing, thickness));
  return out;
}

}  // namespace trocar::volumes
