// A folder of a test's own, and short ways to make steps.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

class Workplace {
 public:
  Workplace() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    m_path = fs::path(TROCAR_BINARY_DIR) / "test-files" / (std::string(info->test_suite_name()) + "." + info->name());
    fs::remove_all(m_path);
    fs::create_directories(m_path);
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  fs::path operator/(const std::string& name) const { return m_path / name; }

 private:
  fs::path m_path;
};

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline scene::JsonValue json(const std::string& text) {
  std::vector<core::Fault> faults;
  scene::JsonDocument d = scene::parse_json(text, "step", faults);
  EXPECT_TRUE(faults.empty()) << text;
  return std::move(d.root);
}

/// Does an operation by its name.
inline void apply(Document& document, const std::string& name, const std::string& parameters) {
  const Operation* operation = find_operation(name);
  ASSERT_NE(operation, nullptr) << name;
  modeller::apply(*operation, json(parameters), "step", document);
}

inline std::string fault_of(Document& document, const std::string& name, const std::string& parameters) {
  try {
    modeller::apply(*find_operation(name), json(parameters), "step", document);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

/// Volume of a body that a document builds [mL].
inline double built_mL(const Document& document, const std::string& name) {
  const Built built = build(document);
  EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
  for (const ReadOut& r : read_outs(built, 0))
    if (r.name == name) return r.volume_mL;
  return 0;
}

}  // namespace trocar::modeller
