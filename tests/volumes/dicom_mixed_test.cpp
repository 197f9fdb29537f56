// DICOM series whose slices do not belong together, or do not mean the same.
#include <fmt/format.h>

#include "made_dicom.hpp"

namespace trocar::volumes {
namespace {

constexpr std::uint32_t kImageType = 0x00080008, kAcquisition = 0x00200012, kTime = 0x00080032, kPatient = 0x00100020,
                        kPosition = 0x00200032, kBetweenSlices = 0x00180088, kPadding = 0x00280120,
                        kPaddingLimit = 0x00280121, kIntercept = 0x00281052, kSlope = 0x00281053, kType = 0x00281054;

/// A number of 16 bits as a value.
std::string word(int value) { return {char(value & 0xff), char(value >> 8 & 0xff)}; }

}  // namespace

class MixedDicom : public MadeDicom {
 protected:
  /// Two times five slices, 2 mm apart each, the second ones 1 mm behind the first.
  void write_interleaved(const std::vector<DicomFile::Attribute>& first,
                         const std::vector<DicomFile::Attribute>& second) const {
    for (int k = 0; k < 10; ++k) {
      DicomFile file = slice(k, k % 2 == 0 ? 100 : 200);
      file.position = fmt::format("0\\0\\{}", k);
      file.more = k % 2 == 0 ? first : second;
      write(std::to_string(k), file);
    }
  }
  void expect_two_to_choose(const std::string& words) const {
    expect_words(fault(), words);
    const VolumeFile second = read_volume(m_folder, {.series = 2});
    EXPECT_EQ(second.volume.grid.size[2], 5);
    EXPECT_NEAR(second.volume.grid.spacing.z, 2, 1e-9);
    expect_value_everywhere(second.volume, 200);
  }
  /// A series of four slices that `change` gets with their numbers.
  template <class Change>
  void write_series(Change&& change) const {
    for (int k = 0; k < 4; ++k) {
      DicomFile file = slice(k, 40);
      change(k, file);
      write(std::to_string(k), file);
    }
  }
};

TEST_F(MixedDicom, PatientsThatShareASeriesAreAChoice) {
  write_interleaved({{kPatient, "LO", "a"}}, {{kPatient, "LO", "b"}});
  expect_two_to_choose("expected slices of one patient, study and frame of reference in a series, got 2 volumes");
  expect_words(fault(), "Patient ID b");
}

TEST_F(MixedDicom, ImagesOfAnotherTypeBetweenTheSlicesAreAChoice) {
  write_interleaved({{kImageType, "CS", "ADDED"}}, {{kImageType, "CS", "DERIVED"}});
  expect_two_to_choose("expected slices of one acquisition, got 2 whose slices lie between each other");
}

TEST_F(MixedDicom, AcquisitionsBetweenEachOtherAreAChoice) {
  write_interleaved({{kAcquisition, "IS", "1"}, {kTime, "TM", "100000"}},
                    {{kAcquisition, "IS", "2"}, {kTime, "TM", "101000"}});
  expect_two_to_choose("Acquisition Number 2");
}

TEST_F(MixedDicom, AcquisitionsOfOneTimeBetweenEachOtherAreOneVolume) {
  write_interleaved({{kAcquisition, "IS", "1"}, {kTime, "TM", "100000"}},
                    {{kAcquisition, "IS", "2"}, {kTime, "TM", "100000"}});
  EXPECT_EQ(read_volume(m_folder).volume.grid.size[2], 10);
}

TEST_F(MixedDicom, AcquisitionsThatFollowEachOtherAreOneVolume) {
  write_series([](int k, DicomFile& file) { file.more = {{kAcquisition, "IS", k < 2 ? "1" : "2"}}; });
  EXPECT_EQ(read_volume(m_folder).volume.grid.size[2], 4);
}

TEST_F(MixedDicom, PlanesOfEqualKindInSingleFilesAreAChoice) {
  write_series([](int, DicomFile&) {});
  for (int k = 0; k < 3; ++k) {
    DicomFile file = slice(k, 40);
    file.orientation = "0\\1\\0\\0\\0\\-1", file.position = fmt::format("{}\\0\\0", k), file.object += ".9";
    write("sagittal" + std::to_string(k), file);
  }
  expect_words(fault(), "expected slices of one direction and size, got 2: choose one");
  EXPECT_EQ(read_volume(m_folder, {.series = 2}).volume.grid.size[2], 3);
}

TEST_F(MixedDicom, ASliceWithoutSlopeAndInterceptIsRefused) {
  write_series([](int k, DicomFile& file) {
    if (k == 2) file.more = {{kSlope, "", ""}, {kIntercept, "", ""}};
  });
  expect_words(fault(), "2: expected Rescale Slope and Rescale Intercept as in 3 other slices");
}

TEST_F(MixedDicom, CtWithoutSlopeOrInterceptIsNotInHounsfieldUnits) {
  for (const auto& [tag, vr, value] : {DicomFile::Attribute{kSlope, "", ""}, DicomFile::Attribute{kIntercept, "", ""},
                                       DicomFile::Attribute{kSlope, "DS", "0"}}) {
    write_series([&, t = tag, r = vr, v = value](int, DicomFile& file) { file.more = {{t, r, v}}; });
    const VolumeFile file = read_volume(m_folder);
    EXPECT_EQ(file.volume.unit, "");
    expect_words(notes_of(file), "the values are no Hounsfield units");
  }
}

TEST_F(MixedDicom, TheUnitOfCtIsItsRescaleType) {
  write_series([](int, DicomFile&) {});
  EXPECT_EQ(read_volume(m_folder).volume.unit, "HU");
  write_series([](int, DicomFile& file) { file.more = {{kType, "LO", "US"}}; });
  const VolumeFile file = read_volume(m_folder);
  EXPECT_EQ(file.volume.unit, "US");
  expect_words(notes_of(file), "Rescale Type is 'US'");
  write_series([](int k, DicomFile& slice) { slice.more = {{kType, "LO", k == 3 ? "US" : "HU"}}; });
  expect_words(fault(), "expected the Rescale Type 'HU' as in the other slices, got 'US'");
}

TEST_F(MixedDicom, PaddingBecomesTheLeastValueOfTheRest) {
  write_series([](int, DicomFile& file) {
    file.stored = 16;
    file.pixel = [](int i) { return i == 0 ? 63536 : i == 1 ? 63000 : 1024 + i; };
    file.more = {{kPadding, "US", word(63536)}};
  });
  const VolumeFile one = read_volume(m_folder);
  EXPECT_EQ(one.volume.value(0, 0, 1), 2);
  EXPECT_EQ(one.volume.value(1, 0, 1), 63000 - 1024);
  expect_words(notes_of(one), "4 voxels are padding around the patient (Pixel Padding Value): they became 2");
  write_series([](int, DicomFile& file) {
    file.stored = 16;
    file.pixel = [](int i) { return i == 0 ? 63536 : i == 1 ? 63000 : 1024 + i; };
    file.more = {{kPadding, "US", word(63536)}, {kPaddingLimit, "US", word(62000)}};
  });
  EXPECT_EQ(read_volume(m_folder).volume.value(1, 0, 1), 2);
}

TEST_F(MixedDicom, PaddingBeyondTheStoredBitsIsIgnoredWithANote) {
  write_series([](int, DicomFile& file) { file.more = {{kPadding, "US", word(63536)}}; });
  const VolumeFile file = read_volume(m_folder);
  expect_value_everywhere(file.volume, 40);
  expect_words(notes_of(file), "Pixel Padding Value 63536 does not fit into the 12 bits stored");
}

TEST_F(MixedDicom, SignedAndUnsignedSlicesAreReadEachByItsOwn) {
  write_series([](int k, DicomFile& file) {
    file.stored = 16, file.is_signed = k == 1;
    file.pixel = [k](int) { return k == 1 ? 65536 - 100 : k == 2 ? 40000 : 1024; };
  });
  const Volume v = read_volume(m_folder).volume;
  EXPECT_EQ(v.value(0, 0, 0), 0);
  EXPECT_EQ(v.value(0, 0, 1), -1124);
  EXPECT_EQ(v.value(0, 0, 2), 40000 - 1024);
}

TEST_F(MixedDicom, TheSignOfSpacingBetweenSlicesSaysOnWhichSideFramesLie) {
  for (const char* modality : {"CT", "NM"}) {
    DicomFile file;
    file.frames = 3, file.frame_places = false, file.modality = modality;
    file.more = {{kPosition, "DS", "0\\0\\20"}, {kBetweenSlices, "DS", "-5"}};
    file.pixel = [](int i) { return 1024 + i / 6; };
    const VolumeFile read = read_volume_bytes(file.bytes(), "a");
    EXPECT_NEAR(read.volume.grid.origin.z, 10, 1e-9);
    EXPECT_EQ(read.volume.value(0, 0, 0), 2);
    expect_words(notes_of(read), "5 mm apart against the normal (Spacing Between Slices is -5)");
  }
}

TEST_F(MixedDicom, ASliceThatWasSetAsideIsNamedWhereItIsMissing) {
  write_series([](int k, DicomFile& file) {
    if (k == 2) file.spacing = "1\\0.5";
  });
  expect_words(fault(), "2: expected the Pixel Spacing 0.75 x 0.5 mm as in the other slices, got 1 x 0.5");
  write_series([](int k, DicomFile& file) {
    if (k == 2) file.orientation = "0.99939083\\0.0348995\\0\\-0.0348995\\0.99939083\\0";
  });
  expect_words(fault(), "2: expected the Image Orientation (Patient) of the other slices, got one turned by 2 degrees");
}

TEST_F(MixedDicom, TwoDistancesOfSlicesAreBothSaid) {
  for (int k = 0; k < 7; ++k) {
    DicomFile file = slice(k, 40);
    file.position = fmt::format("0\\0\\{}", k < 4 ? 5.0 * k : 15 + 2.5 * (k - 3));
    write(std::to_string(k), file);
  }
  expect_words(fault(), "got 5 mm up to 15.00 mm along the slices' normal and 2.5 mm behind it");
}

TEST_F(MixedDicom, WhatAFileLacksIsSaidWithAWayOut) {
  DicomFile zero, negative, none, no_place, real;
  zero.spacing = "0\\0", negative.spacing = "-1\\1", none.spacing = "", no_place.position = "";
  expect_fault(zero, "expected Pixel Spacing above 0, got 0 x 0: export the series again");
  expect_fault(negative, "expected Pixel Spacing above 0, got -1 x 1");
  expect_fault(none, "expected Pixel Spacing, got none: export the series again");
  expect_fault(no_place, "which Slice Location cannot replace");
  real.more = {{0x7fe00008, "FL", "abcd"}};
  expect_fault(real, "got Float Pixel Data: open the series in 3D Slicer");
}

}  // namespace trocar::volumes
