#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_header.hpp>
#include <trocar/volumes/files/dicom_kinds.hpp>

namespace trocar::volumes {
namespace {

constexpr int kMostFrames = 65536;
constexpr const char* kConvert = "export the series again, or convert it to NIfTI, for instance with dcm2niix";

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

constexpr std::uint32_t kSharedGroups = 0x52009229, kFrameGroups = 0x52009230, kDetector = 0x00540022,
                        kPlanePosition = 0x00209113, kPlaneOrientation = 0x00209116, kPixelMeasures = 0x00289110,
                        kValueTransformation = 0x00289145, kRescaleType = 0x00281054, kFloatPixels = 0x7fe00008,
                        kDoublePixels = 0x7fe00009;

std::string text_of_first(std::initializer_list<const DicomItem*> items, std::uint32_t tag) {
  constexpr std::size_t kMost = 256;  // [bytes], as each frame has its own
  std::string out;
  for (const DicomItem* item : items)
    if (item && out.empty()) out = text_of(*item, tag, kMost);
  return out;
}

/// Reads what stands in the data set itself, in what all frames share, or in what is each frame's own.
class HeaderOfImage {
 public:
  HeaderOfImage(const DicomDocument& file, DicomHeader& out)
      : m_data(file.root),
        m_damage(file.damage),
        m_big(file.big_endian),
        m_out(out),
        m_shared(item_of(&m_data, kSharedGroups)),
        m_marks_of(m_data, m_shared, m_big),
        m_common_type(text_of_first({item_of(m_shared, kValueTransformation), &m_data}, kRescaleType)) {}

  void read() {
    m_out.uid = text_of(m_data, 0x0020000e);
    m_out.instance = text_of(m_data, 0x00080018);
    m_out.patient = text_of(m_data, 0x00100020);
    m_out.study = text_of(m_data, 0x0020000d);
    m_out.frame_of_reference = text_of(m_data, 0x00200052);
    m_out.description = text_of(m_data, 0x0008103e);
    m_out.modality = text_of(m_data, 0x00080060);
    m_out.photometric = text_of(m_data, 0x00280004);
    if (const std::string own = text_of(m_data, 0x00080016); !own.empty()) m_out.sop_class = own;
    const DicomItem* first = item_of(&m_data, kFrameGroups);
    const bool has_places = !text_of(m_data, 0x00200032).empty() || item_of(first, kPlanePosition);
    m_marks = m_marks_of.of(first);
    const std::string kind =
        other_than_slices({m_out.sop_class, m_out.modality, m_marks[Mark::image_type], has_places});
    if (!kind.empty()) return void(m_out.fault = tr("expected slices of a patient, got {}", kind));
    if (!m_damage.empty()) refuse(m_out.path, damaged_dicom(m_damage));
    m_out.rows = unsigned_short(0x00280010);
    m_out.columns = unsigned_short(0x00280011);
    const auto tilt = decimals(m_data, 0x00181120, 1, "Gantry/Detector Tilt");
    if (!tilt.empty()) m_out.tilt_deg = tilt[0];
    pixels();
    if (m_out.fault.empty()) padding();
    if (m_out.fault.empty()) frames();
    if (!m_out.fault.empty()) m_out.frames.clear();
  }

 private:
  const DicomItem& m_data;
  const std::string& m_damage;
  bool m_big;
  DicomHeader& m_out;
  const DicomItem* m_shared;
  FrameMarks m_marks_of;
  std::string m_common_type;                              // Rescale Type of frames without their own
  std::map<std::uint32_t, std::vector<double>> m_common;  // numbers of frames without their own, by their tags
  Marks m_marks;                                          // of the first frame
  Rescale m_padding;                                      // without slope and intercept
  int m_count = 1;

  int unsigned_short(std::uint32_t tag) const {
    const DicomElement* element = m_data.find(tag);
    if (!element || element->value.size() < 2) return 0;
    return geometry::number_at_in<std::uint16_t>(m_big, element->value.data());
  }

  std::vector<double> decimals(const DicomItem& data, std::uint32_t tag, std::size_t count, const char* name) {
    return decimals_of(data, tag, count, m_out.path, name);
  }
  std::vector<double> decimals(const DicomItem* own, std::uint32_t group, std::uint32_t tag, std::size_t count,
                               const char* name) {
    const DicomItem* item = item_of(own, group);
    if (item && item->find(tag)) return decimals(*item, tag, count, name);
    const auto known = m_common.find(tag);
    return known != m_common.end() ? known->second : m_common[tag] = decimals_of_all(group, tag, count, name);
  }
  /// What the file says of all frames.
  std::vector<double> decimals_of_all(std::uint32_t group, std::uint32_t tag, std::size_t count, const char* name) {
    for (const DicomItem* item : {item_of(m_shared, group), item_of(&m_data, kDetector)})
      if (item && item->find(tag)) return decimals(*item, tag, count, name);
    return decimals(m_data, tag, count, name);
  }

