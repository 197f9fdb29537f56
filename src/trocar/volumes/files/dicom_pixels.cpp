#ifdef TROCAR_GDCM

#include <algorithm>
#include <cstring>
#include <iostream>
#include <mutex>
#include <sstream>

#include <fmt/format.h>
#include <gdcmImage.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <trocar/core/error.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>

namespace trocar::volumes {
namespace {

std::mutex& gdcm_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// What of a warning is worth telling: its last line with words.
std::string short_line(const std::string& text) {
  std::string line, last;
  std::istringstream lines(text);
  while (std::getline(lines, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return core::printable(std::string_view(last).substr(0, 160));
}

bool element_of(const gdcm::PixelFormat& format, Element& element) {
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      element = Element::uint8;
      return true;
    case gdcm::PixelFormat::INT8:
      element = Element::int8;
      return true;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      element = Element::uint16;
      return true;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      element = Element::int16;
      return true;
    case gdcm::PixelFormat::UINT32:
      element = Element::uint32;
      return true;
    case gdcm::PixelFormat::INT32:
      element = Element::int32;
      return true;
    case gdcm::PixelFormat::FLOAT32:
      element = Element::real32;
      return true;
    case gdcm::PixelFormat::FLOAT64:
      element = Element::real64;
      return true;
    default:
      return false;
  }
}

/// Bits above those that are stored may hold anything: signs are spread over them, the rest is cleared.
template <class T>
void keep_stored_bits(std::vector<char>& bytes, int stored) {
  const int spare = int(8 * sizeof(T)) - stored;
  if (spare <= 0) return;
  using Bits = std::make_unsigned_t<T>;
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    Bits bits;
    std::memcpy(&bits, bytes.data() + at, sizeof(T));
    bits = Bits(bits << spare);
    T value;
    std::memcpy(&value, &bits, sizeof(T));
    value = T(value >> spare);
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
}

void clean_up(DicomPixels& pixels, int stored) {
  if (pixels.element == Element::uint8) keep_stored_bits<std::uint8_t>(pixels.bytes, stored);
  if (pixels.element == Element::int8) keep_stored_bits<std::int8_t>(pixels.bytes, stored);
  if (pixels.element == Element::uint16) keep_stored_bits<std::uint16_t>(pixels.bytes, stored);
  if (pixels.element == Element::int16) keep_stored_bits<std::int16_t>(pixels.bytes, stored);
}

}  // namespace

struct GdcmWarnings::Held {
  std::lock_guard<std::mutex> lock{gdcm_mutex()};
  std::ostringstream text;
};

GdcmWarnings::GdcmWarnings() : m_held(std::make_unique<Held>()) {
  gdcm::Trace::SetWarningStream(m_held->text);
  gdcm::Trace::SetErrorStream(m_held->text);
  gdcm::Trace::WarningOn();
  gdcm::Trace::ErrorOn();
  gdcm::Trace::DebugOff();
}
GdcmWarnings::~GdcmWarnings() {
  gdcm::Trace::SetWarningStream(std::cerr);
  gdcm::Trace::SetErrorStream(std::cerr);
}
std::string GdcmWarnings::taken() {
  const std::string out = short_line(m_held->text.str());
  m_held->text.str("");
  return out;
}

bool read_dicom_header(std::istream& in, const std::string& path, GdcmWarnings& warnings, DicomHeader& out) {
  gdcm::Reader reader;
  reader.SetStream(in);
  bool read = false;
  try {
    read = reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010));
  } catch (const std::exception&) {
    read = false;
  }
  warnings.taken();  // what is wrong with the pixels' file is told when they are read
  if (!read) return false;
  out = dicom_header(reader.GetFile().GetDataSet(), path);
  return true;
}

DicomPixels read_dicom_pixels(std::istream& in, const DicomHeader& header, GdcmWarnings& warnings,
                              std::size_t most_voxels) {
  warnings.taken();
  const std::size_t pixels = std::size_t(header.rows) * std::size_t(header.columns) * std::size_t(header.frames);
  if (pixels > most_voxels)
    refuse(header.path, fmt::format("expected at most {} voxels, got {} x {} x {}", most_voxels, header.columns,
                                    header.rows, header.frames));
  const auto damaged = [&](const std::string& why) {
    refuse(header.path, fmt::format("expected a whole DICOM image, got a damaged one: {}", why));
  };
  DicomPixels out;
  int stored = 0;
  try {
    gdcm::ImageReader reader;
    reader.SetStream(in);
    if (!reader.Read()) damaged(warnings.taken());
    const gdcm::Image& image = reader.GetImage();
    const gdcm::PixelFormat& format = image.GetPixelFormat();
    const std::string syntax = image.GetTransferSyntax().GetString() ? image.GetTransferSyntax().GetString() : "";
    if (!element_of(format, out.element) || format.GetSamplesPerPixel() != 1)
      refuse(header.path, fmt::format("expected grey values of 8 to 32 bits or floating-point ones, got {} bits in {}",
                                      format.GetBitsStored(), format.GetBitsAllocated()));
    const unsigned frames = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1;
    if (image.GetDimension(0) != unsigned(header.columns) || image.GetDimension(1) != unsigned(header.rows) ||
        frames != unsigned(header.frames))
      damaged("its size changed while it was read");
    if (format.GetHighBit() + 1 != format.GetBitsStored())
      refuse(header.path,
             fmt::format("expected the highest bit {}, got {}", format.GetBitsStored() - 1, format.GetHighBit()));
    const std::size_t wanted = pixels * width_of(out.element);
    if (image.GetBufferLength() != wanted)
      damaged(fmt::format("{} bytes of pixels instead of {}", image.GetBufferLength(), wanted));
    const gdcm::ByteValue* raw = image.GetDataElement().GetByteValue();
    if (raw && !image.GetTransferSyntax().IsEncapsulated() && raw->GetLength() < wanted)
      damaged(fmt::format("{} bytes of pixels instead of {}", std::size_t(raw->GetLength()), wanted));
    if (const std::string said = warnings.taken(); !said.empty()) damaged(said);
    out.bytes.resize(wanted);
    const bool decoded = image.GetBuffer(out.bytes.data());
    if (const std::string said = warnings.taken(); !said.empty()) damaged(said);
    if (!decoded)
      refuse(header.path, fmt::format("expected a compression that GDCM decodes, got {}", core::printable(syntax)));
    stored = format.GetBitsStored();
  } catch (const core::BadInput&) {
    throw;
  } catch (const std::bad_alloc&) {
    damaged("it asks for more memory than there is");
  } catch (const std::exception& e) {
    damaged(core::printable(std::string_view(e.what()).substr(0, 160)));
  }
  clean_up(out, stored);
  return out;
}

}  // namespace trocar::volumes

#endif
