// The pixels of DICOM files, decoded when they are asked for, and digests by which copies are found. Used by the
// readers only.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_stacks.hpp>

namespace trocar::volumes {

/// All frames of a file, decoded; what had to be corrected goes into the notes.
using PixelsOf = std::function<std::vector<char>(int file, std::vector<std::string>& notes)>;

/// The frames of the file that was asked for last, as files have many.
class LastPixels {
 public:
  explicit LastPixels(PixelsOf read) : m_read(std::move(read)) {}

  const std::vector<char>& of(int file);
  const std::vector<std::string>& notes() const { return m_notes; }  ///< on that file

 private:
  PixelsOf m_read;
  std::vector<char> m_pixels;
  std::vector<std::string> m_notes;
  int m_file = -1;
};

/// The digests of images. Each file is decoded once, in whatever order its images are asked for: copies are compared
/// position by position, so that the files alternate.
class PixelDigests {
 public:
  PixelDigests(const std::vector<DicomHeader>& files, LastPixels& pixels) : m_files(files), m_pixels(pixels) {}

  /// Equal where the pixels and what they mean are equal. Empty: the file is damaged.
  const std::string& of(ImageAt image);

 private:
  const std::vector<DicomHeader>& m_files;
  LastPixels& m_pixels;
  std::map<int, std::vector<std::string>> m_of_file;  // of each frame

  std::vector<std::string> of_frames(int file);
};

}  // namespace trocar::volumes