  void pixels() {
    const int samples = unsigned_short(0x00280002);
    if (m_out.rows == 0 || m_out.columns == 0)
      m_out.fault = "expected an image, got a file without rows and columns";
    else if (samples > 1 || (m_out.photometric != "MONOCHROME2" && m_out.photometric != "MONOCHROME1"))
      m_out.fault =
          tr("expected one grey value a pixel, got {} ({} values): open the series of grey values that these "
             "pictures were made of",
             shown(m_out.photometric), samples);
    else if (m_data.find(0x00283000))
      m_out.fault = tr("expected slope and intercept, got values by a table (Modality LUT): {}", tr(kConvert));
    else if (m_data.find(kFloatPixels) || m_data.find(kDoublePixels))
      m_out.fault =
          tr("expected Pixel Data of whole numbers, got Float Pixel Data: open the series in 3D Slicer and "
             "save it as NRRD");
    m_out.allocated = unsigned_short(0x00280100);
    m_out.stored = unsigned_short(0x00280101);
    m_out.is_signed = unsigned_short(0x00280103) == 1;
    const int high = unsigned_short(0x00280102);
    const bool known = m_out.allocated == 8 || m_out.allocated == 16 || m_out.allocated == 32;
    if (m_out.fault.empty() &&
        (!known || m_out.stored < 1 || m_out.stored > m_out.allocated || high != m_out.stored - 1))
      m_out.fault =
          tr("expected 8, 16 or 32 bits a pixel with those that count lowest, got {} of {} bits up to bit {}: {}",
             m_out.stored, m_out.allocated, high, tr(kConvert));
  }

  /// Numbers that fill up the picture around the patient. [PS3.3, C.7.5.1.1.2]
  void padding() {
    constexpr std::uint32_t kValue = 0x00280120, kLimit = 0x00280121;
    const DicomElement* element = m_data.find(kValue);
    if (!element || element->value.size() < 2) return;
    const auto number = [&](std::uint32_t tag) {
      const int bits = unsigned_short(tag);
      return m_out.is_signed && bits > 32767 ? bits - 65536 : bits;
    };
    const int value = number(kValue);
    const DicomElement* limit = m_data.find(kLimit);
    const int other = limit && limit->value.size() >= 2 ? number(kLimit) : value;
    const double most = std::ldexp(1.0, m_out.stored - (m_out.is_signed ? 1 : 0)) - 1;
    if (std::max(value, other) > most || std::min(value, other) < (m_out.is_signed ? -most - 1 : 0))
      return m_out.corrected.push_back(
          tr("Pixel Padding Value {} does not fit into the {} bits stored: it was ignored", value, m_out.stored));
    m_padding.padding_from = std::min(value, other), m_padding.padding_to = std::max(value, other);
  }

  int frame_count() {
    const auto said = decimals(m_data, 0x00280008, 1, "Number of Frames");
    if (said.empty()) return 1;
    if (said[0] == 0) m_out.corrected.emplace_back(tr("Number of Frames is 0: taken as 1"));
    if (!(said[0] >= 0 && said[0] <= kMostFrames))
      refuse(m_out.path, tr("expected 1 to {} frames, got {}", kMostFrames, said[0]));
    return std::max(1, int(said[0]));
  }

  void frames() {
    m_count = frame_count();
    const std::string instance = m_marks[Mark::instance];
    int own_places = 0;
    for (int f = 0; f < m_count; ++f) {
      const DicomItem* own = item_of(&m_data, kFrameGroups, std::size_t(f));
      DicomFrame frame;
      if (!place(own, frame)) return;
      own_places += item_of(own, kPlanePosition) != nullptr;
      rescale(own, frame);
      frame.marks = own && f > 0 ? m_marks_of.of(own) : m_marks;
      if (core::is_decimal(instance))
        frame.marks[Mark::instance] = fmt::format("{:.0f}", core::to_double(instance) + f);
      m_out.frames.push_back(std::move(frame));
    }
    if (m_count > 1 && own_places < m_count) place_along_the_normal(own_places);
  }

  /// False where the frame does not say where it is.
  bool place(const DicomItem* own, DicomFrame& frame) {
    const auto at = decimals(own, kPlanePosition, 0x00200032, 3, "Image Position (Patient)");
    const auto axes = decimals(own, kPlaneOrientation, 0x00200037, 6, "Image Orientation (Patient)");
    const auto apart = decimals(own, kPixelMeasures, 0x00280030, 2, "Pixel Spacing");
    const auto thickness = decimals(own, kPixelMeasures, 0x00180050, 1, "Slice Thickness");
    if (at.empty())
      m_out.fault = m_count > 1
                        ? tr("expected a place for each frame (Plane Position Sequence), got none: {}", tr(kConvert))
                        : tr("expected Image Position (Patient), got none, which Slice Location cannot replace: export "
                             "the series again with it");
    else if (axes.empty())
      m_out.fault = tr(
          "expected Image Orientation (Patient), got none: export the series again with it, or open the original one");
    else if (apart.empty())
      m_out.fault = tr("expected Pixel Spacing, got none: export the series again with it, or open the original one");
    else if (!(apart[0] > 0 && apart[1] > 0))
      m_out.fault = tr("expected Pixel Spacing above 0, got {} x {}: export the series again, or open the original one",
                       apart[0], apart[1]);
    if (!m_out.fault.empty()) return false;
    frame.position = {at[0], at[1], at[2]};
    frame.between_rows = apart[0], frame.between_columns = apart[1];
    if (!thickness.empty()) frame.thickness = thickness[0];
    const Vec3d row{axes[0], axes[1], axes[2]}, column{axes[3], axes[4], axes[5]};
    if (!(length(row) > 0.9 && length(row) < 1.1 && length(column) > 0.9 && length(column) < 1.1 &&
          std::fabs(dot(row, column)) < 1e-2))
      refuse(m_out.path,
             "expected two perpendicular directions of unit length in Image Orientation (Patient), got others");
    frame.row = normalised(row);
    frame.column = normalised(column - dot(column, frame.row) * frame.row);
    return true;
  }

