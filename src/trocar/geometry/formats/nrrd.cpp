#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/formats/nrrd.hpp>
#include <trocar/geometry/formats/vtk_values.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {
namespace {

enum class Type : unsigned char { int8, uint8, int16, uint16, int32, uint32, real32, real64 };
struct TypeName {
  const char* name;
  Type type;
};
constexpr TypeName kTypeNames[] = {
    {"int8", Type::int8},
    {"int8_t", Type::int8},
    {"signed char", Type::int8},
    {"uint8", Type::uint8},
    {"uint8_t", Type::uint8},
    {"uchar", Type::uint8},
    {"unsigned char", Type::uint8},
    {"int16", Type::int16},
    {"int16_t", Type::int16},
    {"short", Type::int16},
    {"short int", Type::int16},
    {"signed short", Type::int16},
    {"signed short int", Type::int16},
    {"uint16", Type::uint16},
    {"uint16_t", Type::uint16},
    {"ushort", Type::uint16},
    {"unsigned short", Type::uint16},
    {"unsigned short int", Type::uint16},
    {"int32", Type::int32},
    {"int32_t", Type::int32},
    {"int", Type::int32},
    {"signed int", Type::int32},
    {"uint32", Type::uint32},
    {"uint32_t", Type::uint32},
    {"uint", Type::uint32},
    {"unsigned int", Type::uint32},
    {"float", Type::real32},
    {"double", Type::real64},
};
std::size_t width_of(Type type) {
  constexpr std::size_t kWidths[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kWidths[std::size_t(type)];
}

enum class Encoding : unsigned char { raw, gzip, ascii };
enum class Endian : unsigned char { little, big };

/// What an axis of the file's space is in our frame: its sign and which of ours.
struct SpaceName {
  const char* name;
  Mat3d to_ours;
};
constexpr Mat3d kFromLps{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
constexpr Mat3d kFromRas{{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
constexpr Mat3d kFromLas{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
constexpr SpaceName kSpaces[] = {
    {"left-posterior-superior", kFromLps}, {"lps", kFromLps}, {"right-anterior-superior", kFromRas}, {"ras", kFromRas},
    {"left-anterior-superior", kFromLas},  {"las", kFromLas},
};

struct UnitName {
  const char* name;
  double metres;
};
constexpr UnitName kUnits[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"um", 1e-6}};

/// Between neighbouring voxels [units of the file]: at any origin there is then a millionth of a step's resolution
/// left.
constexpr double kLeastStep = 1e-4, kMostStep = 1e4;

/// What follows in a field's value, with its place.
class Words {
 public:
  Words(std::string_view text, std::size_t at) : m_text(text), m_at(at) {}

  std::size_t at() {
    skip_blanks();
    return m_at + m_next;
  }
  bool end() {
    skip_blanks();
    return m_next == m_text.size();
  }
  bool take(char c) {
    skip_blanks();
    if (m_next == m_text.size() || m_text[m_next] != c) return false;
    ++m_next;
    return true;
  }
  /// Up to a blank, a comma or a bracket; after a quotation mark up to the next.
  std::string_view word() {
    if (take('"')) {
      const std::string_view inside = up_to("\"");
      take('"');
      return inside;
    }
    skip_blanks();
    return up_to(" \t,()");
  }

 private:
  std::string_view m_text;
  std::size_t m_at, m_next = 0;

  void skip_blanks() {
    while (m_next < m_text.size() && (m_text[m_next] == ' ' || m_text[m_next] == '\t')) ++m_next;
  }
  std::string_view up_to(const char* ends) {
    const std::size_t from = m_next;
    m_next = std::min(m_text.find_first_of(ends, from), m_text.size());
    return m_text.substr(from, m_next - from);
  }
};

struct Header {
  std::optional<Type> type;
  std::optional<Encoding> encoding;
  std::optional<Endian> endian;
  std::optional<Mat3d> to_ours;
  std::optional<Mat3d> directions;  ///< columns, in the file's space and unit
  std::optional<Vec3d> spacings, origin;
  std::optional<std::array<int, 3>> sizes;
  std::optional<int> dimension;
  double unit = 1e-3;
};

class HeaderReader {
 public:
  HeaderReader(MeshSource& in, std::size_t most_voxels) : m_in(in), m_most(most_voxels) {}

  Header read() {
    magic();
    while (line()) {
    }
    require(m_header.type.has_value(), "type");
    require(m_header.dimension.has_value(), "dimension");
    require(m_header.sizes.has_value(), "sizes");
    require(m_header.encoding.has_value(), "encoding");
    require(m_header.to_ours.has_value(), "space");
    require(m_header.directions || m_header.spacings, "space directions");
    const bool bytes = m_header.encoding && *m_header.encoding != Encoding::ascii;
    if (bytes && m_header.type && width_of(*m_header.type) > 1) require(m_header.endian.has_value(), "endian");
    m_in.finish();
    return m_header;
  }

 private:
  MeshSource& m_in;
  std::size_t m_most;
  Header m_header;
  std::vector<std::string> m_seen;
  std::string_view m_value;
  std::size_t m_at = 0;   ///< of the value
  std::size_t m_end = 0;  ///< of the line that ends the header

  std::size_t place(std::string_view text) const { return std::size_t(text.data() - m_in.all().data()); }
  std::string got() const { return m_value.empty() ? "nothing" : in_quotes(m_value); }

  void require(bool there, const char* field) {
    if (!there && std::find(m_seen.begin(), m_seen.end(), field) == m_seen.end())
      m_in.fault(m_end, tr("expected the field '{}', got none", field));
  }

  void magic() {
    const std::string_view first = m_in.line();
    if (first.size() == 8 && first.substr(0, 7) == "NRRD000" && first[7] >= '1' && first[7] <= '5') return;
    m_in.lose(0, tr("expected NRRD0001 to NRRD0005, got {}", in_quotes(first)));
  }

  /// False at the empty line that ends the header.
  bool line() {
    if (m_in.left() == 0) m_in.lose(m_in.at(), "expected an empty line and the data, got the end of the file");
    m_end = m_in.at();
    const std::string_view text = m_in.line();
    if (text.empty()) return false;
    if (text[0] == '#') return true;
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) m_in.lose(place(text), tr("expected 'field: value', got {}", in_quotes(text)));
    if (text.substr(colon, 2) == ":=") return true;  // notes of other programs
    m_value = text.substr(colon + 1);
    while (!m_value.empty() && (m_value[0] == ' ' || m_value[0] == '\t')) m_value.remove_prefix(1);
    m_at = place(text) + (text.size() - m_value.size());
    field(lower(text.substr(0, std::min<std::size_t>(colon, 40))), place(text));
    return true;
  }

  void field(const std::string& name, std::size_t at) {
    struct Known {
      const char* name;
      void (HeaderReader::*read)();
    };
    static constexpr Known kKnown[] = {
        {"type", &HeaderReader::type},
        {"dimension", &HeaderReader::dimension},
        {"sizes", &HeaderReader::sizes},
        {"encoding", &HeaderReader::encoding},
        {"endian", &HeaderReader::endian},
        {"space", &HeaderReader::space},
        {"space dimension", &HeaderReader::space_dimension},
        {"space directions", &HeaderReader::directions},
        {"space origin", &HeaderReader::origin},
        {"space units", &HeaderReader::units},
        {"spacings", &HeaderReader::spacings},
        {"data file", &HeaderReader::data_file},
        {"datafile", &HeaderReader::data_file},
        {"line skip", &HeaderReader::skip},
        {"lineskip", &HeaderReader::skip},
        {"byte skip", &HeaderReader::skip},
        {"byteskip", &HeaderReader::skip},
    };
    for (const Known& known : kKnown) {
      if (name != known.name) continue;
      if (std::find(m_seen.begin(), m_seen.end(), name) != m_seen.end())
        return m_in.fault(at, tr("expected the field '{}' once, got it again", name));
      m_seen.push_back(name);
      return (this->*known.read)();
    }
  }

  void type() {
    const std::string name = lower(m_value.substr(0, 40));
    for (const TypeName& t : kTypeNames)
      if (name == t.name) m_header.type = t.type;
    if (!m_header.type) m_in.fault(m_at, tr("expected a type from int8 to uint32, float or double, got {}", got()));
  }

  void dimension() {
    const auto number = core::to_integer(m_value);
    if (number == 3)
      m_header.dimension = 3;
    else
      m_in.fault(m_at, tr("expected dimension 3, got {}", got()));
  }

  void sizes() {
    Words words(m_value, m_at);
    std::array<int, 3> sizes{};
    std::size_t room = m_most;
    for (int& size : sizes) {
      const std::size_t at = words.at();
      const std::string_view word = words.word();
      const auto number = core::to_integer(word);
      if (!number || *number < 1) return expected_at(at, "a size of at least 1", word);
      if (std::uint64_t(*number) > room) return m_in.fault(at, tr("expected at most {} voxels, got more", m_most));
      size = int(*number);
      room /= std::size_t(size);
    }
    if (ends(words)) m_header.sizes = sizes;
  }

  void encoding() {
    const std::string name = lower(m_value.substr(0, 40));
    if (name == "raw") m_header.encoding = Encoding::raw;
    if (name == "gzip" || name == "gz") m_header.encoding = Encoding::gzip;
    if (name == "ascii" || name == "text" || name == "txt") m_header.encoding = Encoding::ascii;
    if (!m_header.encoding) m_in.fault(m_at, tr("expected encoding raw, gzip or ascii, got {}", got()));
  }

  void endian() {
    const std::string name = lower(m_value.substr(0, 40));
    if (name == "little") m_header.endian = Endian::little;
    if (name == "big") m_header.endian = Endian::big;
    if (!m_header.endian) m_in.fault(m_at, tr("expected little or big, got {}", got()));
  }

  void space() {
    const std::string name = lower(m_value.substr(0, 40));
    for (const SpaceName& s : kSpaces)
      if (name == s.name) m_header.to_ours = s.to_ours;
    if (!m_header.to_ours)
      m_in.fault(m_at, tr("expected left-posterior-superior, right-anterior-superior or "
                          "left-anterior-superior, got {}",
                          got()));
  }

  void space_dimension() {
    m_in.fault(m_at, "expected 'space', which says where the patient's left is, got 'space dimension'");
  }

  void directions() {
    Words words(m_value, m_at);
    std::array<Vec3d, 3> columns;
    for (Vec3d& column : columns)
      if (!vector(words, column)) return;
    if (!ends(words)) return;
    for (const Vec3d& column : columns)
      if (!(length(column) >= kLeastStep && length(column) <= kMostStep))
        return m_in.fault(m_at, tr("expected directions of a length from 1e-4 to 1e4, got {}", length(column)));
    const double box = length(columns[0]) * length(columns[1]) * length(columns[2]);
    if (!(std::fabs(dot(columns[0], cross(columns[1], columns[2]))) > 1e-3 * box))
      return m_in.fault(m_at, tr("expected three directions that span a voxel, got {}", got()));
    m_header.directions = Mat3d::from_columns(columns[0], columns[1], columns[2]);
  }

  void spacings() {
    Words words(m_value, m_at);
    Vec3d s;
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = words.at();
      if (!number(words, s[k])) return;
      if (!(s[k] >= kLeastStep && s[k] <= kMostStep))
        return m_in.fault(at, tr("expected a spacing from 1e-4 to 1e4, got {}", s[k]));
    }
    if (ends(words)) m_header.spacings = s;
  }

  void origin() {
    Words words(m_value, m_at);
    Vec3d v;
    if (vector(words, v) && ends(words)) m_header.origin = v;
  }

  void units() {
    Words words(m_value, m_at);
    std::string first;
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = words.at();
      const std::string_view word = words.word();
      if (k == 0) first = std::string(word);
      if (word != first) return expected_at(at, "the same unit for all axes", word);
      const auto* unit =
          std::find_if(std::begin(kUnits), std::end(kUnits), [&](const UnitName& u) { return word == u.name; });
      if (unit == std::end(kUnits)) return expected_at(at, "the unit mm, cm, m or um", word);
      m_header.unit = unit->metres;
    }
    ends(words);
  }

  void data_file() { m_in.fault(m_at, tr("expected the data in this file, got it in {}", got())); }
  void skip() {
    if (m_value != "0") m_in.fault(m_at, tr("expected the data right after the header (0), got {}", got()));
  }

  void expected_at(std::size_t at, const char* what, std::string_view word) {
    m_in.fault(at, tr("expected {}, got {}", what, word.empty() ? m_in.shown(at) : in_quotes(word)));
  }

  bool ends(Words& words) {
    if (words.end()) return true;
    m_in.fault(words.at(), tr("expected the end of the line after three, got {}", m_in.shown(words.at())));
    return false;
  }

  bool number(Words& words, double& value) {
    const std::size_t at = words.at();
    const std::string_view word = words.word();
    if (core::is_decimal(word)) value = core::to_double(word);
    if (core::is_decimal(word) && std::fabs(value) <= kMostNrrdOrigin) return true;
    expected_at(at, "a number up to 1e6", word);
    return false;
  }

  /// (1, 2, 3)
  bool vector(Words& words, Vec3d& v) {
    for (int k = 0; k < 3; ++k) {
      if (!words.take(k == 0 ? '(' : ',')) {
        expected_at(words.at(), k == 0 ? "a vector (x,y,z)" : "a comma", "");
        return false;
      }
      if (!number(words, v[k])) return false;
    }
    if (words.take(')')) return true;
    expected_at(words.at(), "a bracket after three numbers", "");
    return false;
  }
};

/// The bytes that gzip packed: so many and not one more.
std::string unpacked(MeshSource& in, std::size_t wanted) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) in.lose(in.at(), "expected memory for gzip, got none");
  struct Ends {
    z_stream* s;
    ~Ends() { inflateEnd(s); }
  } const ends{&stream};
  const std::size_t from = in.at();
  const std::string_view packed = in.all().substr(from);
  // zlib does not write through next_in; its type says so only where ZLIB_CONST is defined.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string out;
  std::vector<char> chunk(std::size_t(1) << 16);
  int status = Z_OK;
  while (status == Z_OK && out.size() <= wanted) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    status = inflate(&stream, Z_NO_FLUSH);
    out.append(chunk.data(), chunk.size() - stream.avail_out);
  }
  const std::size_t at = from + (packed.size() - stream.avail_in);
  if (status == Z_DATA_ERROR || status == Z_NEED_DICT) in.lose(at, "expected gzip data, got damaged ones");
  if (status == Z_MEM_ERROR) in.lose(at, "expected memory for gzip, got none");
  if (out.size() > wanted) in.lose(at, tr("expected {} bytes unpacked, got more", wanted));
  if (status != Z_STREAM_END)
    in.lose(at, tr("expected {} bytes unpacked, got the end of the file after {}", wanted, out.size()));
  if (out.size() < wanted) in.lose(at, tr("expected {} bytes unpacked, got {}", wanted, out.size()));
  return out;
}

