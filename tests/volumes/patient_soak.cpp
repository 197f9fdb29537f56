// A patient of the data folder: the DICOM series and what can go wrong with it, and organs of the label map.
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/organ/centre_line.hpp>
#include <trocar/volumes/organ/label_surface.hpp>

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(TROCAR_SOURCE_DIR) / "../shared/data/volumes/totalsegmentator";
const fs::path kSeries = kData / "example_ct_dicom_raw", kLabels = kData / "example_seg_dicom.nii.gz";

std::string bytes_of_file(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}
void write_bytes(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

class PatientSeries : public testing::Test {
 protected:
  fs::path m_folder = fs::path(TROCAR_BINARY_DIR) / "test-dicom";
  std::vector<fs::path> m_files;  // of the copy, by position

  void SetUp() override {
    if (!fs::exists(kSeries)) GTEST_SKIP() << "the data folder " << kSeries << " is absent";
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
    for (const auto& entry : fs::directory_iterator(kSeries)) {
      write_bytes(m_folder / entry.path().filename(), bytes_of_file(entry.path()));
      m_files.push_back(m_folder / entry.path().filename());
    }
    std::sort(m_files.begin(), m_files.end());
  }
  void TearDown() override { fs::remove_all(m_folder); }

  std::string fault() const {
    try {
      read_volume(m_folder);
    } catch (const core::BadInput& bad) {
      return bad.what();
    }
    return "";
  }
  static void replace_in(const fs::path& path, const std::string& what, const std::string& with) {
    std::string bytes = bytes_of_file(path);
    std::size_t count = 0;
    for (std::size_t at = bytes.find(what); at != std::string::npos; at = bytes.find(what, at + 1), ++count)
      bytes.replace(at, what.size(), with);
    ASSERT_GT(count, 0u) << what;
    write_bytes(path, bytes);
  }
};

}  // namespace

TEST_F(PatientSeries, LabelsLieOnTheOrgansAndTheScanIsInHounsfieldUnits) {
  const VolumeFile ct = read_volume(kSeries);
  EXPECT_EQ(ct.volume.grid.size, (Index3{512, 512, 20}));
  EXPECT_NEAR(ct.volume.grid.spacing.z, 2, 1e-9);
  EXPECT_EQ(ct.volume.unit, "HU");
  EXPECT_EQ(ct.report.series.size(), 1u);
  const LabelFile organs = read_labels(kLabels);
  EXPECT_FALSE(same_place(organs.labels.grid, ct.volume.grid));  // their y axes are reversed against each other
  const Labels labels = resampled(organs.labels, ct.volume.grid);
  for (const auto& [label, mean] : {std::pair<int, double>{1, 79.6}, {5, 89.3}, {7, 61.0}, {52, 177.3}}) {
    EXPECT_NEAR(statistics(ct.volume, labels, label).mean, mean, 0.05) << label;
    EXPECT_NEAR(millilitres(labels, label), millilitres(organs.labels, label), 1e-6);
  }
}

TEST_F(PatientSeries, AnyFileOfASeriesGivesTheSeries) {
  const VolumeFile all = read_volume(m_folder), one = read_volume(m_files[7]);
  EXPECT_EQ(all.volume.stored, one.volume.stored);
  EXPECT_TRUE(all.volume.grid == one.volume.grid);
}

TEST_F(PatientSeries, AMissingSliceIsNamed) {
  fs::remove(m_files[9]);
  const std::string words = fault();
  EXPECT_NE(words.find("expected slices 2 mm apart without gaps, got 19 positions; missing at -"), std::string::npos)
      << words;
}

TEST_F(PatientSeries, ATruncatedFileIsAFault) {
  const std::string whole = bytes_of_file(m_files[3]);
  for (const double share : {0.999, 0.6, 0.3}) {
    write_bytes(m_files[3], whole.substr(0, std::size_t(share * double(whole.size()))));
    const std::string words = fault();
    EXPECT_NE(words.find("damaged"), std::string::npos) << words;
    EXPECT_NE(words.find(m_files[3].filename().string()), std::string::npos) << words;
  }
}

