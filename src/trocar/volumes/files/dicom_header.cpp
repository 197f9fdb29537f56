#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_header.hpp>
#include <trocar/volumes/files/header_fields.hpp>

namespace trocar::volumes {
namespace {

constexpr int kMostFrames = 65536;

/// An attribute's text without its padding; empty where it is not there.
std::string text_of(const DicomItem& data, std::uint32_t tag) {
  const DicomElement* element = data.find(tag);
  if (!element) return "";
  std::string text(element->value.substr(0, 4096));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

/// Numbers apart by backslashes; none where the attribute is not there or empty.
std::vector<double> decimals_of(const DicomItem& data, std::uint32_t tag, std::size_t count, const std::string& path,
                                const char* name) {
  const std::string text = text_of(data, tag);
  std::vector<double> out;
  if (text.empty()) return out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string word = text.substr(at, end - at);
    word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
    word.erase(word.find_last_not_of(' ') + 1);
    const double value = core::is_decimal(word) ? core::to_double(word) : NAN;
    if (!(std::fabs(value) <= 1e9)) refuse(path, tr("expected numbers up to 1e9 in {}, got {}", name, shown(word)));
    out.push_back(value);
    at = end + 1;
  }
  if (out.size() < count) refuse(path, tr("expected {} numbers in {}, got {}", count, name, shown(text)));
  out.resize(count);
  return out;
}

/// The item of a sequence in a data set, or null.
const DicomItem* item_of(const DicomItem* data, std::uint32_t sequence, std::size_t number = 0) {
  const DicomElement* element = data ? data->find(sequence) : nullptr;
  return element && number < element->items.size() ? &element->items[number] : nullptr;
}

constexpr std::uint32_t kSharedGroups = 0x52009229, kFrameGroups = 0x52009230;

/// Reads what stands in the data set itself, in what all frames share, or in what is each frame's own.
class HeaderOfImage {
 public:
  HeaderOfImage(const DicomDocument& file, DicomHeader& out)
      : m_data(file.root), m_big(file.big_endian), m_out(out), m_shared(item_of(&m_data, kSharedGroups)) {}

  void read() {
    m_out.uid = core::printable(text_of(m_data, 0x0020000e));
    m_out.description = core::printable(text_of(m_data, 0x0008103e));
    m_out.modality = core::printable(text_of(m_data, 0x00080060));
    m_out.photometric = text_of(m_data, 0x00280004);
    m_out.rows = unsigned_short(0x00280010);
    m_out.columns = unsigned_short(0x00280011);
    const auto tilt = decimals(m_data, 0x00181120, 1, "Gantry/Detector Tilt");
    if (!tilt.empty()) m_out.tilt_deg = tilt[0];
    const auto frames = decimals(m_data, 0x00280008, 1, "Number of Frames");
    if (!frames.empty() && !(frames[0] >= 1 && frames[0] <= kMostFrames))
      refuse(m_out.path, tr("expected 1 to {} frames, got {}", kMostFrames, frames[0]));
    if (!frames.empty()) m_out.frames = int(frames[0]);
    pixels();
    const auto number = decimals(m_data, 0x00200013, 1, "Instance Number");
    for (int f = 0; f < m_out.frames; ++f) {
      const DicomItem* own = item_of(&m_data, kFrameGroups, std::size_t(f));
      place(own, number.empty() ? 0 : int(std::clamp(number[0], -1e9, 1e9)) + f);
      rescale(own);
      if (f == 0) plane(own);
    }
    if (m_out.places.size() < std::size_t(m_out.frames)) m_out.places.clear();
  }

 private:
  const DicomItem& m_data;
  bool m_big;
  DicomHeader& m_out;
  const DicomItem* m_shared;

  int unsigned_short(std::uint32_t tag) const {
    const DicomElement* element = m_data.find(tag);
    if (!element || element->value.size() < 2) return 0;
    const auto byte = [&](std::size_t i) { return int(static_cast<unsigned char>(element->value[i])); };
    return byte(m_big ? 1 : 0) + 256 * byte(m_big ? 0 : 1);
  }

  std::vector<double> decimals(const DicomItem& data, std::uint32_t tag, std::size_t count, const char* name) {
    return decimals_of(data, tag, count, m_out.path, name);
  }
  std::vector<double> decimals(const DicomItem* own, std::uint32_t group, std::uint32_t tag, std::size_t count,
                               const char* name) {
    for (const DicomItem* item : {item_of(own, group), item_of(m_shared, group)})
      if (item && item->find(tag)) return decimals(*item, tag, count, name);
    return decimals(m_data, tag, count, name);
  }

