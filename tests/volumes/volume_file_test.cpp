// Readers of NIfTI, NRRD and MetaImage, and the writers.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/files/volume_writer.hpp>

#include "../full_disk.hpp"
#include "dicom_bytes.hpp"
#include "volume_bytes.hpp"

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

std::string faults_of(const std::string& bytes, const ReadOptions& options = {}) {
  try {
    read_volume_bytes(bytes, "a", options);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}
void expect_fault(const std::string& bytes, const std::string& words, const ReadOptions& options = {}) {
  const std::string faults = faults_of(bytes, options);
  EXPECT_NE(faults.find(words), std::string::npos) << "wanted: " << words << "\ngot: " << faults;
}
std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}
void expect_near(Vec3d a, Vec3d b) { EXPECT_LT(length(a - b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z; }

/// The volume that all of volume_bytes.hpp describe.
void expect_the_volume(const Volume& v) {
  ASSERT_EQ(v.grid.size, (Index3{2, 3, 2}));
  for (int i = 0; i < 12; ++i) EXPECT_EQ(v.value(v.grid.place(std::size_t(i))), i - 3);
  EXPECT_EQ(v.error, 0);
  expect_near(v.grid.origin, {-10, -20, 30});
  expect_near(v.grid.to_patient({1, 2, 1}), {-9.5, -21.5, 32});
  expect_near(scene_from_patient(v.grid.to_patient({1, 2, 1})), {-0.0095, 0.032, 0.0215});
}

struct TemporaryFolder {
  fs::path path = fs::path(TROCAR_BINARY_DIR) / "test-volumes";
  TemporaryFolder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~TemporaryFolder() { fs::remove_all(path); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }
};

const std::string kNifti = Nifti().header() + twelve_numbers<std::int16_t>();

}  // namespace

TEST(VolumeFiles, EveryFormatGivesTheSameVolumeAtTheSamePlace) {
  for (const bool big : {false, true}) {
    Nifti nifti;
    nifti.big = big;
    const std::string numbers = twelve_numbers<std::int16_t>(big), endian = big ? "big" : "little";
    expect_the_volume(read_volume_bytes(nifti.header() + numbers, "a").volume);
    expect_the_volume(read_volume_bytes(deflated(nifti.header() + numbers), "a").volume);
    expect_the_volume(read_volume_bytes(nrrd_fields("short", "raw", endian) + "\n" + numbers, "a").volume);
    expect_the_volume(read_volume_bytes(nrrd_fields("short", "gzip", endian) + "\n" + deflated(numbers), "a").volume);
    expect_the_volume(read_volume_bytes(meta_fields("MET_SHORT", false, "LOCAL", big) + numbers, "a").volume);
    expect_the_volume(
        read_volume_bytes(meta_fields("MET_SHORT", true, "LOCAL", big) + deflated(numbers, false), "a").volume);
  }
  expect_the_volume(read_volume_bytes(nifti2_header() + twelve_numbers<std::int16_t>(), "a").volume);
  expect_the_volume(read_volume_bytes(nrrd_fields("short", "ascii") + "\n" + kTwelveText, "a").volume);
  expect_the_volume(read_volume_bytes(nrrd_fields("double", "raw") + "\n" + twelve_numbers<double>(), "a").volume);
  expect_the_volume(read_volume_bytes(meta_fields("MET_FLOAT", false) + twelve_numbers<float>(), "a").volume);
}

/// A body with nothing alike on any two sides, in each format with its own convention of axes, lands at the same place.
TEST(VolumeFiles, AnAsymmetricBodyLandsAtTheSamePlaceInEveryFormatAndSpace) {
  const std::string numbers = twelve_numbers<std::int16_t>();
  const auto in_space = [&](const std::string& space, const std::string& directions, const std::string& origin) {
    std::string header = replaced(nrrd_fields("short", "raw"), "left-posterior-superior", space);
    header = replaced(header, "(0.5,0,0) (0,-0.75,0) (0,0,2)", directions);
    return replaced(header, "(-10,-20,30)", origin) + "\n" + numbers;
  };
  expect_the_volume(read_volume_bytes(in_space("LPS", "(0.5,0,0) (0,-0.75,0) (0,0,2)", "(-10,-20,30)"), "a").volume);
  expect_the_volume(
      read_volume_bytes(in_space("right-anterior-superior", "(-0.5,0,0) (0,0.75,0) (0,0,2)", "(10,20,30)"), "a")
          .volume);
  expect_the_volume(read_volume_bytes(in_space("LAS", "(0.5,0,0) (0,0.75,0) (0,0,2)", "(-10,20,30)"), "a").volume);
  expect_the_volume(read_volume_bytes(kNifti, "a").volume);                                     // R A S
  expect_the_volume(read_volume_bytes(meta_fields("MET_SHORT", false) + numbers, "a").volume);  // L P S
  const TemporaryFolder folder;
  for (int k = 0; k < 2; ++k) {  // L P S; rows run to the front
    DicomFile slice;
    slice.columns = 2, slice.rows = 3, slice.is_signed = 1, slice.stored = 16, slice.intercept = "0";
    slice.orientation = "1\\0\\0\\0\\-1\\0", slice.spacing = "0.75\\0.5";
    slice.position = k == 0 ? "-10\\-20\\30" : "-10\\-20\\32";
    slice.pixel = [k](int i) { return 6 * k + i - 3; };
    folder.write(k == 0 ? "b.dcm" : "a.dcm", slice.bytes());
  }
  const Volume dicom = read_volume(folder.path).volume;
  // Its normal points to the feet, so that its slices come from the head: the places count, not the order.
  for (int i = 0; i < 12; ++i) {
    const Index3 at{i % 2, i / 2 % 3, i / 6};
    EXPECT_EQ(dicom.at(dicom.grid.to_index(Vec3d{-10 + 0.5 * at[0], -20 - 0.75 * at[1], 30 + 2.0 * at[2]})), i - 3);
  }
}

TEST(VolumeFiles, DataLongerThanTheHeaderSaysAreTold) {
  const std::string numbers = twelve_numbers<std::int16_t>();
  for (const std::string& bytes :
       {kNifti + "x", deflated(kNifti + "x"), meta_fields("MET_SHORT", false) + numbers + "x",
        meta_fields("MET_SHORT", true) + deflated(numbers + "x", false),
        nrrd_fields("short", "raw") + "\n" + numbers + "x"}) {
    const VolumeFile file = read_volume_bytes(bytes, "a");
    expect_the_volume(file.volume);
    ASSERT_FALSE(file.report.notes.empty());
    EXPECT_NE(file.report.notes.back().find("what follows was passed over"), std::string::npos);
  }
  const TemporaryFolder folder;
  folder.write("voxels.raw", "a header" + numbers);
  try {
    read_volume(folder.write("a.mhd", meta_fields("MET_SHORT", false, "voxels.raw")));
    FAIL() << "which bytes are the voxels is not known";
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("got 32: write \"HeaderSize\" into the header"), std::string::npos);
  }
  for (const std::string size : {"8", "-1"})
    expect_the_volume(read_volume(folder.write("a.mhd", replaced(meta_fields("MET_SHORT", false, "./voxels.raw"),
                                                                 "NDims", "HeaderSize = " + size + "\nNDims")))
                          .volume);
}