template <class T>
T number_at(const char* from, bool swapped) {
  std::array<char, sizeof(T)> own{};
  std::copy_n(from, sizeof(T), own.begin());
  if (swapped) std::reverse(own.begin(), own.end());
  T value;
  std::memcpy(&value, own.data(), sizeof(T));
  return value;
}

constexpr double kMostWhole = 16'777'216;  // float holds every whole number up to here

/// The number as it is kept; a fault where that cannot hold it.
template <class Kept, class Read>
bool keep(Read value, Kept& kept) {
  kept = Kept(0);
  if constexpr (std::is_floating_point_v<Read>) {
    if (!(std::fabs(double(value)) <= double(std::numeric_limits<float>::max()))) return false;
  } else if constexpr (std::is_floating_point_v<Kept>) {
    if (!(std::fabs(double(value)) <= kMostWhole)) return false;
  }
  kept = static_cast<Kept>(value);
  return true;
}

class DataReader {
 public:
  DataReader(MeshSource& in, const Header& header) : m_in(in), m_header(header) {
    m_count = 1;
    for (const int size : *header.sizes) m_count *= std::size_t(size);
  }

  void read(Voxels& voxels) {
    switch (*m_header.type) {
      case Type::int8:
        return fill<std::int8_t, std::int16_t>(voxels);
      case Type::uint8:
        return fill<std::uint8_t, std::uint8_t>(voxels);
      case Type::int16:
        return fill<std::int16_t, std::int16_t>(voxels);
      case Type::uint16:
        return fill<std::uint16_t, std::uint16_t>(voxels);
      case Type::int32:
        return fill<std::int32_t, float>(voxels);
      case Type::uint32:
        return fill<std::uint32_t, float>(voxels);
      case Type::real32:
        return fill<float, float>(voxels);
      case Type::real64:
        return fill<double, float>(voxels);
    }
  }

