// Copies of files with many frames are found without decoding a file for each of its frames.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/volumes/files/dicom_digests.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>

#include "dicom_bytes.hpp"

namespace trocar::volumes {
namespace {

constexpr int kFrames = 300;

/// Two files of the same frames; each object has an identifier of its own, or both have the same.
std::vector<DicomHeader> two_files(bool own_identifiers) {
  std::vector<DicomHeader> out;
  for (int f = 0; f < 2; ++f) {
    DicomFile file;
    file.frames = kFrames;
    file.object = fmt::format("1.2.9.{}", own_identifiers ? f : 0);
    out.push_back(dicom_header(parse_dicom(file.bytes(), "a"), fmt::format("{}.dcm", f)));
  }
  return out;
}

struct Found {
  std::vector<DicomStack> stacks;
  int decoded = 0;  ///< files, each time
};
Found stacks_of(const std::vector<DicomHeader>& files, bool damaged) {
  Found out;
  LastPixels pixels([&](int, std::vector<std::string>&) {
    ++out.decoded;
    if (damaged) throw core::BadInput({{{"a", 0, 0}, "damaged"}});
    return std::vector<char>(std::size_t(kFrames) * frame_bytes(files[0]), 'x');
  });
  PixelDigests digests(files, pixels);
  out.stacks = dicom_stacks(
      files, [&](ImageAt image) { return digests.of(image); }, "a");
  return out;
}

TEST(DicomDigests, CopiesOfManyFramesAreDecodedOnceEach) {
  for (const bool own_identifiers : {false, true}) {
    const std::vector<DicomHeader> files = two_files(own_identifiers);
    ASSERT_EQ(files[0].frames.size(), std::size_t(kFrames)) << files[0].fault;
    const Found found = stacks_of(files, false);
    ASSERT_EQ(found.stacks.size(), 1u);
    EXPECT_EQ(found.stacks[0].fault, "");
    EXPECT_EQ(found.stacks[0].slices(), std::size_t(kFrames));
    EXPECT_FALSE(found.stacks[0].copies.empty());
    EXPECT_EQ(found.decoded, 2) << "own identifiers: " << own_identifiers;
  }
}

TEST(DicomDigests, DamagedFilesAreDecodedOnceEach) {
  const Found found = stacks_of(two_files(false), true);
  EXPECT_EQ(found.decoded, 2);
  ASSERT_EQ(found.stacks.size(), 1u);
  EXPECT_NE(found.stacks[0].fault, "");
}

}  // namespace
}  // namespace trocar::volumes
