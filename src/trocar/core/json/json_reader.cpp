#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/json/json_grammar.hpp>
#include <trocar/core/json/json_reader.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>

namespace trocar::core {
namespace {

using Kind = JsonValue::Kind;

struct Place {
  int line = 1, column = 1;
};

/// Length in bytes of the UTF-8 character that starts at `at`, 0 where the bytes are none.  [RFC 3629 section 4]
int utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const int length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
  for (int i = 1; i < length; ++i)
    if ((byte(at + std::size_t(i)) & 0xc0) != 0x80) return 0;
  const unsigned second = byte(at + 1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second >= 0xa0;
  const bool beyond = first == 0xf4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

bool is_number_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) {
  return is_number_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '+' || c == '-' ||
         c == '.';
}

bool looks_not_finite(std::string_view word) {
  std::string lower;
  for (const char c : word)
    if (c != '+' && c != '-') lower.push_back(small_letter(c));
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

/// As a fault shows it: short, and nothing that a terminal would obey.
std::string shortened(std::string_view text) {
  constexpr std::size_t limit = 40;
  if (text.size() <= limit) return printable(text);
  std::size_t end = limit;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return printable(text.substr(0, end)) + "...";
}

/// Recursion is bounded by kMaxJsonDepth, so the depth of the input never meets the depth of the machine's stack.
class Parser {
 public:
  Parser(std::string_view text, const std::string& file, std::vector<Fault>& faults, const JsonLimits& limits)
      : m_text(text), m_file(file), m_faults(faults), m_limits(limits) {}

  JsonValue document() {
    JsonValue root = broken({1, 1});
    if (!well_encoded()) return root;
    if (m_text.substr(0, 3) == "\xef\xbb\xbf") m_at = 3;
    skip_space();
    if (m_lost) return root;
    if (at_end()) {
      lost(m_place, "expected a value, got the end of the file");
      return root;
    }
    root = value(0);
    skip_space();
    if (!m_lost && !at_end()) lost(m_place, tr("expected the end of the file, got {}", here()));
    return root;
  }
  bool is_lost() const { return m_lost; }
  int values() const { return m_values; }

 private:
  std::string_view m_text;
  const std::string& m_file;
  std::vector<Fault>& m_faults;
  const JsonLimits& m_limits;
  std::size_t m_at = 0;
  Place m_place;
  int m_values = 0;
  bool m_has_nul = false;  ///< the string that is being read
  bool m_lost = false;     ///< the structure cannot be followed any further

  bool at_end() const { return m_at >= m_text.size(); }
  char peek(std::size_t ahead = 0) const { return m_at + ahead < m_text.size() ? m_text[m_at + ahead] : '\0'; }
  void next() {
    if (at_end()) return;
    const char c = m_text[m_at++];
    if (c == '\n') {
      ++m_place.line;
      m_place.column = 1;
    } else if (m_at >= m_text.size() || (static_cast<unsigned char>(m_text[m_at]) & 0xc0) != 0x80) {
      ++m_place.column;  // counted at a character's last byte
    }
  }

  void fault(Place at, std::string message) {
    tell(m_faults, {{m_file, at.line, at.column}, std::move(message)});
    m_lost = m_lost || m_faults.size() > kMaxFaults;  // nothing more is reported
  }
  void lost(Place at, std::string message) {
    if (!m_lost) fault(at, std::move(message));
    m_lost = true;
  }
  static JsonValue made(Place at, Kind kind) {
    JsonValue v;
    v.kind = kind;
    v.line = at.line;
    v.column = at.column;
    return v;
  }
  static JsonValue broken(Place at) { return made(at, Kind::broken); }

  /// What stands at the cursor, as a fault shows it.
  std::string here() const {
    if (at_end()) return "the end of the file";
    if (is_word(peek())) {
      std::size_t n = 0;
      while (m_at + n < m_text.size() && is_word(peek(n))) ++n;
      return shortened(m_text.substr(m_at, n));
    }
    if (peek() == '"') return "a string";
    if (static_cast<unsigned char>(peek()) < 0x20) return tr("control character 0x{:02x}", int(peek()));
    const int length = utf8_length(m_text, m_at);
    return fmt::format("'{}'", printable(m_text.substr(m_at, std::size_t(length))));
  }

  bool well_encoded() {
    for (std::size_t i = 0; i < m_text.size();) {
      const int length = utf8_length(m_text, i);
      if (length == 0) {
        while (m_at < i) next();
        lost(m_place, tr("expected UTF-8 text, got the byte 0x{:02x}", static_cast<unsigned char>(m_text[i])));
        return false;
      }
      i += std::size_t(length);
    }
    return true;
  }

  void skip_space() {
    while (!at_end() && !m_lost) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
        next();
      } else if (c == '/' && peek(1) == '/') {
        while (!at_end() && peek() != '\n') next();
      } else if (c == '/' && peek(1) == '*') {
        skip_block_comment();
      } else {
        return;
      }
    }
  }

  void skip_block_comment() {
    const Place begin = m_place;
    next(), next();
    while (!at_end() && !(peek() == '*' && peek(1) == '/')) next();
    if (at_end()) return lost(begin, "expected '*/' to close this comment, got the end of the file");
    next(), next();
  }

