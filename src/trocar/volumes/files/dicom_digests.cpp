#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/volumes/files/dicom_digests.hpp>

namespace trocar::volumes {

const std::vector<char>& LastPixels::of(int file) {
  if (file == m_file) return m_pixels;
  m_file = -1;
  m_notes.clear();
  m_pixels = m_read(file, m_notes);
  m_file = file;
  return m_pixels;
}

const std::string& PixelDigests::of(ImageAt image) {
  auto known = m_of_file.find(image.file);
  if (known == m_of_file.end()) known = m_of_file.emplace(image.file, of_frames(image.file)).first;
  return known->second[std::size_t(image.frame)];
}

std::vector<std::string> PixelDigests::of_frames(int file) {
  const std::vector<DicomFrame>& frames = m_files[std::size_t(file)].frames;
  std::vector<std::string> out(frames.size());
  try {
    const std::vector<char>& all = m_pixels.of(file);
    const std::size_t bytes = all.size() / frames.size();
    for (std::size_t f = 0; f < frames.size(); ++f)
      out[f] = fmt::format("{} {} {}", core::hex(core::hash_bytes(all.data() + bytes * f, bytes)),
                           frames[f].rescale.slope, frames[f].rescale.intercept);
  } catch (const core::BadInput&) {
    // Damaged: the digests stay empty.
  }
  return out;
}

}  // namespace trocar::volumes
