// How near a condition is to being fulfilled: what it consists of as rows with value, target and unit, for the trainee.
// Derived from the condition itself. Of alternatives ("any") those rows are shown that are nearest.
//
//   for (const Nearness& row : nearness(rule.when, snapshot, rules.names()))
//     show(row.label, row.value, row.low, row.high);
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/training/rules/condition.hpp>

namespace trocar::training {

struct Nearness {
  std::string label;  ///< "Distance", "Needle held: left"; in the user's language
  std::string unit;   ///< "mm", "%"; empty: a plain number, or a truth
  bool is_truth = false;
  bool wanted = true;    ///< of a truth
  bool known = false;    ///< false: nothing can be said now (out of view ...)
  bool outside = false;  ///< the value has to lie outside [low, high]
  double value = 0;      ///< in the unit; of a truth 1 or 0
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool fulfilled = false;
  double share = 0;  ///< 0 far .. 1 fulfilled

  const Fact* fact = nullptr;  ///< null: a step, or something that is not a fact
  int watch = -1;
  std::string subject;  ///< what the fact is about, part of the label where rows differ in it

  /// "40 to 60 mm", "max 5 N", "min 1 s"; empty for a truth.
  std::string target() const;
  std::string shown_value() const;  ///< "52"; "-" where nothing is known
};

/// @param names  titles of what the scene names
std::vector<Nearness> nearness(const Condition& condition, const Snapshot& snapshot, const Names& names);

/// No more than `most` rows: those of one fact become a count, then fulfilled ones give way.
std::vector<Nearness> in_short(std::vector<Nearness> rows, std::size_t most);

/// A number against one bound, as a row.
Nearness counted(std::string label, double value, double least, std::string unit);

}  // namespace trocar::training
