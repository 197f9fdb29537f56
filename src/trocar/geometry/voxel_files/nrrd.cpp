#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/geometry/voxel_files/nrrd.hpp>
#include <trocar/geometry/voxel_files/nrrd_header.hpp>

namespace trocar::geometry {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// Where the numbers are, as the header says.
class NrrdNumbers {
 public:
  NrrdNumbers(NrrdHeader& header, const std::string& file, const NrrdOptions& options)
      : m_header(header), m_volume(header.volume), m_file(file), m_options(options) {}

  /// @param data   the file's bytes behind the header, or those of the file beside
  /// @param other  they are from the file beside
  void read(std::string_view data, bool other) {
    m_data = data;
    m_other = other;
    for (std::int64_t line = 0; line < m_header.line_skip; ++line) {
      const std::size_t end = m_data.find('\n');
      if (end == std::string_view::npos) refuse(m_file, "expected as many lines as 'line skip' passes over, got fewer");
      m_data.remove_prefix(end + 1);
    }
    switch (m_header.encoding) {
      case NrrdEncoding::raw:
        return raw();
      case NrrdEncoding::gzip:
        return packed();
      case NrrdEncoding::text:
        return text();
    }
  }

 private:
  NrrdHeader& m_header;
  NrrdVolume& m_volume;
  const std::string& m_file;
  const NrrdOptions& m_options;
  std::string_view m_data;
  bool m_other = false;

  std::size_t all_bytes() const { return m_header.all_numbers() * width_of(m_volume.type); }
  std::size_t offset() const { return m_header.first * width_of(m_volume.type); }

  void raw() {
    const std::size_t all = all_bytes();
    if (m_header.byte_skip < 0) m_data.remove_prefix(m_data.size() - std::min(m_data.size(), all));  // the last bytes
    if (m_header.byte_skip > 0) m_data.remove_prefix(std::min(m_data.size(), std::size_t(m_header.byte_skip)));
    if (m_data.size() < all) refuse(m_file, tr("expected {} bytes of voxels, got {}", all, m_data.size()));
    if (m_data.size() > all) tell_longer(all, std::to_string(m_data.size()));
    const std::string_view own = m_data.substr(offset(), m_volume.wanted());
    if (m_other)
      m_volume.owned.assign(own.begin(), own.end());
    else
      m_volume.bytes = own;
  }

  void packed() {
    const std::size_t skip = std::size_t(m_header.byte_skip), all = all_bytes();
    const PackedPart wanted{skip + offset(), m_volume.wanted(), all - offset() - m_volume.wanted()};
    bool more = false;
    m_volume.owned = inflated_part(m_data, Wrapping::gzip, wanted, m_file, m_options.progress, more);
    if (more) tell_longer(all, tr("more"));
  }

  /// Which bytes are the voxels is certain behind a header and where the header says what to skip. A file beside may
  /// begin with a header of its own.
  void tell_longer(std::size_t all, const std::string& got) {
    const bool certain = !m_other || m_header.byte_skip != 0 || m_header.line_skip != 0;
    if (!certain)
      refuse(m_file, tr("expected {} bytes of voxels, as the sizes say, got {}: write \"byte skip\" into the header "
                        "(-1 where raw voxels are the file's last bytes)",
                        all, got));
    m_volume.notes.push_back(
        tr("the sizes say {} bytes of voxels, there are {}: what follows was passed over", all, got));
  }

