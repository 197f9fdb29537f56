#include <algorithm>

#include <trocar/volumes/show/transfer.hpp>

namespace trocar::volumes {

TransferPoint TransferFunction::at(double value) const {
  if (points.empty()) return {value, {}, 0};
  if (value <= points.front().value) return {value, points.front().colour, points.front().opacity};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TransferPoint &a = points[i - 1], &b = points[i];
    if (value > b.value) continue;
    const double share = b.value > a.value ? (value - a.value) / (b.value - a.value) : 1;
    TransferPoint out{value, {}, a.opacity + share * (b.opacity - a.opacity)};
    for (std::size_t c = 0; c < 3; ++c) out.colour[c] = a.colour[c] + share * (b.colour[c] - a.colour[c]);
    return out;
  }
  return {value, points.back().colour, points.back().opacity};
}

TransferFunction transfer_preset(TransferPreset preset) {
  switch (preset) {
    case TransferPreset::bone:
      return {{{160, {0.75, 0.45, 0.30}, 0},
               {300, {0.90, 0.78, 0.60}, 0.35},
               {700, {0.98, 0.95, 0.86}, 0.8},
               {2000, {1, 1, 0.97}, 0.95}}};
    case TransferPreset::skin:
      return {{{-450, {0.80, 0.58, 0.46}, 0},
               {-250, {0.88, 0.66, 0.54}, 0.7},
               {100, {0.93, 0.74, 0.62}, 0.95},
               {3000, {1, 0.95, 0.9}, 0.95}}};
    case TransferPreset::vessels:
      return {{{120, {0.55, 0.05, 0.04}, 0},
               {170, {0.80, 0.16, 0.12}, 0.15},
               {320, {0.95, 0.35, 0.25}, 0.6},
               {600, {0.98, 0.9, 0.78}, 0.8},
               {2000, {1, 1, 0.97}, 0.9}}};
    case TransferPreset::soft_tissue:
      return {{{-60, {0.70, 0.45, 0.25}, 0},
               {20, {0.75, 0.40, 0.30}, 0.015},
               {90, {0.80, 0.35, 0.28}, 0.05},
               {180, {0.90, 0.55, 0.45}, 0.1},
               {400, {1, 0.95, 0.85}, 0.5}}};
  }
  return {};
}

TransferFunction grey_ramp(double from, double to) {
  return {{{from, {0, 0, 0}, 0}, {from + 0.2 * (to - from), {0.2, 0.2, 0.2}, 0}, {to, {1, 1, 1}, 0.2}}};
}

}  // namespace trocar::volumes
