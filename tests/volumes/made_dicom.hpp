// A folder of DICOM files that a test writes, and what reading it says.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/volumes/files/volume_file.hpp>

#include "dicom_bytes.hpp"

namespace trocar::volumes {

class MadeDicom : public testing::Test {
 protected:
  std::filesystem::path m_folder =
      std::filesystem::path(TROCAR_BINARY_DIR) /
      (std::string("test-dicom-") + testing::UnitTest::GetInstance()->current_test_info()->name());

  void SetUp() override {
    std::filesystem::remove_all(m_folder);
    std::filesystem::create_directories(m_folder);
  }
  void TearDown() override { std::filesystem::remove_all(m_folder); }

  void write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((m_folder / name).parent_path());
    std::ofstream(m_folder / name, std::ios::binary) << bytes;
  }
  void write(const std::string& name, const DicomFile& file) const { write(name, file.bytes()); }

  /// Slice k of a stack, 2 mm apart, all of whose pixels have one value.
  static DicomFile slice(int k, int value) {
    DicomFile file;
    file.position = "0\\0\\" + std::to_string(2 * k);
    file.instance = k + 1;
    file.object = "1.2.9." + std::to_string(k);
    file.pixel = [value](int) { return 1024 + value; };
    return file;
  }

  template <class Read>
  static std::string fault_of_read(Read&& read) {
    try {
      read();
    } catch (const core::BadInput& bad) {
      return bad.what();
    }
    return "";
  }
  std::string fault(const ReadOptions& options = {}) const {
    return fault_of_read([&] { read_volume(m_folder, options); });
  }
  static std::string fault_of(const std::string& bytes) {
    return fault_of_read([&] { read_volume_bytes(bytes, "a"); });
  }
  static void expect_words(const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << "wanted: " << words << "\ngot: " << text;
  }
  static void expect_fault(const DicomFile& file, const std::string& words) {
    expect_words(fault_of(file.bytes()), words);
  }

  static std::string notes_of(const VolumeFile& file) {
    std::string out;
    for (const std::string& note : file.report.notes) out += note + "\n";
    return out;
  }
  static void expect_value_everywhere(const Volume& v, double value) {
    for (std::size_t i = 0; i < v.grid.count(); ++i) ASSERT_EQ(v.value(v.grid.place(i)), value) << i;
  }
};

}  // namespace trocar::volumes