  /// Text becomes doubles in the machine's order of bytes.
  void text() {
    m_data.remove_prefix(std::min(m_data.size(), std::size_t(m_header.byte_skip)));
    const std::size_t all = m_header.all_numbers(), from = m_header.first, to = from + m_volume.wanted_numbers();
    if (all > m_data.size() / 2 + 1) refuse(m_file, tr("expected {} values, got {} bytes", all, m_data.size()));
    m_volume.owned.resize((to - from) * sizeof(double));
    std::size_t at = 0;
    for (std::size_t i = 0; i < all; ++i) {
      const double value = number(at, i, all);
      if (i >= from && i < to) std::memcpy(m_volume.owned.data() + (i - from) * sizeof(double), &value, sizeof(double));
    }
    if (m_data.find_first_not_of(kBlanks, at) != std::string_view::npos)
      m_volume.notes.push_back(tr("the sizes say {} values, there are more: what follows was passed over", all));
    m_volume.type = NumberType::real64;
    m_volume.big_endian = machine_is_big();
  }
  double number(std::size_t& at, std::size_t i, std::size_t all) const {
    at = std::min(m_data.find_first_not_of(kBlanks, at), m_data.size());
    const std::size_t end = std::min(m_data.find_first_of(kBlanks, at), m_data.size());
    const std::string_view word = m_data.substr(at, end - at);
    at = end;
    const bool is_number = core::is_decimal(word);
    const double value = is_number ? core::to_double(word) : 0;
    if (!is_number || !fits(value))
      refuse(m_file, tr("expected value {} of {} as {}, got {}", i, all, name_of(m_volume.written), shown(word)));
    return value;
  }
  bool fits(double value) const {
    bool out = true;
    if (is_whole(m_volume.written))
      with_type(m_volume.written, [&](auto zero) {
        using T = decltype(zero);
        out = value == std::floor(value) && value >= double(std::numeric_limits<T>::min()) &&
              value <= double(std::numeric_limits<T>::max());
      });
    return out;
  }
};

void require_magic(std::string_view bytes, const std::string& file) {
  const std::string_view first = bytes.substr(0, std::min(bytes.find('\n'), bytes.size()));
  if (first.substr(0, 7) != "NRRD000" || first.size() < 8 || first[7] < '1' || first[7] > '5')
    throw core::BadInput({{{file, 1, 1}, tr("expected NRRD0001 to NRRD0005, got {}", shown(first))}});
}

constexpr double kMostWhole = 16'777'216;  // float holds every whole number up to here

/// The numbers in a type that holds them; a fault where it does not.
template <class Kept>
std::vector<Kept> kept_as(const NrrdVolume& volume, const std::string& file) {
  std::vector<Kept> out(volume.count());
  const bool swapped = volume.big_endian != machine_is_big();
  with_type(volume.type, [&](auto zero) {
    using Read = decltype(zero);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto value = double(number_at<Read>(volume.data() + i * volume.stride * sizeof(Read), swapped));
      const double most = is_whole(volume.written) ? kMostWhole : double(std::numeric_limits<float>::max());
      if (!(std::fabs(value) <= most))
        refuse(file, tr("expected {}, got {} in voxel {}",
                        is_whole(volume.written) ? "a whole number up to 16777216" : "a finite number", value, i));
      out[i] = static_cast<Kept>(value);
    }
  });
  return out;
}

}  // namespace

bool looks_like_nrrd(std::string_view bytes) { return bytes.substr(0, 4) == "NRRD"; }

std::optional<std::string> name_beside(std::string_view name) {
  while (name.substr(0, 2) == "./") name.remove_prefix(2);
  const bool plain = !name.empty() && name.size() < 256 && name[0] != '.' && name.substr(0, 4) != "LIST" &&
                     name.find_first_of("/\\:%") == std::string_view::npos && name.find('\0') == std::string_view::npos;
  return plain ? std::optional<std::string>(name) : std::nullopt;
}

std::string remedy_for_name(std::string_view name) {
  if (name.substr(0, 4) == "LIST" || name.find('%') != std::string_view::npos)
    return tr(": several files; open it in 3D Slicer and save it as one file first");
  return tr(": put that file beside the header and write its name alone");
}

NrrdVolume read_nrrd(std::string_view bytes, const std::string& file, const NrrdOptions& options) {
  require_magic(bytes, file);
  // The first line has no colon: it is passed over as a comment is.
  std::string commented(bytes.substr(0, std::min<std::size_t>(bytes.size(), (1u << 20) + 65536)));
  commented[0] = '#';
  // A file with its data elsewhere may end with its last field.
  const bool ends_early = commented.find("\n\n") == std::string::npos && commented.find("\n\r\n") == std::string::npos;
  if (ends_early) commented += commented.back() == '\n' ? "\n" : "\n\n";
  HeaderFields fields = read_fields(commented, file, ':', "");
  NrrdHeader header = nrrd_header(fields, options, file);
  std::string other;
  if (header.data_file) {
    const auto name = name_beside(header.data_file->value);
    if (!options.beside || !name)
      throw core::BadInput({{{file, header.data_file->line, header.data_file->column},
                             tr("expected the data in this file or in one file of its folder, got {}{}",
                                shown(header.data_file->value), remedy_for_name(header.data_file->value))}});
    other = options.beside(*name);
  } else if (ends_early) {
    refuse(file, "expected an empty line and the data, got the end of the file");
  }
  const std::string_view behind = bytes.substr(std::min(fields.end, bytes.size()));
  NrrdNumbers(header, file, options)
      .read(header.data_file ? std::string_view(other) : behind, header.data_file != nullptr);
  return std::move(header.volume);
}

Voxels voxels_of(const NrrdVolume& volume, const std::string& file) {
  constexpr Mat3d kScene{{{1e-3, 0, 0}, {0, 0, 1e-3}, {0, -1e-3, 0}}};  // of millimetres in L P S
  Voxels out;
  out.size = volume.size;
  out.origin = kScene * volume.origin;
  out.step = kScene * volume.step;
  switch (volume.written) {
    case NumberType::uint8:
      out.values = kept_as<std::uint8_t>(volume, file);
      break;
    case NumberType::int8:
    case NumberType::int16:
      out.values = kept_as<std::int16_t>(volume, file);
      break;
    case NumberType::uint16:
      out.values = kept_as<std::uint16_t>(volume, file);
      break;
    default:
      out.values = kept_as<float>(volume, file);
  }
  return out;
}

}  // namespace trocar::geometry
