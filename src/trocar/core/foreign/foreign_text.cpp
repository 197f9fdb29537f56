#include <algorithm>
#include <array>

#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/letters.hpp>

namespace trocar::core {
namespace {

constexpr std::string_view kBlank = " \t\r\n";
constexpr std::size_t kLongestRoot = 40;  // letters of a name that is shown

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool begins_with(std::string_view text, std::string_view word) {
  return text.size() >= word.size() &&
         std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) { return a == small_letter(b); });
}

std::string_view without_mark(std::string_view text) {
  return text.substr(0, 3) == "\xef\xbb\xbf" ? text.substr(3) : text;
}
std::string_view without_blank(std::string_view text) {
  const std::size_t at = text.find_first_not_of(kBlank);
  return at == text.npos ? std::string_view() : text.substr(at);
}

/// Past what stands before the first element; empty where that is nothing.
std::string_view from_first_element(std::string_view text) {
  for (text = without_blank(without_mark(text)); !text.empty() && text[0] == '<'; text = without_blank(text)) {
    const char* end = begins_with(text, "<?")     ? "?>"
                      : begins_with(text, "<!--") ? "-->"
                      : begins_with(text, "<!")   ? ">"
                                                  : nullptr;
    if (!end) return text;
    const std::size_t at = text.find(end);
    if (at == text.npos) return {};
    text.remove_prefix(at + std::string_view(end).size());
  }
  return {};
}

}  // namespace

const char* wide_encoding(std::string_view bytes) {
  const auto is_text = [&bytes](std::size_t at) { return bytes[at] >= ' ' && bytes[at] <= '~'; };
  using namespace std::string_view_literals;
  if (bytes.substr(0, 4) == "\xff\xfe\0\0"sv || bytes.substr(0, 4) == "\0\0\xfe\xff"sv) return "UTF-32";
  if (bytes.substr(0, 2) == "\xff\xfe" || bytes.substr(0, 2) == "\xfe\xff") return "UTF-16";
  if (bytes.size() < 4) return nullptr;
  const bool little = is_text(0) && bytes[1] == 0 && is_text(2) && bytes[3] == 0;
  const bool big = bytes[0] == 0 && is_text(1) && bytes[2] == 0 && is_text(3);
  return little || big ? "UTF-16" : nullptr;
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    if (length == 0 || at + length > text.size()) return false;
    for (std::size_t i = 1; i < length; ++i)
      if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return false;
    at += length;
  }
  return true;
}

std::string xml_root(std::string_view text) {
  text = from_first_element(text);
  if (text.size() < 2 || !is_letter(text[1])) return {};
  const std::size_t end = text.find_first_of(" \t\r\n/>", 1);
  return std::string(text.substr(1, std::min(end == text.npos ? text.size() : end, kLongestRoot + 1) - 1));
}

bool looks_like_page(std::string_view text) {
  text = without_blank(without_mark(text));
  return begins_with(text, "<!doctype html") || begins_with(text, "<html");
}

// The first line that is neither empty nor a comment has a key, or begins a document or a list.
bool looks_like_yaml(std::string_view text) {
  for (text = without_mark(text); !text.empty();) {
    const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.find_first_not_of(kBlank) == line.npos || line[0] == '#') continue;
    if (begins_with(line, "%yaml") || line == "---" || begins_with(line, "--- ") || begins_with(line, "- "))
      return true;
    const std::size_t colon = line.find(':');
    if (colon == line.npos || !is_letter(line[0])) return false;
    const bool plain = line.substr(0, colon).find_first_of("{}[]\",/<>") == line.npos;
    return plain && (colon + 1 == line.size() || line[colon + 1] == ' ');
  }
  return false;
}

}  // namespace trocar::core
