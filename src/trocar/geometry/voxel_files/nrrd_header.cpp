#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/grid_faults.hpp>
#include <trocar/geometry/voxel_files/nrrd_header.hpp>

namespace trocar::geometry {
namespace {

struct TypeName {
  const char* name;
  NumberType type;
};
constexpr TypeName kNrrdTypes[] = {
    {"signed char", NumberType::int8},
    {"int8", NumberType::int8},
    {"int8_t", NumberType::int8},
    {"uchar", NumberType::uint8},
    {"unsigned char", NumberType::uint8},
    {"uint8", NumberType::uint8},
    {"uint8_t", NumberType::uint8},
    {"short", NumberType::int16},
    {"short int", NumberType::int16},
    {"signed short", NumberType::int16},
    {"signed short int", NumberType::int16},
    {"int16", NumberType::int16},
    {"int16_t", NumberType::int16},
    {"ushort", NumberType::uint16},
    {"unsigned short", NumberType::uint16},
    {"unsigned short int", NumberType::uint16},
    {"uint16", NumberType::uint16},
    {"uint16_t", NumberType::uint16},
    {"int", NumberType::int32},
    {"signed int", NumberType::int32},
    {"int32", NumberType::int32},
    {"int32_t", NumberType::int32},
    {"uint", NumberType::uint32},
    {"unsigned int", NumberType::uint32},
    {"uint32", NumberType::uint32},
    {"uint32_t", NumberType::uint32},
    {"longlong", NumberType::int64},
    {"long long", NumberType::int64},
    {"long long int", NumberType::int64},
    {"signed long long", NumberType::int64},
    {"signed long long int", NumberType::int64},
    {"int64", NumberType::int64},
    {"int64_t", NumberType::int64},
    {"ulonglong", NumberType::uint64},
    {"unsigned long long", NumberType::uint64},
    {"unsigned long long int", NumberType::uint64},
    {"uint64", NumberType::uint64},
    {"uint64_t", NumberType::uint64},
    {"float", NumberType::real32},
    {"double", NumberType::real64},
};

constexpr std::int64_t kMostLayers = 65536;

/// Signs that turn the axes of a file's space into L P S.
struct Space {
  const char* name;
  Vec3d to_lps;
};
constexpr Space kSpaces[] = {{"left-posterior-superior", {1, 1, 1}},   {"lps", {1, 1, 1}},
                             {"right-anterior-superior", {-1, -1, 1}}, {"ras", {-1, -1, 1}},
                             {"left-anterior-superior", {1, -1, 1}},   {"las", {1, -1, 1}}};

/// Kinds of an axis that may be layers or points in time; all others make several numbers one value.
constexpr const char* kListKinds[] = {"none", "???", "time", "list", "domain", "space", "scalar", "stub"};

class HeaderReader {
 public:
  HeaderReader(HeaderFields& fields, const NrrdOptions& options, const std::string& file)
      : m_fields(fields), m_options(options), m_file(file) {}

  NrrdHeader read() {
    for (const HeaderField& field : m_fields.fields)
      if (field.name.starts_with("seq_frame")) m_fields.lose(field.line, 1, tracked_sequence());
    type();
    how_packed();
    sizes();
    byte_order();
    place();
    m_out.data_file = either("data file", "datafile");
    m_out.byte_skip = skip_of("byte skip", "byteskip", -1);
    m_out.line_skip = skip_of("line skip", "lineskip", 0);
    if (m_out.byte_skip < 0 && m_out.encoding != NrrdEncoding::raw)
      m_fields.fault(*either("byte skip", "byteskip"),
                     "expected byte skip -1 with encoding raw only, got another encoding");
    segments();
    m_fields.finish();
    layers();
    return std::move(m_out);
  }

 private:
  HeaderFields& m_fields;
  const NrrdOptions& m_options;
  const std::string& m_file;
  NrrdHeader m_out;
  NrrdVolume& m_volume = m_out.volume;
  std::array<bool, 4> m_is_space{};  // which of the file's axes are the patient's
  std::int64_t m_axes = 0, m_layers = 1;
  bool m_layers_first = false;
  std::vector<int> m_segment_layers;

  const HeaderField* either(const char* name, const char* other) const {
    return m_fields.find(name) ? m_fields.find(name) : m_fields.find(other);
  }

  void layers() {
    const char* what = m_layers_first ? "layers" : "time points";
    if (m_layers > kMostLayers) refuse(m_file, tr("expected 1 to {} {}, got {}", kMostLayers, what, m_layers));
    const int chosen = m_options.choose ? m_options.choose(m_layers, what) : 0;
    if (m_layers == 1) return;
    if (!m_options.choose) m_volume.notes.push_back(tr("{} {}: number 0 is read", m_layers, what));
    m_out.layers = std::size_t(m_layers);
    m_volume.stride = m_layers_first ? m_out.layers : 1;
    m_out.first = m_layers_first ? std::size_t(chosen) : std::size_t(chosen) * m_volume.count();
    std::vector<NrrdSegment> kept;
    for (std::size_t s = 0; s < m_segment_layers.size(); ++s)
      if (m_segment_layers[s] == chosen) kept.push_back(m_volume.segments[s]);
    m_volume.segments = kept;
  }

  void type() {
    const HeaderField* field = m_fields.need("type");
    if (!field) return;
    const std::string name = core::in_small_letters(field->value.substr(0, 40));
    for (const TypeName& t : kNrrdTypes)
      if (name == t.name) return void(m_volume.type = m_volume.written = t.type);
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
    if (const auto fault = size_fault(size, m_options.most_voxels)) m_fields.lose(sizes->line, sizes->column, *fault);
    m_volume.size = {int(size[0]), int(size[1]), int(size[2])};
    if (m_axes == 4) require_list();
  }

