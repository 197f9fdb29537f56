#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <string>

#include <locale.h>

#include <trocar/core/decimal.hpp>

namespace trocar::core {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t after_sign(std::string_view word) { return !word.empty() && (word[0] == '+' || word[0] == '-') ? 1 : 0; }

}  // namespace

bool is_decimal(std::string_view word) {
  std::size_t i = after_sign(word);
  const auto digits = [&] {
    const std::size_t from = i;
    while (i < word.size() && is_digit(word[i])) ++i;
    return i - from;
  };
  std::size_t mantissa = digits();
  if (i < word.size() && word[i] == '.') {
    ++i;
    mantissa += digits();
  }
  if (mantissa == 0) return false;
  if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
    ++i;
    if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == word.size();
}

double to_double(std::string_view decimal) {
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", locale_t{});
  std::array<char, 64> place{};  // strtod wants an end that it can see
  if (decimal.size() >= place.size()) return strtod_l(std::string(decimal).c_str(), nullptr, plain);
  std::copy(decimal.begin(), decimal.end(), place.begin());
  return strtod_l(place.data(), nullptr, plain);
}

std::optional<std::int64_t> to_integer(std::string_view word) {
  std::size_t i = after_sign(word);
  if (i == word.size()) return std::nullopt;
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  std::int64_t below = 0;  // minus the value: the negative side reaches one further
  for (; i < word.size(); ++i) {
    if (!is_digit(word[i])) return std::nullopt;
    const int digit = word[i] - '0';
    if (below < (least + digit) / 10) return std::nullopt;
    below = below * 10 - digit;
  }
  if (word[0] == '-') return below;
  if (below == least) return std::nullopt;
  return -below;
}

}  // namespace trocar::core
