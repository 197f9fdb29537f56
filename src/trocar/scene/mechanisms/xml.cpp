#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/json/json_grammar.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/scene/mechanisms/xml.hpp>

namespace trocar::scene {
namespace {

constexpr int kMostLevels = 32, kMostElements = 100'000;
constexpr std::size_t kMostAttributes = 64, kLongestName = 200, kLongestValue = 10'000;

bool is_xml_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_xml_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.' || c == ':' || static_cast<unsigned char>(c) >= 0x80;
}

class XmlParser {
 public:
  XmlParser(std::string_view text, const std::string& file, std::vector<core::Fault>& faults)
      : m_text(text), m_file(file), m_faults(faults) {}

  XmlElement document() {
    XmlElement root;
    if (m_text.size() > kMaxXmlBytes) {
      lost(tr("at most {} bytes, got {}", kMaxXmlBytes, m_text.size()));
      return root;
    }
    if (starts("\xef\xbb\xbf")) skip(3);
    misc();
    if (m_lost) return root;
    if (peek() != '<') {
      lost(fmt::format("'<', got {}", here()));
      return root;
    }
    root = element(0);
    misc();
    if (!m_lost && m_at < m_text.size()) lost(tr("the end of the file after the root element, got {}", here()));
    return root;
  }

 private:
  char peek() const { return m_at < m_text.size() ? m_text[m_at] : '\0'; }
  bool at_end() const { return m_at >= m_text.size(); }
  bool starts(std::string_view what) const { return m_text.substr(m_at, what.size()) == what; }
  void next() {
    const char c = m_text[m_at++];
    if (c == '\n') {
      ++m_line;
      m_column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) {
      ++m_column;
    }
  }
  void skip(std::size_t count) {
    for (std::size_t i = 0; i < count && !at_end(); ++i) next();
  }
  void space() {
    while (!at_end() && is_xml_space(peek())) next();
  }
  std::string here() const {
    if (at_end()) return "the end of the file";
    const auto c = static_cast<unsigned char>(peek());
    return c < 0x20 || c >= 0x7f ? fmt::format("byte 0x{:02x}", int(c)) : fmt::format("'{}'", char(c));
  }
  void fault_at(int line, int column, const std::string& what) {
    tell(m_faults, {{m_file, line, column}, "expected " + what});
  }
  void lost(const std::string& what) {
    if (!m_lost) fault_at(m_line, m_column, what);
    m_lost = true;
  }

  /// Past `end`, or lost.
  void through(std::string_view end, const char* what) {
    const int line = m_line, column = m_column;
    while (!at_end() && !starts(end)) next();
    if (at_end()) {
      m_line = line;
      m_column = column;
      return lost(tr("\"{}\" to end the {} that begins here, got the end of the file", end, what));
    }
    skip(end.size());
  }

  /// Spaces, comments and instructions between elements. Text is passed over inside elements only.
  void misc(bool inside = false) {
    for (;;) {
      if (inside)
        while (!at_end() && peek() != '<') next();
      else
        space();
      if (m_lost) return;
      if (starts("<!--")) {
        skip(4);
        through("-->", "comment");
      } else if (starts("<?")) {
        through("?>", "instruction");
      } else if (inside && starts("<![CDATA[")) {
        through("]]>", "text");
      } else if (starts("<!")) {
        return lost("no document type (entities are not resolved), got \"<!\"");
      } else {
        return;
      }
      if (m_lost) return;
    }
  }

  std::string name(const char* what) {
    std::string out;
    while (!at_end() && is_xml_name(peek())) {
      out += peek();
      next();
      if (out.size() > kLongestName) {
        lost(tr("a name of at most {} characters", kLongestName));
        return out;
      }
    }
    if (out.empty()) lost(tr("the name of {}, got {}", what, here()));
    return out;
  }

