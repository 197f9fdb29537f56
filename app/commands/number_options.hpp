// Numbers on the command line, checked before anything is done: decimal, finite and within bounds. Neither "nan", which
// is in no order with anything and so slips through comparisons, nor "-1" for a count, which would wrap, nor "010",
// which would be octal.
//
//   command->add_option("--from", o->from, "...")->check(number_between(0, kLongest, "s"));
//   command->add_option("--seed", o->seed, "...")->transform(whole_number(0, kLargestSeed));
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include <CLI/CLI.hpp>

namespace trocar::app {

inline constexpr double kLongestRecording = 14400;  ///< [s]
inline constexpr double kLongestRun = 86400;        ///< of what is simulated at a go [s]
inline constexpr std::int64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();  ///< that a store's row holds

/// A number in [low, high]. @param unit  for people, after the bounds; may be empty
CLI::Validator number_between(double low, double high, const std::string& unit);
/// A number in (low, high].
CLI::Validator number_above(double low, double high, const std::string& unit);
/// A whole number in [low, high]. For transform(): the text becomes plain decimal digits.
CLI::Validator whole_number(std::int64_t low, std::int64_t high);

}  // namespace trocar::app
