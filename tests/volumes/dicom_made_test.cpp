// DICOM files that were made for what scanners do and the scan of the data folder does not.
#include <cmath>

#include <fmt/format.h>

#include "dicom_packed.hpp"
#include "made_dicom.hpp"

namespace trocar::volumes {
namespace fs = std::filesystem;

TEST_F(MadeDicom, ASliceIsInHounsfieldUnitsAtItsPlaceInEitherByteOrder) {
  for (const bool big : {false, true}) {
    DicomFile file;
    file.big = big;
    const VolumeFile read = read_volume_bytes(file.bytes(), "a");
    ASSERT_EQ(read.volume.grid.size, (Index3{3, 2, 1}));
    EXPECT_EQ(read.volume.grid.spacing, (Vec3d{0.5, 0.75, 2}));
    EXPECT_EQ(read.volume.grid.origin, (Vec3d{-10, -20, 30}));
    for (int i = 0; i < 6; ++i) EXPECT_EQ(read.volume.value(i % 3, i / 3, 0), i - 24);
  }
}

TEST_F(MadeDicom, SignsReachTheBitsThatAreNotStored) {
  DicomFile file;
  file.is_signed = 1, file.intercept = "0";
  file.pixel = [](int i) { return (-i) & 0x0fff; };
  const VolumeFile read = read_volume_bytes(file.bytes(), "a");
  for (int i = 0; i < 6; ++i) EXPECT_EQ(read.volume.value(i % 3, i / 3, 0), -i);
}

TEST_F(MadeDicom, SlicesWithSlopesOfTheirOwnAreInOneScale) {
  for (int k = 0; k < 3; ++k) {
    DicomFile file;
    file.modality = "PT", file.intercept = "0", file.slope = k == 1 ? "0.5" : "2";
    file.position = "0\\0\\" + std::to_string(2 * k);
    file.pixel = [](int i) { return 100 * i; };
    write("s" + std::to_string(k) + ".dcm", file);
  }
  const Volume v = read_volume(m_folder).volume;
  EXPECT_EQ(v.value(2, 1, 0), 1000);
  EXPECT_EQ(v.value(2, 1, 1), 250);
  EXPECT_EQ(v.unit, "");
}

TEST_F(MadeDicom, ObliqueSeriesKeepTheirDirections) {
  for (int k = 0; k < 4; ++k) {
    DicomFile file;
    file.orientation = "0.8\\0.6\\0\\0\\0\\-1";  // the normal is (-0.6, 0.8, 0)
    char place[64];
    std::snprintf(place, sizeof place, "%.6f\\%.6f\\0", 5 - 0.6 * 1.5 * k, 0.8 * 1.5 * k);
    file.position = place;
    write("o" + std::to_string(9 - k), file);  // names in the other order, without an extension
  }
  const Volume v = read_volume(m_folder).volume;
  ASSERT_EQ(v.grid.size, (Index3{3, 2, 4}));
  EXPECT_NEAR(v.grid.spacing.z, 1.5, 1e-5);
  EXPECT_LT(length(v.grid.to_patient({2, 1, 3}) - Vec3d{5 + 0.8 - 2.7, 0.6 + 3.6, -0.75}), 1e-5);
}

TEST_F(MadeDicom, FramesOfOneFileArePutInOrderByTheirPlaces) {
  DicomFile file;
  file.frames = 4;
  const VolumeFile read = read_volume_bytes(file.bytes(), "a");
  ASSERT_EQ(read.volume.grid.size, (Index3{3, 2, 4}));
  EXPECT_EQ(read.volume.grid.origin, (Vec3d{-10, -20, 30}));
  EXPECT_EQ(read.volume.value(0, 0, 0), 1000 + 18 - 1024);  // the last frame is the lowest
  EXPECT_EQ(read.volume.value(2, 1, 3), 1000 + 5 - 1024);
  write("frames.dcm", file);
  EXPECT_EQ(read_volume(m_folder / "frames.dcm").volume.stored, read.volume.stored);
  file.frame_places = false;
  expect_fault(file, "expected a place for each frame");
}

TEST_F(MadeDicom, TwoTimePointsAreChosenBetween) {
  for (int t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) {
      DicomFile file;
      file.position = "0\\0\\" + std::to_string(2 * k);
      file.instance = 3 * t + k;
      file.more = {{0x00200100, "IS", std::to_string(t + 1)}};
      file.pixel = [&](int) { return 1024 + 10 * t + k; };
      write("t" + std::to_string(3 * t + k), file);
    }
  const VolumeFile first = read_volume(m_folder), second = read_volume(m_folder, {.frame = 1});
  EXPECT_EQ(first.volume.value(0, 0, 2), 2);
  EXPECT_EQ(second.volume.value(0, 0, 2), 12);
  EXPECT_EQ(second.report.frames, 2);
  EXPECT_THROW(read_volume(m_folder, {.frame = 2}), core::BadInput);
}

/// Two series in one folder, one of them tilted; then a slice of it is lost, then one ends early.
TEST_F(MadeDicom, AFolderOfMixedSeriesIsToldApartAndWhatIsLostOrDamagedIsNamed) {
  const auto name_of = [](int tilted, int k) { return fmt::format("s{}_{}.dcm", tilted, k); };
  for (int tilted = 0; tilted < 2; ++tilted)
    for (int k = 0; k < 5 + 2 * tilted; ++k) {
      DicomFile file;
      file.series = fmt::format("1.2.{}", 3 + tilted);
      file.position = fmt::format("0\\{}\\{}", 0.75 * tilted * k, 2 * k);
      file.pixel = [&](int) { return 1024 + 100 * tilted + k; };
      write(name_of(tilted, k), file);
    }
  const VolumeFile most = read_volume(m_folder), other = read_volume(m_folder / name_of(0, 2));
  EXPECT_EQ(most.volume.grid.size, (Index3{3, 2 + 6, 7})) << "straightened";
  EXPECT_EQ(most.report.series.size(), 2u);
  EXPECT_NE(most.report.notes.front().find("of 2 is read; others, to be chosen with \"series\": "), std::string::npos)
      << most.report.notes.front();
  EXPECT_NE(most.report.notes.back().find("the grid is sheared by 20.6 degrees"), std::string::npos)
      << most.report.notes.back();
  EXPECT_EQ(other.volume.grid.size, (Index3{3, 2, 5}));
  EXPECT_EQ(other.volume.value(1, 1, 4), 4);
  fs::resize_file(m_folder / name_of(1, 4), fs::file_size(m_folder / name_of(1, 4)) - 3);
  EXPECT_NE(fault().find(name_of(1, 4)), std::string::npos) << fault();
  fs::remove(m_folder / name_of(1, 4));
  EXPECT_NE(fault().find("without gaps, got 6 positions; missing at 8"), std::string::npos) << fault();
  EXPECT_EQ(read_volume(m_folder / name_of(0, 2)).volume.stored, other.volume.stored) << "the sound one is still read";
}

TEST_F(MadeDicom, WhatIsNoGreyScanIsRefusedWithItsReason) {
  DicomFile colours;
  colours.photometric = "RGB", colours.samples = 3, colours.allocated = colours.stored = 8;
  expect_fault(colours, "expected one grey value a pixel, got 'RGB' (3 values)");
  DicomFile palette;
  palette.photometric = "PALETTE COLOR";
  expect_fault(palette, "got 'PALETTE COLOR'");
  DicomFile nowhere;
  nowhere.position = "";
  expect_fault(nowhere, "expected Image Position (Patient), got none");
  DicomFile unsized;
  unsized.spacing = "";
  expect_fault(unsized, "expected Pixel Spacing, got none");
  DicomFile word;
  word.position = "1\\x\\2";
  expect_fault(word, "expected numbers up to 1e9 in Image Position (Patient), got 'x'");
  DicomFile huge;
  huge.columns = huge.rows = 60000, huge.pixel = [](int) { return 0; };
  std::string bytes = DicomFile().bytes();
  const auto number = [](int n) { return std::string{char(n & 255), char(n >> 8)}; };
  for (const auto& [element, was] : {std::pair<int, int>{0x10, 2}, {0x11, 3}}) {
    const std::string at = std::string{'\x28', '\0', char(element), '\0', 'U', 'S', '\2', '\0'};
    bytes.replace(bytes.find(at + number(was)) + 8, 2, number(60000));
  }
  EXPECT_NE(fault_of(bytes).find("expected at most 268435456 voxels, got 60000 x 60000"), std::string::npos)
      << fault_of(bytes);
}

TEST_F(MadeDicom, InvertedGreyIsTold) {
  DicomFile file;
  file.photometric = "MONOCHROME1";
  const VolumeFile read = read_volume_bytes(file.bytes(), "a");
  EXPECT_EQ(read.volume.value(0, 0, 0), -24);
  EXPECT_NE(read.report.notes.back().find("MONOCHROME1"), std::string::npos);
}

TEST_F(MadeDicom, FilesThatEndEarlyAreFaults) {
  const std::string whole = DicomFile().bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_NE(fault_of(whole.substr(0, size)), "") << size;
  EXPECT_EQ(fault_of(whole), "");
}

TEST_F(MadeDicom, EveryLosslessCompressionGivesTheSameVoxelsAndItsTruncatedFilesAreFaults) {
  if (!unpacks_jpeg()) GTEST_SKIP() << "built without GDCM";
  DicomFile file;
  file.columns = 64, file.rows = 48;
  file.pixel = [](int i) { return 1024 + (i % 64) * 7 + (i / 64) * (i % 13); };
  const Volume raw = read_volume_bytes(file.bytes(), "a").volume;
  const std::vector<PackedDicom> all = packed_dicom(file.bytes());
  EXPECT_EQ(all.size(), 6u);
  for (const auto& [syntax, bytes] : all) {
    SCOPED_TRACE(syntax);
    EXPECT_EQ(read_volume_bytes(bytes, "a").volume.stored, raw.stored);
    for (const double share : {0.4, 0.7, 0.9, 0.97}) {
      const std::string fault = fault_of(bytes.substr(0, std::size_t(share * double(bytes.size()))));
      EXPECT_NE(fault, "") << share;
    }
  }
}

}  // namespace trocar::volumes
