// trocar trials: figures of motion files on the command line and as a page.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/json.hpp>

#include "commands/program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

class Trials : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar_trials_test_" + std::to_string(getpid()) + "_" +
                                            testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name) << text;
    return (m_folder / name).string();
  }

  /// Three people, four trials each, every trial 3 s shorter than the one before: straight there and back, 1 row a
  /// second, the left hand at 10 mm/s.
  std::string practice() const {
    std::string text = "operator,trial,t_ms,xL,yL,zL,rollL,handleL,xR,yR,zR,rollR,handleR\n";
    for (const char* person : {"Ann", "B<b>", "Cyd"})
      for (int trial = 1; trial <= 4; ++trial)
        for (int s = 0; s <= 30 - 3 * trial; ++s) {
          text += std::string(person) + ",T" + std::to_string(trial) + ',' + std::to_string(500 + 1000 * s) + ',';
          text +=
              std::to_string(10 * s) + ",0,0," + std::to_string(0.1 * s) + ",0,0," + std::to_string(s % 2) + ",0,0,0\n";
        }
    return write("practice.csv", text);
  }

  int run(std::vector<std::string> words) {
    std::vector<const char*> argv{"trocar", "trials"};
    for (const std::string& w : words) argv.push_back(w.c_str());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_program(int(argv.size()), argv.data());
    m_out = testing::internal::GetCapturedStdout();
    m_err = testing::internal::GetCapturedStderr();
    return code;
  }

  const Json* metric(const Json& result, const std::string& key) const {
    for (const Json& m : result["metrics"])
      if (m["key"] == key) return &m;
    return nullptr;
  }

  fs::path m_folder;
  std::string m_out, m_err;
};

TEST_F(Trials, FiguresOfEveryTrialAndTheirTrend) {
  practice();
  ASSERT_EQ(run({m_folder.string(), "--json"}), 0) << m_err;
  const Json result = Json::parse(m_out);
  ASSERT_EQ(result["attempts"].size(), 12u);
  const Json& first = result["attempts"][0];
  EXPECT_EQ(first["person"], "Ann");
  EXPECT_EQ(first["trial"], "T1");
  EXPECT_EQ(first["repetition"], 1);
  EXPECT_NEAR(first["metrics"]["duration_s"].get<double>(), 27, 1e-9);
  EXPECT_NEAR(first["metrics"]["hands"][0]["path_m"].get<double>(), 0.27, 2e-3);
  EXPECT_NEAR(first["metrics"]["hands"][0]["angular_path_rad"].get<double>(), 2.7, 0.05) << "the turn about the shaft";
  EXPECT_TRUE(first["metrics"]["hands"][0]["depth_m"].is_null());
  EXPECT_TRUE(first["metrics"]["both"]["forces"]["pull"].is_null());
  const Json* duration = metric(result, "duration_s");
  ASSERT_NE(duration, nullptr);
  EXPECT_NEAR((*duration)["trend"]["slope_per_repetition"]["value"].get<double>(), -3, 1e-9);
  EXPECT_NEAR((*duration)["trend"]["spearman_within"]["high"].get<double>(), -1, 1e-9);
  EXPECT_EQ(metric(result, "pull_max_N"), nullptr) << "nobody measured it";
}

TEST_F(Trials, PageNeedsNothingFromOutsideAndEscapesNames) {
  const std::string page_file = (m_folder / "page.html").string();
  ASSERT_EQ(run({practice(), "--html", page_file}), 0) << m_err;
  std::ifstream in(page_file);
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("B&lt;b&gt;"), std::string::npos);
  for (const char* outside : {"B<b>", "<script", "http:", "https:", "src=", "href=", "url(", "nan"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_NE(m_out.find("Duration changes by -3.00 s"), std::string::npos) << m_out;
}

TEST_F(Trials, FaultsAreToldWithTheirPlace) {
  EXPECT_EQ(run({(m_folder / "missing.csv").string()}), 2);
  EXPECT_EQ(run({m_folder.string()}), 2);
  EXPECT_NE(m_err.find("expected CSV files of motion in this folder, found none"), std::string::npos) << m_err;
  EXPECT_EQ(run({write("bad.csv", "operator,trial,t_ms\n")}), 2);
  EXPECT_NE(m_err.find("bad.csv:1:1: expected a column named xL"), std::string::npos) << m_err;
  EXPECT_EQ(run({practice(), "--html", (m_folder / "no/such/folder.html").string()}), 3);
}

}  // namespace
}  // namespace trocar::app
