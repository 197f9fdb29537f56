// What a fact says, and what a condition makes of it. Where something is gone or was never there, neither a condition
// nor its negation may count: such a value is unknown.
#pragma once

namespace trocar::training {

enum class TriState { no, unknown, yes };

constexpr TriState tri_state(bool b) { return b ? TriState::yes : TriState::no; }
constexpr TriState negated(TriState t) { return t == TriState::unknown ? t : tri_state(t == TriState::no); }

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
