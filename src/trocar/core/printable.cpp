#include <fmt/format.h>

#include <trocar/core/printable.hpp>

namespace trocar::core {
namespace {

constexpr unsigned kHarmless = 0xffff;

/// The character that the bytes at `at` encode, as far as it is one that must not reach a terminal; else kHarmless.
/// @param length  of it, in bytes
unsigned unwanted(std::string_view text, std::size_t at, std::size_t& length) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at), second = byte(at + 1), third = byte(at + 2);
  length = 1;
  if (first < 0x20 || first == 0x7f) return first;
  if (first == 0xc2 && second >= 0x80 && second < 0xa0) {
    length = 2;
    return second;
  }
  // U+200E, U+200F, U+2028 to U+202E, U+2066 to U+2069
  const bool turns =
      first == 0xe2 && ((second == 0x80 && (third == 0x8e || third == 0x8f || (third >= 0xa8 && third <= 0xae))) ||
                        (second == 0x81 && third >= 0xa6 && third <= 0xa9));
  if (!turns) return kHarmless;
  length = 3;
  return 0x2000u | ((second & 0x3f) << 6) | (third & 0x3f);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t length = 1;
    const unsigned code = unwanted(text, at, length);
    if (code == kHarmless)
      out += text[at];
    else
      out += fmt::format("\\u{:04x}", code);
    at += length;
  }
  return out;
}

}  // namespace trocar::core