TEST(VolumeFiles, DimensionsThatAreZeroAreOne) {
  Nifti nifti;
  nifti.dim = {4, 2, 3, 2, 0, 0, 0, 0};
  const VolumeFile file = read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a");
  expect_the_volume(file.volume);
  EXPECT_EQ(file.report.notes.at(0), "dimension 4 is 0: taken as 1");
  nifti.dim = {3, 0, 3, 2, 1, 1, 1, 1};
  expect_fault(nifti.header() + twelve_numbers<std::int16_t>(), "expected sizes of at least 1, got 0 x 3 x 2");
}

TEST(VolumeFiles, ATimePointThatThereIsNotIsRefusedInEveryFormat) {
  for (const std::string& bytes : {kNifti, nrrd_fields("short", "raw") + "\n" + twelve_numbers<std::int16_t>(),
                                   meta_fields("MET_SHORT", false) + twelve_numbers<std::int16_t>()})
    expect_fault(bytes, "expected one of 1 time points (0 to 0), got 1", {.frame = 1});
  expect_fault(DicomFile().bytes(), "expected one of 1 images at each position (0 to 0), got 1", {.frame = 1});
}

TEST(VolumeFiles, ASeriesOfAFileWithoutSeriesIsRefused) {
  for (const std::string& bytes : {kNifti, nrrd_fields("short", "raw") + "\n" + twelve_numbers<std::int16_t>(),
                                   meta_fields("MET_SHORT", false) + twelve_numbers<std::int16_t>()}) {
    expect_fault(bytes, "this file has no series: expected no --series above 1, got 2",
                 {.series = 2, .series_choice = "--series"});
    EXPECT_NO_THROW(read_volume_bytes(bytes, "a", {.series = 1}));
  }
  expect_fault(DicomFile().bytes(), "expected one of 1 series (1 to 1), got 2", {.series = 2});
}

