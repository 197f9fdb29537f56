#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>

namespace trocar::volumes {
namespace {

[[noreturn]] void damaged_pixels(const DicomHeader& header, const std::string& what) {
  refuse(header.path, damaged_dicom(what));
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
void clean_up(std::vector<char>& bytes, const DicomHeader& header, int stored) {
  switch (header.element()) {
    case Element::int8:
      return keep_stored_bits<std::int8_t>(bytes, stored);
    case Element::uint8:
      return keep_stored_bits<std::uint8_t>(bytes, stored);
    case Element::int16:
      return keep_stored_bits<std::int16_t>(bytes, stored);
    case Element::uint16:
      return keep_stored_bits<std::uint16_t>(bytes, stored);
    case Element::int32:
      return keep_stored_bits<std::int32_t>(bytes, stored);
    default:
      return keep_stored_bits<std::uint32_t>(bytes, stored);
  }
}

std::vector<char> plain_pixels(const DicomElement& pixels, const DicomHeader& header, bool big,
                               std::vector<std::string>& notes) {
  const std::size_t wanted = frame_bytes(header) * header.frames.size();
  if (pixels.value.size() < wanted)
    damaged_pixels(header, tr("{} bytes of pixels instead of {}", pixels.value.size(), wanted));
  if (pixels.value.size() > wanted + wanted % 2)  // values have an even length
    notes.push_back(tr("{} bytes behind the last pixel were passed over", pixels.value.size() - wanted));
  std::vector<char> out(pixels.value.begin(), pixels.value.begin() + std::ptrdiff_t(wanted));
  // Pixels of a byte are written as words of two, too.
  const std::size_t word = std::max<std::size_t>(2, std::size_t(header.allocated / 8));
  if (big != geometry::machine_is_big())
    for (std::size_t at = 0; at + word <= out.size(); at += word)
      std::reverse(out.begin() + std::ptrdiff_t(at), out.begin() + std::ptrdiff_t(at + word));
  return out;
}

std::uint32_t little32(std::string_view bytes, std::size_t at) {
  return geometry::number_at_in<std::uint32_t>(false, bytes.data() + at);
}

/// Fragments belong to frames one by one, all to the only frame, or as the table of offsets says.
std::vector<std::string> packed_frames(const DicomElement& pixels, const DicomHeader& header) {
  const std::size_t frames = header.frames.size();
  if (pixels.fragments.size() < frames + 1)
    damaged_pixels(header,
                   tr("{} packed frames instead of {}", std::max<std::size_t>(pixels.fragments.size(), 1) - 1, frames));
  std::vector<std::string> out(frames);
  const std::string_view table = pixels.fragments[0];
  const bool one_each = pixels.fragments.size() == frames + 1;
  if (!one_each && frames > 1 && table.size() < 4 * frames)
    refuse(header.path, "expected a fragment for each frame or a table of offsets, got neither");
  std::size_t frame = 0, offset = 0;
  for (std::size_t f = 1; f < pixels.fragments.size(); ++f) {
    if (one_each)
      frame = f - 1;
    else
      while (frame + 1 < frames && offset >= little32(table, 4 * (frame + 1))) ++frame;
    out[frame].append(pixels.fragments[f]);
    offset += pixels.fragments[f].size() + 8;
  }
  return out;
}

/// Runs of bytes; the bytes of a number are apart, the highest first. [PS3.5, annex G]
std::vector<char> unpacked_rle(std::string_view packed, const DicomHeader& header) {
  const std::size_t width = std::size_t(header.allocated / 8), count = frame_bytes(header) / width;
  if (packed.size() < 64 || little32(packed, 0) != width) damaged_pixels(header, tr("no RLE of {} segments", width));
  std::vector<char> out(count * width);
  for (std::size_t s = 0; s < width; ++s) {
    const std::size_t from = little32(packed, 4 + 4 * s);
    const std::size_t to = s + 1 < width ? little32(packed, 8 + 4 * s) : packed.size();
    if (from < 64 || from > to || to > packed.size()) damaged_pixels(header, "RLE segments outside of their frame");
    const std::size_t place = geometry::machine_is_big() ? s : width - 1 - s;
    std::size_t done = 0;
    for (std::size_t at = from; at < to && done < count;) {
      const int control = static_cast<signed char>(packed[at++]);
      if (control == -128) continue;
      const std::size_t run = std::size_t(control < 0 ? 1 - control : 1 + control);
      const std::size_t needed = control < 0 ? 1 : run;
      if (to - at < needed) damaged_pixels(header, "an RLE segment that ends early");
      for (std::size_t i = 0; i < run && done < count; ++i, ++done)
        out[done * width + place] = packed[at + (control < 0 ? 0 : i)];
      at += needed;
    }
    if (done < count) damaged_pixels(header, "an RLE segment that ends early");
  }
  return out;
}

}  // namespace

std::vector<char> dicom_pixels(const DicomDocument& file, const DicomHeader& header, std::size_t most_voxels,
                               std::vector<std::string>& notes) {
  if (const auto fault = size_fault({header.columns, header.rows, std::int64_t(header.frames.size())}, most_voxels))
    refuse(header.path, *fault);
  const DicomElement* pixels = file.root.find(kDicomPixels);
  if (!pixels) damaged_pixels(header, "no pixels");
  std::vector<char> out;
  int stored = header.stored;
  if (file.packing == DicomPacking::none) {
    out = plain_pixels(*pixels, header, file.big_endian, notes);
  } else if (file.packing == DicomPacking::other) {
    refuse(header.path, tr("expected pixels that are not packed, or by RLE, JPEG, JPEG-LS or JPEG 2000, got the "
                           "transfer syntax {}",
                           core::printable(file.syntax)));
  } else {
    const std::vector<std::string> frames = packed_frames(*pixels, header);
    if (file.packing != DicomPacking::rle) {
      UnpackedFrames unpacked = unpacked_jpeg(frames, file.packing, file.syntax, header);
      out = std::move(unpacked.bytes);
      stored = unpacked.stored;
      if (stored != header.stored)
        notes.push_back(tr("the packed pixels hold {} bits, where the header says {}", stored, header.stored));
    } else {
      for (const std::string& packed : frames) {
        const std::vector<char> frame = unpacked_rle(packed, header);
        out.insert(out.end(), frame.begin(), frame.end());
      }
    }
  }
  clean_up(out, header, stored);
  return out;
}

}  // namespace trocar::volumes
