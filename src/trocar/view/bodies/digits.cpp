#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/bodies/digits.hpp>

namespace trocar::view {
namespace {

constexpr double kHalfStroke = 0.085, kDigitWide = 0.6, kGap = 0.3;  // of a digit's height

struct DigitPoint {
  double x, y;  ///< tenths of the height; a digit is six wide
};
using Stroke = std::vector<DigitPoint>;

const std::array<Stroke, 10>& strokes() {
  static const std::array<Stroke, 10> all{{
      {{3, 10},
       {1.2, 9.2},
       {0.3, 7},
       {0.3, 3},
       {1.2, 0.8},
       {3, 0},
       {4.8, 0.8},
       {5.7, 3},
       {5.7, 7},
       {4.8, 9.2},
       {3, 10}},
      {{1.2, 8}, {3.4, 10}, {3.4, 0}},
      {{0.5, 7.4}, {0.9, 9}, {2.2, 10}, {3.8, 10}, {5.1, 9}, {5.4, 7.4}, {4.8, 5.6}, {0.3, 0}, {5.7, 0}},
      {{0.6, 10},
       {5.4, 10},
       {2.7, 6.2},
       {4.3, 5.9},
       {5.5, 4.6},
       {5.6, 2.7},
       {4.8, 1},
       {3.1, 0},
       {1.8, 0.1},
       {0.5, 1.2}},
      {{4.2, 0}, {4.2, 10}, {0.2, 3.2}, {5.8, 3.2}},
      {{5.2, 10},
       {1.2, 10},
       {0.8, 5.8},
       {2.2, 6.4},
       {3.6, 6.4},
       {5.2, 5.2},
       {5.6, 3.2},
       {5, 1.2},
       {3.4, 0},
       {1.8, 0.1},
       {0.5, 1.2}},
      {{4.9, 9.4},
       {3.3, 10},
       {1.6, 9.2},
       {0.6, 7},
       {0.4, 3.4},
       {1.2, 0.9},
       {3, 0},
       {4.7, 0.8},
       {5.6, 2.8},
       {5, 5},
       {3.4, 6},
       {1.6, 5.4},
       {0.5, 3.6}},
      {{0.4, 10}, {5.6, 10}, {2.2, 0}},
      {{3, 5.4},
       {1.2, 6.4},
       {0.8, 7.9},
       {1.4, 9.4},
       {3, 10},
       {4.6, 9.4},
       {5.2, 7.9},
       {4.8, 6.4},
       {3, 5.4},
       {1, 4.2},
       {0.4, 2.5},
       {1.2, 0.7},
       {3, 0},
       {4.8, 0.7},
       {5.6, 2.5},
       {5, 4.2},
       {3, 5.4}},
      {{1.1, 0.6},
       {2.7, 0},
       {4.4, 0.8},
       {5.4, 3},
       {5.6, 6.6},
       {4.8, 9.1},
       {3, 10},
       {1.3, 9.2},
       {0.4, 7.2},
       {1, 5},
       {2.6, 4},
       {4.4, 4.6},
       {5.5, 6.4}},
  }};
  return all;
}

double to_segment(DigitPoint p, DigitPoint a, DigitPoint b) {
  const double ux = b.x - a.x, uy = b.y - a.y, whole = ux * ux + uy * uy;
  const double w = whole > 0 ? std::clamp(((p.x - a.x) * ux + (p.y - a.y) * uy) / whole, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - w * ux, p.y - a.y - w * uy);
}

}  // namespace

double ink_at(const std::string& digits, double x, double y, double soft) {
  const double wide = kDigitWide * double(digits.size()) + kGap * (double(digits.size()) - 1);
  double least = 1e9;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (digits[i] < '0' || digits[i] > '9') continue;
    const Stroke& stroke = strokes()[std::size_t(digits[i] - '0')];
    const DigitPoint at{10 * (x + 0.5 * wide - double(i) * (kDigitWide + kGap)), 10 * (y + 0.5)};
    for (std::size_t k = 1; k < stroke.size(); ++k)
      least = std::min(least, 0.1 * to_segment(at, stroke[k - 1], stroke[k]));
  }
  return smooth(kHalfStroke + 0.5 * soft, kHalfStroke - 0.5 * soft, least);
}

}  // namespace trocar::view
