#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/volumes/files/dicom_elements.hpp>
#include <trocar/volumes/files/raster.hpp>

namespace trocar::volumes {
namespace {

constexpr std::uint32_t kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr int kDeepestItem = 12;
constexpr std::size_t kMostElements = 2'000'000, kPreamble = 132;
constexpr std::size_t kMostInflated = std::size_t(1) << 30;

/// Sequences that the reader looks into; all others of known length are passed over.
constexpr std::uint32_t kWanted[] = {0x52009229, 0x52009230, 0x00209111, 0x00209113, 0x00209116, 0x00289110,
                                     0x00289145, 0x00283000, 0x00540022, 0x00189114, 0x00189117, 0x00189076,
                                     0x00189118, 0x00189226, 0x00189329, 0x00189314, 0x00189325};
bool is_wanted(std::uint32_t tag) {
  return std::find(std::begin(kWanted), std::end(kWanted), tag) != std::end(kWanted);
}

/// Representations whose length has 32 bits.
bool has_long_length(std::string_view vr) {
  for (const std::string_view known : {"OB", "OW", "OF", "OD", "OL", "OV", "SQ", "UT", "UN", "UC", "UR", "SV", "UV"})
    if (vr == known) return true;
  return false;
}
bool is_vr(std::string_view two) {
  return two.size() == 2 && two[0] >= 'A' && two[0] <= 'Z' && two[1] >= 'A' && two[1] <= 'Z';
}

struct Syntax {
  const char* uid;
  DicomPacking packing;
};
constexpr Syntax kPacked[] = {
    {"1.2.840.10008.1.2.5", DicomPacking::rle},          {"1.2.840.10008.1.2.4.50", DicomPacking::jpeg},
    {"1.2.840.10008.1.2.4.51", DicomPacking::jpeg},      {"1.2.840.10008.1.2.4.57", DicomPacking::jpeg},
    {"1.2.840.10008.1.2.4.70", DicomPacking::jpeg},      {"1.2.840.10008.1.2.4.80", DicomPacking::jpeg_ls},
    {"1.2.840.10008.1.2.4.81", DicomPacking::jpeg_ls},   {"1.2.840.10008.1.2.4.90", DicomPacking::jpeg_2000},
    {"1.2.840.10008.1.2.4.91", DicomPacking::jpeg_2000},
};

bool tag_less(const DicomElement& a, const DicomElement& b) { return a.tag < b.tag; }

/// Puts the elements of a data set in order where it ends, by damage too: they are searched once for each frame.
class InOrderAtEnd {
 public:
  explicit InOrderAtEnd(DicomItem& item) : m_elements(item.elements) {}
  ~InOrderAtEnd() {
    if (!std::is_sorted(m_elements.begin(), m_elements.end(), tag_less))
      std::stable_sort(m_elements.begin(), m_elements.end(), tag_less);
  }
  InOrderAtEnd(const InOrderAtEnd&) = delete;
  InOrderAtEnd& operator=(const InOrderAtEnd&) = delete;

 private:
  std::vector<DicomElement>& m_elements;
};

/// The bytes given are a file's beginning, and it continues.
struct EndsEarly {};
/// Why no element can follow.
struct Damaged {
  std::string what;
};

/// As bytes that stand for no representation are written.
bool is_blank_vr(std::string_view two) {
  return two == "  " || two == "??" || two == "--" || two == std::string_view("\0\0", 2);
}

struct ElementHead {
  std::uint32_t tag = 0, length = 0;
  std::string_view vr;  // empty in implicit syntaxes
};

class Parser {
 public:
  Parser(std::string_view bytes, bool beginning_only) : m_bytes(bytes), m_beginning(beginning_only) {}

  bool implicit = false, big = false;
  std::vector<std::string> corrected;  ///< what was wrong and does no harm, each once

  std::size_t at() const { return m_at; }
  void go_to(std::size_t at) { m_at = at; }
  std::size_t left(std::size_t end) const { return end - m_at; }

