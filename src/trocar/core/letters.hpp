// Small and capital letters of ASCII. The language of the machine changes nothing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace trocar::core {

constexpr char small_letter(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
constexpr char capital_letter(char c) noexcept { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string in_small_letters(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = small_letter(c);
  return out;
}

inline std::string in_capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = capital_letter(c);
  return out;
}

/// The same, but the first letter is a capital.
inline std::string with_capital(std::string text) {
  if (!text.empty()) text[0] = capital_letter(text[0]);
  return text;
}

/// Is it this word, in small or capital letters? @param word  in small letters
constexpr bool spells(std::string_view text, std::string_view word) noexcept {
  if (text.size() != word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (small_letter(text[i]) != word[i]) return false;
  return true;
}

/// Does it end so, in small or capital letters? @param ending  in small letters
constexpr bool ends_in(std::string_view text, std::string_view ending) noexcept {
  return text.size() >= ending.size() && spells(text.substr(text.size() - ending.size()), ending);
}

}  // namespace trocar::core