  void pixels() {
    const int samples = unsigned_short(0x00280002);
    if (m_out.rows == 0 || m_out.columns == 0)
      m_out.fault = "expected an image, got a file without rows and columns";
    else if (samples > 1 || (m_out.photometric != "MONOCHROME2" && m_out.photometric != "MONOCHROME1"))
      m_out.fault = tr("expected one grey value a pixel, got {} ({} values)", shown(m_out.photometric), samples);
    else if (m_data.find(0x00283000))
      m_out.fault = "expected slope and intercept, got values by a table (Modality LUT)";
    m_out.allocated = unsigned_short(0x00280100);
    m_out.stored = unsigned_short(0x00280101);
    m_out.is_signed = unsigned_short(0x00280103) == 1;
    const int high = unsigned_short(0x00280102);
    const bool known = m_out.allocated == 8 || m_out.allocated == 16 || m_out.allocated == 32;
    if (m_out.fault.empty() &&
        (!known || m_out.stored < 1 || m_out.stored > m_out.allocated || high != m_out.stored - 1))
      m_out.fault = tr("expected 8, 16 or 32 bits a pixel with those that count lowest, got {} of {} bits up to bit {}",
                       m_out.stored, m_out.allocated, high);
  }

  void place(const DicomItem* own, int number) {
    const auto at = decimals(own, 0x00209113, 0x00200032, 3, "Image Position (Patient)");
    if (at.empty()) return;
    const auto thickness = decimals(own, 0x00289110, 0x00180050, 1, "Slice Thickness");
    m_out.places.push_back({{at[0], at[1], at[2]}, number, thickness.empty() ? 0 : thickness[0]});
  }

  void rescale(const DicomItem* own) {
    const auto intercept = decimals(own, 0x00289145, 0x00281052, 1, "Rescale Intercept");
    const auto slope = decimals(own, 0x00289145, 0x00281053, 1, "Rescale Slope");
    Rescale r;
    if (!intercept.empty()) r.intercept = intercept[0];
    if (!slope.empty() && slope[0] != 0) r.slope = slope[0];
    m_out.rescale.push_back(r);
  }

  void plane(const DicomItem* own) {
    const auto axes = decimals(own, 0x00209116, 0x00200037, 6, "Image Orientation (Patient)");
    const auto apart = decimals(own, 0x00289110, 0x00280030, 2, "Pixel Spacing");
    if (apart.size() == 2) m_out.between_rows = apart[0], m_out.between_columns = apart[1];
    if (axes.empty()) return;
    const Vec3d row{axes[0], axes[1], axes[2]}, column{axes[3], axes[4], axes[5]};
    if (!(length(row) > 0.9 && length(row) < 1.1 && length(column) > 0.9 && length(column) < 1.1 &&
          std::fabs(dot(row, column)) < 1e-2))
      refuse(m_out.path,
             "expected two perpendicular directions of unit length in Image Orientation (Patient), got others");
    m_out.row = normalised(row);
    m_out.column = normalised(column - dot(column, m_out.row) * m_out.row);
  }
};

}  // namespace

Element DicomHeader::element() const {
  if (allocated == 8) return is_signed ? Element::int8 : Element::uint8;
  if (allocated == 16) return is_signed ? Element::int16 : Element::uint16;
  return is_signed ? Element::int32 : Element::uint32;
}

DicomHeader dicom_header(const DicomDocument& file, const std::string& path) {
  DicomHeader out;
  out.path = path;
  HeaderOfImage(file, out).read();
  return out;
}

bool same_stack(const DicomHeader& a, const DicomHeader& b) {
  if (a.uid.empty() && (a.description != b.description || a.modality != b.modality)) return false;  // taken out
  return a.uid == b.uid && a.rows == b.rows && a.columns == b.columns && length(a.row - b.row) < 1e-3 &&
         length(a.column - b.column) < 1e-3 && std::fabs(a.between_rows - b.between_rows) < 1e-4 &&
         std::fabs(a.between_columns - b.between_columns) < 1e-4 && (a.frames > 1) == (b.frames > 1);
}

}  // namespace trocar::volumes