  /// Elements up to `end`, or to the mark that ends an item of undefined length. What was read before damage stays in
  /// `out`.
  void data_set(std::size_t end, bool to_mark, int depth, DicomItem& out) {
    const InOrderAtEnd in_order(out);
    while (m_at < end) {
      const std::size_t from = m_at;
      const ElementHead e = element(end);
      if (e.tag == kItemEnd && to_mark) return;
      if (depth == 0 && e.tag >> 16 == 0xfffe) damaged(from, "an item outside of sequences");
      if (depth == 0 && m_beginning && e.tag == kDicomPixels) return;
      if (!out.elements.empty() && depth == 0 && e.tag < out.elements.back().tag)
        correct(tr("elements are out of order"));
      out.elements.push_back(value_of(e, end, depth));
    }
    if (to_mark) missing_end(end, "an item without its end");
  }

  /// Are the bytes behind `m_at` elements with their representation? They say so themselves, whatever the file's
  /// transfer syntax is.
  void sniff() {
    if (left(m_bytes.size()) < 8 || big) return;
    const std::string_view vr = m_bytes.substr(m_at + 4, 2);
    const bool lettered = is_vr(vr);
    const std::size_t from = m_at;
    m_at += 4;
    const std::uint32_t length = number(4, m_bytes.size());
    m_at = from;
    const bool other = implicit ? lettered : !lettered && !is_blank_vr(vr) && length <= kMostFirstValue;
    if (!other) return;
    implicit = !implicit;
    correct(tr("the file is written in another way than its transfer syntax says"));
  }

  /// One element of the group that says how the others are written; false where another group begins.
  bool meta_element(DicomElement& out) {
    const std::size_t from = m_at;
    const std::uint32_t group = number(2, m_bytes.size());
    m_at = from;
    if (group != 2) return false;
    const ElementHead e = element(m_bytes.size());
    out = value_of(e, m_bytes.size(), 0);
    return true;
  }

  void correct(const std::string& what) {
    if (std::find(corrected.begin(), corrected.end(), what) == corrected.end()) corrected.push_back(what);
  }
  [[noreturn]] void damaged(std::size_t at, const std::string& what) const {
    throw Damaged{tr("at byte {}: {}", at, what)};
  }

 private:
  static constexpr std::uint32_t kMostFirstValue = 1024;  // values of group 8 that come first are short

  std::string_view m_bytes;
  bool m_beginning;
  std::size_t m_at = 0, m_count = 0;

  void need(std::size_t count, std::size_t end) const {
    if (left(end) >= count) return;
    missing_end(end, tr("{} bytes, where {} are left", count, left(end)));
  }
  /// More was to come up to `end`: it is in the file, behind the beginning, or nowhere.
  [[noreturn]] void missing_end(std::size_t end, const std::string& what) const {
    if (m_beginning && end == m_bytes.size()) throw EndsEarly{};
    damaged(m_at, what);
  }
  std::uint32_t number(int width, std::size_t end) {
    need(std::size_t(width), end);
    const char* from = m_bytes.data() + m_at;
    const std::uint32_t out = width == 2 ? geometry::number_at_in<std::uint16_t>(big, from)
                                         : geometry::number_at_in<std::uint32_t>(big, from);
    m_at += std::size_t(width);
    return out;
  }

  ElementHead element(std::size_t end) {
    if (++m_count > kMostElements) damaged(m_at, "more than two million elements");
    ElementHead e;
    const std::uint32_t group = number(2, end);
    e.tag = group << 16 | number(2, end);
    if (group == 0xfffe || implicit) {
      e.length = number(4, end);
      return e;
    }
    need(2, end);
    e.vr = m_bytes.substr(m_at, 2);
    if (!is_vr(e.vr)) return without_representation(e, end);
    m_at += 2;
    if (!has_long_length(e.vr)) {
      e.length = number(2, end);
      return e;
    }
    number(2, end);  // reserved
    e.length = number(4, end);
    return e;
  }