 private:
  MeshSource& m_in;
  const Header& m_header;
  std::size_t m_count;

  template <class Read, class Kept>
  void fill(Voxels& voxels) {
    std::vector<Kept> values;
    if (*m_header.encoding == Encoding::ascii)
      from_text<Read>(values);
    else
      from_bytes<Read>(values);
    m_in.finish();
    voxels.values = std::move(values);
  }

  template <class Read, class Kept>
  void from_bytes(std::vector<Kept>& values) {
    m_in.set_form(MeshSource::Form::binary);
    const std::size_t wanted = m_count * sizeof(Read), from = m_in.at();
    const bool packed = *m_header.encoding == Encoding::gzip;
    if (!packed && m_in.left() != wanted)
      m_in.lose(from, tr("expected {} bytes of voxels, got {}", wanted, m_in.left()));
    const std::string bytes = packed ? unpacked(m_in, wanted) : std::string();
    const char* data = packed ? bytes.data() : m_in.all().data() + from;
    const std::uint16_t one = 1;
    const bool little = *reinterpret_cast<const char*>(&one) == 1;
    const bool swapped = sizeof(Read) > 1 && (*m_header.endian == Endian::little) != little;
    values.resize(m_count);
    for (std::size_t i = 0; i < m_count; ++i) {
      const Read value = number_at<Read>(data + i * sizeof(Read), swapped);
      if (!keep(value, values[i]))
        m_in.fault(packed ? from : from + i * sizeof(Read), bad_value(i, fmt::format("{}", value)));
    }
  }

