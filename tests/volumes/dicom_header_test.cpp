// Headers with many elements and many frames: what the file says of all frames is looked up once, and by its tag.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/volumes/files/dicom_header.hpp>

#include "dicom_bytes.hpp"

namespace trocar::volumes {
namespace {

/// Elements of a program's own, as many as wanted, in groups of odd numbers.
std::vector<std::uint32_t> private_tags(int count) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t group = 0x0031; int(out.size()) < count; group += 2)
    for (std::uint32_t element = 0x1000; element < 0xff00 && int(out.size()) < count; ++element)
      out.push_back(group << 16 | element);
  return out;
}

std::string marked(const DicomElements& data) {
  DicomElements meta;
  meta.text(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1");
  std::string out(128, '\0');
  out += "DICM";
  out += meta.bytes;
  return out += data.bytes;
}

TEST(DicomElements, AreFoundByTheirTagsWhateverTheirOrderIs) {
  DicomElements data;
  data.text(0x0008, 0x0060, "CS", "CT");
  data.text(0x0028, 0x0004, "CS", "first");
  std::vector<std::uint32_t> tags = private_tags(100'000);
  std::reverse(tags.begin(), tags.end());
  for (const std::uint32_t tag : tags) data.number(tag >> 16, tag & 0xffff, 0);
  data.text(0x0028, 0x0004, "CS", "second");
  data.text(0x0010, 0x0020, "LO", "patient");
  const std::string bytes = marked(data);
  const DicomDocument file = parse_dicom(bytes, "a");
  EXPECT_TRUE(std::is_sorted(file.root.elements.begin(), file.root.elements.end(),
                             [](const DicomElement& a, const DicomElement& b) { return a.tag < b.tag; }));
  EXPECT_EQ(text_of(file.root, 0x00100020), "patient");
  EXPECT_EQ(text_of(file.root, 0x00280004), "first");
  EXPECT_NE(file.root.find(tags.back()), nullptr);
  EXPECT_EQ(file.root.find(0x0031ffff), nullptr);
}

TEST(DicomElements, InFrontOfDamageAreInOrder) {
  DicomElements data;
  data.text(0x0028, 0x0004, "CS", "grey");
  data.text(0x0008, 0x0060, "CS", "CT");
  data.tag(0x0030, 0x0010);
  const std::string bytes = marked(data) + "LO\xff";
  const DicomDocument file = parse_dicom(bytes, "a");
  EXPECT_NE(file.damage, "");
  EXPECT_EQ(text_of(file.root, 0x00080060), "CT");
}

/// A search through all elements for each attribute of each frame would take 10^11 steps, and minutes.
TEST(DicomHeaders, OfManyElementsAndManyFramesAreRead) {
  constexpr int kFrames = 20'000;
  DicomFile file;
  file.frames = kFrames, file.rows = file.columns = 1;
  file.frame_time = [](int f) { return f; };
  for (const std::uint32_t tag : private_tags(100'000)) file.more.push_back({tag, "CS", ""});
  file.more.push_back({0x00180060, "DS", "120"});
  const std::string bytes = file.bytes();
  const DicomHeader header = dicom_header(parse_dicom(bytes, "a"), "a");
  ASSERT_EQ(header.fault, "");
  ASSERT_EQ(header.frames.size(), std::size_t(kFrames));
  for (const int f : {0, 1, kFrames - 1}) {
    const DicomFrame& frame = header.frames[std::size_t(f)];
    EXPECT_EQ(frame.position.z, 30 + 2 * (kFrames - 1 - f));
    EXPECT_EQ(frame.marks[Mark::temporal_position], std::to_string(f));
    EXPECT_EQ(frame.marks[Mark::voltage], "120");
    EXPECT_EQ(frame.between_columns, 0.5);
    EXPECT_EQ(frame.rescale.intercept, -1024);
    EXPECT_EQ(frame.rescale_type, "HU");
  }
}

}  // namespace
}  // namespace trocar::volumes