TEST(VolumeFiles, BeginAsDicomOrNot) {
  const std::filesystem::path folder = std::filesystem::path(TROCAR_BINARY_DIR) / "test-begins-as-dicom";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a", std::ios::binary) << DicomFile().bytes();
  std::ofstream(folder / "b", std::ios::binary) << kNifti;
  EXPECT_TRUE(begins_as_dicom(folder / "a"));
  for (const char* name : {"b", "missing", "."}) EXPECT_FALSE(begins_as_dicom(folder / name)) << name;
  std::filesystem::remove_all(folder);
}

TEST(VolumeFiles, FilesOfOtherKindsAreNamed) {
  expect_fault(std::string("PK\x03\x04\x14\0\0\0", 8), "got a ZIP archive: unpack it and open the folder or file");
  expect_fault(deflated("NRRD0004\n"), "got a gzip file: it holds no NIfTI. Unpack it first");
  expect_fault("\x89PNG\r\n", "got a picture");
  expect_fault("solid liver\n", "got a surface (STL): import it as one");
  expect_fault("\x89HDF\r\n", "got an HDF5 file (MINC 2)");
  expect_fault("---\nmesh: a\n", "got a YAML text");
  std::string tar(512, '\0');
  tar.replace(257, 5, "ustar");
  expect_fault(tar, "got an archive");
}

TEST(VolumeFiles, DataBesideAreReadFromTheSameFolderAndNoOther) {
  const TemporaryFolder folder;
  const std::string numbers = twelve_numbers<std::int16_t>();
  folder.write("voxels.raw", numbers);
  folder.write("voxels.gz", deflated(numbers));
  expect_the_volume(read_volume(folder.write("a.mhd", meta_fields("MET_SHORT", false, "voxels.raw"))).volume);
  expect_the_volume(
      read_volume(folder.write("a.nhdr", nrrd_fields("short", "raw") + "data file: voxels.raw\n")).volume);
  expect_the_volume(
      read_volume(folder.write("b.nhdr", nrrd_fields("short", "gzip") + "data file: voxels.gz\n\n")).volume);
  for (const std::string name : {"../voxels.raw", "/etc/passwd", "..", "a%03d.raw"}) {
    EXPECT_THROW(read_volume(folder.write("c.mhd", meta_fields("MET_SHORT", false, name))), core::BadInput) << name;
    EXPECT_THROW(read_volume(folder.write("c.nhdr", nrrd_fields("short", "raw") + "data file: " + name + "\n")),
                 core::BadInput);
  }
  expect_fault(meta_fields("MET_SHORT", false, "voxels.raw"), "a:12:19: expected LOCAL or one file of the same folder");
}

