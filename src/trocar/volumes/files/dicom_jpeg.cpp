// Frames of JPEG, JPEG-LS and JPEG 2000, by GDCM's codecs. GDCM is given frames only, whose marks were looked at here,
// and not files: its parser ends the program at some damaged ones. What it only warns of is a fault, because pixels
// that are not there become zeros with no more than a warning.
#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>
#include <trocar/volumes/files/in_child.hpp>

#ifdef TROCAR_GDCM
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>
#endif

namespace trocar::volumes {
namespace {

/// What the frame itself says of its size.
struct CodestreamSize {
  std::uint32_t columns = 0, rows = 0, components = 0, bits = 0;
};

class CodestreamMarks {
 public:
  CodestreamMarks(std::string_view bytes, const DicomHeader& header) : m_bytes(bytes), m_header(header) {}

  CodestreamSize size(DicomPacking packing) {
    require(m_bytes.size() >= 8, "a frame of a few bytes");
    require_end();
    return packing == DicomPacking::jpeg_2000 ? jpeg_2000() : jpeg();
  }

 private:
  std::string_view m_bytes;
  const DicomHeader& m_header;

  std::uint32_t number(std::size_t at, int width) const {
    require(at + std::size_t(width) <= m_bytes.size(), "a mark that ends early");
    std::uint32_t out = 0;
    for (int i = 0; i < width; ++i)
      out = out << 8 | std::uint32_t(static_cast<unsigned char>(m_bytes[at + std::size_t(i)]));
    return out;
  }
  void require(bool holds, const char* what) const {
    if (!holds) refuse(m_header.path, damaged_dicom(what));
  }
  /// The end's mark within the last bytes, which may be padding.
  void require_end() const {
    const std::size_t at = m_bytes.rfind("\xff\xd9");
    require(at != std::string_view::npos && at + 2 + 8 >= m_bytes.size(), "a packed frame without its end");
  }

