// The numbers that decide in an exercise: each with a name that ends in its unit, a value or a range, and where it
// comes from. They are reported in results.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/training/facts/unit.hpp>

namespace trocar::training {

struct Limit {
  /// Which way a limit of common rules is stricter; an exercise may move it that way only.
  enum class Stricter { either, low, high };

  std::string name;          ///< "first_clip_mm"
  double low = 0, high = 0;  ///< as the file writes them; of a single number both are it
  bool is_range = false;
  bool broken = false;  ///< a fault has been reported; nothing more is said of it
  std::string source;
  Stricter stricter = Stricter::either;
  core::Location at;
  /// What it is in patients of another anatomy.
  struct Elsewhere {
    std::string anatomy;
    double low = 0, high = 0;
  };
  std::vector<Elsewhere> elsewhere;

  const Unit& unit() const { return unit_of(name); }
  double si() const { return low * unit().si; }  ///< of a single number
  double si_low() const { return low * unit().si; }
  double si_high() const { return high * unit().si; }
  std::string shown() const;  ///< "15", "12 to 20"
};
using Limits = std::vector<Limit>;

/// As they are in patients of this anatomy (sim::Model::anatomy).
Limits limits_in(Limits limits, std::string_view anatomy);

/// Null: there is none of that name.
const Limit* find_limit(const Limits& limits, std::string_view name);

}  // namespace trocar::training
