// NRRD, with the data attached or beside (.nhdr), and the segments of 3D Slicer (.seg.nrrd). Source: Definition of the
// NRRD file format, teem 1.9. geometry/formats/nrrd.hpp reads the attached ones for the cells of organs.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/header_fields.hpp>
#include <trocar/volumes/files/inflate.hpp>
#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {
namespace {

struct ElementName {
  const char* name;
  Element element;
};
constexpr ElementName kNrrdTypes[] = {
    {"signed char", Element::int8},
    {"int8", Element::int8},
    {"int8_t", Element::int8},
    {"uchar", Element::uint8},
    {"unsigned char", Element::uint8},
    {"uint8", Element::uint8},
    {"uint8_t", Element::uint8},
    {"short", Element::int16},
    {"short int", Element::int16},
    {"signed short", Element::int16},
    {"signed short int", Element::int16},
    {"int16", Element::int16},
    {"int16_t", Element::int16},
    {"ushort", Element::uint16},
    {"unsigned short", Element::uint16},
    {"unsigned short int", Element::uint16},
    {"uint16", Element::uint16},
    {"uint16_t", Element::uint16},
    {"int", Element::int32},
    {"signed int", Element::int32},
    {"int32", Element::int32},
    {"int32_t", Element::int32},
    {"uint", Element::uint32},
    {"unsigned int", Element::uint32},
    {"uint32", Element::uint32},
    {"uint32_t", Element::uint32},
    {"longlong", Element::int64},
    {"long long", Element::int64},
    {"int64", Element::int64},
    {"int64_t", Element::int64},
    {"ulonglong", Element::uint64},
    {"unsigned long long", Element::uint64},
    {"uint64", Element::uint64},
    {"uint64_t", Element::uint64},
    {"float", Element::real32},
    {"double", Element::real64},
};

/// Signs that turn the axes of a file's space into L P S.
struct Space {
  const char* name;
  Vec3d to_lps;
};
constexpr Space kSpaces[] = {{"left-posterior-superior", {1, 1, 1}},   {"lps", {1, 1, 1}},
                             {"right-anterior-superior", {-1, -1, 1}}, {"ras", {-1, -1, 1}},
                             {"left-anterior-superior", {1, -1, 1}},   {"las", {1, -1, 1}}};

enum class Encoding : unsigned char { raw, gzip, text };

class NrrdHeader {
 public:
  NrrdHeader(const Source& source, HeaderFields& fields) : m_source(source), m_fields(fields) {}

  Raster raster;
  Encoding encoding = Encoding::raw;
  std::size_t skip = 0, per_voxel = 1;  // elements to the chosen layer or time point; layers side by side
  const HeaderField* data_file = nullptr;
  std::int64_t byte_skip = 0, line_skip = 0;

  void read() {
    type();
    sizes();
    byte_order();
    how_packed();
    place();
    data_file = m_fields.find("data file") ? m_fields.find("data file") : m_fields.find("datafile");
    byte_skip = skip_of("byte skip", "byteskip", -1);
    line_skip = skip_of("line skip", "lineskip", 0);
    segments();
    m_fields.finish();
    if (m_layers > 1) {
      const int frame = choose_frame(m_source, m_layers, m_layers_first ? "layers" : "time points");
      raster.stride = m_layers_first ? std::size_t(m_layers) : 1;
      skip = m_layers_first ? std::size_t(frame) : std::size_t(frame) * raster.grid.count();
      keep_segments_of(frame);
    }
    raster.segments = m_segments;
  }

 private:
  const Source& m_source;
  HeaderFields& m_fields;
  std::array<bool, 4> m_is_space{};  // which of the file's axes are the patient's
  std::int64_t m_axes = 0, m_layers = 1;
  bool m_layers_first = false;
  std::vector<Segment> m_segments;
  std::vector<int> m_segment_layers;

  void type() {
    const HeaderField* field = m_fields.need("type");
    if (!field) return;
    const std::string name = lowered(field->value.substr(0, 40));
    for (const ElementName& t : kNrrdTypes)
      if (name == t.name) return void(raster.element = t.element);
    m_fields.fault(*field, tr("expected a type from int8 to uint64, float or double, got {}", shown(field->value)));
  }