  void entity(std::string& out) {
    const std::size_t semicolon = m_text.substr(m_at, 12).find(';');
    if (semicolon == std::string_view::npos) return lost("an entity like &amp; or &#65;, got '&'");
    const std::string_view word = m_text.substr(m_at + 1, semicolon - 1);
    constexpr std::pair<std::string_view, char> kBuiltIn[] = {
        {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    const auto* found =
        std::find_if(std::begin(kBuiltIn), std::end(kBuiltIn), [&](const auto& e) { return e.first == word; });
    if (found != std::end(kBuiltIn)) {
      out += found->second;
    } else {
      const bool hex = word.size() > 2 && word[0] == '#' && word[1] == 'x';
      unsigned code = 0;
      bool good = word.size() > 1 && word[0] == '#';
      for (std::size_t i = hex ? 2 : 1; good && i < word.size(); ++i) {
        const int digit = core::hex_digit(word[i]);
        good = digit >= 0 && (hex || digit < 10) && code < 0x110000;
        code = code * (hex ? 16u : 10u) + unsigned(std::max(digit, 0));
      }
      if (!good || code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
        return lost("an entity like &amp; or &#65;, got another");
      core::append_utf8(out, code);
    }
    skip(semicolon + 1);
  }

  void attribute(XmlElement& e) {
    XmlAttribute a;
    const int line = m_line, column = m_column;
    a.name = name("an attribute");
    space();
    if (m_lost) return;
    if (peek() != '=') return lost(tr("'=' after the attribute \"{}\", got {}", a.name, here()));
    next();
    space();
    const char quote = peek();
    if (quote != '"' && quote != '\'') return lost(tr("a value in quotes, got {}", here()));
    next();
    a.line = m_line;
    a.column = m_column;
    while (!m_lost && peek() != quote) {
      if (at_end() || peek() == '<') return lost(tr("{} to end the value, got {}", quote, here()));
      if (a.value.size() > kLongestValue) return lost(tr("a value of at most {} bytes, got more", kLongestValue));
      if (peek() == '&') {
        entity(a.value);
      } else {
        a.value += is_xml_space(peek()) ? ' ' : peek();
        next();
      }
    }
    if (m_lost) return;
    next();
    if (e.attribute(a.name)) return fault_at(line, column, tr("every attribute once, got \"{}\" again", a.name));
    if (e.attributes.size() >= kMostAttributes) return lost(tr("at most {} attributes, got more", kMostAttributes));
    e.attributes.push_back(std::move(a));
  }

  /// Stands at '<'.
  XmlElement element(int level) {
    XmlElement e;
    e.line = m_line;
    e.column = m_column;
    if (level >= kMostLevels) {
      lost(tr("at most {} levels, got more", kMostLevels));
      return e;
    }
    if (++m_count > kMostElements) {
      lost(tr("at most {} elements, got more", kMostElements));
      return e;
    }
    next();
    e.name = name("an element");
    for (space(); !m_lost && peek() != '>' && peek() != '/'; space()) {
      if (at_end()) lost("'>' to end the tag, got the end of the file");
      if (!m_lost) attribute(e);
    }
    if (m_lost) return e;
    if (peek() == '/') {
      next();
      if (peek() != '>') lost(tr("'>' after '/', got {}", here()));
      if (!m_lost) next();
      return e;
    }
    next();
    for (;;) {
      misc(true);
      if (m_lost) return e;
      if (at_end()) {
        lost(tr("\"</{}>\" to end the element of line {}, got the end of the file", e.name, e.line));
        return e;
      }
      if (starts("</")) break;
      e.children.push_back(element(level + 1));
      if (m_lost) return e;
    }
    const int line = m_line, column = m_column;
    skip(2);
    const std::string end = name("an element");
    space();
    if (!m_lost && (end != e.name || peek() != '>')) {
      m_line = line;
      m_column = column;
      lost(tr("\"</{}>\" to end the element of line {}, got \"</{}\"", e.name, e.line, end));
    }
    if (!m_lost) next();
    return e;
  }

  std::string_view m_text;
  const std::string& m_file;
  std::vector<core::Fault>& m_faults;
  std::size_t m_at = 0;
  int m_line = 1, m_column = 1, m_count = 0;
  bool m_lost = false;
};

/// The encoding that the first line declares, in capitals: "ISO-8859-1". Empty: none, which means UTF-8.
std::string declared_encoding(std::string_view text) {
  if (!text.starts_with("<?xml")) return {};
  text = text.substr(0, text.find("?>"));
  const std::size_t key = text.find("encoding");
  const std::size_t from = key == text.npos ? key : text.find_first_of("\"'", key);
  if (from == text.npos) return {};
  return core::in_capitals(text.substr(from + 1, text.find_first_of("\"'", from + 1) - from - 1).substr(0, 40));
}

struct XmlText {
  std::string converted;  ///< empty: the text is UTF-8 as it is
  std::string refused;    ///< an encoding that is not read
};
XmlText in_utf8(std::string_view text) {
  if (const char* wide = core::wide_encoding(text)) return {{}, wide};
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  if (std::all_of(text.begin(), text.end(), is_ascii)) return {};  // the same in every encoding that is left
  const std::string encoding = declared_encoding(text);
  if (encoding == "ISO-8859-1" || encoding == "LATIN1") {
    XmlText out;
    for (const char c : text) core::append_utf8(out.converted, static_cast<unsigned char>(c));
    return out;
  }
  if (!encoding.empty() && encoding != "UTF-8" && encoding != "UTF8") return {{}, core::printable(encoding)};
  return core::is_utf8(text) ? XmlText{} : XmlText{{}, tr("another encoding")};
}

}  // namespace

const XmlAttribute* XmlElement::attribute(std::string_view of) const {
  for (const XmlAttribute& a : attributes)
    if (a.name == of) return &a;
  return nullptr;
}
const XmlElement* XmlElement::child(std::string_view of) const {
  for (const XmlElement& e : children)
    if (e.name == of) return &e;
  return nullptr;
}

XmlElement parse_xml(std::string_view text, const std::string& file, std::vector<core::Fault>& faults) {
  const XmlText read = in_utf8(text);
  if (!read.refused.empty()) {
    tell(faults, {{file, 1, 1}, tr("expected text in UTF-8, got {}: save the file as UTF-8", read.refused)});
    return {};
  }
  return XmlParser(read.converted.empty() ? text : read.converted, file, faults).document();
}

}  // namespace trocar::scene
