#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include <trocar/view/base/colour_scale.hpp>

namespace trocar::view {
namespace {

// [Okabe & Ito 2008]: sky blue, blue, orange, vermilion; what is between and around them is our choice.
constexpr Colour kDiverging[] = {{0.00f, 0.30f, 0.55f}, {0.00f, 0.45f, 0.70f}, {0.34f, 0.71f, 0.91f},
                                 {0.95f, 0.95f, 0.93f}, {0.95f, 0.68f, 0.18f}, {0.84f, 0.37f, 0.00f},
                                 {0.62f, 0.22f, 0.00f}};
constexpr Colour kSequential[] = {
    {0.10f, 0.05f, 0.25f}, {0.11f, 0.28f, 0.52f}, {0.40f, 0.46f, 0.50f}, {0.77f, 0.66f, 0.27f}, {0.98f, 0.93f, 0.55f}};
constexpr float kAnalysisStops = 1;

/// @param at  0 .. 1 along the colours
Colour between(std::span<const Colour> colours, double at) {
  const double place = (at > 0 ? std::min(at, 1.0) : 0.0) * double(colours.size() - 1);
  const std::size_t k = std::min(std::size_t(place), colours.size() - 2);
  const float t = float(place - double(k));
  const Colour a = colours[k], b = colours[k + 1];
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
double encoded(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; }

/// The light that the camera's curve (develop.frag) shows as `shown`: with f the curve, f(x) = shown is quadratic in x.
double light_shown_as(double shown) {
  const double a = 1.25 * 6.2 - 6.2 * shown, b = 1.25 * 3.7 - 5.4 * shown, c = -0.78 * shown;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

std::uint8_t painted(float shown) {
  const double light = light_shown_as(double(shown)) / std::exp2(double(kAnalysisStops));
  return std::uint8_t(std::clamp(255 * encoded(light) + 0.5, 0.0, 255.0));
}

}  // namespace

Colour colour_on(Scale scale, double value) {
  return scale == Scale::diverging ? between(kDiverging, 0.5 * (value + 1)) : between(kSequential, value);
}

double lightness_of(Colour c) {
  const double y =
      0.2126 * linear(double(c.r)) + 0.7152 * linear(double(c.g)) + 0.0722 * linear(double(c.b));  // CIE luminance
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

render::Paint paint_shown_as(Colour c) { return {painted(c.r), painted(c.g), painted(c.b), 255}; }

render::EndoscopeLook analysis_look() {
  render::EndoscopeLook look = render::plain_look();
  look.exposure_ev = kAnalysisStops;
  return look;
}

render::Light light_for_analysis() {
  render::Light light;
  light.position = {0, 0, 0};
  light.colour = {1, 1, 1};
  light.inverse_square = false;
  light.bounce = 0;
  light.ambient = 0.12f;  // little: shape is seen by shade
  light.crevices = 0;
  light.intensity = 1 / (1 + light.ambient);  // what faces the lamp gets 1
  return light;
}

}  // namespace trocar::view
