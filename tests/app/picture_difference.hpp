// How different two pictures look: CIE L*a*b* distances after a blur that takes away what nobody sees at arm's length
// (sensor grain, an edge that is half a pixel off).  [CIE 15:2004, 8.2.1; the blur after Zhang & Wandell 1997]
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <trocar/render/frame/image.hpp>

namespace trocar::app {

struct PictureDifference {
  double mean = 0;   ///< of all pixels; 1 is just about to be seen
  double worst = 0;  ///< what one pixel in 200 exceeds
};

namespace detail {

inline std::array<float, 3> lab(const std::uint8_t* rgb) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const double r = linear(rgb[0] / 255.0), g = linear(rgb[1] / 255.0), b = linear(rgb[2] / 255.0);
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505), y = f(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {float(116 * y - 16), float(500 * (x - y)), float(200 * (y - z))};
}

using LabPicture = std::vector<std::array<float, 3>>;

/// Weights 1 2 3 2 1 along one way.
inline LabPicture blurred(const LabPicture& from, int width, int height, int dx, int dy) {
  LabPicture to(from.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = -2; k <= 2; ++k) {
        const int i = std::clamp(x + k * dx, 0, width - 1), j = std::clamp(y + k * dy, 0, height - 1);
        for (std::size_t c = 0; c < 3; ++c)
          to[std::size_t(y) * width + x][c] += float(3 - std::abs(k)) / 9 * from[std::size_t(j) * width + i][c];
      }
  return to;
}

inline LabPicture as_seen(const render::Image& image) {
  LabPicture p(std::size_t(image.width) * image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) p[std::size_t(y) * image.width + x] = lab(image.at(x, y));
  return blurred(blurred(p, image.width, image.height, 1, 0), image.width, image.height, 0, 1);
}

}  // namespace detail

/// Of pictures of one size.
inline PictureDifference difference(const render::Image& a, const render::Image& b) {
  const detail::LabPicture p = detail::as_seen(a), q = detail::as_seen(b);
  std::vector<double> apart(p.size());
  PictureDifference out;
  for (std::size_t i = 0; i < p.size(); ++i) {
    apart[i] = std::hypot(double(p[i][0] - q[i][0]), double(p[i][1] - q[i][1]), double(p[i][2] - q[i][2]));
    out.mean += apart[i] / double(apart.size());
  }
  const auto one_in_200 = apart.begin() + std::ptrdiff_t(apart.size() - apart.size() / 200 - 1);
  std::nth_element(apart.begin(), one_in_200, apart.end());
  out.worst = *one_in_200;
  return out;
}

}  // namespace trocar::app
