// One scripted surgeon a code: on the shipped scene it works as always but for one flaw, which must trigger its error
// and only what the exercise's table says that error implies or may bring with it.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/surgeon.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

const Exercise& shipped() {
  static const Exercise made = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  return made;
}
const sim::Model& model() {
  static const sim::Model made = scene::compile(scene::read_scene(shipped().scene));
  return made;
}

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::vector<std::string> codes() {
  std::vector<std::string> all;
  for (const Penalty& p : shipped().penalties) all.push_back(p.code);
  return all;
}

class Flaw : public testing::TestWithParam<std::string> {};

TEST_P(Flaw, TriggersItsErrorAndOnlyWhatTheTableSaysItImplies) {
  const std::string code = GetParam();
  const Penalty& p = *shipped().penalty(code);
  Exercise e = shipped();
  // One side is enough; the right one where instruments must be exchanged first.
  e.goal.sides = {e.goal.sides[code == "E13" ? 1u : 0u]};
  Monitor monitor(e, model());
  Surgeon surgeon(e, model(), {{0.0002, 1}, code});
  sim::State s = sim::initial_state(model());
  sim::Work w = sim::make_work(model());
  int after = 0;
  constexpr int kAfter = 2500, kLongest = 150000;  // ticks
  while (!surgeon.done() && after < kAfter && s.tick < kLongest) {
    const sim::StepReport report = step(model(), surgeon.next(model(), s), s, w);
    monitor.update(model(), s, report);
    after += surgeon.blundered();
  }
  ASSERT_TRUE(surgeon.blundered()) << surgeon.doing();
  std::vector<std::string> made;
  for (const ErrorMade& error : monitor.errors()) {
    made.push_back(error.code);
    std::printf("%s: %s at %.1f s\n", code.c_str(), error.code.c_str(), error.at);
    EXPECT_TRUE(error.code == code || has(p.implies, error.code) || has(p.may, error.code))
        << error.code << " at " << error.at << " s is not in the table for " << code;
  }
  EXPECT_EQ(std::count(made.begin(), made.end(), code), 1);
  for (const std::string& implied : p.implies) EXPECT_TRUE(has(made, implied)) << implied;
  EXPECT_EQ(monitor.score().failed, p.fail);
}

std::string word(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Codes, Flaw, testing::ValuesIn(codes()), word);

}  // namespace
