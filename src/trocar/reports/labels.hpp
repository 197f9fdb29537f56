// The words for what results hold: a title and a unit for each limit, detail and attribute that exercise files name.
// A name that the table does not know is written in words; its unit is that of its ending.
//
//   const Label label = label_of("blind_speed_mm_s");    // "Speed of a tip out of view", "mm/s", 1
//   quantity(5, label)                                   // "5 mm/s"
#pragma once

#include <string>
#include <string_view>

namespace trocar::reports {

struct Label {
  std::string title;
  std::string unit;  ///< symbol; empty: a plain number
  double scale = 1;  ///< from the file's number to the unit
};
Label label_of(std::string_view name);

/// "5 mm/s", "15°", "40 %"
std::string quantity(double value, const Label& label);
/// "40 to 60 mm"
std::string quantity(double from, double to, const Label& label);

/// The same with up to 3 decimals, no trailing zeros: "0.1", "12", "-52".
std::string plain_number(double value);

/// "left_lateral" -> "left lateral"; the first letter as a capital where `sentence`.
std::string in_plain_words(std::string_view name, bool sentence);

}  // namespace trocar::reports
