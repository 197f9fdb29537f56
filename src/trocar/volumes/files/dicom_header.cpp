#ifdef TROCAR_GDCM

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <gdcmByteValue.h>
#include <gdcmDataSet.h>
#include <gdcmSequenceOfItems.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/volumes/files/dicom_header.hpp>
#include <trocar/volumes/files/header_fields.hpp>

namespace trocar::volumes {
namespace {

constexpr int kMostFrames = 65536;

/// An attribute's text without its padding; empty where it is not there.
std::string text_of(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return "";
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes || !bytes->GetPointer()) return "";
  std::string text(bytes->GetPointer(), std::min<std::size_t>(bytes->GetLength(), 4096));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

int unsigned_short_of(const gdcm::DataSet& data, const gdcm::Tag& tag) {
  if (!data.FindDataElement(tag)) return 0;
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes || !bytes->GetPointer() || bytes->GetLength() < 2) return 0;
  std::uint16_t value = 0;  // GDCM has turned big-endian numbers already
  std::memcpy(&value, bytes->GetPointer(), 2);
  return value;
}

/// Numbers apart by backslashes; none where the attribute is not there or empty.
std::vector<double> decimals_of(const gdcm::DataSet& data, const gdcm::Tag& tag, std::size_t count,
                                const std::string& path, const char* name) {
  const std::string text = text_of(data, tag);
  std::vector<double> out;
  if (text.empty()) return out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    std::string word = text.substr(at, end - at);
    word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
    word.erase(word.find_last_not_of(' ') + 1);
    const double value = core::is_decimal(word) ? core::to_double(word) : NAN;
    if (!(std::fabs(value) <= 1e9))
      refuse(path, fmt::format("expected numbers up to 1e9 in {}, got {}", name, shown(word)));
    out.push_back(value);
    at = end + 1;
  }
  if (out.size() < count) refuse(path, fmt::format("expected {} numbers in {}, got {}", count, name, shown(text)));
  out.resize(count);
  return out;
}

/// The item of a sequence in a data set, or null.
class Item {
 public:
  Item() = default;
  Item(const gdcm::DataSet& data, const gdcm::Tag& sequence, std::size_t number = 0) {
    if (!data.FindDataElement(sequence)) return;
    m_items = data.GetDataElement(sequence).GetValueAsSQ();
    if (m_items && number < m_items->GetNumberOfItems()) m_data = &m_items->GetItem(number + 1).GetNestedDataSet();
  }
  const gdcm::DataSet* get() const { return m_data; }
  Item inside(const gdcm::Tag& sequence) const { return m_data ? Item(*m_data, sequence) : Item(); }

 private:
  gdcm::SmartPointer<gdcm::SequenceOfItems> m_items;  // keeps what m_data points into
  const gdcm::DataSet* m_data = nullptr;
};

const gdcm::Tag kSharedGroups(0x5200, 0x9229), kFrameGroups(0x5200, 0x9230);

/// Reads what stands in the data set itself, in what all frames share, or in what is each frame's own.
class Reader {
 public:
  Reader(const gdcm::DataSet& data, DicomHeader& out) : m_data(data), m_out(out), m_shared(data, kSharedGroups) {}

  void read() {
    m_out.uid = core::printable(text_of(m_data, {0x0020, 0x000e}));
    m_out.description = core::printable(text_of(m_data, {0x0008, 0x103e}));
    m_out.modality = core::printable(text_of(m_data, {0x0008, 0x0060}));
    m_out.photometric = text_of(m_data, {0x0028, 0x0004});
    m_out.rows = unsigned_short_of(m_data, {0x0028, 0x0010});
    m_out.columns = unsigned_short_of(m_data, {0x0028, 0x0011});
    const auto tilt = decimals(m_data, {0x0018, 0x1120}, 1, "Gantry/Detector Tilt");
    if (!tilt.empty()) m_out.tilt_deg = tilt[0];
    const auto frames = decimals(m_data, {0x0028, 0x0008}, 1, "Number of Frames");
    if (!frames.empty() && !(frames[0] >= 1 && frames[0] <= kMostFrames))
      refuse(m_out.path, fmt::format("expected 1 to {} frames, got {}", kMostFrames, frames[0]));
    if (!frames.empty()) m_out.frames = int(frames[0]);
    pixels();
    const auto number = decimals(m_data, {0x0020, 0x0013}, 1, "Instance Number");
    for (int f = 0; f < m_out.frames; ++f) {
      const Item own(m_data, kFrameGroups, std::size_t(f));
      place(own, number.empty() ? 0 : int(std::clamp(number[0], -1e9, 1e9)) + f);
      rescale(own);
      if (f == 0) plane(own);
    }
    if (m_out.places.size() < std::size_t(m_out.frames)) m_out.places.clear();
  }