TEST(VolumeFiles, SformComesBeforeQformAndTheNotesTellWhereBothLack) {
  Nifti nifti;
  nifti.qform = 1;
  expect_the_volume(read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a").volume);
  nifti.sform = 0;
  nifti.quaternion = {0, 1, 0, 10, 20, 30};  // half a turn about the patient's anterior axis: -x, y, -z
  nifti.pixdim[0] = -1;                      // and the third axis mirrored
  expect_the_volume(read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a").volume);
  nifti.qform = 0;
  const VolumeFile blind = read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a");
  ASSERT_FALSE(blind.report.notes.empty());
  EXPECT_NE(blind.report.notes[0].find("where the patient's left is"), std::string::npos);
  expect_near(blind.volume.grid.step().column(0), {-0.5, 0, 0});
}

TEST(VolumeFiles, UnitsOfLengthBecomeMillimetres) {
  Nifti nifti;
  nifti.units = 1;
  expect_near(read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a").volume.grid.spacing,
              {500, 750, 2000});
  const std::string cm =
      nrrd_fields("short", "raw") + "space units: \"cm\" \"cm\" \"cm\"\n\n" + twelve_numbers<std::int16_t>();
  expect_near(read_volume_bytes(cm, "a").volume.grid.spacing, {5, 7.5, 20});
}

TEST(VolumeFiles, ValuesBeyond16BitsAreKeptInEqualStepsAndThatIsTold) {
  Nifti nifti;
  nifti.datatype = 16, nifti.bits = 32;
  Packed data{false, nifti.header()};
  for (int i = 0; i < 12; ++i) data.put(float(0.1 * i * i));
  const VolumeFile file = read_volume_bytes(data.bytes, "a");
  EXPECT_GT(file.volume.error, 0);
  EXPECT_FALSE(file.report.notes.empty());
  for (int i = 0; i < 12; ++i)
    EXPECT_NEAR(file.volume.value(file.volume.grid.place(std::size_t(i))), 0.1 * i * i, file.volume.error + 1e-6);
}

TEST(VolumeFiles, SlopesAndUnsignedNumbersAreExact) {
  Nifti nifti;
  nifti.slope = 0.25f, nifti.intercept = 100;
  const Volume sloped = read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a").volume;
  EXPECT_EQ(sloped.error, 0);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(sloped.value(sloped.grid.place(std::size_t(i))), 100 + 0.25 * (i - 3));
  const Volume big =
      read_volume_bytes(nrrd_fields("ushort", "raw") + "\n" + twelve_numbers<std::uint16_t>(), "a").volume;
  EXPECT_EQ(big.value(0, 0, 0), 65533);
  EXPECT_EQ(big.value(1, 1, 0), 0);
}

TEST(VolumeFiles, WhatIsNoNumberBecomesTheLeastValueAndIsTold) {
  Nifti nifti;
  nifti.datatype = 16, nifti.bits = 32;
  Packed data{false, nifti.header()};
  for (int i = 0; i < 12; ++i) data.put(i == 5 ? NAN : i == 6 ? INFINITY : float(i + 2));
  const VolumeFile file = read_volume_bytes(data.bytes, "a");
  EXPECT_EQ(file.volume.value(1, 2, 0), 2);
  EXPECT_EQ(file.volume.value(0, 0, 1), 2);
  EXPECT_NE(file.report.notes.at(0).find("2 voxels hold no number"), std::string::npos);
  EXPECT_THROW(read_labels_bytes(data.bytes, "a"), core::BadInput);
}

TEST(VolumeFiles, OneOfSeveralTimePointsIsChosenAndTold) {
  Nifti nifti;
  nifti.dim = {4, 2, 3, 2, 3, 1, 1, 1};
  std::string bytes = nifti.header();
  for (int t = 0; t < 3; ++t) {
    Packed frame;
    for (int i = 0; i < 12; ++i) frame.put(std::int16_t(100 * t + i));
    bytes += frame.bytes;
  }
  for (const std::string& file : {bytes, deflated(bytes)}) {
    const VolumeFile last = read_volume_bytes(file, "a", {.frame = 2});
    EXPECT_EQ(last.volume.value(1, 2, 1), 211);
    EXPECT_EQ(last.report.frames, 3);
    EXPECT_NE(last.report.notes.at(0).find("3 time points"), std::string::npos);
    EXPECT_EQ(read_volume_bytes(file, "a").volume.value(1, 2, 1), 11);
    expect_fault(file, "expected one of 3 time points (0 to 2), got 3", {.frame = 3});
  }
}

TEST(VolumeFiles, ShearedGridsComeOutStraightWithEverythingAtItsPlace) {
  Nifti nifti;
  const int n = 20;
  nifti.dim = {3, n, n, n, 1, 1, 1, 1};
  const double tilt = std::tan(15 * 3.14159265358979 / 180);
  nifti.srow = {1, 0, 0, 0, 0, 1, float(2 * tilt), 0, 0, 0, 2, 0};
  Packed data{false, nifti.header()};
  const auto value = [](Vec3d ras) { return 500 + 7 * ras.x + 5 * ras.y - 3 * ras.z; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) data.put(std::int16_t(std::lround(value({double(i), j + 2 * tilt * k, 2.0 * k}))));
  const VolumeFile file = read_volume_bytes(data.bytes, "a");
  EXPECT_LT(shear_deg(file.volume.grid), 1e-6);
  EXPECT_NE(file.report.notes.at(0).find("sheared by 15 degrees"), std::string::npos);
  const Vec3d inside_ras{10, 10 + 2 * tilt * 10, 20};
  EXPECT_NEAR(file.volume.at(file.volume.grid.to_index({-inside_ras.x, -inside_ras.y, inside_ras.z})),
              value(inside_ras), 1.5);
}

TEST(VolumeFiles, AHeaderThatClaimsGigabytesIsRefusedBeforeAnythingIsAllocated) {
  Nifti nifti;
  nifti.dim = {3, 1024, 1024, 1024, 1, 1, 1, 1};
  const ReadOptions roomy{.most_voxels = std::size_t(1) << 31};
  expect_fault(nifti.header() + std::string(100, 'x'), "got a file of 452 bytes", roomy);
  expect_fault(deflated(nifti.header() + std::string(100, 'x')), "which cannot be so many", roomy);
  expect_fault(nifti.header() + std::string(100, 'x'), "expected at most 268435456 voxels");
  const std::string nrrd = replaced(nrrd_fields("short", "gzip"), "2 3 2", "1024 1024 1024") + "\n" + deflated("abc");
  expect_fault(nrrd, "which cannot be so many", roomy);
  expect_fault(replaced(meta_fields("MET_SHORT", false), "2 3 2", "1024 1024 1024") + "abc",
               "expected 2147483648 bytes", roomy);
  expect_fault(replaced(meta_fields("MET_SHORT", false), "2 3 2", "99999999999 9999999999 99999999"),
               "expected at most 268435456 voxels");
}

TEST(VolumeFiles, FilesThatEndEarlyAreRefused) {
  for (const std::string& whole : {kNifti, nrrd_fields("short", "raw") + "\n" + twelve_numbers<std::int16_t>(),
                                   meta_fields("MET_SHORT", false) + twelve_numbers<std::int16_t>(), deflated(kNifti),
                                   nrrd_fields("short", "gzip") + "\n" + deflated(twelve_numbers<std::int16_t>())}) {
    EXPECT_EQ(faults_of(whole), "");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::string cut = whole.substr(0, size);
      // The last bytes of gzip are an end, a sum and a length, which nobody waits for once all voxels are there.
      if (size + 11 < whole.size() || whole[0] == 'O') {
        EXPECT_NE(faults_of(cut), "") << size;
      }
    }
  }
}

TEST(VolumeFiles, FaultsOfHeadersNameLineAndColumn) {
  expect_fault(replaced(nrrd_fields("short", "raw"), "little", "middle") + "\n",
               "a:9:9: expected little or big, got 'middle'");
  expect_fault(replaced(nrrd_fields("short", "raw"), "short", "block") + "\n", "a:3:7: expected a type");
  expect_fault(replaced(nrrd_fields("short", "raw"), "(0,0,2)", "(0,0,0)") + "\n", "a:7:19: expected voxels from 1e-4");
  expect_fault(replaced(nrrd_fields("short", "raw"), "type: short\n", "") + "\n",
               "expected the field 'type', got none");
  expect_fault(replaced(meta_fields("MET_SHORT", false), "0.5 0.75 2", "0.5 0.75"), "a:9:18: expected 3 numbers");
  expect_fault("ObjectType = Image\nNDims = 3\n", "expected the field 'elementdatafile', got the end of the file");
  expect_fault("hello", "expected DICOM, NIfTI, NRRD or MetaImage, got a text that begins with 'hello'");
  Nifti colours;
  colours.datatype = 128, colours.bits = 24;
  expect_fault(colours.header() + kNifti, "got datatype 128 (colours)");
}

TEST(VolumeFiles, SegmentsOfSlicerKeepTheirNamesAndColours) {
  const std::string header =
      nrrd_fields("uchar", "raw") +
      "Segment0_ID:=Segment_1\nSegment0_Name:=liver\nSegment0_LabelValue:=5\nSegment0_Color:=0.5 0.25 1\n"
      "Segment0_Layer:=0\n\n";
  const LabelFile file = read_labels_bytes(header + std::string(11, '\5') + '\7', "a");
  ASSERT_EQ(file.labels.segments.size(), 2u);
  EXPECT_EQ(file.labels.segments[0].name, "liver");
  EXPECT_EQ(file.labels.segments[0].colour, (std::array<float, 3>{0.5f, 0.25f, 1}));
  EXPECT_EQ(file.labels.segments[1].name, "label 7");
  EXPECT_NEAR(millilitres(file.labels, 5), 11 * 0.5 * 0.75 * 2 * 1e-3, 1e-12);
  const LabelFile again = read_labels_bytes(to_nrrd(file.labels), "b");
  EXPECT_EQ(again.labels.at, file.labels.at);
  EXPECT_EQ(again.labels.segments[0].name, "liver");
  EXPECT_EQ(again.labels.segments[0].colour, file.labels.segments[0].colour);
}

TEST(VolumeFiles, LayersSideBySideAreChosenFrom) {
  std::string header = replaced(nrrd_fields("uchar", "raw"), "dimension: 3", "dimension: 4");
  header = replaced(header, "sizes: 2 3 2", "sizes: 2 2 3 2");
  header = replaced(header, "directions: (", "directions: none (");
  header = replaced(header, "kinds: domain", "kinds: list domain");
  std::string data;
  for (int i = 0; i < 12; ++i) data += char(i), data += char(100 + i);
  const std::string bytes = header + "\n" + data;
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(read_labels_bytes(bytes, "a").labels.at[std::size_t(i)], i);
    EXPECT_EQ(read_labels_bytes(bytes, "a", {.frame = 1}).labels.at[std::size_t(i)], 100 + i);
  }
  EXPECT_EQ(read_labels_bytes(bytes, "a").report.frames, 2);
}

