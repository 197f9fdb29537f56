#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/ply_header.hpp>
#include <trocar/geometry/surface_files/surface_reader.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostPlyItems = 256;  ///< elements, and properties of one

struct NamedPlyType {
  const char* name;
  PlyType type;
};
constexpr NamedPlyType kPlyTypes[] = {
    {"char", {1, true, true}},     {"int8", {1, true, true}},     {"uchar", {1, true, false}},
    {"uint8", {1, true, false}},   {"short", {2, true, true}},    {"int16", {2, true, true}},
    {"ushort", {2, true, false}},  {"uint16", {2, true, false}},  {"int", {4, true, true}},
    {"int32", {4, true, true}},    {"uint", {4, true, false}},    {"uint32", {4, true, false}},
    {"float", {4, false, true}},   {"float32", {4, false, true}}, {"double", {8, false, true}},
    {"float64", {8, false, true}},
};

class PlyHeaderReader {
 public:
  explicit PlyHeaderReader(MeshSource& in) : m_in(in) {}

  PlyHeader read() {
    m_in.line();  // ply
    while (!m_ended) line();
    m_in.finish();
    if (!m_have_form) m_in.lose(0, "expected a format, such as 'format ascii 1.0', got none");
    for (PlyElement& element : m_header.elements) check(element);
    return std::move(m_header);
  }

 private:
  MeshSource& m_in;
  PlyHeader m_header;
  bool m_have_form = false, m_ended = false;

  void line() {
    const std::string_view word = m_in.peek_word();
    const std::size_t at = m_in.at();
    if (word.empty()) m_in.lose(at, "expected end_header, got the end of the file");
    if (word == "comment" || word == "obj_info") {
      take_head(m_header.head, m_in.line());
      return;
    }
    m_in.word();
    if (word == "end_header") {
      m_ended = true;
    } else if (word == "format") {
      form();
    } else if (word == "element") {
      element();
    } else if (word == "property") {
      property(at);
    } else {
      m_in.lose(at, tr("expected format, element, property or end_header, got {}", m_in.shown(at)));
    }
    m_in.line();
  }

  std::string_view next(std::size_t& at) {
    const bool there = m_in.word_on_line();
    at = m_in.at();
    return there ? m_in.word() : std::string_view{};
  }

  void form() {
    std::size_t at = 0;
    const std::string_view word = next(at);
    m_have_form = true;
    if (word == "binary_little_endian")
      m_header.form = MeshSource::Form::binary;
    else if (word == "binary_big_endian")
      m_header.form = MeshSource::Form::binary_swapped;
    else if (word != "ascii")
      m_in.lose(at, tr("expected ascii, binary_little_endian or binary_big_endian, got {}", m_in.shown(at)));
  }

  void element() {
    PlyElement element;
    element.name = std::string(next(element.at).substr(0, 100));
    m_in.set_records_on_lines(true);
    element.count = m_in.count("items", 1);
    m_in.set_records_on_lines(false);
    if (m_header.elements.size() == kMostPlyItems)
      m_in.lose(element.at, tr("expected at most {} elements, got more", kMostPlyItems));
    m_header.elements.push_back(std::move(element));
  }

  PlyType type() {
    std::size_t at = 0;
    const std::string_view word = next(at);
    for (const NamedPlyType& known : kPlyTypes)
      if (word == known.name) return known.type;
    m_in.lose(at, tr("expected a type such as float or uchar, got {}", m_in.shown(at)));
  }

  void property(std::size_t at) {
    if (m_header.elements.empty()) m_in.lose(at, "expected an element in front of its properties, got none");
    std::vector<PlyProperty>& properties = m_header.elements.back().properties;
    PlyProperty property;
    std::size_t type_at = 0;
    const std::size_t here = m_in.at();
    if (next(type_at) == "list") {
      property.is_list = true;
      property.length = type();
      if (!property.length.whole) m_in.lose(type_at, "expected a list whose length is a whole number, got another one");
    } else {
      m_in.go_to(here);
    }
    property.type = type();
    property.name = std::string(next(at).substr(0, 100));
    if (properties.size() == kMostPlyItems)
      m_in.lose(at, tr("expected at most {} properties of an element, got more", kMostPlyItems));
    properties.push_back(std::move(property));
  }

  /// There must be room for what is announced: a byte a number in binary files, two in text.
  void check(PlyElement& element) {
    if (element.properties.empty()) element.count = 0;
    std::size_t least = 0;
    for (const PlyProperty& p : element.properties) {
      const bool text = m_header.form == MeshSource::Form::text;
      least += text ? 2 : std::size_t(p.is_list ? p.length.width : p.type.width);
    }
    if (least > 0 && element.count > (m_in.left() + 1) / least)
      m_in.lose(element.at, tr("expected at most {} items, for which the {} bytes that follow have room, got {} "
                               "announced",
                               (m_in.left() + 1) / least, m_in.left(), element.count));
  }
};

}  // namespace

const PlyProperty* PlyElement::find(std::string_view name_of_property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == name_of_property; });
  return found == properties.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(MeshSource& in) { return PlyHeaderReader(in).read(); }

}  // namespace trocar::geometry
