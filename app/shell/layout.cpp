#include "shell/layout.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::app {
namespace {

constexpr float kCorner = 0.3f;  // of the picture's width
constexpr double kFixed = 0.3;   // share of a picture's cost that its size does not change, as render::Governor has it

/// From a to b of the length, leaving `gap` to what comes after.
Area part(const Area& whole, float x0, float x1, float y0, float y1, float gap) {
  Area a{std::floor(whole.x + x0 * whole.width), std::floor(whole.y + y0 * whole.height), 0, 0};
  a.width = std::max(1.0f, std::floor(whole.x + x1 * whole.width) - a.x - (x1 < 1 ? gap : 0));
  a.height = std::max(1.0f, std::floor(whole.y + y1 * whole.height) - a.y - (y1 < 1 ? gap : 0));
  return a;
}

Area in_corner(const Area& whole, float scale) {
  const float gap = std::floor(10 * scale), width = std::max(1.0f, std::floor(kCorner * whole.width));
  const float height = std::max(1.0f, std::floor(std::min(0.75f * width, whole.height)));
  return {whole.x + std::max(0.0f, whole.width - width - gap), whole.y + std::min(gap, whole.height - height), width,
          height};
}

double cost(const Area& a, double whole) { return kFixed + (1 - kFixed) * double(a.width) * double(a.height) / whole; }

}  // namespace

std::vector<Area> areas_of(Layout layout, const Area& whole, float scale) {
  const float gap = std::max(1.0f, std::floor(2 * scale));
  switch (layout) {
    case Layout::one:
      break;
    case Layout::side_by_side:
      return {part(whole, 0, 0.5f, 0, 1, gap), part(whole, 0.5f, 1, 0, 1, gap)};
    case Layout::corner:
      return {whole, in_corner(whole, scale)};
    case Layout::four:
      return {part(whole, 0, 0.5f, 0, 0.5f, gap), part(whole, 0.5f, 1, 0, 0.5f, gap),
              part(whole, 0, 0.5f, 0.5f, 1, gap), part(whole, 0.5f, 1, 0.5f, 1, gap)};
  }
  return {whole};
}

double load_of(const std::vector<Area>& areas, const Area& whole) {
  const double pixels = std::max(1.0, double(whole.width) * double(whole.height));
  double largest = 0;
  for (std::size_t i = 1; i < areas.size(); ++i) largest = std::max(largest, cost(areas[i], pixels));
  return cost(areas.front(), pixels) + largest;
}

}  // namespace trocar::app