TEST_F(PatientSeries, SeveralSeriesAreToldApartAndOneIsChosen) {
  for (int i = 0; i < 4; ++i) {
    const fs::path copy = m_folder / ("other" + std::to_string(i) + ".dcm");
    write_bytes(copy, bytes_of_file(m_files[std::size_t(i)]));
    replace_in(copy, "CT Body 3.0", "CT Body 5.0");  // its series have no identifiers
  }
  write_bytes(m_folder / "readme.txt", "not a scan");
  const auto series = list_series(m_folder);
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[0].files, 20);
  EXPECT_EQ(series[1].files, 4);
  const VolumeFile most = read_volume(m_folder), second = read_volume(m_folder, {.series = 2});
  EXPECT_EQ(most.volume.grid.size[2], 20);
  EXPECT_EQ(second.volume.grid.size[2], 4);
  EXPECT_EQ(second.report.chosen_series, 2);
  EXPECT_EQ(read_volume(m_folder / "other0.dcm").volume.grid.size[2], 4);
  ASSERT_GE(most.report.notes.size(), 2u);
  EXPECT_NE(most.report.notes[0].find("of 2 is read; others, to be chosen with \"series\": 2"), std::string::npos)
      << most.report.notes[0];
  EXPECT_NE(most.report.notes.back().find("left out: readme.txt (no DICOM file)"), std::string::npos)
      << most.report.notes.back();
  EXPECT_THROW(read_volume(m_folder, {.series = 3}), core::BadInput);
}

TEST_F(PatientSeries, ATiltedGantryIsStraightenedAndEveryVoxelStaysAtItsPlace) {
  const Volume upright = read_volume(m_folder).volume;
  // Each slice a pixel further to the back than its neighbour: places are text, and the new ones have the same length.
  for (std::size_t i = 0; i < m_files.size(); ++i) {
    char y[32];
    std::snprintf(y, sizeof y, "\\%13.8f\\-", -437.51171875 - 0.9765625 * double(i));
    replace_in(m_files[i], "\\-437.51171875\\-", y);
  }
  const VolumeFile file = read_volume(m_folder);
  EXPECT_LT(shear_deg(file.volume.grid), 1e-6);
  EXPECT_EQ(file.volume.grid.size, (Index3{512, 512 + 19, 20}));
  EXPECT_NE(file.report.notes.back().find("the grid is sheared by 26 degrees"), std::string::npos)
      << file.report.notes.back();
  for (int k = 0; k < 20; ++k)
    for (int n = 0; n < 500; ++n) {
      const Vec3d pixel{double(n), double((7 * n + 13 * k) % 512), double(k)};
      const Vec3d moved = upright.grid.to_patient(pixel) + Vec3d{0, -0.9765625 * (19 - k), 0};
      EXPECT_NEAR(file.volume.at(file.volume.grid.to_index(moved)), upright.at(pixel), 1e-6);
    }
}

TEST(PatientLabels, OrgansOfAPatientAreBodiesOfTheirVolume) {
  if (!fs::exists(kLabels)) GTEST_SKIP() << "the data folder " << kData << " is absent";
  const Labels labels = read_labels(kLabels).labels;
  for (const int organ : {1, 5, 7, 52}) {
    const LabelSurface s = label_surface(labels, organ, {.most_triangles = 20'000});
    EXPECT_TRUE(s.is_body) << organ;
    EXPECT_NEAR(s.ml, s.ml_of_label, 0.02 * s.ml_of_label) << organ;
    EXPECT_LE(s.mesh.triangles.size(), 20'000u) << organ;
    ::testing::Test::RecordProperty("held_back_" + std::to_string(organ), s.held_back);
  }
}

TEST(PatientLabels, TheAortaThatAScanCutsIsOneVessel) {
  if (!fs::exists(kLabels)) GTEST_SKIP() << "the data folder " << kData << " is absent";
  const CentreTree tree = centre_tree(read_labels(kLabels).labels, 52);
  EXPECT_EQ(tree.ends.size(), 1u);
}

}  // namespace trocar::volumes
