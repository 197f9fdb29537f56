// What a fact says, and what a condition makes of it. Where something is gone or was never there, neither a condition
// nor its negation may count: such a value is unknown.
#pragma once

namespace trocar::training {

enum class Truth { no, unknown, yes };

constexpr Truth truth(bool b) { return b ? Truth::yes : Truth::no; }
constexpr Truth negated(Truth t) { return t == Truth::unknown ? t : truth(t == Truth::no); }

/// A number in SI, or a truth as 1 and 0.
struct Value {
  double number = 0;
  bool known = false;

  constexpr Value() = default;
  constexpr Value(double v) : number(v), known(true) {}        // NOLINT: a fact's number is its value
  constexpr Value(bool v) : number(v ? 1 : 0), known(true) {}  // NOLINT: the same of a truth
};
inline constexpr Value kUnknown{};

}  // namespace trocar::training
