#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/formats/nrrd.hpp>
#include <trocar/geometry/tets/stuffing.hpp>

#include "nrrd_bytes.hpp"

namespace trocar::geometry {
namespace {

std::string faults_of(const std::string& bytes, std::size_t most = kMostVoxels) {
  try {
    read_nrrd(bytes, "a.nrrd", most);
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
      expect_minus_3_to_8(read_nrrd(nrrd_header(name, "raw", endian) + bytes, "a.nrrd"));
      expect_minus_3_to_8(read_nrrd(nrrd_header(name, "gzip", endian) + gzipped(bytes), "a.nrrd"));
      expect_minus_3_to_8(read_nrrd(nrrd_header(name, "ascii", endian) + kNrrdText, "a.nrrd"));
    }
  }
  const Voxels bytes = read_nrrd(nrrd_header("uchar", "raw") + nrrd_numbers<std::uint8_t>(false), "a.nrrd");
  EXPECT_EQ(bytes.at(0, 0, 0), 253);
  const Voxels words = read_nrrd(nrrd_header("unsigned short", "raw", "big") + nrrd_numbers<std::uint16_t>(true), "a");
  EXPECT_EQ(words.at(1, 0, 0), 65534);
  EXPECT_NE(faults_of(nrrd_header("uint", "raw") + nrrd_numbers<std::uint32_t>(false)).find("up to 16777216"),
            std::string::npos);
}

TEST(Nrrd, SpacesBecomeOursLeftCranialAnterior) {
  const Vec3d file{3, 5, 7};  // mm from the origin
  const auto origin_in = [&](const std::string& space) {
    const std::string text = replaced(kText, "left-posterior-superior", space);
    return 1e3 * read_nrrd(replaced(text, "(-10,20,-30.5)", "(3,5,7)"), "a.nrrd").origin;
  };
  const auto near = [](Vec3d a, Vec3d b) { return length(a - b) < 1e-12; };
  EXPECT_TRUE(near(origin_in("left-posterior-superior"), {file.x, file.z, -file.y}));
  EXPECT_TRUE(near(origin_in("LPS"), {file.x, file.z, -file.y}));
  EXPECT_TRUE(near(origin_in("right-anterior-superior"), {-file.x, file.z, file.y}));
  EXPECT_TRUE(near(origin_in("LAS"), {file.x, file.z, file.y}));
  const Voxels v = read_nrrd(kText, "a.nrrd");
  EXPECT_TRUE(near(v.centre({1, 2, 1}), {-0.0095, -0.0285, -0.0215}));
}

TEST(Nrrd, UnitsSpacingsCommentsAndForeignFieldsAreUnderstoodOrPassedOver) {
  const Voxels cm =
      read_nrrd(replaced(kText, "kinds: domain domain domain\n", "space units: \"cm\" \"cm\" \"cm\"\n"), "a");
  EXPECT_NEAR(cm.origin.x, -0.1, 1e-15);
  const std::string spaced = replaced(kText, "space directions: (0.5,0,0) (0,0.75,0) (0,0,2)", "spacings: 0.5 0.75 2");
  EXPECT_NEAR(read_nrrd(spaced, "a").step.m[1][2], 0.002, 1e-15);
  std::string windows;
  for (const char c : kText) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_minus_3_to_8(read_nrrd(windows, "a"));
  expect_minus_3_to_8(read_nrrd(replaced(kText, "(0.5,0,0)", "( 0.5, 0 ,\t0 )"), "a"));
  expect_minus_3_to_8(read_nrrd(replaced(kText, "kinds", "Number: 12\nold min: 3\nkinds"), "a"));
}

TEST(Nrrd, FaultsSayWhereAndWhatWasExpected) {
  const auto expect_fault = [&](const std::string& what, const std::string& with, const std::string& fault) {
    EXPECT_NE(faults_of(replaced(kText, what, with)).find(fault), std::string::npos)
        << "with " << with << " got: " << faults_of(replaced(kText, what, with));
  };
  expect_fault("NRRD0004", "NRRD0009", "a.nrrd:1:1: expected NRRD0001 to NRRD0005, got 'NRRD0009'");
  expect_fault("int16", "block", "a.nrrd:3:7: expected a type from int8 to uint32, float or double, got 'block'");
  expect_fault("int16", "int64", "a.nrrd:3:7: expected a type");
  expect_fault("dimension: 3", "dimension: 4", "a.nrrd:4:12: expected dimension 3, got '4'");
  expect_fault("left-posterior-superior", "scanner-xyz", "a.nrrd:5:8: expected left-posterior-superior, ");
  expect_fault("2 3 2", "2 0 2", "a.nrrd:6:10: expected a size of at least 1, got '0'");
  expect_fault("2 3 2", "2 3", "a.nrrd:6:11: expected a size of at least 1, got the end of the line");
  expect_fault("2 3 2", "2 3 2 2", "a.nrrd:6:14: expected the end of the line after three, got '2'");
  expect_fault("2 3 2", "2000000000 2000000000 2000000000", "a.nrrd:6:8: expected at most 134217728 voxels, got more");
  expect_fault("2 3 2", "512 512 9999999", "expected at most 134217728 voxels, got more");
  expect_fault("(0,0.75,0)", "none", "a.nrrd:7:29: expected a vector (x,y,z), got 'none'");
  expect_fault("(0,0.75,0)", "(0,0.75)", "a.nrrd:7:36: expected a comma, got ')'");
  expect_fault("(0,0.75,0)", "(0,nan,0)", "expected a number up to 1e6, got 'nan'");
  expect_fault("(0,0.75,0)", "(1,0,0)", "expected three directions that span a voxel");
  expect_fault("(0,0.75,0)", "(0,1e-5,0)", "expected directions of a length from 1e-4 to 1e4, got 1e-05");
  expect_fault("(0,0.75,0)", "(0,0.75,0,0)", "expected a bracket after three numbers");
  expect_fault("endian: little", "endian: middle", "a.nrrd:9:9: expected little or big, got 'middle'");
  expect_fault("ascii", "bzip2", "a.nrrd:10:11: expected encoding raw, gzip or ascii, got 'bzip2'");
  expect_fault("kinds: domain", "data file: skip.raw\nkinds: domain",
               "a.nrrd:8:12: expected the data in this file, got it in 'skip.raw'");
  expect_fault("kinds: domain", "byte skip: -1\nkinds: domain",
               "expected the data right after the header (0), got '-1'");
  expect_fault("kinds: domain", "sizes: 1 1 1\nkinds: domain",
               "a.nrrd:8:1: expected the field 'sizes' once, got it again");
  expect_fault("kinds: domain", "space units: \"mm\" \"cm\" \"mm\"\nkinds: domain",
               "expected the same unit for all axes, got 'cm'");
  expect_fault("kinds: domain domain domain", "kinds", "a.nrrd:8:1: expected 'field: value', got 'kinds'");
  expect_fault("type: int16\n", "", "a.nrrd:12:1: expected the field 'type', got none");
  expect_fault("space: left-posterior-superior\n", "", "expected the field 'space', got none");
  expect_fault("7 8", "7 8 9", "a.nrrd:15:13: expected the end of the file after 12 values, got '9'");
  expect_fault("7 8", "7", "expected a whole number, got the end of the file");
  expect_fault("7 8", "7 1e3", "a.nrrd:15:11: expected a whole number, got '1e3'");
  expect_fault("7 8", "7 40000", "a.nrrd:15:11: expected a number that the type holds, got '40000'");
  EXPECT_NE(faults_of(replaced(replaced(kText, "int16", "block"), "ascii", "hex")).find("\n"), std::string::npos)
      << "several faults in one pass";
}

TEST(Nrrd, DataThatAreTooShortTooLongOrDamagedAreFaults) {
  const std::string numbers = nrrd_numbers<std::int16_t>(false), raw = nrrd_header("short", "raw"),
                    zip = nrrd_header("short", "gzip"), packed = gzipped(numbers);
  EXPECT_NE(faults_of(raw + numbers.substr(1)).find("expected 24 bytes of voxels, got 23"), std::string::npos);
  EXPECT_NE(faults_of(raw + numbers + "x").find("got 25"), std::string::npos);
  EXPECT_NE(faults_of(raw).find("expected 24 bytes of voxels, got 0"), std::string::npos);
  for (std::size_t n = 0; n < packed.size(); ++n)
    EXPECT_NE(faults_of(zip + packed.substr(0, n)), "") << n << " of " << packed.size() << " bytes";
  EXPECT_NE(faults_of(zip + packed.substr(0, 14)).find("got the end of the file after"), std::string::npos);
  EXPECT_NE(faults_of(zip + gzipped(numbers + "x")).find("expected 24 bytes unpacked, got more"), std::string::npos);
  EXPECT_NE(faults_of(zip + gzipped(numbers.substr(2))).find("expected 24 bytes unpacked, got 22"), std::string::npos);
  EXPECT_NE(faults_of(zip + gzipped(std::string(50'000'000, '\0'))).find("got more"), std::string::npos);
  EXPECT_NE(faults_of(zip + numbers).find("expected gzip data, got damaged ones"), std::string::npos);
  std::string spoilt = packed;
  spoilt[12] ^= 0x55;
  EXPECT_NE(faults_of(zip + spoilt), "");
  const float bad[] = {1, 2, 3, 4, 5, INFINITY, 7, 8, 9, 10, 11, 12};
  const std::string not_finite(reinterpret_cast<const char*>(bad), sizeof bad);
  EXPECT_NE(faults_of(nrrd_header("float", "raw") + not_finite).find("expected a finite number, got inf in voxel 5"),
            std::string::npos);
  EXPECT_NE(faults_of(kText, 11).find("expected at most 11 voxels"), std::string::npos);
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
  const Voxels volume = read_nrrd(header + gzipped(values), "ball.nrrd");
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