  void sizes() {
    const HeaderField *dimension = m_fields.need("dimension"), *sizes = m_fields.need("sizes");
    if (!dimension || !sizes) m_fields.finish();
    m_axes = m_fields.integers(*dimension, 1, 1)[0];
    if (m_axes != 3 && m_axes != 4)
      m_fields.lose(dimension->line, dimension->column,
                    tr("expected dimension 3, or 4 with time points or layers, got {}", shown(dimension->value)));
    const auto all = m_fields.integers(*sizes, std::size_t(m_axes), std::size_t(m_axes));
    which_are_space();
    std::array<std::int64_t, 3> size{1, 1, 1};
    std::size_t next = 0;
    for (std::size_t a = 0; a < std::size_t(m_axes); ++a) {
      if (m_is_space[a] && next < 3) size[next++] = all[a];
      if (!m_is_space[a]) {
        m_layers = all[a];
        m_layers_first = a == 0;
        if (a != 0 && a != 3)
          m_fields.fault(*sizes, "expected time points or layers as the first or last axis, got them between");
      }
    }
    if (m_layers < 1) m_fields.fault(*sizes, tr("expected at least one time point or layer, got {}", m_layers));
    if (const auto fault = size_fault(size, m_source.options.most_voxels))
      m_fields.lose(sizes->line, sizes->column, *fault);
    // Layers side by side are in the memory together.
    if (m_layers > 1 && m_layers_first && std::uint64_t(m_layers) > 65536)
      m_fields.fault(*sizes, "expected at most 65536 layers, got more");
    raster.grid.size = {int(size[0]), int(size[1]), int(size[2])};
  }

  /// Of four axes the one without a direction, or that is not called one of space, is time or a list.
  void which_are_space() {
    m_is_space = {true, true, true, m_axes == 4};
    if (m_axes == 3) return;
    if (const HeaderField* field = m_fields.find("space directions")) {
      const std::string text = lowered(field->value.substr(0, 2000));
      // Vectors and the word "none" follow each other: their order is what counts.
      std::size_t axis = 0;
      int none = 0;
      for (std::size_t at = 0; at < text.size() && axis < 4; ++at) {
        if (text[at] == '(') m_is_space[axis++] = true;
        if (text[at] == 'n') m_is_space[axis++] = false, ++none, at += 3;
      }
      if (none == 1 && axis == 4) return;
    }
    m_is_space = {true, true, true, false};
    if (const HeaderField* kinds = m_fields.find("kinds"))
      if (lowered(kinds->value.substr(0, 4)) != "doma" && lowered(kinds->value.substr(0, 4)) != "spac")
        m_is_space = {false, true, true, true};
  }

  void byte_order() {
    const HeaderField* field = m_fields.find("endian");
    if (!field) {
      if (width_of(raster.element) > 1 && encoding_name() != "ascii" && encoding_name() != "text" &&
          encoding_name() != "txt")
        m_fields.need("endian");
      return;
    }
    const std::string name = lowered(field->value.substr(0, 40));
    raster.big_endian = name == "big";
    if (name != "big" && name != "little")
      m_fields.fault(*field, tr("expected little or big, got {}", shown(field->value)));
  }

  std::string encoding_name() const {
    const HeaderField* field = m_fields.find("encoding");
    return field ? lowered(field->value.substr(0, 40)) : "";
  }
  void how_packed() {
    const HeaderField* field = m_fields.need("encoding");
    if (!field) return;
    const std::string name = encoding_name();
    if (name == "raw")
      encoding = Encoding::raw;
    else if (name == "gzip" || name == "gz")
      encoding = Encoding::gzip;
    else if (name == "ascii" || name == "text" || name == "txt")
      encoding = Encoding::text;
    else
      m_fields.fault(*field, tr("expected encoding raw, gzip or ascii, got {}", shown(field->value)));
  }

