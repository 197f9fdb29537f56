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
  std::vector<int> images;
};

std::vector<Level> levels_of(std::span<const SlicePlace> places, Vec3d normal) {
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return dot(places[a].position, normal) < dot(places[b].position, normal); });
  std::vector<Level> out;
  for (const int i : order) {
    const double along = dot(places[i].position, normal);
    if (out.empty() || along - out.back().along > kSamePosition) out.push_back({along, {}});
    out.back().images.push_back(i);
  }
  for (Level& level : out)
    std::stable_sort(level.images.begin(), level.images.end(),
                     [&](int a, int b) { return places[a].number < places[b].number; });
  return out;
}

void require_equally_many(const std::vector<Level>& levels, const std::string& file) {
  const std::size_t usual = levels[0].images.size();
  for (const Level& level : levels)
    if (level.images.size() != usual)
      refuse(file, tr("expected equally many images at each position, got {} at {:.2f} mm and {} at {:.2f} mm", usual,
                      levels[0].along, level.images.size(), level.along));
}

double median_gap(const std::vector<Level>& levels) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < levels.size(); ++i) gaps.push_back(levels[i].along - levels[i - 1].along);
  std::nth_element(gaps.begin(), gaps.begin() + std::ptrdiff_t(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2];
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

SliceStack stack_slices(std::span<const SlicePlace> places, Vec3d row, Vec3d column, const std::string& file,
                        std::vector<std::string>& notes) {
  const Vec3d normal = normalised(cross(row, column));
  const std::vector<Level> levels = levels_of(places, normal);
  require_equally_many(levels, file);
  SliceStack out;
  out.slices = int(levels.size());
  out.frames = int(levels[0].images.size());
  for (const Level& level : levels) out.order.insert(out.order.end(), level.images.begin(), level.images.end());
  out.origin = places[levels[0].images[0]].position;
  if (levels.size() == 1) {
    const double thickness = places[0].thickness;
    out.step = (thickness > 0 ? thickness : 1) * normal;
    notes.push_back(tr("a single slice: taken as {:.3g} mm thick", thickness > 0 ? thickness : 1));
    return out;
  }
  require_none_missing(levels, median_gap(levels), file);
  out.step = (places[levels.back().images[0]].position - out.origin) / double(levels.size() - 1);
  const double spacing = dot(out.step, normal);
  double worst = 0;
  for (std::size_t k = 0; k < levels.size(); ++k)
    for (const int i : levels[k].images)
      worst = std::max(worst, length(places[i].position - (out.origin + double(k) * out.step)));
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
