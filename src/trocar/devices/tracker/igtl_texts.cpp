#include <algorithm>

#include <trocar/core/letters.hpp>
#include <trocar/devices/tracker/igtl_texts.hpp>

namespace trocar::devices {
namespace {

constexpr std::size_t kExtendedHeader = 12, kTableEntry = 8;
constexpr std::size_t kMostTexts = 1024;  // of a message; of more none is read
constexpr char kWholeName[] = "IGTL_DEVICE_NAME";
constexpr std::size_t kLongestWord = 40;  // of a status that is shown

bool begins(const std::string& text, const std::string& with) { return text.compare(0, with.size(), with) == 0; }
bool ends(const std::string& text, const std::string& with) {
  return text.size() >= with.size() && text.compare(text.size() - with.size(), with.size(), with) == 0;
}

/// Keys and values follow each other in `texts`; the table has their sizes.
IgtlTexts read_texts(IgtlBytes table, IgtlBytes texts) {
  IgtlTexts out;
  if (table.size() < 2 || table.size() != 2 + kTableEntry * big_endian(table.first(2))) return out;
  if (table.size() > 2 + kTableEntry * kMostTexts) return out;
  for (table = table.subspan(2); !table.empty(); table = table.subspan(kTableEntry)) {
    const std::size_t key = std::size_t(big_endian(table.first(2)));
    const std::size_t value = std::size_t(big_endian(table.subspan(4, 4)));
    if (key > texts.size() || value > texts.size() - key) return {};
    out.emplace_back(igtl_text(texts.first(key)), igtl_text(texts.subspan(key, value)));
    texts = texts.subspan(key + value);
  }
  return out;
}

/// Upper case, without the prefix that older versions of PLUS write.
std::string status_word(const std::string& text) {
  const std::string word = core::in_capitals(text.substr(0, kLongestWord));
  return begins(word, "TOOL_") ? word.substr(5) : word;
}

bool is_seen_word(const std::string& word) {
  return word == "OK" || word == "VALID" || word == "TRUE" || word == "1" || begins(word, "SWITCH");
}

/// Does a text with this key say whether the tool is seen?
bool is_about(const std::string& key, const std::string& element, const char* suffix) {
  if (!ends(key, suffix)) return false;
  const std::string of = key.substr(0, key.size() - std::string(suffix).size());
  if (of.empty() || of == "Transform" || of == "Tool") return true;  // of all that the message is about
  if (element.empty()) return false;
  return of == element || of == element + "Transform" || (element.size() == kIgtlName && begins(of, element));
}

/// What the texts say of the tool: one that says "not seen" counts before others. Empty: none says anything.
std::string word_about(const IgtlTexts& texts, const std::string& element) {
  std::string said;
  for (const char* suffix : {"Status", "Valid"})
    for (const auto& [key, value] : texts) {
      if (value.empty() || !is_about(key, element, suffix)) continue;
      said = status_word(value);
      if (!is_seen_word(said)) return said;
    }
  return said;
}

}  // namespace

IgtlBody split_body(int version, IgtlBytes body) {
  if (version < 2 || body.size() < kExtendedHeader) return {body, {}};
  const std::uint64_t extended = big_endian(body.first(2)), table = big_endian(body.subspan(2, 2)),
                      texts = big_endian(body.subspan(4, 4));
  if (extended < kExtendedHeader || extended + table + texts > body.size()) return {body, {}};
  const std::size_t content = std::size_t(body.size() - extended - table - texts);
  const IgtlBytes after = body.subspan(std::size_t(extended) + content);
  return {body.subspan(std::size_t(extended), content),
          read_texts(after.first(std::size_t(table)), after.subspan(std::size_t(table)))};
}

bool same_tool_name(const std::string& one, const std::string& other) noexcept {
  if (one == other) return true;
  const std::string& shorter = one.size() < other.size() ? one : other;
  const std::string& longer = one.size() < other.size() ? other : one;
  return shorter.size() == kIgtlName && begins(longer, shorter);
}

std::string whole_name(const IgtlTexts& texts, const std::string& cut) {
  for (const auto& [key, value] : texts)
    if (key == kWholeName && !value.empty() && value.size() <= kLongestName) return value;
  if (cut.size() < kIgtlName) return cut;
  for (const auto& [key, value] : texts)
    if (value.size() > kIgtlName && value.size() <= kLongestName && begins(value, cut)) return value;
  return cut;
}

std::string whole_element_name(const IgtlTexts& texts, const std::string& cut) {
  if (cut.size() < kIgtlName) return cut;
  std::string whole = cut;
  int found = 0;
  for (const auto& [key, value] : texts) {
    if (key.size() > kLongestName || !begins(key, cut) || !ends(key, "Status")) continue;
    whole = key.substr(0, key.size() - 6);
    if (ends(whole, "Transform") && whole.size() > kIgtlName + 9) whole.resize(whole.size() - 9);
    ++found;
  }
  return found == 1 && whole.size() > kIgtlName ? whole : cut;  // of two, nobody knows which it is
}

std::string why_unseen(const IgtlTexts& texts, const std::string& element) {
  const std::string word = word_about(texts, element);
  if (word.empty() || is_seen_word(word)) return {};
  return word == "FALSE" || word == "0" ? "INVALID" : word;
}

bool is_called_seen(const IgtlTexts& texts, const std::string& element) {
  return is_seen_word(word_about(texts, element));
}

}  // namespace trocar::devices
