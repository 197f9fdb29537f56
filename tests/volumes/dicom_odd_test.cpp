// DICOM files that other programs write: what is no slice of a patient, what is damaged, what is wrong and does no
// harm.
#include <fmt/format.h>

#include "dicom_packed.hpp"
#include "made_dicom.hpp"

namespace trocar::volumes {

namespace fs = std::filesystem;

TEST_F(MadeDicom, ObjectsThatAreNoSlicesAreRefusedByName) {
  struct Kind {
    const char *sop_class, *modality, *words;
  };
  for (const Kind& kind : {Kind{"481.2", "RTDOSE", "an RT dose grid (RTDOSE): open the CT or MR series instead"},
                           {"2", "RTDOSE", "an RT dose grid (RTDOSE)"},
                           {"481.3", "RTSTRUCT", "an RT structure set (RTSTRUCT): export it as NRRD or NIfTI"},
                           {"66.4", "SEG", "a segmentation object (SEG): export it as NRRD or NIfTI"},
                           {"11.1", "PR", "a presentation state (PR)"},
                           {"88.11", "SR", "a structured report (SR)"},
                           {"6.1", "US", "an ultrasound image (US)"},
                           {"3.1", "US", "an ultrasound clip (US)"},
                           {"12.1", "XA", "an X-ray angiogram or fluoroscopy"},
                           {"1.1", "DX", "a plain X-ray image"}}) {
    DicomFile file;
    file.sop_class = kind.sop_class, file.modality = kind.modality;
    expect_fault(file, std::string("expected slices of a patient, got ") + kind.words);
  }
  DicomFile screen;
  screen.sop_class = "7", screen.position = "";
  expect_fault(screen, "a secondary capture (a picture of a screen or of paper)");
  DicomFile localizer;
  localizer.more = {{0x00080008, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER"}};
  expect_fault(localizer, "a localizer (a projection of the patient)");
  DicomFile mosaic;
  mosaic.modality = "MR", mosaic.more = {{0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC"}};
  expect_fault(mosaic, "a mosaic (many slices in one picture): convert the series to NIfTI first");
}

TEST_F(MadeDicom, AFolderWithoutImagesSaysSo) { expect_words(fault(), "expected DICOM images, got none"); }

TEST_F(MadeDicom, ReadingIsCancelled) {
  for (int k = 0; k < 20; ++k) write(std::to_string(k), slice(k, 40));
  int calls = 0;
  EXPECT_THROW(read_volume(m_folder, {.progress = [&](double) { return ++calls < 30; }}), Cancelled);
  EXPECT_EQ(calls, 30);
}

TEST_F(MadeDicom, WhatIsBesideASeriesCostsANote) {
  for (int k = 0; k < 5; ++k) write(fmt::format("IM{}.dcm", k), slice(k, k));
  DicomFile dose = slice(0, 0), report = slice(0, 0), other = slice(0, 0);
  dose.sop_class = "481.2", dose.modality = "RTDOSE";
  report.sop_class = "88.11", report.modality = "SR", report.series = "1.2.77";
  other.series = "1.2.78";
  write("dose.dcm", dose);
  write("cut_report.dcm", report.bytes().substr(0, 330));
  write("cut_other.dcm", other.bytes().substr(0, 420));
  write("readme.txt", std::string("hello"));
  write("study.zip", std::string("PK\x03\x04") + std::string(60, '\1'));
  const VolumeFile read = read_volume(m_folder);
  EXPECT_EQ(read.volume.grid.size[2], 5);
  const std::string notes = notes_of(read);
  expect_words(notes, "left out: dose.dcm (expected slices of a patient, got an RT dose grid (RTDOSE)");
  expect_words(notes, "left out: cut_report.dcm (expected slices of a patient, got a structured report (SR)");
  expect_words(notes, "left out: cut_other.dcm (expected a whole DICOM file, got a damaged one: at byte ");
  expect_words(notes, "left out: readme.txt (no DICOM file)");
  expect_words(notes, "left out: study.zip (a ZIP archive: unpack it");
  // Whoever names a file is not told about what has nothing to do with it.
  EXPECT_EQ(notes_of(read_volume(m_folder / "IM1.dcm")).find("readme"), std::string::npos);
  expect_words(fault_of_read([&] { read_volume(m_folder / "dose.dcm"); }), "dose.dcm: expected slices of a patient");
}

TEST_F(MadeDicom, ADamagedSliceOfTheSeriesItselfIsAFault) {
  for (int k = 0; k < 7; ++k) write(fmt::format("IM{}.dcm", k), slice(k, k));
  write("IM6.dcm", slice(6, 6).bytes().substr(0, 420));
  expect_words(fault(), "IM6.dcm: expected a whole DICOM file, got a damaged one");
  write("IM6.dcm", std::string(128, '\0') + "DICM");
  EXPECT_EQ(read_volume(m_folder).volume.grid.size[2], 6) << "nothing says that it is of this series";
  fs::remove(m_folder / "IM2.dcm");
  expect_words(fault(), "missing at 4.00");
  expect_words(fault(), "IM6.dcm: expected a whole DICOM file");
}

TEST_F(MadeDicom, AListOfADiscStandsForItsFolder) {
  for (int k = 0; k < 3; ++k) write(fmt::format("IM{}", k), slice(k, k));
  DicomElements meta;
  meta.text(0x0002, 0x0002, "UI", "1.2.840.10008.1.3.10");
  meta.text(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1");
  DicomElements data;
  data.text(0x0004, 0x1130, "CS", "DISC");
  write("DICOMDIR", std::string(128, '\0') + "DICM" + meta.bytes + data.bytes);
  EXPECT_EQ(read_volume(m_folder / "DICOMDIR").volume.grid.size[2], 3);
}

TEST_F(MadeDicom, BytesBehindThePixelsDoNoHarmAndAreTold) {
  const std::string whole = slice(0, 3).bytes();
  for (const std::string& tail : {std::string(500, '\0'), std::string("end of the transfer"), std::string(3, '\xff')}) {
    const VolumeFile read = read_volume_bytes(whole + tail, "a");
    expect_value_everywhere(read.volume, 3);
    expect_words(notes_of(read), "bytes behind the pixels are no elements");
  }
  DicomFile longer = slice(0, 3);
  longer.rows = 4;
  std::string bytes = longer.bytes();
  bytes.replace(bytes.find(std::string("\x28\0\x10\0US\2\0\4\0", 10)) + 8, 1, "\2");
  const VolumeFile read = read_volume_bytes(bytes, "a");
  EXPECT_EQ(read.volume.grid.size, (Index3{3, 2, 1}));
  expect_words(notes_of(read), "12 bytes behind the last pixel were passed over");
}

TEST_F(MadeDicom, ElementsWithoutARepresentationAreRead) {
  const std::string whole = slice(0, 3).bytes();
  const std::size_t pixels = whole.find(std::string("\xe0\x7f\x10\0", 4));
  for (const std::string& element : {std::string(")\0\x10\x10  \4\0abcd", 12),            // blank, a short length
                                     std::string(")\0\x10\x10\0\0\0\0\4\0\0\0abcd", 16),  // zero, a long length
                                     std::string(")\0\x10\x10\4\0\0\0abcd", 12)}) {       // as in implicit files
    std::string bytes = whole;
    bytes.insert(pixels, element);
    const VolumeFile read = read_volume_bytes(bytes, "a");
    expect_value_everywhere(read.volume, 3);
    expect_words(notes_of(read), "elements lack their value representation");
  }
}

TEST_F(MadeDicom, ATransferSyntaxThatIsWrongOrMissingIsTold) {
  const std::string whole = slice(0, 3).bytes();
  std::string wrong = whole;
  wrong.replace(wrong.find("1.2.840.10008.1.2.1"), 19, std::string("1.2.840.10008.1.2\0\0", 19));
  const VolumeFile read = read_volume_bytes(wrong, "a");
  expect_value_everywhere(read.volume, 3);
  expect_words(notes_of(read), "the file is written in another way than its transfer syntax says");
  DicomElements meta;
  meta.text(0x0002, 0x0002, "UI", "1.2.840.10008.5.1.4.1.1.2");
  const VolumeFile unnamed = read_volume_bytes(
      std::string(128, '\0') + "DICM" + meta.bytes + whole.substr(whole.find(std::string("\x08\0\x16\0", 4))), "a");
  expect_value_everywhere(unnamed.volume, 3);
  expect_words(notes_of(unnamed), "the file does not name its transfer syntax");
}

TEST_F(MadeDicom, NoFramesAreOneFrame) {
  for (int k = 0; k < 3; ++k) {
    DicomFile file = slice(k, 5);
    file.more = {{0x00280008, "IS", "0"}};
    write(fmt::format("{}.dcm", k), file);
  }
  const VolumeFile read = read_volume(m_folder);
  EXPECT_EQ(read.volume.grid.size[2], 3);
  expect_words(notes_of(read), "Number of Frames is 0: taken as 1 (3 files)");
}

/// Headers are read from a file's beginning, which may end anywhere in them.
TEST_F(MadeDicom, AHeaderThatCrossesTheBeginningIsReadWholeWhereverItIsCut) {
  for (int spare = -24; spare <= 24; ++spare) {
    DicomFile file;
    file.frames = 3;
    std::string bytes = file.bytes();
    // A private element in the first frame's item, which ends about where the beginning of 64 KiB does.
    DicomElements own;
    const std::size_t groups = bytes.find(std::string("\0\x52\x30\x92SQ", 6)), item = groups + 12 + 8;
    const std::size_t size = 65536 - item - 12 + std::size_t(spare + 24) / 2 * 2 - 24;
    own.data(0x0019, 0x1010, "OB", std::string(size, '\1'));
    const auto undefined = [&](std::size_t at) { bytes.replace(at, 4, "\xff\xff\xff\xff"); };
    const std::size_t length = std::size_t(static_cast<unsigned char>(bytes[item - 4])) +
                               256 * std::size_t(static_cast<unsigned char>(bytes[item - 3]));
    bytes.insert(bytes.find(std::string("\xe0\x7f\x10\0", 4)), std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8));
    bytes.insert(item + length, std::string("\xfe\xff\x0d\xe0\0\0\0\0", 8));
    bytes.insert(item, own.bytes);
    undefined(groups + 8);
    undefined(item - 4);
    write("enhanced.dcm", bytes);
    ASSERT_EQ(read_volume(m_folder / "enhanced.dcm").volume.grid.size[2], 3) << spare;
  }
}

TEST_F(MadeDicom, Jpeg2000OfFewerBitsThanTheHeaderSaysIsRead) {
  if (!unpacks_jpeg()) GTEST_SKIP() << "built without GDCM";
  DicomFile file;
  file.columns = 64, file.rows = 48, file.allocated = file.stored = 8, file.intercept = "0";
  file.pixel = [](int i) { return i % 64 + 2 * (i / 64); };
  const Volume raw = read_volume_bytes(file.bytes(), "a").volume;
  int tried = 0;
  for (const auto& [syntax, packed] : packed_dicom(file.bytes())) {
    if (syntax != "1.2.840.10008.1.2.4.90") continue;
    std::string bytes = packed;
    for (const auto& [element, bits] : {std::pair<int, int>{0, 16}, {1, 12}, {2, 11}}) {  // allocated, stored, highest
      const std::string at = std::string{'\x28', '\0', char(element), '\x01', 'U', 'S', '\2', '\0'};
      bytes.replace(bytes.find(at) + 8, 1, std::string(1, char(bits)));
    }
    const VolumeFile read = read_volume_bytes(bytes, "a");
    EXPECT_EQ(read.volume.stored, raw.stored);
    expect_words(notes_of(read), "the packed pixels hold 8 bits, where the header says 12");
    ++tried;
  }
  EXPECT_EQ(tried, 1);
}

TEST_F(MadeDicom, APositionWithoutADirectionIsRefused) {
  DicomFile file;
  file.orientation = "";
  expect_fault(file, "expected Image Orientation (Patient), got none");
}

}  // namespace trocar::volumes