  template <class Read, class Kept>
  void from_text(std::vector<Kept>& values) {
    if (m_count > m_in.left() / 2 + 1)
      m_in.lose(m_in.at(), tr("expected {} values, got {} bytes", m_count, m_in.left()));
    values.resize(m_count);
    for (std::size_t i = 0; i < m_count; ++i) {
      m_in.skip_space();
      text_value<Read>(values[i]);
    }
    m_in.skip_space();
    if (m_in.left() > 0)
      m_in.fault(m_in.at(), tr("expected the end of the file after {} values, got {}", m_count, m_in.shown(m_in.at())));
  }

  template <class Read, class Kept>
  void text_value(Kept& kept) {
    const std::size_t at = m_in.at();
    bool fits = false;
    if constexpr (std::is_floating_point_v<Read>) {
      double value = 0;
      if (!m_in.real(value, 8, "a number")) return;
      fits = keep(value, kept);
    } else {
      std::int64_t value = 0;
      if (!m_in.integer(value, 8, "a whole number")) return;
      fits = value >= std::int64_t(std::numeric_limits<Read>::min()) &&
             value <= std::int64_t(std::numeric_limits<Read>::max()) && keep(static_cast<Read>(value), kept);
    }
    if (!fits) m_in.fault(at, tr("expected a number that the type holds, got {}", m_in.shown(at)));
  }

