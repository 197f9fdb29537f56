#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>

namespace trocar::geometry {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr char kComment = '#';

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_space(char c) { return is_blank(c) || is_line_end(c); }

/// Does the first line end in CR alone?
bool first_line_ends_in_cr(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  return end != text.npos && text[end] == '\r' && text.substr(end, 2) != "\r\n";
}

std::size_t word_end(std::string_view text, std::size_t at) {
  while (at < text.size() && !is_space(text[at])) ++at;
  return at;
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t limit = 40;
  std::string out = "'";
  for (const char c : text.substr(0, limit)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > limit ? "...'" : "'");
}

MeshSource::MeshSource(std::string_view bytes, std::string file)
    : m_bytes(bytes), m_file(std::move(file)), m_ends_in_cr(first_line_ends_in_cr(bytes)) {
  if (m_bytes.starts_with(kByteOrderMark)) m_at = kByteOrderMark.size();
}

void MeshSource::refuse_wide_text() const {
  if (const char* encoding = core::wide_encoding(m_bytes))
    throw core::BadInput({{{m_file, 1, 1}, tr("expected text in UTF-8, got {}: save the file as UTF-8", encoding)}});
}

std::string_view MeshSource::line() {
  const std::size_t from = m_at, end = std::min(m_bytes.find_first_of("\r\n", from), m_bytes.size());
  m_at = end;
  if (!m_ends_in_cr && m_bytes.substr(end, 2) == "\r\n") ++m_at;
  m_at = std::min(m_at + 1, m_bytes.size());
  std::string_view text = m_bytes.substr(from, end - from);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

void MeshSource::skip_space() {
  while (m_at < m_bytes.size() && is_space(m_bytes[m_at])) ++m_at;
}

std::string_view MeshSource::word() {
  skip_space();
  const std::size_t from = m_at;
  m_at = word_end(m_bytes, from);
  return m_bytes.substr(from, m_at - from);
}

std::string_view MeshSource::peek_word() {
  skip_space();
  return m_bytes.substr(m_at, word_end(m_bytes, m_at) - m_at);
}

bool MeshSource::word_on_line() {
  while (m_at < m_bytes.size() && is_blank(m_bytes[m_at])) ++m_at;
  return m_at < m_bytes.size() && !is_line_end(m_bytes[m_at]) && m_bytes[m_at] != kComment;
}

void MeshSource::skip_comments() {
  for (skip_space(); m_at < m_bytes.size() && m_bytes[m_at] == kComment; skip_space()) line();
}

bool MeshSource::only_padding_left() {
  using namespace std::string_view_literals;
  return m_bytes.find_first_not_of("\0\x1a \t\f\v\r\n"sv, m_at) == std::string_view::npos;
}

void MeshSource::begin_value() {
  if (binary()) return;
  if (m_by_line)
    word_on_line();
  else
    skip_comments();
}

bool MeshSource::value_follows() {
  begin_value();
  return word_on_line();
}

void MeshSource::begin_record() {
  if (!binary()) skip_comments();
}

void MeshSource::end_record() {
  if (binary() || !m_by_line) return;
  if (word_on_line()) fault(m_at, tr("expected the end of the line, got {}", shown(m_at)));
  skip_line();
}

void MeshSource::skip_line() {
  if (!binary()) line();
}

std::string MeshSource::shown(std::size_t at) const {
  while (at < m_bytes.size() && is_blank(m_bytes[at])) ++at;
  if (at >= m_bytes.size()) return "the end of the file";
  if (is_line_end(m_bytes[at])) return "the end of the line";
  return in_quotes(m_bytes.substr(at, word_end(m_bytes, at) - at));
}

bool MeshSource::number_word(std::string_view& text, std::size_t& at, const char* what) {
  if (!value_follows()) {
    if (left() == 0) lose(m_at, tr("expected {}, got the end of the file", what));
    fault(m_at, tr("expected {}, got {}", what, shown(m_at)));
    return false;
  }
  at = m_at;
  text = word();
  return true;
}

const unsigned char* MeshSource::take(int width, const char* what) {
  if (left() < std::size_t(width))
    lose(m_at, tr("expected {} of {} bytes, got the end of the file after {}", what, width, left()));
  const auto* from = reinterpret_cast<const unsigned char*>(m_bytes.data()) + m_at;
  m_at += std::size_t(width);
  return from;
}

namespace {

/// The number that the machine has where these bytes stand.
template <class T>
T from_bytes(const unsigned char* bytes, bool swapped) {
  std::array<unsigned char, sizeof(T)> own{};
  for (std::size_t i = 0; i < sizeof(T); ++i) own[i] = bytes[swapped ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, own.data(), sizeof(T));
  return value;
}

}  // namespace

bool MeshSource::integer(std::int64_t& value, int width, const char* what) {
  value = 0;
  if (binary()) {
    const unsigned char* bytes = take(width, what);
    const bool swapped = m_form == Form::binary_swapped;
    value = width == 8   ? from_bytes<std::int64_t>(bytes, swapped)
            : width == 4 ? from_bytes<std::int32_t>(bytes, swapped)
            : width == 2 ? from_bytes<std::int16_t>(bytes, swapped)
                         : from_bytes<std::int8_t>(bytes, swapped);
    return true;
  }
  std::string_view text;
  std::size_t at = 0;
  if (!number_word(text, at, what)) return false;
  const auto number = core::to_integer(text);
  if (number)
    value = *number;
  else
    fault(at, tr("expected {}, got {}", what, in_quotes(text)));
  return number.has_value();
}

bool MeshSource::real(double& value, int width, const char* what) {
  value = 0;
  std::string_view text;
  std::size_t at = m_at;
  if (binary()) {
    const unsigned char* bytes = take(width, what);
    const bool swapped = m_form == Form::binary_swapped;
    value = width == 8 ? from_bytes<double>(bytes, swapped) : double(from_bytes<float>(bytes, swapped));
    if (std::isfinite(value)) return true;
    fault(at, tr("expected {}, got {}", what, value));
    value = 0;
    return false;
  }
  if (!number_word(text, at, what)) return false;
  if (core::is_decimal(text)) value = core::to_double(text);
  if (core::is_decimal(text) && std::isfinite(value)) return true;
  fault(at, tr("expected {}, got {}", what, in_quotes(text)));
  value = 0;
  return false;
}

std::size_t MeshSource::count(const char* things, std::size_t least, int width) {
  begin_value();
  const std::size_t from = m_at;
  std::int64_t value = 0;
  if (!integer(value, width, tr("the number of {}", things).c_str())) finish();
  const std::size_t most = left() / least;
  if (value < 0) lose(from, tr("expected the number of {}, got {}", things, value));
  if (std::uint64_t(value) > most)
    lose(from, tr("expected at most {} {}, for which the {} bytes that follow have room, got {} announced", most,
                  things, left(), value));
  return std::size_t(value);
}

void MeshSource::skip_bytes(std::uint64_t bytes, const char* what) {
  if (bytes > left()) lose(m_at, tr("expected {} bytes of {}, got {}", bytes, what, left()));
  m_at += std::size_t(bytes);
}

void MeshSource::fault(std::size_t at, std::string message) {
  m_faults.push_back({at, binary(), std::move(message)});
  if (m_faults.size() < kMaxMeshFaults) return;
  m_faults.push_back({at, binary(), "expected fewer faults: further ones are not reported"});
  tell_all();
}

void MeshSource::lose(std::size_t at, std::string message) {
  m_faults.push_back({at, binary(), std::move(message)});
  tell_all();
}

void MeshSource::finish() const {
  if (!m_faults.empty()) tell_all();
}

void MeshSource::tell_all() const {
  std::vector<Fault> sorted = m_faults;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Fault& a, const Fault& b) { return a.at < b.at; });
  std::vector<core::Fault> told;
  std::size_t at = 0, line_start = 0;
  int line = 1;
  for (const Fault& fault : sorted) {
    for (; at < std::min(fault.at, m_bytes.size()); ++at)
      if (m_bytes[at] == '\n' || (m_bytes[at] == '\r' && m_bytes.substr(at, 2) != "\r\n")) {
        ++line;
        line_start = at + 1;
      }
    const core::Location place{m_file, line, int(fault.at - line_start) + 1};
    told.push_back({place, fault.binary ? tr("at byte {}: {}", fault.at, fault.message) : fault.message});
  }
  throw core::BadInput(std::move(told));
}

}  // namespace trocar::geometry
