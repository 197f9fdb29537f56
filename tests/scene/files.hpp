// Files for tests: written into a folder of the test's own, removed afterwards.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>

namespace trocar::scene {

class Folder {
 public:
  Folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    m_path = std::filesystem::path(TROCAR_BINARY_DIR) / "test-files" /
             (std::string(info->test_suite_name()) + "." + info->name());
    std::filesystem::remove_all(m_path);
    std::filesystem::create_directories(m_path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = m_path / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// "line:column message" of every fault, for comparing.
inline std::vector<std::string> told(const std::vector<core::Fault>& faults) {
  std::vector<std::string> all;
  for (const core::Fault& f : faults)
    all.push_back(std::to_string(f.at.line) + ":" + std::to_string(f.at.column) + " " + f.message);
  return all;
}

}  // namespace trocar::scene