  std::string bad_value(std::size_t voxel, const std::string& value) const {
    const char* what = *m_header.type >= Type::real32 ? "a finite number" : "a whole number up to 16777216";
    return tr("expected {}, got {} in voxel {}", what, value, voxel);
  }
};

/// Scaled and in our axes.
void place(const Header& header, Voxels& voxels) {
  voxels.size = *header.sizes;
  const Vec3d s = header.spacings.value_or(Vec3d{1, 1, 1});
  const Mat3d directions = header.directions.value_or(Mat3d{{{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}});
  voxels.origin = header.unit * (*header.to_ours * header.origin.value_or(Vec3d{}));
  voxels.step = *header.to_ours * directions;
  for (auto& row : voxels.step.m)
    for (double& value : row) value *= header.unit;
}

}  // namespace

Voxels read_nrrd(std::string_view bytes, const std::string& file, std::size_t most_voxels) {
  MeshSource in(bytes, file);
  if (bytes.size() > kMaxMeshBytes)
    in.lose(0, tr("expected at most {} MiB, got {} bytes", kMaxMeshBytes >> 20, bytes.size()));
  const Header header = HeaderReader(in, most_voxels).read();
  Voxels voxels;
  place(header, voxels);
  DataReader(in, header).read(voxels);
  return voxels;
}

}  // namespace trocar::geometry