  JsonValue value(int depth) {
    const std::size_t from = m_at;
    JsonValue v = value_here(depth);
    v.from = std::uint32_t(from);
    v.to = std::uint32_t(m_at);
    return v;
  }

  JsonValue value_here(int depth) {
    const Place at = m_place;
    if (++m_values > m_limits.values) {
      lost(at, tr("expected at most {} values in a file, got more", m_limits.values));
      return broken(at);
    }
    const char c = peek();
    if ((c == '{' || c == '[') && depth >= kMaxJsonDepth) {
      lost(at, tr("expected at most {} levels of nesting, got more", kMaxJsonDepth));
      return broken(at);
    }
    if (c == '{') return object(depth);
    if (c == '[') return array(depth);
    if (c == '"') return string();
    if (is_word(c)) return word();
    lost(at, tr("expected a value, got {}", here()));
    return broken(at);
  }

  JsonValue word() {
    const Place at = m_place;
    std::string text;
    while (is_word(peek())) {
      text.push_back(peek());
      next();
    }
    if (text == "null") return made(at, Kind::null);
    if (text == "true" || text == "false") {
      JsonValue v = made(at, Kind::boolean);
      v.truth = text == "true";
      return v;
    }
    if (is_json_number(text)) {
      JsonValue v = made(at, Kind::number);
      v.number = to_double(text);
      if (std::isfinite(v.number)) return v;
    }
    const std::string message = tr("expected {}, got {}", wanted_instead_of(text), shortened(text));
    if (at_end())
      lost(at, message);  // a file cut off inside a word: what follows from that is not worth telling
    else
      fault(at, message);
    return broken(at);
  }

  static const char* wanted_instead_of(const std::string& word) {
    if (is_json_number(word) || looks_not_finite(word)) return "a finite number";
    const bool numeric = is_number_digit(word[0]) || word[0] == '-' || word[0] == '+' || word[0] == '.';
    return numeric ? "a number as JSON writes it (like -0.5 or 2e-3)" : "a value";
  }

  JsonValue string() {
    const Place at = m_place;
    JsonValue v = made(at, Kind::string);
    next();
    while (!m_lost) {
      if (at_end() || peek() == '\n') {
        const char* what = at_end() ? "the end of the file" : "the end of the line";
        lost(m_place, tr("expected '\"' to close the string that began at {}:{}, got {}", at.line, at.column, what));
      } else if (v.text.size() > m_limits.text_bytes) {
        lost(at, tr("expected a text of at most {} bytes, got a longer one", m_limits.text_bytes));
      } else if (peek() == '"') {
        next();
        return std::exchange(m_has_nul, false) ? broken(at) : v;
      } else if (static_cast<unsigned char>(peek()) < 0x20) {
        lost(m_place, tr("expected a character of a string, got control character 0x{:02x}", int(peek())));
      } else if (peek() == '\\') {
        escape(v.text);
      } else {
        plain(v.text);
      }
    }
    return broken(at);
  }

  /// Characters that stand for themselves, all at once: an embedded buffer of many megabytes is one string.
  void plain(std::string& out) {
    const std::size_t from = m_at;
    while (!at_end() && static_cast<unsigned char>(m_text[m_at]) >= 0x20 && m_text[m_at] != '"' &&
           m_text[m_at] != '\\') {
      ++m_at;
      m_place.column += at_end() || (static_cast<unsigned char>(m_text[m_at]) & 0xc0) != 0x80;
    }
    out.append(m_text, from, m_at - from);
  }

  void escape(std::string& out) {
    static constexpr std::string_view names = "\"\\/bfnrt", values = "\"\\/\b\f\n\r\t";
    const Place at = m_place;
    next();
    const char c = peek();
    if (c == 'u') {
      next();
      return unicode_escape(out, at);
    }
    const std::size_t which = at_end() ? names.npos : names.find(c);
    if (which == names.npos) return lost(at, tr("expected an escape like \\n or \\u00e4, got \\ and {}", here()));
    out.push_back(values[which]);
    next();
  }

  /// Four hexadecimal digits, or -1.
  int hex4() {
    int code = 0;
    for (int i = 0; i < 4; ++i) {
      const int digit = hex_digit(peek());
      if (digit < 0) return -1;
      code = code * 16 + digit;
      next();
    }
    return code;
  }

  void unicode_escape(std::string& out, Place at) {
    const int first = hex4();
    if (first < 0) return lost(at, "expected four hexadecimal digits after \\u");
    if (first == 0) {
      m_has_nul = true;
      return fault(at, "expected a character of a text, got \\u0000");  // texts of the system end there
    }
    if (first < 0xd800 || first > 0xdfff) return append_utf8(out, unsigned(first));
    if (first < 0xdc00 && peek() == '\\' && peek(1) == 'u') {
      next(), next();
      const int second = hex4();
      if (second >= 0xdc00 && second <= 0xdfff)
        return append_utf8(out, 0x10000u + ((unsigned(first) - 0xd800u) << 10) + (unsigned(second) - 0xdc00u));
    }
    lost(at, "expected a pair of surrogates, \\ud800-\\udbff then \\udc00-\\udfff, got half of one");
  }

