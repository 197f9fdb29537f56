#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

namespace trocar::geometry {
namespace {

struct LengthUnit {
  double metres;
  const char* name;
};
constexpr LengthUnit kLengthUnits[] = {{1, "metres"}, {0.01, "centimetres"}, {0.001, "millimetres"}};

double longest_side(const Bounds& box) {
  const Vec3d side = box.high - box.low;
  const double longest = std::max({side.x, side.y, side.z});
  return longest > 0 && std::isfinite(longest) ? longest : 0;
}

/// How many times longer or shorter than usual.
double oddness(double longest, const LengthUnit& unit) {
  const double length = longest * unit.metres;
  return std::max(length / kUsualBody, kUsualBody / length) * (unit.metres == 0.01 ? kSeldom : 1);
}

std::string length_in_words(double metres) {
  if (metres >= 1) return fmt::format("{:.3g} m", metres);
  return metres >= 0.01 ? fmt::format("{:.3g} cm", 100 * metres) : fmt::format("{:.3g} mm", 1000 * metres);
}

std::string volume_in_words(double cubic_metres) {
  const double mL = 1e6 * cubic_metres;
  if (mL < 1e-3) return tr("less than 0.001 mL");
  if (mL < 1e4) return mL < 100 ? fmt::format("{:.3g} mL", mL) : fmt::format("{:.0f} mL", mL);
  if (mL < 1e7) return fmt::format("{:.0f} L", 1e-3 * mL);
  return cubic_metres < 1e9 ? fmt::format("{:.0f} m3", cubic_metres) : fmt::format("{:.3g} m3", cubic_metres);
}

std::string size_in_words(const Extent& extent, double metres) {
  const std::string length = length_in_words(longest_side(extent.box) * metres);
  if (extent.volume == 0) return length;
  return tr("{} and {}", length, volume_in_words(extent.volume * metres * metres * metres));
}

/// "longest side 15: 15 cm and 200 mL in centimetres, 15 mm and 0.2 mL in millimetres"
std::string sizes_in_words(const Extent& extent, const std::vector<LengthUnit>& units) {
  std::string words = tr("longest side {:.4g}:", longest_side(extent.box));
  for (const LengthUnit& unit : units)
    words += fmt::format("{} {}", words.back() == ':' ? "" : ",",
                         tr("{} in {}", size_in_words(extent, unit.metres), tr(unit.name)));
  return words;
}

std::vector<LengthUnit> likeliest_first(double longest) {
  std::vector<LengthUnit> units(std::begin(kLengthUnits), std::end(kLengthUnits));
  std::stable_sort(units.begin(), units.end(),
                   [&](const LengthUnit& a, const LengthUnit& b) { return oddness(longest, a) < oddness(longest, b); });
  return units;
}

}  // namespace

double unit_in_head(std::string_view line) {
  struct NamedUnit {
    std::string_view names;
    double metres;
  };
  constexpr NamedUnit kNamed[] = {{" mm millimeter millimeters millimetre millimetres ", 1e-3},
                                  {" cm centimeter centimeters centimetre centimetres ", 1e-2},
                                  {" m meter meters metre metres ", 1},
                                  {" in inch inches ", 0.0254},
                                  {" ft foot feet ", 0.3048},
                                  {" um micron microns micrometer micrometers micrometre micrometres ", 1e-6}};
  const std::string text = core::in_small_letters(line.substr(0, 1000));
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  const std::size_t key = text.find("unit");
  if (key == text.npos || (key > 0 && is_letter(text[key - 1]))) return 0;
  std::size_t at = key + 4 + (text.substr(key + 4, 1) == "s");
  const std::size_t sign = text.find_first_not_of(" \t", at);
  if (sign == text.npos || (text[sign] != '=' && text[sign] != ':')) return 0;
  at = std::min(text.find_first_not_of(" \t\"'", sign + 1), text.size());
  std::size_t end = at;
  while (end < text.size() && is_letter(text[end])) ++end;
  const std::string word = ' ' + text.substr(at, end - at) + ' ';
  for (const NamedUnit& unit : kNamed)
    if (word.size() > 2 && unit.names.find(word) != std::string_view::npos) return unit.metres;
  return 0;
}

Extent extent_of(const TriMesh& closed) { return {bounds(closed.positions), std::fabs(volume(closed))}; }

Extent in_unit(const Extent& extent, double unit) {
  return {{extent.box.low / unit, extent.box.high / unit}, extent.volume / (unit * unit * unit)};
}

std::string unit_in_words(double metres) {
  for (const LengthUnit& unit : kLengthUnits)
    if (std::fabs(metres / unit.metres - 1) < 1e-9) return tr(unit.name);
  return tr("units of {:g} mm", 1e3 * metres);
}

bool is_organs_volume(const Extent& extent, double metres) {
  const double volume = extent.volume * metres * metres * metres;
  return volume == 0 || (volume >= kSmallestOrgan && volume <= kLargestOrgan);
}

UnitGuess guess_unit(const Extent& extent) {
  UnitGuess guess;
  const double longest = longest_side(extent.box);
  if (longest == 0) {
    guess.words = tr("without extent");
    return guess;
  }
  const std::vector<LengthUnit> units = likeliest_first(longest);
  guess.words = sizes_in_words(extent, units);
  for (const LengthUnit& unit : units) {
    const double length = longest * unit.metres;
    if (length < kShortestBody || length > kLongestBody || !is_organs_volume(extent, unit.metres)) continue;
    if (guess.metres == 0)
      guess.metres = unit.metres;
    else
      guess.also.push_back(unit.metres);
  }
  return guess;
}

UnitChoice choose_unit(const Extent& extent, double said, const char* by) {
  const UnitGuess guess = guess_unit(extent);
  UnitChoice choice;
  choice.metres = said > 0 ? said : guess.metres > 0 ? guess.metres : 1e-3;
  if (said > 0 && !is_organs_volume(extent, said))
    choice.question =
        tr("expected an organ of 0.1 mL to 20 L, got {} with coordinates in {}; {} sets another unit ({})",
           size_in_words(extent, said), unit_in_words(said), by, guess.words);
  else if (said == 0 && guess.metres == 0 && longest_side(extent.box) > 0)
    choice.question =
        tr("expected the unit of its coordinates by {}, got none and a size that suggests none ({})", by, guess.words);
  else if (said == 0 && guess.metres > 0)
    choice.note = tr("coordinates are taken as {}, guessed from the size ({}); {} sets another unit",
                     unit_in_words(guess.metres), guess.words, by);
  return choice;
}

}  // namespace trocar::geometry
