// DICOM: several images at one position, copies, several directions in one file.
#include <fmt/format.h>

#include "made_dicom.hpp"

namespace trocar::volumes {

namespace fs = std::filesystem;

/// Two acquisitions with the same numbers at the same places, in files with names in no order.
TEST_F(MadeDicom, TwoPhasesAreToldApartByTheirAcquisitionNotByTheirNumbers) {
  for (int phase = 0; phase < 2; ++phase)
    for (int k = 0; k < 6; ++k) {
      DicomFile file = slice(k, phase == 0 ? 40 : 160);
      file.object = fmt::format("1.2.9.{}.{}", phase, k);
      file.more = {{0x00080032, "TM", phase == 0 ? "100000" : "100500"}, {0x00200012, "IS", std::to_string(phase + 1)}};
      write(fmt::format("{}.dcm", 7 * (6 * phase + k) % 13), file);
    }
  const VolumeFile first = read_volume(m_folder), second = read_volume(m_folder, {.frame = 1});
  EXPECT_EQ(first.volume.grid.size, (Index3{3, 2, 6}));
  expect_value_everywhere(first.volume, 40);
  expect_value_everywhere(second.volume, 160);
  EXPECT_EQ(first.report.frame_names, (std::vector<std::string>{"Acquisition Number 1", "Acquisition Number 2"}));
  expect_words(notes_of(first),
               "2 time points or phases, told apart by Acquisition Number: number 0 is read (Acquisition "
               "Number 1); others, to be chosen with \"frame\": 1 (Acquisition Number 2)");
  // A file that is named stands for its own phase.
  expect_value_everywhere(read_volume(m_folder / "5.dcm").volume, 160);
  expect_value_everywhere(read_volume(m_folder / "5.dcm", {.frame = 0}).volume, 40);
}

TEST_F(MadeDicom, AcquisitionsOfUnlikeExtentAreAChoice) {
  for (int k = 0; k < 12; ++k) {
    const bool second = k >= 4;
    DicomFile file = slice(second ? k - 4 : k, second ? 200 : 100);
    file.object = fmt::format("1.2.9.{}", k);
    file.more = {{0x00200012, "IS", second ? "2" : "1"}};
    write(fmt::format("IM{:03}.dcm", k), file);
  }
  try {
    read_volume(m_folder);
    FAIL() << "a choice was expected";
  } catch (const SeriesChoice& choice) {
    expect_words(choice.what(),
                 "expected one image at each position, got 2 acquisitions of unlike extent: choose one with "
                 "\"series\": 1 'by hand' (3 x 2 x 8, axial, Acquisition Number 2), 2 'by hand' (3 x 2 x "
                 "4, axial, Acquisition Number 1)");
    ASSERT_EQ(choice.series().size(), 2u);
    EXPECT_EQ(choice.series()[0].size[2], 8);
  }
  expect_value_everywhere(read_volume(m_folder, {.series = 1}).volume, 200);
  expect_value_everywhere(read_volume(m_folder, {.series = 2}).volume, 100);
  expect_value_everywhere(read_volume(m_folder / "IM001.dcm").volume, 100);
  EXPECT_EQ(list_series(m_folder).size(), 2u);
}

TEST_F(MadeDicom, ImagesThatNothingTellsApartAreNamed) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 2; ++i) {
      DicomFile file = slice(k, 10 * i);
      file.object = fmt::format("1.2.9.{}.{}", k, i);
      write(fmt::format("{}_{}.dcm", k, i), file);
    }
  expect_words(fault(), "got 2 at 0.00 mm that nothing distinguishes (");
  expect_words(fault(), "0_0.dcm and ");
}

TEST_F(MadeDicom, ImagesThatOnlyTheirNumbersDistinguishAreAChoice) {
  for (int t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) {
      DicomFile file = slice(k, 10 * t);
      file.object = fmt::format("1.2.9.{}.{}", t, k);
      file.instance = 3 * t + k;
      write(fmt::format("{}_{}.dcm", t, k), file);
    }
  expect_words(fault(), "got Instance Number alone: choose one with \"series\": 1 ");
  for (int t = 0; t < 2; ++t) expect_value_everywhere(read_volume(m_folder, {.series = t + 1}).volume, 10 * t);
  expect_value_everywhere(read_volume(m_folder / "1_2.dcm").volume, 10);
}

TEST_F(MadeDicom, CopiesWithIdentifiersOfTheirOwnAreCopies) {
  for (int t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) {
      DicomFile file = slice(k, 10 * k);
      file.object = fmt::format("1.2.9.{}.{}", t, k);
      file.instance = 3 * t + k;
      write(fmt::format("{}_{}.dcm", t, k), file);
    }
  const VolumeFile read = read_volume(m_folder);
  EXPECT_EQ(read.report.frames, 1);
  expect_words(notes_of(read), "images that are there twice are read once; left out: ");
}

