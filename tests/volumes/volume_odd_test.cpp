// NIfTI, NRRD and MetaImage that are damaged, of rare types, or no volume: read right, or refused with a way out.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/volume_file.hpp>

#include "volume_bytes.hpp"

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

template <class Read>
void expect_refused(Read&& read, const std::string& words) {
  std::string got = "a volume";
  try {
    read();
  } catch (const core::BadInput& bad) {
    got = bad.what();
  }
  EXPECT_NE(got.find(words), std::string::npos) << "wanted: " << words << "\ngot: " << got;
}
void expect_fault(const std::string& bytes, const std::string& words) {
  expect_refused([&] { read_volume_bytes(bytes, "a"); }, words);
}
void expect_note(const VolumeFile& file, const std::string& words) {
  std::string all;
  for (const std::string& note : file.report.notes) all += note + "\n";
  EXPECT_NE(all.find(words), std::string::npos) << all;
}

/// Each format around packed voxels.
struct PackedVolume {
  bool gzip;
  std::string before, packed;
  std::string bytes() const { return before + packed; }
};
std::vector<PackedVolume> packed_volumes(const std::string& voxels) {
  return {{true, "", deflated(Nifti().header() + voxels)},
          {true, nrrd_fields("short", "gzip") + "\n", deflated(voxels)},
          {false, meta_fields("MET_SHORT", true), deflated(voxels, false)}};
}

VolumeFile floats(const std::vector<float>& values) {
  Nifti nifti;
  nifti.dim = {3, int(values.size()), 1, 1, 1, 1, 1, 1}, nifti.datatype = 16, nifti.bits = 32;
  Packed data{false, nifti.header()};
  for (const float v : values) data.put(v);
  return read_volume_bytes(data.bytes, "a");
}

}  // namespace

TEST(OddVolumes, PackedVoxelsThatDisagreeWithTheirCheckSumAreRefused) {
  // Longer than the header says, of its length, and of its length with a check sum that is cut off.
  for (const int more : {1000, 0})
    for (PackedVolume& volume : packed_volumes(twelve_numbers<std::int16_t>() + std::string(std::size_t(more), '\1'))) {
      EXPECT_NO_THROW(read_volume_bytes(volume.bytes(), "a"));
      std::string& packed = volume.packed;
      packed.pop_back();
      expect_fault(volume.bytes(), "the file is cut, copy or download it again");
      packed += '\0';
      packed[packed.size() - (volume.gzip ? 8 : 4)] ^= 1;
      expect_fault(volume.bytes(), "expected packed data, got damaged ones");
    }
}

TEST(OddVolumes, DamageBehindTheTimePointThatIsReadIsFound) {
  Nifti nifti;
  nifti.dim[0] = 4, nifti.dim[4] = 50;
  std::string voxels;
  for (int t = 0; t < 50; ++t) voxels += twelve_numbers<std::int16_t>();
  std::string packed = deflated(nifti.header() + voxels);
  EXPECT_EQ(read_volume_bytes(packed, "a").report.frames, 50);
  packed[packed.size() - 8] ^= 1;
  expect_fault(packed, "got damaged ones");
  expect_fault(deflated(nifti.header() + voxels.substr(0, 400)), "the file is cut");
}

TEST(OddVolumes, OneOutlierDoesNotMakeAllValuesCoarse) {
  std::vector<float> values;
  for (int i = 0; i < 400; ++i) values.push_back(0.25f * float(i));
  values[7] = 1e9f;
  const VolumeFile high = floats(values);
  EXPECT_NEAR(high.volume.value(100, 0, 0), 25, 0.01);
  EXPECT_GT(high.volume.value(7, 0, 0), 100);
  expect_note(high, "1 voxels far beyond the others were clipped to the range from 0 to");
  values[7] = -1e9f;
  const VolumeFile low = floats(values);
  EXPECT_NEAR(low.volume.value(100, 0, 0), 25, 0.01);
  EXPECT_LT(low.volume.value(7, 0, 0), 0);
}

TEST(OddVolumes, WhatIsNoNumberIsNeverTheValueOfAllOthers) {
  const VolumeFile positive = floats({300, NAN, NAN, 300}), zero = floats({0, NAN, NAN, 0});
  EXPECT_EQ(positive.volume.value(1, 0, 0), 0);
  EXPECT_EQ(positive.volume.value(3, 0, 0), 300);
  EXPECT_EQ(zero.volume.value(1, 0, 0), -1);
  expect_note(positive, "2 voxels hold no number (nan) or one beyond 1e30");
}

