// What tells the images at one position of a series apart: phase, acquisition, echo, time. Used by the readers only.
//
// Source: DICOM PS3.3 and PS3.6 (2023b).
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_elements.hpp>

namespace trocar::volumes {

/// In the order in which they are tried.
enum class Mark : unsigned char {
  temporal_position,
  acquisition,
  echo,
  echo_time,
  inversion_time,
  trigger_time,
  cardiac_phase,
  reference_time,
  b_value,
  gradient,
  image_type,
  component,
  kernel,
  voltage,
  acquisition_time,
  content_time,
  instance  ///< says no more than an order
};
inline constexpr std::size_t kMarks = std::size_t(Mark::instance) + 1;

/// The attribute's name in DICOM.
const char* name_of(Mark mark);

/// Of each mark the value; empty where it is not there. Times as "2026-11-30 10:05:00.000", numbers as short as they
/// go.
struct Marks {
  std::array<std::string, kMarks> values;

  std::string& operator[](Mark mark) { return values[std::size_t(mark)]; }
  const std::string& operator[](Mark mark) const { return values[std::size_t(mark)]; }
};

/// Numbers by size, then other text by its letters.
bool mark_less(const std::string& a, const std::string& b);

/// The marks of a file's frames. What the file says of all frames is looked up once.
class FrameMarks {
 public:
  /// @param shared  what the file says of all frames; null: nothing
  FrameMarks(const DicomItem& data, const DicomItem* shared, bool big_endian);
  /// @param own  what it says of this frame; null: nothing
  Marks of(const DicomItem* own) const;

 private:
  bool m_big_endian;
  std::vector<std::string> m_common;  // at each place where a mark is looked for
  std::string m_acquisition_time, m_content_time;
};

/// An attribute's text without its padding, what a terminal would obey spelled out; empty where it is not there.
/// @param most  bytes that are taken
std::string text_of(const DicomItem& data, std::uint32_t tag, std::size_t most = 4096);

/// The item of a sequence in a data set, or null.
const DicomItem* item_of(const DicomItem* data, std::uint32_t sequence, std::size_t number = 0);

}  // namespace trocar::volumes
