// The elements of a DICOM file, as a tree over its bytes. Every length is looked at before it is believed: what comes
// out lies within the file. Used by the readers only.
//
//   const DicomDocument file = parse_dicom(bytes, "a.dcm");
//   const DicomElement* rows = file.root.find(0x00280010);
//
// Source: DICOM PS3.5 (2023b), sections 7 and 10, annex A.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::volumes {

struct DicomElement;
/// A data set: the file's own, or that of an item of a sequence.
struct DicomItem {
  std::vector<DicomElement> elements;                 ///< by their tags, those of one tag as in the file
  const DicomElement* find(std::uint32_t tag) const;  ///< the first of this tag, or null
};
struct DicomElement {
  std::uint32_t tag = 0;  ///< group << 16 | element
  std::string_view value;
  std::vector<DicomItem> items;             ///< of sequences that somebody here asks for
  std::vector<std::string_view> fragments;  ///< of packed pixels, the table of offsets first
};

enum class DicomPacking : unsigned char { none, rle, jpeg, jpeg_ls, jpeg_2000, other };

struct DicomDocument {
  DicomItem root;
  std::string syntax;       ///< the transfer syntax's identifier
  std::string media_class;  ///< what the object is, by the group that says how the others are written
  DicomPacking packing = DicomPacking::none;
  bool big_endian = false;
  bool ends_early = false;             ///< of a beginning: more bytes are needed
  std::string damage;                  ///< where and why the elements end early, or empty
  std::vector<std::string> corrected;  ///< what was wrong and does no harm
  std::vector<char> inflated;          ///< of deflated files; the elements lie in it
};

inline constexpr std::uint32_t kDicomPixels = 0x7fe00010;

/// The elements of a file, as far as it is sound: see DicomDocument::damage. Bytes behind the pixels that are no
/// elements do no harm.
/// @param beginning_only  the bytes are the beginning of a file: stop at the pixels, or say that it ends early
/// @throws core::BadInput  where it is no DICOM file
DicomDocument parse_dicom(std::string_view bytes, const std::string& file, bool beginning_only = false);

/// The message about a damaged file.
std::string damaged_dicom(const std::string& what);

/// "DICM" behind a preamble of 128 bytes.
bool has_dicom_mark(std::string_view bytes);
/// With DICOM's mark, or as files without it begin.
bool looks_like_dicom(std::string_view bytes);

}  // namespace trocar::volumes
