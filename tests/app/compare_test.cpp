// trocar precompute and trocar compare, as a script runs them.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/error.hpp>

#include "run_program.hpp"

namespace trocar::app {
namespace {

/// A folder of its own, also for compliances.
class Compare : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = std::filesystem::temp_directory_path() / ("trocar_compare_test_" + std::to_string(getpid()));
    std::filesystem::remove_all(m_folder);
    std::filesystem::create_directories(m_folder);
    setenv("TROCAR_CACHE", (m_folder / "cache").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("TROCAR_CACHE");
    std::filesystem::remove_all(m_folder);
  }
  std::string file(const std::string& name) const { return (m_folder / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream in(m_folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path m_folder;
};

TEST_F(Compare, APrecomputedSolverIsThereTheNextTime) {
  for (const bool computed : {true, false}) {
    const Outcome o = trocar({"precompute", "gynaecology", "--organ", "ovary_left", "--json"});
    ASSERT_EQ(o.exit, core::kDone) << o.err;
    const Json result = o.json();
    ASSERT_EQ(result["organs"].size(), 1u);
    const Json& organ = result["organs"][0];
    EXPECT_EQ(organ["organ"], "ovary_left");
    EXPECT_EQ(organ["computed"], computed);
    EXPECT_LE(organ["kept"].get<int>(), organ["nodes"].get<int>());
    EXPECT_TRUE(std::filesystem::exists(organ["file"].get<std::string>()));
  }
}

TEST_F(Compare, WithoutAStaticOrganItSaysWhatToWrite) {
  const Outcome o = trocar({"precompute", "peg_transfer"});
  EXPECT_EQ(o.exit, core::kDone) << o.err;
  EXPECT_NE(o.out.find("\"solver\": \"static\""), std::string::npos) << o.out;
}

TEST_F(Compare, AnUnknownOrganIsBadInputWithASuggestion) {
  for (const char* command : {"precompute", "compare"}) {
    const Outcome o = trocar({command, "gynaecology", "--organ", "bladdr"});
    EXPECT_EQ(o.exit, core::kBadInput);
    EXPECT_EQ(o.err.rfind("--organ:", 0), o.err.find("--organ:")) << o.err;
    EXPECT_NE(o.err.find("did you mean \"bladder\""), std::string::npos) << o.err;
  }
}

TEST_F(Compare, BesideAnAttemptNeedsAWindow) {
  const Outcome o = trocar({"train", "gynaecology", "--headless", "--input", "demo", "--beside", "bladder"});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("--beside: expected an exercise in a window"), std::string::npos) << o.err;
}

TEST_F(Compare, AnOrganInWhichWavesRunHasNoStaticSolver) {
  const Outcome o = trocar({"compare", "digestive", "--organ", "stomach", "--out", file("out")});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("stomach.json:"), std::string::npos) << o.err;
}

TEST_F(Compare, LeavesFiguresAndAPage) {
  const Outcome o = trocar({"compare", "gynaecology", "--organ", "bladder", "--depth", "1", "--seconds", "1.6", "--out",
                            file("out"), "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json result = o.json();
  EXPECT_GT(result["deepest_mm"].get<double>(), 0.3);
  EXPECT_GT(result["worst"]["largest_mm"].get<double>(), 0);
  EXPECT_LT(result["held"]["rms_percent"].get<double>(), 5);
  const std::string csv = text("out/difference.csv"), page = text("out/index.html");
  EXPECT_EQ(csv.rfind("time_s,moved_mm,rms_mm,largest_mm,", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + std::ptrdiff_t(result["samples"].get<std::size_t>()));
  EXPECT_EQ(result["samples"], 160u) << "one every 10 ms";
  EXPECT_NE(page.find("<svg"), std::string::npos);
  for (const char* wrong : {"nan", "http:", "https:", "{{"}) EXPECT_EQ(page.find(wrong), std::string::npos) << wrong;
  for (const Json& picture : result["pictures"]) {
    EXPECT_NE(page.find(picture.get<std::string>()), std::string::npos);
    EXPECT_GT(text("out/" + picture.get<std::string>()).size(), 10'000u);
  }
}

}  // namespace
}  // namespace trocar::app
