// docs/guides/exercise_sterilisation.md says what the exercise file says.
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/training/exercise/exercise.hpp>

using namespace trocar::training;

namespace {

std::string page() {
  std::ifstream in(TROCAR_SOURCE_DIR "/docs/guides/exercise_sterilisation.md");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text.empty() ? "–" : text;
}

TEST(ExercisePage, HasEveryErrorAndWhatItBrings) {
  const Exercise e = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  const std::string text = page();
  for (const Penalty& p : e.penalties) {
    const std::string points = p.fail ? "fails" : fmt::format("{:g}", p.points);
    const std::string row = fmt::format("|{}|{}|{}|{}|{}|{}|\n", p.code, p.name, points, listed(p.implies),
                                        listed(p.may), listed(p.leaves));
    EXPECT_NE(text.find(row), std::string::npos) << "expected the row " << row;
  }
}

TEST(ExercisePage, HasEveryLimit) {
  const Exercise e = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  const std::string text = page();
  for (const Limit& l : e.limits) {
    const std::string line = fmt::format("|`{}`|{}|", l.name, l.shown());
    EXPECT_NE(text.find(line), std::string::npos) << "expected the row " << line;
  }
}

}  // namespace