  /// Some writers leave the representation of elements that they do not know blank, or leave it out. Where the value
  /// is follows from what must come behind it: an element or the end.
  ElementHead without_representation(ElementHead e, std::size_t end) {
    struct Way {
      std::size_t length_at;
      int width;
    };
    const std::size_t from = m_at;
    for (const Way way : {Way{2, 2}, Way{0, 4}, Way{4, 4}}) {
      if (way.width == 2 && !is_blank_vr(e.vr)) continue;
      if (end - from < way.length_at + std::size_t(way.width)) continue;
      m_at = from + way.length_at;
      e.length = number(way.width, end);
      if (e.length == kUndefined || e.length > left(end) || !element_at(m_at + e.length, end, e.tag)) continue;
      e.vr = "UN";
      correct(tr("elements lack their value representation"));
      return e;
    }
    m_at = from;
    missing_end(m_beginning ? m_bytes.size() : end, "no value representation");
  }
  bool element_at(std::size_t at, std::size_t end, std::uint32_t behind) {
    if (at == end && m_beginning && end == m_bytes.size()) throw EndsEarly{};
    if (at == end) return true;
    if (end - at < 8) return false;
    const std::size_t was = m_at;
    m_at = at;
    const std::uint32_t group = number(2, end), tag = group << 16 | number(2, end);
    m_at = was;
    const std::string_view vr = m_bytes.substr(at + 4, 2);
    return tag == kItemEnd || (tag > behind && (is_vr(vr) || is_blank_vr(vr)));
  }

  DicomElement value_of(const ElementHead& e, std::size_t end, int depth) {
    DicomElement out;
    out.tag = e.tag;
    const bool undefined = e.length == kUndefined;
    if (undefined && e.tag == kDicomPixels) {
      fragments(end, out);
    } else if (undefined) {
      if (!implicit && e.vr != "SQ" && e.vr != "UN") damaged(m_at, "a value without a length");
      // What is unknown and has no length is written in implicit elements, whatever the rest is.
      const bool was = implicit;
      implicit = implicit || e.vr == "UN";
      items(end, true, depth, out);
      implicit = was;
    } else {
      if (depth == 0 && !is_wanted(e.tag) && m_beginning && e.length > left(end)) throw EndsEarly{};
      need(e.length, end);
      const std::size_t to = m_at + e.length;
      if (is_wanted(e.tag) && (implicit || e.vr == "SQ"))
        items(to, false, depth, out);
      else
        out.value = m_bytes.substr(m_at, e.length);
      m_at = to;
    }
    return out;
  }

  void items(std::size_t end, bool to_mark, int depth, DicomElement& out) {
    if (depth >= kDeepestItem) damaged(m_at, "sequences within sequences, twelve deep");
    while (m_at < end) {
      const std::size_t from = m_at;
      const ElementHead e = element(end);
      if (e.tag == kSequenceEnd && to_mark) return;
      if (e.tag != kItem) damaged(from, "no item in a sequence");
      const bool open = e.length == kUndefined;
      if (!open) need(e.length, end);
      const std::size_t to = open ? end : m_at + e.length;
      out.items.emplace_back();
      data_set(to, open, depth + 1, out.items.back());
      if (!open) m_at = to;
    }
    if (to_mark) missing_end(end, "a sequence without its end");
  }

