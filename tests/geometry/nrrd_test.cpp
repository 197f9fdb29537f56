#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/geometry/voxel_files/nrrd.hpp>

#include "nrrd_bytes.hpp"

namespace trocar::geometry {
namespace {

Voxels voxels_in(const std::string& bytes, std::size_t most = kMostVoxels) {
  NrrdOptions options;
  options.most_voxels = most;
  return voxels_of(read_nrrd(bytes, "a.nrrd", options), "a.nrrd");
}
std::string faults_of(const std::string& bytes, std::size_t most = kMostVoxels) {
  try {
    voxels_in(bytes, most);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}
std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}
void expect_minus_3_to_8(const Voxels& v) {
  ASSERT_EQ(v.size, (std::array<int, 3>{2, 3, 2}));
  for (int i = 0; i < 12; ++i) EXPECT_EQ(v.at(i % 2, i / 2 % 3, i / 6), i - 3);
}
const std::string kText = nrrd_header("int16", "ascii") + kNrrdText;

}  // namespace

TEST(Nrrd, EveryTypeEncodingAndByteOrderGivesTheSameNumbers) {
  for (const bool swapped : {false, true}) {
    const std::string endian = swapped ? "big" : "little";
    for (const auto& [name, bytes] :
         {std::pair<std::string, std::string>{"signed char", nrrd_numbers<std::int8_t>(swapped)},
          {"short", nrrd_numbers<std::int16_t>(swapped)},
          {"int", nrrd_numbers<std::int32_t>(swapped)},
          {"float", nrrd_numbers<float>(swapped)},
          {"double", nrrd_numbers<double>(swapped)}}) {
      SCOPED_TRACE(name + " " + endian);
      expect_minus_3_to_8(voxels_in(nrrd_header(name, "raw", endian) + bytes));
      expect_minus_3_to_8(voxels_in(nrrd_header(name, "gzip", endian) + gzipped(bytes)));
      expect_minus_3_to_8(voxels_in(nrrd_header(name, "ascii", endian) + kNrrdText));
    }
  }
  const Voxels bytes = voxels_in(nrrd_header("uchar", "raw") + nrrd_numbers<std::uint8_t>(false));
  EXPECT_EQ(bytes.at(0, 0, 0), 253);
  const Voxels words = voxels_in(nrrd_header("unsigned short", "raw", "big") + nrrd_numbers<std::uint16_t>(true));
  EXPECT_EQ(words.at(1, 0, 0), 65534);
  EXPECT_NE(faults_of(nrrd_header("uint", "raw") + nrrd_numbers<std::uint32_t>(false)).find("up to 16777216"),
            std::string::npos);
}

TEST(Nrrd, SpacesBecomeOursLeftCranialAnterior) {
  const Vec3d file{3, 5, 7};  // mm from the origin
  const auto origin_in = [&](const std::string& space) {
    const std::string text = replaced(kText, "left-posterior-superior", space);
    return 1e3 * voxels_in(replaced(text, "(-10,20,-30.5)", "(3,5,7)")).origin;
  };
  const auto near = [](Vec3d a, Vec3d b) { return length(a - b) < 1e-12; };
  EXPECT_TRUE(near(origin_in("left-posterior-superior"), {file.x, file.z, -file.y}));
  EXPECT_TRUE(near(origin_in("LPS"), {file.x, file.z, -file.y}));
  EXPECT_TRUE(near(origin_in("right-anterior-superior"), {-file.x, file.z, file.y}));
  EXPECT_TRUE(near(origin_in("LAS"), {file.x, file.z, file.y}));
  const Voxels v = voxels_in(kText);
  EXPECT_TRUE(near(v.centre({1, 2, 1}), {-0.0095, -0.0285, -0.0215}));
}

TEST(Nrrd, UnitsSpacingsCommentsAndForeignFieldsAreUnderstoodOrPassedOver) {
  const Voxels cm = voxels_in(replaced(kText, "kinds: domain domain domain\n", "space units: \"cm\" \"cm\" \"cm\"\n"));
  EXPECT_NEAR(cm.origin.x, -0.1, 1e-15);
  const std::string spaced = replaced(kText, "space directions: (0.5,0,0) (0,0.75,0) (0,0,2)", "spacings: 0.5 0.75 2");
  EXPECT_NEAR(voxels_in(spaced).step.m[1][2], 0.002, 1e-15);
  std::string windows;
  for (const char c : kText) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_minus_3_to_8(voxels_in(windows));
  expect_minus_3_to_8(voxels_in(replaced(kText, "(0.5,0,0)", "( 0.5, 0 ,\t0 )")));
  expect_minus_3_to_8(voxels_in(replaced(kText, "kinds", "Number: 12\nold min: 3\nkinds")));
}

TEST(Nrrd, FaultsSayWhereAndWhatWasExpected) {
  const auto expect_fault = [&](const std::string& what, const std::string& with, const std::string& fault) {
    EXPECT_NE(faults_of(replaced(kText, what, with)).find(fault), std::string::npos)
        << "with " << with << " got: " << faults_of(replaced(kText, what, with));
  };
  expect_fault("NRRD0004", "NRRD0009", "a.nrrd:1:1: expected NRRD0001 to NRRD0005, got 'NRRD0009'");
  expect_fault("int16", "block", "a.nrrd:3:7: expected a type from int8 to uint64, float or double, got 'block'");
  expect_fault("dimension: 3", "dimension: 5", "a.nrrd:4:12: expected dimension 3, or 4 with time points or layers");
  expect_fault("left-posterior-superior", "scanner-xyz", "a.nrrd:5:8: expected left-posterior-superior, ");
  expect_fault("2 3 2", "2 0 2", "a.nrrd:6:8: expected sizes of at least 1, got 2 x 0 x 2");
  expect_fault("2 3 2", "2 3", "a.nrrd:6:8: expected 3 whole numbers, got '2 3'");
  expect_fault("2 3 2", "2000000000 2000000000 2000000000", "a.nrrd:6:8: expected at most 134217728 voxels, got");
  expect_fault("2 3 2", "512 512 9999999", "expected at most 134217728 voxels, got");
  expect_fault("(0,0.75,0)", "none", "a.nrrd:7:19: expected 9 numbers, got");
  expect_fault("(0,0.75,0)", "(0,nan,0)", "expected numbers up to 1e9, got 'nan'");
  expect_fault("(0,0.75,0)", "(1,0,0)", "expected three axes that span a voxel");
  expect_fault("(0,0.75,0)", "(0,1e-5,0)", "expected voxels from 1e-4 to 1e4 mm apart, got 1e-05 along axis 1");
  expect_fault("endian: little", "endian: middle", "a.nrrd:9:9: expected little or big, got 'middle'");
  expect_fault("ascii", "bzip2", "a.nrrd:10:11: expected encoding raw, gzip or ascii, got 'bzip2'");
  expect_fault("kinds: domain", "data file: skip.raw\nkinds: domain",
               "a.nrrd:8:12: expected the data in this file or in one file of its folder, got 'skip.raw'");
  expect_fault("kinds: domain", "byte skip: -1\nkinds: domain", "a.nrrd:8:12: expected byte skip -1 with encoding raw");
  expect_fault("kinds: domain", "sizes: 1 1 1\nkinds: domain",
               "a.nrrd:8:1: expected the field 'sizes' once, got it again");
  expect_fault("kinds: domain", "space units: \"mm\" \"cm\" \"mm\"\nkinds: domain",
               "expected the unit mm, cm, m or um, the same for all axes, got");
  expect_fault("kinds: domain domain domain", "kinds", "a.nrrd:8:1: expected 'field : value', got 'kinds'");
  expect_fault("type: int16\n", "", "expected the field 'type', got none");
  expect_fault("7 8", "7", "expected value 11 of 12 as int16, got nothing");
  expect_fault("7 8", "7 1.5", "expected value 11 of 12 as int16, got '1.5'");
  expect_fault("7 8", "7 40000", "expected value 11 of 12 as int16, got '40000'");
  EXPECT_NE(faults_of(replaced(replaced(kText, "int16", "block"), "ascii", "hex")).find("\n"), std::string::npos)
      << "several faults in one pass";
}

TEST(Nrrd, WithoutASpaceTheAxesAreTakenAsLeftPosteriorSuperiorWithANote) {
  const NrrdVolume volume = read_nrrd(replaced(kText, "space: left-posterior-superior", "space dimension: 3"), "a");
  ASSERT_EQ(volume.notes.size(), 1u);
  EXPECT_NE(volume.notes[0].find("where the patient's left is"), std::string::npos);
  EXPECT_EQ(volume.step.column(1), (Vec3d{0, 0.75, 0}));
}

TEST(Nrrd, DataThatAreTooShortOrDamagedAreFaults) {
  const std::string numbers = nrrd_numbers<std::int16_t>(false), raw = nrrd_header("short", "raw"),
                    zip = nrrd_header("short", "gzip"), packed = gzipped(numbers);
  EXPECT_NE(faults_of(raw + numbers.substr(1)).find("expected 24 bytes of voxels, got 23"), std::string::npos);
  EXPECT_NE(faults_of(raw).find("expected 24 bytes of voxels, got 0"), std::string::npos);
  for (std::size_t n = 0; n + 11 < packed.size(); ++n)  // its last bytes are a sum and a length
    EXPECT_NE(faults_of(zip + packed.substr(0, n)), "") << n << " of " << packed.size() << " bytes";
  EXPECT_NE(faults_of(zip + gzipped(numbers.substr(2))).find("expected 24 bytes unpacked, got 22"), std::string::npos);
  EXPECT_NE(faults_of(zip + numbers).find("expected packed data, got damaged ones"), std::string::npos);
  for (const std::size_t at : {packed.size() - 6, std::size_t(12)}) {  // in the sum, in the data
    std::string spoilt = packed;
    spoilt[at] ^= 0x55;
    EXPECT_NE(faults_of(zip + spoilt), "") << at;
  }
  const float bad[] = {1, 2, 3, 4, 5, INFINITY, 7, 8, 9, 10, 11, 12};
  const std::string not_finite(reinterpret_cast<const char*>(bad), sizeof bad);
  EXPECT_NE(faults_of(nrrd_header("float", "raw") + not_finite).find("expected a finite number, got inf in voxel 5"),
            std::string::npos);
  EXPECT_NE(faults_of(kText, 11).find("expected at most 11 voxels"), std::string::npos);
}

/// Behind its own header the first bytes are the voxels. In a file beside nobody knows, if the header does not say it.
TEST(Nrrd, DataLongerThanTheSizesSayAreToldOrRefused) {
  const std::string numbers = nrrd_numbers<std::int16_t>(false);
  for (const std::string& bytes : {nrrd_header("short", "raw") + numbers + "x", kText + " 9",
                                   nrrd_header("short", "gzip") + gzipped(numbers + "x")}) {
    const NrrdVolume read = read_nrrd(bytes, "a");
    ASSERT_EQ(read.notes.size(), 1u);
    EXPECT_NE(read.notes[0].find("what follows was passed over"), std::string::npos) << read.notes[0];
    expect_minus_3_to_8(voxels_of(read, "a"));
  }
  NrrdOptions options;
  std::string data = "a header" + numbers;
  options.beside = [&](const std::string& name) {
    EXPECT_EQ(name, "a.raw");
    return data;
  };
  const auto beside = [&](const std::string& fields) {
    return replaced(nrrd_header("short", "raw"), "kinds: domain", fields + "data file: ./a.raw\nkinds: domain");
  };
  try {
    read_nrrd(beside(""), "a", options);
    FAIL() << "eight bytes more were expected to be a fault";
  } catch (const core::BadInput& bad) {
    EXPECT_NE(
        std::string(bad.what()).find("expected 24 bytes of voxels, as the sizes say, got 32: write \"byte skip\""),
        std::string::npos)
        << bad.what();
  }
  expect_minus_3_to_8(voxels_of(read_nrrd(beside("byte skip: 8\n"), "a", options), "a"));
  expect_minus_3_to_8(voxels_of(read_nrrd(beside("byte skip: -1\n"), "a", options), "a"));
}

/// "byte skip: -1" counts from the end of all time points.
TEST(Nrrd, TheLastBytesOfAFileAreThoseOfAllTimePoints) {
  std::string header = replaced(nrrd_header("short", "raw"), "dimension: 3", "dimension: 4");
  header = replaced(header, "sizes: 2 3 2", "sizes: 2 3 2 3");
  header = replaced(header, "(0,0,2)", "(0,0,2) none");
  header = replaced(header, "kinds: domain domain domain", "kinds: domain domain domain list\nbyte skip: -1");
  MeshBytes data;
  for (int t = 0; t < 3; ++t)
    for (int i = 0; i < 12; ++i) data.number(std::int16_t(100 * (t + 1)));
  for (int t = 0; t < 3; ++t) {
    NrrdOptions options;
    options.choose = [&](std::int64_t count, const char*) {
      EXPECT_EQ(count, 3);
      return t;
    };
    EXPECT_EQ(voxels_of(read_nrrd(header + "a header" + data.bytes, "a", options), "a").at(1, 2, 1), 100 * (t + 1));
  }
  EXPECT_NE(read_nrrd(header + data.bytes, "a").notes.at(0).find("3 time points: number 0 is read"), std::string::npos);
  EXPECT_NE(faults_of(header + data.bytes.substr(1)).find("expected 72 bytes of voxels, got 71"), std::string::npos);
}

TEST(Nrrd, ColoursAndVectorsAreNoLayers) {
  std::string header = replaced(nrrd_header("uchar", "raw"), "dimension: 3", "dimension: 4");
  header = replaced(header, "sizes: 2 3 2", "sizes: 3 2 3 2");
  header = replaced(header, "directions: (", "directions: none (");
  const std::string bytes = replaced(header, "kinds: domain", "kinds: RGB-color domain") + std::string(36, '\1');
  EXPECT_NE(faults_of(bytes).find("expected one number a voxel, or an axis of time points or a list, got 'rgb-color'"),
            std::string::npos)
      << faults_of(bytes);
}

TEST(Nrrd, OnlyNamesInTheSameFolderAreBeside) {
  EXPECT_EQ(name_beside("a.raw.gz"), "a.raw.gz");
  EXPECT_EQ(name_beside("././a.raw"), "a.raw");
  for (const char* name : {"", "./", "..", "../a.raw", "./../a", "/etc/passwd", "below/a.raw", "a%03d.raw", "c:a", "LIST 2"})
    EXPECT_FALSE(name_beside(name)) << name;
}

TEST(Nrrd, CutOffOrChangedAnywhereItIsReadOrRefusedButNoMore) {
  core::Random random(8);
  const std::string whole[] = {kText, nrrd_header("short", "gzip") + gzipped(nrrd_numbers<std::int16_t>(false)),
                               nrrd_header("double", "raw", "big") + nrrd_numbers<double>(true)};
  int read = 0;
  for (const std::string& bytes : whole) {
    for (std::size_t n = 0; n < bytes.size(); ++n) read += faults_of(bytes.substr(0, n)).empty();
    for (int i = 0; i < 3000; ++i) {
      std::string changed = bytes;
      for (int k = 0; k < 3; ++k)
        changed[std::size_t(random.uniform() * double(changed.size()))] = char(random.uniform() * 256);
      read += faults_of(changed, 1000).empty();
    }
  }
  EXPECT_GT(read, 100) << "changes in comments and numbers do no harm";
}

TEST(Nrrd, ABallOfVoxelsBecomesABodyOfItsVolume) {
  // 3D Slicer's way: bytes, voxels of 1 x 1 x 2 mm, packed.
  std::string values;
  int inside = 0;
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 44; ++j)
      for (int i = 0; i < 44; ++i) {
        const bool in = length(Vec3d{i - 21.6, j - 21.3, 2 * (k - 11.4)}) < 18;
        values += char(in ? 5 : (i == 0 ? 7 : 0));
        inside += in;
      }
  std::string header = replaced(nrrd_header("uchar", "gzip"), "2 3 2", "44 44 24");
  header = replaced(header, "(0.5,0,0) (0,0.75,0) (0,0,2)", "(1,0,0) (0,1,0) (0,0,2)");
  const Voxels volume = voxels_in(header + gzipped(values));
  const TetMesh body = stuffed(volume, 5, 0.004);
  const StuffingReport report = compare(body, field_of_label(volume, 5));
  std::printf("ball of %d voxels: %.2f ml, body %.2f ml, %d cells, angles %.1f to %.1f, surface off %.2f mm\n", inside,
              inside * 2e-3, 1e6 * report.volume, report.cells, report.least_dihedral, report.most_dihedral,
              1e3 * report.surface_off);
  EXPECT_NEAR(report.volume / (inside * 2e-9), 1, 0.03);
  EXPECT_EQ(report.parts, 1);
  EXPECT_EQ(report.odd_edges, 0);
  EXPECT_TRUE(check_edges(surface_of(body).mesh).closed());
  EXPECT_GT(report.least_dihedral, kStuffedLeastDihedral);
  EXPECT_LT(report.most_dihedral, kStuffedMostDihedral);
  EXPECT_LT(report.nodes_off, 1e-7);
  const Vec3d centre = volume.centre({21.6, 21.3, 11.4});
  for (const Vec3d p : surface_of(body).mesh.positions) EXPECT_NEAR(length(p - centre), 0.018, 0.0015);
}

}  // namespace trocar::geometry