  double unit() {
    const HeaderField* field = m_fields.find("space units");
    if (!field) return 1;
    const std::string_view value = field->value;
    const std::string first(value.substr(0, std::min(value.find(' '), value.size())));
    for (const auto& [name, mm] : {std::pair<const char*, double>{"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}})
      if (first == fmt::format("\"{}\"", name) || first == name) return mm;
    m_fields.fault(*field, tr("expected the unit mm, cm, m or um, got {}", shown(value)));
    return 1;
  }

  Vec3d signs() {
    const HeaderField* field = m_fields.find("space");
    if (!field) {
      m_source.report.notes.push_back(
          "the file does not say where the patient's left is (no 'space'): taken as its first axis to the left, second "
          "to the back, third to the head");
      return {1, 1, 1};
    }
    const std::string name = lowered(field->value.substr(0, 40));
    for (const Space& s : kSpaces)
      if (name == s.name) return s.to_lps;
    m_fields.fault(*field, tr("expected left-posterior-superior, right-anterior-superior or "
                              "left-anterior-superior, got {}",
                              shown(field->value)));
    return {1, 1, 1};
  }

  void place() {
    const double mm = unit();
    const Vec3d sign = signs();
    const auto turned = [&](double x, double y, double z) {
      return Vec3d{mm * sign.x * x, mm * sign.y * y, mm * sign.z * z};
    };
    Vec3d columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin;
    const HeaderField *directions = m_fields.find("space directions"), *spacings = m_fields.find("spacings");
    if (directions) {
      std::string text = lowered(directions->value.substr(0, 2000));
      for (std::size_t at = text.find("none"); at != std::string::npos; at = text.find("none")) text.erase(at, 4);
      const auto n = m_fields.numbers({directions->name, text, directions->line, directions->column}, 9, 9);
      for (std::size_t k = 0; k < 3; ++k) columns[k] = turned(n[3 * k], n[3 * k + 1], n[3 * k + 2]);
    } else if (spacings) {
      std::string text = lowered(spacings->value.substr(0, 200));
      for (std::size_t at = text.find("nan"); at != std::string::npos; at = text.find("nan")) text.erase(at, 3);
      auto n = m_fields.numbers({spacings->name, text, spacings->line, spacings->column}, 3, 4);
      n.erase(n.begin() + (n.size() > 3 && m_layers_first ? 0 : 3),
              n.begin() + (n.size() > 3 && m_layers_first ? 1 : std::ptrdiff_t(n.size())));
      columns[0] = turned(n[0], 0, 0), columns[1] = turned(0, n[1], 0), columns[2] = turned(0, 0, n[2]);
    } else {
      m_fields.need("space directions");
    }
    if (const HeaderField* field = m_fields.find("space origin")) {
      const auto n = m_fields.numbers(*field, 3, 3);
      origin = turned(n[0], n[1], n[2]);
    }
    const Mat3d step = Mat3d::from_columns(columns[0], columns[1], columns[2]);
    if (const auto fault = place_fault(origin, step)) {
      const HeaderField* at = directions ? directions : spacings;
      m_fields.lose(at ? at->line : 1, at ? at->column : 1, *fault);
    }
    raster.grid = grid_of(raster.grid.size, origin, step);
  }

  std::int64_t skip_of(const char* name, const char* other, std::int64_t least) {
    const HeaderField* field = m_fields.find(name) ? m_fields.find(name) : m_fields.find(other);
    if (!field) return 0;
    const std::int64_t value = m_fields.integers(*field, 1, 1)[0];
    if (value >= least && value <= 1'000'000'000) return value;
    m_fields.fault(*field, tr("expected a number from {}, got {}", least, shown(field->value)));
    return 0;
  }

  const HeaderField* note(int segment, const char* what) const {
    return m_fields.find(fmt::format("segment{}_{}:=", segment, what));
  }
  void segments() {
    for (int s = 0; s < 1000; ++s) {
      const HeaderField *name = note(s, "name"), *id = note(s, "id");
      if (!name && !id) return;
      Segment segment;
      const HeaderField* value = note(s, "labelvalue");
      const std::int64_t label = value ? m_fields.integers(*value, 1, 1)[0] : s + 1;
      if (label < 0 || label > 65535) {
        m_fields.fault(*value, tr("expected a label up to 65535, got {}", shown(value->value)));
        continue;
      }
      segment.label = std::uint16_t(label);
      segment.name = core::printable((name ? name : id)->value.substr(0, 120));
      segment.colour = colour_of(int(label));
      if (const HeaderField* colour = note(s, "color")) {
        const auto n = m_fields.numbers(*colour, 3, 3);
        for (std::size_t c = 0; c < 3; ++c) segment.colour[c] = float(std::clamp(n[c], 0.0, 1.0));
      }
      const HeaderField* layer = note(s, "layer");
      m_segments.push_back(segment);
      m_segment_layers.push_back(layer ? int(std::clamp<std::int64_t>(m_fields.integers(*layer, 1, 1)[0], 0, 1 << 20))
                                       : 0);
    }
  }
  void keep_segments_of(int layer) {
    std::vector<Segment> kept;
    for (std::size_t s = 0; s < m_segments.size(); ++s)
      if (m_segment_layers[s] == layer) kept.push_back(m_segments[s]);
    m_segments = kept;
  }
};

/// Text becomes doubles in our own order of bytes.
void read_text(std::string_view text, const std::string& file, Raster& raster, std::size_t skip) {
  const std::size_t count = skip + (raster.grid.count() - 1) * raster.stride + 1;
  if (count > text.size() / 2 + 1) refuse(file, tr("expected {} values, got {} bytes", count, text.size()));
  raster.owned.resize(count * sizeof(double));
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    at = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
    const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!core::is_decimal(word)) refuse(file, tr("expected value {} of {}, got {}", i, count, shown(word)));
    const double value = core::to_double(word);
    std::memcpy(raster.owned.data() + i * sizeof(double), &value, sizeof(double));
    at = end;
  }
  raster.element = Element::real64;
  raster.big_endian = false;
  raster.owned.erase(raster.owned.begin(), raster.owned.begin() + std::ptrdiff_t(skip * sizeof(double)));
}

}  // namespace

bool looks_like_nrrd(std::string_view bytes) { return bytes.substr(0, 4) == "NRRD"; }

Raster read_nrrd_volume(const Source& source) {
  const std::size_t first = std::min(source.bytes.find('\n'), source.bytes.size());
  const std::string_view magic = source.bytes.substr(0, first);
  if (magic.substr(0, 7) != "NRRD000" || magic.size() < 8 || magic[7] < '1' || magic[7] > '5')
    throw core::BadInput({{{source.file, 1, 1}, tr("expected NRRD0001 to NRRD0005, got {}", shown(magic))}});
  source.report.format = "NRRD";
  // The first line has no colon: it is passed over as a comment is.
  std::string commented(source.bytes.substr(0, std::min<std::size_t>(source.bytes.size(), (1u << 20) + 65536)));
  commented[0] = '#';
  HeaderFields fields(source.file);
  std::size_t header_end = 0;
  // A file with its data elsewhere may end with its last field.
  const bool ends_early = commented.find("\n\n") == std::string::npos && commented.find("\n\r\n") == std::string::npos;
  if (ends_early) commented += commented.back() == '\n' ? "\n" : "\n\n";
  fields = read_fields(commented, source.file, ':', "");
  header_end = std::min(fields.end, source.bytes.size());
  NrrdHeader header(source, fields);
  header.read();
  Raster raster = std::move(header.raster);

  std::string other;
  std::string_view data = source.bytes.substr(header_end);
  if (header.data_file) {
    const std::string name(header.data_file->value);
    if (!source.beside || !is_plain_name(name))
      throw core::BadInput({{{source.file, header.data_file->line, header.data_file->column},
                             tr("expected the data in this file or in one file of its folder, got {}", shown(name))}});
    other = source.beside(name);
    data = other;
  } else if (ends_early) {
    refuse(source.file, "expected an empty line and the data, got the end of the file");
  }
  for (std::int64_t line = 0; line < header.line_skip; ++line) {
    const std::size_t end = data.find('\n');
    if (end == std::string_view::npos)
      refuse(source.file, "expected as many lines as 'line skip' passes over, got fewer");
    data.remove_prefix(end + 1);
  }
  const std::size_t offset = header.skip * width_of(raster.element), wanted = raster.wanted();
  if (header.encoding == Encoding::text) {
    read_text(data, source.file, raster, header.skip);
  } else if (header.encoding == Encoding::gzip) {
    const std::size_t skip = header.byte_skip > 0 ? std::size_t(header.byte_skip) : 0;
    raster.owned = inflated(data, Wrapping::gzip, skip + offset, wanted, source.file, false,
                            part(source.options.progress, 0, 0.5));
  } else {
    if (header.byte_skip >= 0)
      data.remove_prefix(std::min(data.size(), std::size_t(header.byte_skip)));
    else
      data = data.substr(data.size() - std::min(data.size(), wanted));  // -1: the last bytes of the file
    if (data.size() < offset || data.size() - offset < wanted)
      refuse(source.file, tr("expected {} bytes of voxels, got {}", offset + wanted, data.size()));
    if (header.data_file)
      raster.owned.assign(data.begin() + std::ptrdiff_t(offset), data.begin() + std::ptrdiff_t(offset + wanted));
    else
      raster.bytes = data.substr(offset, wanted);
  }
  return raster;
}

}  // namespace trocar::volumes