TEST(VolumeFiles, WhatIsWrittenReadsBackTheSame) {
  const TemporaryFolder folder;
  Nifti sloped;
  sloped.slope = 0.3f, sloped.intercept = 7;
  for (const std::string& bytes : {kNifti, sloped.header() + twelve_numbers<std::int16_t>(),
                                   nrrd_fields("ushort", "raw") + "\n" + twelve_numbers<std::uint16_t>()}) {
    const Volume volume = read_volume_bytes(bytes, "a").volume;
    for (const std::string name : {"a.nii", "a.nii.gz", "a.nrrd"}) {
      SCOPED_TRACE(name);
      write_volume(folder.path / name, volume);
      const Volume again = read_volume(folder.path / name).volume;
      EXPECT_TRUE(same_place(again.grid, volume.grid, 1e-6));
      for (std::size_t i = 0; i < 12; ++i)
        EXPECT_NEAR(again.value(again.grid.place(i)), volume.value(volume.grid.place(i)), 1e-4);
    }
  }
  Labels labels = on_grid_of(read_volume_bytes(kNifti, "a").volume);
  for (std::size_t i = 0; i < 12; ++i) labels.at[i] = std::uint16_t(i * 5000);
  for (const std::string name : {"b.nii", "b.nii.gz", "b.seg.nrrd"}) {
    write_labels(folder.path / name, labels);
    EXPECT_EQ(read_labels(folder.path / name).labels.at, labels.at);
  }
  EXPECT_THROW(write_labels(folder.path / "b.txt", labels), core::BadInput);
  EXPECT_THROW(write_labels(folder.path / "no" / "b.nii", labels), core::BadInput);
}