  void fragments(std::size_t end, DicomElement& out) {
    while (true) {
      const std::size_t from = m_at;
      if (m_at == end && out.fragments.size() > 1)  // the frames are counted where they are unpacked
        return correct(tr("the mark behind the packed pixels is missing"));
      const ElementHead e = element(end);
      if (e.tag == kSequenceEnd) return;
      if (e.tag != kItem) damaged(from, "no fragment among packed pixels");
      need(e.length, end);
      out.fragments.push_back(m_bytes.substr(m_at, e.length));
      m_at += e.length;
    }
  }
};

void use_syntax(DicomDocument& out, Parser& parser, const std::string& file) {
  const std::string& uid = out.syntax;
  if (uid == "1.2.840.10008.1.2") {
    parser.implicit = true;
  } else if (uid == "1.2.840.10008.1.2.2") {
    parser.big = out.big_endian = true;
  } else if (uid != "1.2.840.10008.1.2.1" && uid != "1.2.840.10008.1.2.1.99") {
    out.packing = DicomPacking::other;
    for (const Syntax& s : kPacked)
      if (uid == s.uid) out.packing = s.packing;
    if (uid.compare(0, 14, "1.2.840.10008.") != 0)
      refuse(file, tr("expected a transfer syntax of DICOM, got '{}'", core::printable(uid.substr(0, 64))));
  }
}

}  // namespace

const DicomElement* DicomItem::find(std::uint32_t tag) const {
  const auto found = std::lower_bound(elements.begin(), elements.end(), tag,
                                      [](const DicomElement& e, std::uint32_t wanted) { return e.tag < wanted; });
  return found == elements.end() || found->tag != tag ? nullptr : &*found;
}

bool has_dicom_mark(std::string_view bytes) { return bytes.size() >= kPreamble && bytes.substr(128, 4) == "DICM"; }

bool looks_like_dicom(std::string_view bytes) {
  if (has_dicom_mark(bytes)) return true;
  // Without the mark: group 2 or 8 with a small element, then letters or a short length.
  if (bytes.size() < 16 || (bytes[0] != '\2' && bytes[0] != '\x08') || bytes[1] != '\0' || bytes[3] != '\0')
    return false;
  return is_vr(bytes.substr(4, 2)) || (bytes[6] == '\0' && bytes[7] == '\0');
}

std::string damaged_dicom(const std::string& what) {
  return tr("expected a whole DICOM file, got a damaged one: {}", what);
}

namespace {

std::string text_without_padding(std::string_view value) {
  std::string out(value.substr(0, 64));
  while (!out.empty() && (out.back() == '\0' || out.back() == ' ')) out.pop_back();
  return out;
}

/// The group that says how the others are written; without it they are sniffed.
void read_meta(std::string_view bytes, bool marked, Parser& parser, DicomDocument& out) {
  parser.go_to(marked ? kPreamble : 0);
  DicomElement e;
  if (marked || bytes[0] == '\2')
    while (parser.left(bytes.size()) > 0 && parser.meta_element(e)) {
      if (e.tag == 0x00020002) out.media_class = text_without_padding(e.value);
      if (e.tag == 0x00020010) out.syntax = text_without_padding(e.value);
    }
  if (!out.syntax.empty()) return;
  if (parser.left(bytes.size()) < 8) parser.damaged(parser.at(), "nothing but its first group");
  out.syntax = is_vr(bytes.substr(parser.at() + 4, 2)) ? "1.2.840.10008.1.2.1" : "1.2.840.10008.1.2";
  if (marked || bytes[0] == '\2')
    out.corrected.emplace_back(tr("the file does not name its transfer syntax: it was taken from the bytes"));
}

/// Elements up to the end. Damage behind the pixels does no harm.
void read_root(Parser& parser, std::size_t end, DicomDocument& out) {
  parser.sniff();
  try {
    parser.data_set(end, false, 0, out.root);
  } catch (const Damaged&) {
    if (!out.root.find(kDicomPixels)) throw;
    parser.correct(tr("bytes behind the pixels are no elements: they were passed over"));
  }
  out.corrected.insert(out.corrected.end(), parser.corrected.begin(), parser.corrected.end());
}

}  // namespace

DicomDocument parse_dicom(std::string_view bytes, const std::string& file, bool beginning_only) {
  if (!looks_like_dicom(bytes)) refuse(file, "expected a DICOM file, got another one");
  DicomDocument out;
  Parser parser(bytes, beginning_only);
  try {
    read_meta(bytes, has_dicom_mark(bytes), parser, out);
    use_syntax(out, parser, file);
    if (out.syntax == "1.2.840.10008.1.2.1.99") {
      if (beginning_only) throw EndsEarly{};
      out.inflated = geometry::inflated(bytes.substr(parser.at()), geometry::Wrapping::none, 0, kMostInflated, file);
      Parser inside({out.inflated.data(), out.inflated.size()}, false);
      read_root(inside, out.inflated.size(), out);
    } else {
      read_root(parser, bytes.size(), out);
      if (beginning_only && parser.at() == bytes.size()) out.ends_early = true;
    }
  } catch (const EndsEarly&) {
    out.ends_early = true;
  } catch (const Damaged& d) {
    out.damage = d.what;
  }
  return out;
}

}  // namespace trocar::volumes
