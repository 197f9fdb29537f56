#include <cmath>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/json_grammar.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/json_items.hpp>

namespace trocar::geometry {
namespace {

bool is_json_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Four hexadecimal digits, which stand there.
unsigned code_unit(std::string_view text, std::size_t at) {
  unsigned code = 0;
  for (std::size_t k = 0; k < 4; ++k) code = 16 * code + unsigned(core::hex_digit(text[at + k]));
  return code;
}

}  // namespace

JsonItems::JsonItems(MeshSource& in, std::string_view text)
    : m_in(in), m_text(text), m_offset(std::size_t(text.data() - in.all().data())) {
  skip_space();
  value(0);
  skip_space();
  if (m_at < m_text.size()) lose("the end of the JSON");
}

void JsonItems::lose(const char* expected) const {
  const std::size_t at = m_offset + m_at;
  m_in.lose(at, tr("expected {}, got {}", expected, m_at < m_text.size() ? m_in.shown(at) : "the end of the JSON"));
}

void JsonItems::skip_space() {
  while (is_json_space(next_char())) ++m_at;
}

bool JsonItems::take(char c) {
  skip_space();
  const bool there = m_at < m_text.size() && m_text[m_at] == c;
  m_at += there;
  return there;
}

int JsonItems::value(int level) {
  skip_space();
  if (level > kMostLevels) lose("at most 64 levels of arrays and objects");
  if (m_items.size() == kMostValues) lose("at most two million values");
  const int item = int(m_items.size());
  m_items.emplace_back();
  m_items[item].at = m_offset + m_at;
  const char c = next_char();
  if (c == '{' || c == '[') {
    ++m_at;
    m_items[item].kind = c == '{' ? Kind::object : Kind::array;
    members(item, c == '{' ? '}' : ']', level);
  } else if (c == '"') {
    m_items[item].kind = Kind::string;
    m_items[item].text = string();
  } else if (c == '-' || (c >= '0' && c <= '9')) {
    number_into(m_items[item]);
  } else {
    word_into(m_items[item]);
  }
  return item;
}

void JsonItems::members(int item, char end, int level) {
  if (take(end)) return;
  int last = -1;
  do {
    std::string_view key;
    if (end == '}') {
      skip_space();
      if (next_char() != '"') lose("a key in quotes");
      key = string();
      if (!take(':')) lose("':' after a key");
    }
    const int child = value(level + 1);
    m_items[child].key = key;
    (last < 0 ? m_items[item].first : m_items[last].next) = child;
    last = child;
  } while (take(','));
  if (!take(end)) lose(end == '}' ? "',' or '}'" : "',' or ']'");
}

void JsonItems::number_into(Item& item) {
  const std::size_t from = m_at;
  while (core::is_decimal(m_text.substr(m_at, 1)) ||
         (m_at < m_text.size() && std::string_view("+-.eE").find(m_text[m_at]) != std::string_view::npos))
    ++m_at;
  const std::string_view word = m_text.substr(from, m_at - from);
  const bool good = core::is_json_number(word);
  if (good) item.number = core::to_double(word);
  item.kind = Kind::number;
  if (good && std::isfinite(item.number)) return;
  m_at = from;
  lose("a number");
}

std::string_view JsonItems::string() {
  const std::size_t from = ++m_at;
  while (next_char() != '"') {
    if (m_at >= m_text.size()) lose("'\"' at the end of a string");
    if (static_cast<unsigned char>(m_text[m_at]) < 0x20) lose("a string without control characters");
    if (m_text[m_at] != '\\') {
      ++m_at;
      continue;
    }
    const char kind = m_at + 1 < m_text.size() ? m_text[m_at + 1] : '\0';
    const bool unicode = kind == 'u' && m_at + 6 <= m_text.size() && core::hex_digit(m_text[m_at + 2]) >= 0 &&
                         core::hex_digit(m_text[m_at + 3]) >= 0 && core::hex_digit(m_text[m_at + 4]) >= 0 &&
                         core::hex_digit(m_text[m_at + 5]) >= 0;
    if (!unicode && (kind == '\0' || std::string_view("\"\\/bfnrt").find(kind) == std::string_view::npos))
      lose("an escape such as \\n or \\u00e9");
    m_at += unicode ? 6 : 2;
  }
  return m_text.substr(from, m_at++ - from);
}

void JsonItems::word_into(Item& item) {
  const std::string_view rest = m_text.substr(m_at);
  for (const std::string_view word : {"null", "true", "false"})
    if (rest.substr(0, word.size()) == word) {
      m_at += word.size();
      item.kind = word == "null" ? Kind::null : Kind::boolean;
      item.number = word == "true";
      return;
    }
  lose("a value");
}

int JsonItems::member(int item, std::string_view key) const {
  if (item < 0 || m_items[item].kind != Kind::object) return -1;
  for (int child = m_items[item].first; child >= 0; child = m_items[child].next)
    if (m_items[child].key == key) return child;
  return -1;
}

std::vector<int> JsonItems::items(int item) const {
  std::vector<int> out;
  if (item < 0) return out;
  for (int child = m_items[item].first; child >= 0; child = m_items[child].next) out.push_back(child);
  return out;
}

std::string JsonItems::text(int item) const {
  const std::string_view raw = m_items[item].text;
  std::string out;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      out += raw[i];
      continue;
    }
    const char kind = raw[++i];
    constexpr std::string_view from = "bfnrt", to = "\b\f\n\r\t";
    if (kind != 'u') {
      out += from.find(kind) == from.npos ? kind : to[from.find(kind)];
      continue;
    }
    unsigned code = code_unit(raw, i + 1);
    i += 4;
    const bool pair = code >= 0xd800 && code < 0xdc00 && raw.substr(i + 1, 2) == "\\u";
    const unsigned low = pair ? code_unit(raw, i + 3) : 0;
    if (low >= 0xdc00 && low < 0xe000) {
      code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
      i += 6;
    }
    core::append_utf8(out, code >= 0xd800 && code < 0xe000 ? 0xfffd : code);
  }
  return out;
}

std::string JsonItems::shown(int item) const {
  if (item < 0) return "none";
  switch (m_items[item].kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return m_items[item].number != 0 ? "true" : "false";
    case Kind::number:
      return fmt::format("{}", m_items[item].number);
    case Kind::string:
      return in_quotes(m_items[item].text);
    case Kind::array:
      return "an array";
    case Kind::object:
      break;
  }
  return "an object";
}

}  // namespace trocar::geometry