TEST(VolumeFiles, WhereTheDiskIsFullThatIsToldAndTheOldFileIsStillThere) {
  const TemporaryFolder folder;
  const Labels old = on_grid_of(read_volume_bytes(kNifti, "a").volume);
  Labels large;
  large.grid.size = {40, 40, 40};
  core::Random random(1);  // so that packing does not help
  for (std::size_t i = 0; i < large.grid.count(); ++i) large.at.push_back(std::uint16_t(random.next() % 200));
  for (const std::string name : {"a.nii", "a.nii.gz", "a.seg.nrrd"}) {
    const fs::path file = folder.path / name;
    write_labels(file, old);
    std::string said;
    {
      const test::FullDisk disk(4096);
      try {
        write_labels(file, large);
      } catch (const core::BadInput& bad) {
        said = bad.what();
      }
    }
    EXPECT_NE(said.find(name), std::string::npos) << said;
    EXPECT_NE(said.find("expected a file that can be written, got \"File too large\""), std::string::npos) << said;
    EXPECT_EQ(read_labels(file).labels.at, old.at);
    write_labels(file, large);
    EXPECT_EQ(read_labels(file).labels.at, large.at);
  }
  const auto files = std::distance(fs::directory_iterator(folder.path), fs::directory_iterator());
  EXPECT_EQ(files, 3) << "nothing half written is left";
}

TEST(VolumeFiles, WhoIsToldToStopThrowsCancelled) {
  EXPECT_THROW(read_volume_bytes(kNifti, "a", {.progress = [](double) { return false; }}), Cancelled);
  double last = 0;
  read_volume_bytes(deflated(kNifti), "a", {.progress = [&](double share) { return last = share, true; }});
  EXPECT_GT(last, 0);
  EXPECT_LE(last, 1);
}

}  // namespace trocar::volumes
