#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/header_fields.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostHeader = 1u << 20, kMostFields = 20'000, kMostTold = 50;
constexpr double kMostNumber = 1e9;

bool is_padding(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_padding(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_padding(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r,()";
  std::vector<std::string_view> out;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    out.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBetween, end);
  }
  return out;
}

}  // namespace

void refuse(const std::string& file, std::string message) {
  throw core::BadInput({{{file, 0, 0}, std::move(message)}});
}

std::string shown(std::string_view text) {
  if (text.empty()) return "nothing";
  const bool cut = text.size() > 60;
  return fmt::format("'{}{}'", core::printable(text.substr(0, 60)), cut ? "..." : "");
}

const HeaderField* HeaderFields::find(std::string_view name) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const HeaderField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}
const HeaderField* HeaderFields::need(std::string_view name) {
  const HeaderField* found = find(name);
  if (!found) fault(last_line, 1, tr("expected the field '{}', got none", name));
  return found;
}

std::vector<double> HeaderFields::numbers(const HeaderField& field, std::size_t least, std::size_t most) {
  std::vector<double> out;
  const auto words = words_of(field.value);
  if (words.size() < least || words.size() > most) {
    const std::string count = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    fault(field, tr("expected {} numbers, got {}", count, shown(field.value)));
    return std::vector<double>(least);
  }
  for (const std::string_view word : words) {
    const bool number = core::is_decimal(word);
    const double value = number ? core::to_double(word) : 0;
    if (!number || !(std::fabs(value) <= kMostNumber)) {
      fault(field, tr("expected numbers up to 1e9, got {}", shown(word)));
      return std::vector<double>(least);
    }
    out.push_back(value);
  }
  return out;
}

std::vector<std::int64_t> HeaderFields::integers(const HeaderField& field, std::size_t least, std::size_t most) {
  std::vector<std::int64_t> out;
  const auto words = words_of(field.value);
  for (const std::string_view word : words) {
    const auto value = core::to_integer(word);
    if (!value) break;
    out.push_back(*value);
  }
  if (out.size() == words.size() && out.size() >= least && out.size() <= most) return out;
  fault(field, tr("expected {} whole numbers, got {}", least, shown(field.value)));
  return std::vector<std::int64_t>(least);
}

void HeaderFields::fault(const HeaderField& field, std::string message) {
  fault(field.line, field.column, std::move(message));
}
void HeaderFields::fault(int line, int column, std::string message) {
  m_faults.push_back({{m_file, line, column}, std::move(message)});
  if (m_faults.size() >= kMostTold) finish();
}
void HeaderFields::lose(int line, int column, std::string message) {
  m_faults.push_back({{m_file, line, column}, std::move(message)});
  throw core::BadInput(m_faults);
}
void HeaderFields::finish() const {
  if (!m_faults.empty()) throw core::BadInput(m_faults);
}

HeaderFields read_fields(std::string_view bytes, const std::string& file, char separator, std::string_view last) {
  HeaderFields out(file);
  std::size_t at = 0;
  while (true) {
    ++out.last_line;
    if (at >= bytes.size())
      out.lose(out.last_line, 1,
               last.empty() ? "expected an empty line and the data, got the end of the file"
                            : tr("expected the field '{}', got the end of the file", last));
    if (at > kMostHeader || out.fields.size() > kMostFields)
      out.lose(out.last_line, 1, "expected a header up to 1 MiB, got more");
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string_view whole = bytes.substr(at, end - at);
    at = std::min(end + 1, bytes.size());
    out.end = at;
    const std::string_view line = trimmed(whole);
    if (line.empty() && last.empty()) return out;
    if (line.empty() || line[0] == '#') continue;
    const std::size_t colon = line.find(separator);
    if (colon == std::string_view::npos)
      out.lose(out.last_line, 1, tr("expected 'field {} value', got {}", separator, shown(line)));
    const bool note = separator == ':' && line.substr(colon, 2) == ":=";
    const std::string_view value = trimmed(line.substr(colon + (note ? 2 : 1)));
    const std::string name = core::in_small_letters(trimmed(line.substr(0, colon))) + (note ? ":=" : "");
    const int column = int(value.empty() ? std::size_t(line.data() - whole.data()) + colon + 1
                                         : std::size_t(value.data() - whole.data())) +
                       1;
    if (!note && out.find(name))
      out.fault(out.last_line, 1, tr("expected the field {} once, got it again", shown(name)));
    out.fields.push_back({name, value, out.last_line, column});
    // NRRD's list of files takes the place of the empty line: one name a line, up to the end.
    if (last.empty() && (name == "data file" || name == "datafile") && value.substr(0, 4) == "LIST") return out;
    if (!last.empty() && name == last) return out;
  }
}

}  // namespace trocar::geometry