  /// Colours, vectors and complex numbers are no layers.
  void require_list() {
    const HeaderField* kinds = m_fields.find("kinds");
    if (!kinds) return;
    std::istringstream words(core::in_small_letters(kinds->value.substr(0, 400)));
    std::string word;
    for (std::size_t a = 0; a < 4 && words >> word; ++a) {
      if (m_is_space[a]) continue;
      const bool known =
          std::any_of(std::begin(kListKinds), std::end(kListKinds), [&](const char* k) { return word == k; });
      if (!known)
        m_fields.fault(*kinds,
                       tr("expected one number a voxel, or an axis of time points or a list, got {}", shown(word)));
    }
  }

  /// Of four axes the one without a direction, or that is not called one of space, is time or a list.
  void which_are_space() {
    m_is_space = {true, true, true, m_axes == 4};
    if (m_axes == 3) return;
    if (const HeaderField* field = m_fields.find("space directions")) {
      const std::string text = core::in_small_letters(field->value.substr(0, 2000));
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
      if (core::in_small_letters(kinds->value.substr(0, 4)) != "doma" &&
          core::in_small_letters(kinds->value.substr(0, 4)) != "spac")
        m_is_space = {false, true, true, true};
  }

  void byte_order() {
    const HeaderField* field = m_fields.find("endian");
    if (!field) {
      if (width_of(m_volume.type) > 1 && m_out.encoding != NrrdEncoding::text) m_fields.need("endian");
      return;
    }
    const std::string name = core::in_small_letters(field->value.substr(0, 40));
    m_volume.big_endian = name == "big";
    if (name != "big" && name != "little")
      m_fields.fault(*field, tr("expected little or big, got {}", shown(field->value)));
  }

  void how_packed() {
    const HeaderField* field = m_fields.need("encoding");
    if (!field) return;
    const std::string name = core::in_small_letters(field->value.substr(0, 40));
    if (name == "raw")
      m_out.encoding = NrrdEncoding::raw;
    else if (name == "gzip" || name == "gz")
      m_out.encoding = NrrdEncoding::gzip;
    else if (name == "ascii" || name == "text" || name == "txt")
      m_out.encoding = NrrdEncoding::text;
    else
      m_fields.fault(*field, tr("expected encoding raw, gzip or ascii, got {}: open the file in 3D Slicer and save it "
                                "again, or convert it with 'unu save -f nrrd -e gzip'",
                                shown(field->value)));
  }

  double unit() {
    constexpr std::pair<const char*, double> kUnits[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}};
    const HeaderField* field = m_fields.find("space units");
    if (!field) return 1;
    double out = 0;
    std::istringstream words(std::string(field->value.substr(0, 400)));
    std::string word;
    while (words >> word) {
      word.erase(std::remove(word.begin(), word.end(), '"'), word.end());
      const auto* known =
          std::find_if(std::begin(kUnits), std::end(kUnits), [&](const auto& u) { return word == u.first; });
      if (known == std::end(kUnits) || (out != 0 && out != known->second)) {
        m_fields.fault(*field,
                       tr("expected the unit mm, cm, m or um, the same for all axes, got {}", shown(field->value)));
        return 1;
      }
      out = known->second;
    }
    return out != 0 ? out : 1;
  }

  Vec3d signs() {
    const HeaderField* field = m_fields.find("space");
    if (!field) {
      m_volume.notes.emplace_back(tr(
          "the file does not say where the patient's left is (no 'space'): taken as its first axis to the left, second "
          "to the back, third to the head"));
      return {1, 1, 1};
    }
    const std::string name = core::in_small_letters(field->value.substr(0, 40));
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
      std::string text = core::in_small_letters(directions->value.substr(0, 2000));
      for (std::size_t at = text.find("none"); at != std::string::npos; at = text.find("none")) text.erase(at, 4);
      const auto n = m_fields.numbers({directions->name, text, directions->line, directions->column}, 9, 9);
      for (std::size_t k = 0; k < 3; ++k) columns[k] = turned(n[3 * k], n[3 * k + 1], n[3 * k + 2]);
    } else if (spacings) {
      std::string text = core::in_small_letters(spacings->value.substr(0, 200));
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
    m_volume.origin = origin;
    m_volume.step = step;
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
      NrrdSegment segment;
      const HeaderField* value = note(s, "labelvalue");
      const std::int64_t label = value ? m_fields.integers(*value, 1, 1)[0] : s + 1;
      if (label < 0 || label > 65535) {
        m_fields.fault(*value, tr("expected a label up to 65535, got {}", shown(value->value)));
        continue;
      }
      segment.label = int(label);
      segment.name = core::printable((name ? name : id)->value.substr(0, 120));
      if (const HeaderField* colour = note(s, "color")) {
        const auto n = m_fields.numbers(*colour, 3, 3);
        segment.colour = {std::clamp(n[0], 0.0, 1.0), std::clamp(n[1], 0.0, 1.0), std::clamp(n[2], 0.0, 1.0)};
      }
      const HeaderField* layer = note(s, "layer");
      m_volume.segments.push_back(segment);
      m_segment_layers.push_back(
          layer ? int(std::clamp<std::int64_t>(m_fields.integers(*layer, 1, 1)[0], 0, kMostLayers)) : 0);
    }
  }
};

}  // namespace

NrrdHeader nrrd_header(HeaderFields& fields, const NrrdOptions& options, const std::string& file) {
  return HeaderReader(fields, options, file).read();
}

}  // namespace trocar::geometry