TEST(OddVolumes, AllNamesOfTypesThatNrrdHasAreRead) {
  for (const char* type : {"longlong", "long long", "long long int", "signed long long", "signed long long int"})
    EXPECT_EQ(
        read_volume_bytes(nrrd_fields(type, "raw") + "\n" + twelve_numbers<std::int64_t>(), "a").volume.value(0, 0, 0),
        -3)
        << type;
  Packed whole;
  for (int i = 0; i < 12; ++i) whole.put(std::uint64_t(i));
  for (const char* type : {"ulonglong", "unsigned long long", "unsigned long long int"})
    EXPECT_EQ(read_volume_bytes(nrrd_fields(type, "raw") + "\n" + whole.bytes, "a").volume.value(1, 0, 0), 1) << type;
}

TEST(OddVolumes, LongInMetaImageHasFourBytes) {
  const VolumeFile file = read_volume_bytes(meta_fields("MET_LONG", false) + twelve_numbers<std::int32_t>(), "a");
  EXPECT_EQ(file.volume.value(1, 2, 1), 8);
}

TEST(OddVolumes, TrackedUltrasoundFramesAreRefusedByName) {
  const std::string voxels = twelve_numbers<std::int16_t>(), name = "Seq_Frame0000_ProbeToTrackerTransform",
                    wanted = "a sequence of tracked ultrasound frames (PLUS): reconstruct a volume of it first";
  expect_fault("NDims = 3\n" + name + " = 1 0 0 0\n" + meta_fields("MET_SHORT", false).substr(31) + voxels, wanted);
  expect_fault(nrrd_fields("short", "raw") + name + ":=1 0 0 0\n\n" + voxels, wanted);
}

TEST(OddVolumes, ASformOfZerosGivesWayToTheQform) {
  Nifti nifti;
  nifti.srow = {}, nifti.qform = 1;
  const VolumeFile file = read_volume_bytes(nifti.header() + twelve_numbers<std::int16_t>(), "a");
  EXPECT_NEAR(file.volume.grid.spacing.z, 2, 1e-6);
  expect_note(file, "the sform of the file is all zeros: its qform is taken");
  nifti.qform = 0;
  expect_fault(nifti.header() + twelve_numbers<std::int16_t>(), "write their distance into the header");
  nifti.srow[3] = -NAN, nifti.srow[0] = 1;
  expect_fault(nifti.header() + twelve_numbers<std::int16_t>(), "got nan (not a number) on axis 0");
}

TEST(OddVolumes, CutAndForeignFilesAreNamed) {
  expect_fault(deflated(Nifti().header().substr(0, 112)), "got 112: the file is cut");
  const std::string mgh = std::string("\0\0\0\1\0\0\0\2\0\0\0\3\0\0\0\2\0\0\0\1\0\0\0\4", 24) + std::string(300, '\0');
  expect_fault(mgh, "a volume of FreeSurfer (.mgh, .mgz): convert it to .nii.gz with mri_convert");
  expect_fault(deflated(mgh), "convert it to .nii.gz with mri_convert");
  expect_fault(nrrd_fields("short", "bzip2") + "\n", "got 'bzip2': open the file in 3D Slicer and save it again");
  expect_fault(nrrd_fields("short", "raw") + "data file: LIST\na.raw\nb.raw\n", "got 'LIST': several files");
  expect_fault(nrrd_fields("short", "raw") + "data file: a%d.raw 0 1 1\n\n", "several files");
  expect_fault(meta_fields("MET_SHORT", false, "LIST") + "a.raw\n", "several files; open it in 3D Slicer");
}

TEST(OddVolumes, VoxelsOpenedInPlaceOfTheirHeaderNameIt) {
  const fs::path folder = fs::path(TROCAR_BINARY_DIR) / "test-odd-volumes";
  fs::create_directories(folder);
  std::ofstream(folder / "a.nhdr", std::ios::binary) << nrrd_fields("short", "raw") + "data file: b.raw\n\n";
  std::ofstream(folder / "b.raw", std::ios::binary) << twelve_numbers<std::int16_t>();
  expect_refused([&] { read_volume(folder / "b.raw"); }, "expected a volume, got the voxels of a.nhdr: open a.nhdr");
  EXPECT_EQ(read_volume(folder / "a.nhdr").volume.value(0, 0, 0), -3);
  fs::remove_all(folder);
}

}  // namespace trocar::volumes
