// How a condition holds a number against its limits.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <trocar/training/facts/value.hpp>
#include <trocar/training/rules/names.hpp>

namespace trocar::training {

/// min and max are inclusive, above and below are not. A truth is 1 or 0.
struct Test {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool beyond_low = false, beyond_high = false;  ///< above low, below high
  bool of_size = false;                          ///< of the number without its sign

  TriState of(const Value& value) const {
    if (!value.known) return TriState::unknown;
    const double v = of_size && value.number < 0 ? -value.number : value.number;
    return tri_state((beyond_low ? v > low : v >= low) && (beyond_high ? v < high : v <= high));
  }
  /// "12 to 20", "at most 15", "more than 30", "2", "yes": in a unit, for people.
  std::string shown(const Unit& unit, bool is_truth) const;
};

/// What may be tested: a fact or an attribute of an event.
struct Tested {
  std::string_view name;
  double low = 0, high = 0;  ///< that it can be, in its unit; equal: anything
  bool is_truth = false, is_count = false;
};

/// The keys of a test: min, max, above, below, in, min_abs, max_abs, is.
const std::vector<std::string>& test_keys();

/// The test that an object's keys say. Nothing: a fault has been reported, also where they say none or one that nothing
/// can pass.
std::optional<Test> read_test(const scene::JsonValue& object, const Tested& tested, const RuleReading& reading);
/// Of an attribute: such an object, or in short a truth, a range, or a number that is counted.
std::optional<Test> read_short_test(const scene::JsonValue& value, const Tested& tested, const RuleReading& reading);

}  // namespace trocar::training
