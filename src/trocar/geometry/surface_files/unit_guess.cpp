#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

namespace trocar::geometry {
namespace {

struct LengthUnit {
  double metres;
  const char* name;
};
constexpr LengthUnit kLengthUnits[] = {{1, "metres"}, {0.01, "centimetres"}, {0.001, "millimetres"}};

/// How many times longer or shorter than usual.
double oddness(double longest, const LengthUnit& unit) {
  const double length = longest * unit.metres;
  return std::max(length / kUsualBody, kUsualBody / length) * (unit.metres == 0.01 ? kSeldom : 1);
}

std::string length_in_words(double metres) {
  if (metres >= 1) return fmt::format("{:.3g} m", metres);
  return metres >= 0.01 ? fmt::format("{:.3g} cm", 100 * metres) : fmt::format("{:.3g} mm", 1000 * metres);
}

}  // namespace

UnitGuess guess_unit(const Bounds& box) {
  UnitGuess guess;
  const Vec3d side = box.high - box.low;
  const double longest = std::max({side.x, side.y, side.z});
  if (!(longest > 0) || !std::isfinite(longest)) {
    guess.words = "without extent";
    return guess;
  }
  std::vector<LengthUnit> units(std::begin(kLengthUnits), std::end(kLengthUnits));
  std::stable_sort(units.begin(), units.end(),
                   [&](const LengthUnit& a, const LengthUnit& b) { return oddness(longest, a) < oddness(longest, b); });
  guess.words = tr("longest side {:.4g}:", longest);
  for (const LengthUnit& unit : units) {
    const double length = longest * unit.metres;
    guess.words += fmt::format("{} {} in {}", guess.words.back() == ':' ? "" : ",", length_in_words(length), unit.name);
    if (length < kShortestBody || length > kLongestBody) continue;
    if (guess.metres == 0)
      guess.metres = unit.metres;
    else
      guess.also.push_back(unit.metres);
  }
  return guess;
}

}  // namespace trocar::geometry