TEST_F(MadeDicom, CopiesAreLeftOutAndNamed) {
  for (int k = 0; k < 5; ++k) write(fmt::format("IM{}.dcm", k), slice(k, 10 * k));
  write("IM2 - Copy.dcm", slice(2, 20));
  const VolumeFile one = read_volume(m_folder);
  EXPECT_EQ(one.volume.grid.size[2], 5);
  EXPECT_EQ(one.report.frames, 1);
  expect_words(notes_of(one), "images that are there twice are read once; left out: ");
  expect_words(notes_of(one), "IM2 - Copy.dcm");
  for (int k = 0; k < 5; ++k) write(fmt::format("below/IM{}.dcm", k), slice(k, 10 * k));
  const VolumeFile all = read_volume(m_folder);
  EXPECT_EQ(all.volume.stored, one.volume.stored);
  expect_words(notes_of(all), " and 1 more");
  EXPECT_EQ(read_volume(m_folder / "below" / "IM3.dcm").volume.grid.size[2], 5);
}

TEST_F(MadeDicom, ADamagedCopyIsLeftOutWhereverItEnds) {
  for (int k = 0; k < 5; ++k) write(fmt::format("IM{}.dcm", k), slice(k, 10 * k));
  const std::string whole = slice(2, 20).bytes();
  for (const std::size_t size : {whole.size() - 3, std::size_t(420)}) {  // in its pixels, in its header
    write("IM2 (1).dcm", whole.substr(0, size));
    const VolumeFile read = read_volume(m_folder);
    EXPECT_EQ(read.volume.grid.size[2], 5);
    EXPECT_EQ(read.volume.value(0, 0, 2), 20);
    expect_words(notes_of(read), "IM2 (1).dcm");
  }
}

TEST_F(MadeDicom, TheSameObjectWithOtherPixelsIsNoCopy) {
  for (int k = 0; k < 3; ++k) write(fmt::format("a{}.dcm", k), slice(k, 0));
  write("b.dcm", slice(1, 7));
  expect_words(fault(), "got 2 at 2.00 mm that nothing distinguishes");
}

TEST_F(MadeDicom, FramesOfOneFileAreTimePointsWhereTheySaySo) {
  DicomFile file;
  file.frames = 6;
  file.frame_position = [](int f) { return fmt::format("0\\0\\{}", 2 * (f / 2)); };
  file.frame_time = [](int f) { return 1 + f % 2; };
  file.pixel = [](int i) { return 1024 + 100 * (i / 6 % 2); };
  write("phases.dcm", file);
  const VolumeFile second = read_volume(m_folder / "phases.dcm", {.frame = 1});
  EXPECT_EQ(second.volume.grid.size, (Index3{3, 2, 3}));
  expect_value_everywhere(second.volume, 100);
  expect_value_everywhere(read_volume_bytes(file.bytes(), "a").volume, 0);
  EXPECT_EQ(second.report.frame_names.at(1), "Temporal Position 2");
}

TEST_F(MadeDicom, FramesOfSeveralDirectionsAreAChoice) {
  DicomFile file;
  file.frames = 10;
  file.frame_position = [](int f) { return f < 5 ? fmt::format("0\\0\\{}", 2 * f) : fmt::format("{}\\0\\30", 2 * f); };
  file.frame_orientation = [](int f) { return f < 5 ? "1\\0\\0\\0\\1\\0" : "0\\1\\0\\0\\0\\-1"; };
  write("localizer.dcm", file);
  const std::string words =
      "expected slices of one direction and size, got 2: choose one with \"series\": 1 'by hand' "
      "(3 x 2 x 5, axial), 2 'by hand' (3 x 2 x 5, sagittal)";
  expect_words(fault(), words);
  expect_words(fault_of_read([&] { read_volume(m_folder / "localizer.dcm"); }), words);
  EXPECT_NEAR(read_volume(m_folder, {.series = 2}).volume.grid.step().column(2).x, -2, 1e-9);
}

/// A cone-beam CT: one place for all frames.
TEST_F(MadeDicom, FramesWithOnePlaceAreSlicesAlongTheNormalAndNoTimePoints) {
  DicomFile file;
  file.frames = 4, file.frame_places = false;
  file.more = {{0x00180050, "DS", "0.3"},
               {0x00180088, "DS", "0.3"},
               {0x00200032, "DS", "1\\2\\100"},
               {0x00200037, "DS", "1\\0\\0\\0\\1\\0"},
               {0x00280030, "DS", "0.3\\0.3"}};
  file.pixel = [](int i) { return 1024 + i / 6; };
  const VolumeFile read = read_volume_bytes(file.bytes(), "a");
  EXPECT_EQ(read.volume.grid.size, (Index3{3, 2, 4}));
  EXPECT_LT(length(read.volume.grid.to_patient({0, 0, 3}) - Vec3d{1, 2, 100.9}), 1e-9);
  EXPECT_EQ(read.volume.value(0, 0, 3), 3);
  EXPECT_EQ(read.report.frames, 1);
  expect_words(notes_of(read), "only the first of 4 frames has a place: the others were taken as slices 0.3 mm apart");
  DicomFile unspaced = file;
  unspaced.more.erase(unspaced.more.begin() + 1);
  expect_fault(unspaced,
               "expected a place for each frame (Plane Position Sequence), or one place and Spacing Between "
               "Slices, got 4 frames with neither");
  DicomFile film = file;
  film.more.push_back({0x00280009, "AT", std::string("\x18\x00\x63\x10", 4)});  // frames in time
  expect_fault(film, "got 4 frames with neither");
}

}  // namespace trocar::volumes
