// Units of the numbers in exercise files. A name ends in its unit ("distance_mm", "pull_limit_N"), a name without one
// is a plain number; all values in memory are SI.
#pragma once

#include <span>
#include <string_view>

namespace trocar::training {

struct Unit {
  std::string_view suffix;  ///< "mm"; empty: a plain number
  double si = 1;            ///< of the file's number
  std::string_view words;   ///< "millimetres"
};

std::span<const Unit> units();
/// The unit that a name ends in; the plain number's where it ends in none.
const Unit& unit_of(std::string_view name);

}  // namespace trocar::training
