// Numbers in text, the same whatever the program's locale and standard library (floating from_chars is missing in older
// ones).
//
//   if (is_decimal(word)) x = to_double(word);
//   if (const auto count = to_integer(word)) ...
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace trocar::core {

/// A sign or none, digits with a point in front of, among, behind them or nowhere, an exponent or none. Not "inf",
/// "nan", hexadecimal, or spaces.
bool is_decimal(std::string_view word);

/// A decimal number's nearest double, infinite beyond the largest. The text must be a number.
double to_double(std::string_view decimal);

/// A whole number with a sign or none; nothing for other text and beyond 64 bits.
std::optional<std::int64_t> to_integer(std::string_view word);

}  // namespace trocar::core