  void rescale(const DicomItem* own, DicomFrame& frame) {
    const auto intercept = decimals(own, kValueTransformation, 0x00281052, 1, "Rescale Intercept");
    const auto slope = decimals(own, kValueTransformation, 0x00281053, 1, "Rescale Slope");
    frame.rescale = m_padding;
    if (!intercept.empty()) frame.rescale.intercept = intercept[0];
    if (!slope.empty() && slope[0] != 0) frame.rescale.slope = slope[0];
    if (!slope.empty() && slope[0] == 0 && m_out.frames.empty())
      m_out.corrected.emplace_back(tr("Rescale Slope is 0, which no value has: taken as 1"));
    frame.rescaled = !intercept.empty() && !slope.empty() && slope[0] != 0;
    frame.rescale_type = text_of_first({item_of(own, kValueTransformation)}, kRescaleType);
    if (frame.rescale_type.empty()) frame.rescale_type = m_common_type;
  }

  /// Are the frames slices? They may be a film, too. [PS3.3, C.7.6.6: Frame Increment Pointer]
  bool are_slices() const {
    const DicomElement* pointer = m_data.find(0x00280009);
    if (!pointer || pointer->value.empty()) return true;
    const auto number = [&](std::size_t at) {
      return std::uint32_t(geometry::number_at_in<std::uint16_t>(m_big, pointer->value.data() + at));
    };
    constexpr std::uint32_t kSliceVector = 0x00540080;
    return pointer->value.size() == 4 && (number(0) << 16 | number(2)) == kSliceVector;
  }

  /// Frames without places of their own are slices as far apart as the file says. They are never points in time.
  void place_along_the_normal(int own_places) {
    const auto apart = decimals(nullptr, kPixelMeasures, 0x00180088, 1, "Spacing Between Slices");
    const bool shared = item_of(m_shared, kPlanePosition) != nullptr;
    if (own_places > 0 || shared || !are_slices() || apart.empty() || apart[0] == 0) {
      m_out.fault =
          tr("expected a place for each frame (Plane Position Sequence), or one place and Spacing Between "
             "Slices, got {} frames with neither",
             m_out.frames.size());
      return;
    }
    // Its sign says on which side the slices follow each other. The standard defines that for nuclear medicine; the
    // other kinds of image have no meaning of their own for it. [PS3.3, C.8.4.15]
    const double step = apart[0];
    const Vec3d normal = cross(m_out.frames[0].row, m_out.frames[0].column);
    for (std::size_t f = 0; f < m_out.frames.size(); ++f) m_out.frames[f].position += double(f) * step * normal;
    m_out.corrected.push_back(tr(
        "only the first of {} frames has a place: the others were taken as slices {:.4g} mm apart {} (Spacing Between "
        "Slices is {:.4g})",
        m_out.frames.size(), std::fabs(step), step > 0 ? tr("along the normal") : tr("against the normal"), step));
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
  out.sop_class = file.media_class;
  out.corrected = file.corrected;
  try {
    HeaderOfImage(file, out).read();
  } catch (const core::BadInput& bad) {
    out.fault = bad.faults().front().message;
    out.broken = true;
    out.frames.clear();
  }
  return out;
}

bool same_origin(const DicomHeader& a, const DicomHeader& b) {
  return a.patient == b.patient && a.study == b.study && a.frame_of_reference == b.frame_of_reference;
}

bool same_stack(const DicomHeader& a, const DicomFrame& in_a, const DicomHeader& b, const DicomFrame& in_b) {
  if (a.uid.empty() && (a.description != b.description || a.modality != b.modality)) return false;  // taken out
  return a.uid == b.uid && same_origin(a, b) && a.sop_class == b.sop_class && a.rows == b.rows &&
         a.columns == b.columns && length(in_a.row - in_b.row) < 1e-3 && length(in_a.column - in_b.column) < 1e-3 &&
         std::fabs(in_a.between_rows - in_b.between_rows) < 1e-4 &&
         std::fabs(in_a.between_columns - in_b.between_columns) < 1e-4;
}

}  // namespace trocar::volumes