 private:
  const gdcm::DataSet& m_data;
  DicomHeader& m_out;
  Item m_shared;

  std::vector<double> decimals(const gdcm::DataSet& data, const gdcm::Tag& tag, std::size_t count, const char* name) {
    return decimals_of(data, tag, count, m_out.path, name);
  }
  std::vector<double> decimals(const Item& own, const gdcm::Tag& group, const gdcm::Tag& tag, std::size_t count,
                               const char* name) {
    for (const Item& item : {own.inside(group), m_shared.inside(group)})
      if (item.get() && item.get()->FindDataElement(tag)) return decimals(*item.get(), tag, count, name);
    return decimals(m_data, tag, count, name);
  }

  void pixels() {
    const int samples = unsigned_short_of(m_data, {0x0028, 0x0002});
    if (m_out.rows == 0 || m_out.columns == 0)
      m_out.fault = "expected an image, got a file without rows and columns";
    else if (samples > 1 || (m_out.photometric != "MONOCHROME2" && m_out.photometric != "MONOCHROME1"))
      m_out.fault =
          fmt::format("expected one grey value a pixel, got {} ({} values)", shown(m_out.photometric), samples);
    else if (m_data.FindDataElement(gdcm::Tag(0x0028, 0x3000)))
      m_out.fault = "expected slope and intercept, got values by a table (Modality LUT)";
  }

  void place(const Item& own, int number) {
    const auto at = decimals(own, {0x0020, 0x9113}, {0x0020, 0x0032}, 3, "Image Position (Patient)");
    if (at.empty()) return;
    const auto thickness = decimals(own, {0x0028, 0x9110}, {0x0018, 0x0050}, 1, "Slice Thickness");
    m_out.places.push_back({{at[0], at[1], at[2]}, number, thickness.empty() ? 0 : thickness[0]});
  }

  void rescale(const Item& own) {
    const auto intercept = decimals(own, {0x0028, 0x9145}, {0x0028, 0x1052}, 1, "Rescale Intercept");
    const auto slope = decimals(own, {0x0028, 0x9145}, {0x0028, 0x1053}, 1, "Rescale Slope");
    Rescale r;
    if (!intercept.empty()) r.intercept = intercept[0];
    if (!slope.empty() && slope[0] != 0) r.slope = slope[0];
    m_out.rescale.push_back(r);
  }

  void plane(const Item& own) {
    const auto axes = decimals(own, {0x0020, 0x9116}, {0x0020, 0x0037}, 6, "Image Orientation (Patient)");
    const auto apart = decimals(own, {0x0028, 0x9110}, {0x0028, 0x0030}, 2, "Pixel Spacing");
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

DicomHeader dicom_header(const gdcm::DataSet& data, const std::string& path) {
  DicomHeader out;
  out.path = path;
  Reader(data, out).read();
  return out;
}

bool same_stack(const DicomHeader& a, const DicomHeader& b) {
  if (a.uid.empty() && (a.description != b.description || a.modality != b.modality)) return false;  // taken out
  return a.uid == b.uid && a.rows == b.rows && a.columns == b.columns && length(a.row - b.row) < 1e-3 &&
         length(a.column - b.column) < 1e-3 && std::fabs(a.between_rows - b.between_rows) < 1e-4 &&
         std::fabs(a.between_columns - b.between_columns) < 1e-4 && (a.frames > 1) == (b.frames > 1);
}

}  // namespace trocar::volumes

#endif