  /// After an item: true where another one follows; consumes the comma or the closing bracket.
  bool more(char close, Place begin, const char* what) {
    skip_space();
    if (m_lost) return false;
    if (peek() == close) {
      next();
      return false;
    }
    if (peek() != ',') {
      if (at_end())
        lost(m_place, tr("expected '{}' to close the {} that began at {}:{}, got the end of the file", close, what,
                         begin.line, begin.column));
      else
        lost(m_place, tr("expected ',' or '{}' in the {} that began at {}:{}, got {}", close, what, begin.line,
                         begin.column, here()));
      return false;
    }
    const Place comma = m_place;
    next();
    skip_space();
    if (m_lost || peek() != close) return !m_lost;
    fault(comma, tr("expected another item after ',', got '{}'", close));
    next();
    return false;
  }

  JsonValue array(int depth) {
    const Place begin = m_place;
    JsonValue v = made(begin, Kind::array);
    next();
    skip_space();
    if (peek() == ']') {
      next();
      return v;
    }
    do {
      if (at_end()) {
        lost(m_place, tr("expected ']' to close the array that began at {}:{}, got the end of the file", begin.line,
                         begin.column));
        break;
      }
      v.items.push_back(value(depth + 1));
    } while (!m_lost && more(']', begin, "array"));
    return v;
  }

  JsonValue object(int depth) {
    const Place begin = m_place;
    JsonValue v = made(begin, Kind::object);
    next();
    skip_space();
    if (peek() == '}') {
      next();
      return v;
    }
    Keys keys;
    do member(v, keys, begin, depth);
    while (!m_lost && more('}', begin, "object"));
    return v;
  }

  /// Of an object, once it has many.
  using Keys = std::set<std::string>;
  static const JsonMember* known(const JsonValue& object, Keys& keys, const std::string& key) {
    constexpr std::size_t kFew = 16;
    if (object.members.size() < kFew) return object.find(key);
    if (keys.empty())
      for (const JsonMember& m : object.members) keys.insert(m.key);
    return keys.insert(key).second ? nullptr : object.find(key);
  }

  void member(JsonValue& object, Keys& keys, Place begin, int depth) {
    const Place at = m_place;
    if (at_end())
      return lost(at, tr("expected '}}' to close the object that began at {}:{}, got the end of the file", begin.line,
                         begin.column));
    if (peek() != '"') return lost(at, tr("expected a key in double quotes, got {}", here()));
    JsonMember m;
    m.from = std::uint32_t(m_at);
    m.key = string().text;
    m.line = at.line;
    m.column = at.column;
    skip_space();
    if (m_lost) return;
    if (peek() != ':') return lost(m_place, tr("expected ':' after the key \"{}\", got {}", shortened(m.key), here()));
    next();
    skip_space();
    if (m_lost) return;
    if (at_end())
      return lost(m_place, tr("expected a value for the key \"{}\", got the end of the file", shortened(m.key)));
    m.value = value(depth + 1);
    if (const JsonMember* earlier = known(object, keys, m.key))
      return fault(at, tr("expected every key once, got \"{}\" again (first at {}:{})", shortened(m.key), earlier->line,
                          earlier->column));
    if (object.members.size() >= kMaxJsonKeys)
      return lost(at, tr("expected at most {} keys in an object, got more", kMaxJsonKeys));
    object.members.push_back(std::move(m));
  }
};

}  // namespace

void tell(std::vector<Fault>& faults, Fault fault) {
  if (faults.size() < kMaxFaults) return faults.push_back(std::move(fault));
  if (faults.size() == kMaxFaults) faults.push_back({fault.at, "expected fewer faults: further ones are not reported"});
}

const JsonMember* JsonValue::find(std::string_view key) const {
  for (const JsonMember& m : members)
    if (m.key == key) return &m;
  return nullptr;
}

JsonDocument parse_json(std::string_view text, std::string file, std::vector<Fault>& faults, const JsonLimits& limits) {
  JsonDocument document{std::move(file), {}};
  if (const std::string foreign = foreign_file(text, Wanted::json, document.file); !foreign.empty()) {
    document.root.kind = Kind::broken;
    tell(faults, {{document.file, 1, 1}, tr("expected JSON, got {}", foreign)});
    return document;
  }
  Parser parser(text, document.file, faults, limits);
  document.root = parser.document();
  document.values = parser.values();
  if (parser.is_lost()) document.root.kind = Kind::broken;  // its members still tell the file's kind
  return document;
}

std::string shown(const JsonValue& value) {
  switch (value.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return value.truth ? "true" : "false";
    case Kind::number:
      return fmt::format("{}", value.number);
    case Kind::string:
      return fmt::format("\"{}\"", shortened(value.text));
    case Kind::array:
      return value.items.empty() ? "an empty array" : "an array";
    case Kind::object:
      return "an object";
    case Kind::broken:
      break;
  }
  return "something unreadable";
}

}  // namespace trocar::core