  CodestreamSize jpeg() const {
    require(number(0, 2) == 0xffd8, "no JPEG");
    std::size_t at = 2;
    while (true) {
      while (number(at, 2) == 0xffff) ++at;
      const std::uint32_t mark = number(at, 2);
      require(mark >= 0xffc0 && mark < 0xffff, "something else than a mark of JPEG");
      const std::uint32_t length = number(at + 2, 2);
      require(length >= 2, "a mark without a length");
      const bool frame =
          (mark >= 0xffc0 && mark <= 0xffcf && mark != 0xffc4 && mark != 0xffc8 && mark != 0xffcc) || mark == 0xfff7;
      if (frame) return {number(at + 7, 2), number(at + 5, 2), number(at + 9, 1), number(at + 4, 1)};
      require(mark != 0xffda && mark != 0xffd9, "pixels before their size");
      at += 2 + length;
    }
  }
  CodestreamSize jpeg_2000() const {
    require(number(0, 4) == 0xff4fff51, "no codestream of JPEG 2000");
    const std::uint32_t x = number(8, 4), y = number(12, 4), x0 = number(16, 4), y0 = number(20, 4);
    const std::uint32_t tile_x = number(24, 4), tile_y = number(28, 4), tile_x0 = number(32, 4),
                        tile_y0 = number(36, 4);
    require(x > x0 && y > y0 && x0 == 0 && y0 == 0 && tile_x0 == 0 && tile_y0 == 0 && tile_x > 0 && tile_y > 0,
            "an empty image or tile");
    // So many that each must be larger than its own header.
    const std::uint64_t tiles = ((std::uint64_t(x) + tile_x - 1) / tile_x) * ((std::uint64_t(y) + tile_y - 1) / tile_y);
    require(tiles <= m_bytes.size() / 12 + 1, "more tiles than there are bytes");
    return {x, y, number(40, 2), (number(42, 1) & 0x7f) + 1};
  }
};

/// How GDCM is to see the pixels: with the bits that the frame itself says, so that it finds nothing to correct.
struct PixelBits {
  int allocated = 0, stored = 0;
};

#ifdef TROCAR_GDCM

/// The last line with words of what GDCM has written.
std::string last_words(const std::string& written) {
  std::string line, last;
  std::istringstream lines(written);
  while (std::getline(lines, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return core::printable(std::string_view(last).substr(0, 160));
}

gdcm::Image packed_image(const std::string& packed, const std::string& syntax, const DicomHeader& header,
                         PixelBits bits) {
  gdcm::Image image;
  image.SetNumberOfDimensions(2);
  image.SetDimension(0, unsigned(header.columns));
  image.SetDimension(1, unsigned(header.rows));
  image.SetPixelFormat(gdcm::PixelFormat(1, std::uint16_t(bits.allocated), std::uint16_t(bits.stored),
                                         std::uint16_t(bits.stored - 1), header.is_signed ? 1 : 0));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2));
  image.SetTransferSyntax(gdcm::TransferSyntax(gdcm::TransferSyntax::GetTSType(syntax.c_str())));
  gdcm::Fragment fragment;
  fragment.SetByteValue(packed.data(), gdcm::VL(std::uint32_t(packed.size())));
  gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  fragments->AddFragment(fragment);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVR(gdcm::VR::OB);
  pixels.SetValue(*fragments);
  image.SetDataElement(pixels);
  return image;
}

constexpr int kMostSeconds = 60;

/// Little-endian numbers with more bytes each; signs are spread later, over all bits that are not stored.
std::vector<char> widened(std::vector<char> numbers, int from, int to) {
  if (from == to) return numbers;
  const std::size_t narrow = std::size_t(from), wide = std::size_t(to), count = numbers.size() / narrow;
  std::vector<char> out(count * wide, '\0');
  for (std::size_t i = 0; i < count; ++i)
    std::copy_n(numbers.begin() + std::ptrdiff_t(narrow * i), narrow, out.begin() + std::ptrdiff_t(wide * i));
  return out;
}

/// In the child: 'p' and the pixels, or 'f' and what is wrong. Its streams for warnings are its own.
std::string unpack_all(const std::vector<std::string>& frames, const std::string& syntax, const DicomHeader& header,
                       PixelBits bits) {
  std::ostringstream written;
  gdcm::Trace::SetWarningStream(written);
  gdcm::Trace::SetErrorStream(written);
  gdcm::Trace::WarningOn();
  gdcm::Trace::ErrorOn();
  gdcm::Trace::DebugOff();
  const std::size_t wanted = frame_pixels(header) * std::size_t(bits.allocated / 8);
  std::string out = "p";
  try {
    for (const std::string& frame : frames) {
      const gdcm::Image image = packed_image(frame, syntax, header, bits);
      if (image.GetBufferLength() != wanted) return "fanother size than it says";
      out.resize(out.size() + wanted);
      if (!image.GetBuffer(out.data() + out.size() - wanted)) return "fits pixels cannot be unpacked";
      if (const std::string said = last_words(written.str()); !said.empty()) return "f" + said;
    }
  } catch (const std::exception& e) {
    return "f" + core::printable(std::string_view(e.what()).substr(0, 160));
  }
  return out;
}

std::vector<char> by_gdcm(const std::vector<std::string>& frames, const std::string& syntax, const DicomHeader& header,
                          PixelBits bits) {
  const std::size_t wanted = frame_pixels(header) * std::size_t(bits.allocated / 8) * frames.size();
  const ChildResult child =
      in_child([&] { return unpack_all(frames, syntax, header, bits); }, kMostSeconds, wanted + 4096);
  std::string failure;
  if (!child.came_back || child.bytes.empty())
    failure = "unpacking its pixels fails";
  else if (child.bytes[0] != 'p' || child.bytes.size() != wanted + 1)
    failure = child.bytes.substr(1);
  if (!failure.empty()) refuse(header.path, damaged_dicom(failure));
  return widened({child.bytes.begin() + 1, child.bytes.end()}, bits.allocated / 8, header.allocated / 8);
}

#else

std::vector<char> by_gdcm(const std::vector<std::string>&, const std::string& syntax, const DicomHeader& header,
                          PixelBits) {
  throw core::EnvironmentLacks(
      tr("{}: this build does not unpack JPEG in DICOM (transfer syntax {}): install libgdcm-dev and build again, "
         "or convert the series to NIfTI or NRRD",
         header.path, core::printable(syntax)));
}

#endif

}  // namespace

bool unpacks_jpeg() {
#ifdef TROCAR_GDCM
  return true;
#else
  return false;
#endif
}

UnpackedFrames unpacked_jpeg(const std::vector<std::string>& frames, DicomPacking packing, const std::string& syntax,
                             const DicomHeader& header) {
  std::uint32_t bits = 0;
  for (const std::string& packed : frames) {
    const CodestreamSize size = CodestreamMarks(packed, header).size(packing);
    if (size.columns != std::uint32_t(header.columns) || size.rows != std::uint32_t(header.rows) ||
        size.components != 1 || size.bits > std::uint32_t(header.allocated) || header.allocated > 16)
      refuse(header.path, tr("expected a packed frame of {} x {} pixels with one value of up to {} bits, got {} x "
                             "{} with {} of {} bits",
                             header.columns, header.rows, std::min(header.allocated, 16), size.columns, size.rows,
                             size.components, size.bits));
    if (bits != 0 && size.bits != bits)
      refuse(header.path, tr("expected packed frames of {} bits, got one of {}", bits, size.bits));
    bits = size.bits;
  }
  PixelBits seen{header.allocated, header.stored};
  if (packing == DicomPacking::jpeg_2000 && bits < std::uint32_t(header.stored))
    seen = {bits <= 8 ? 8 : 16, std::max(1, int(bits))};
  return {by_gdcm(frames, syntax, header, seen), seen.stored};
}

}  // namespace trocar::volumes
