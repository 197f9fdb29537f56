// The basic skills with an endoscope, and the page about all of them.
#include "basics.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <trocar/sim/stages/visibility.hpp>

namespace trocar::training::basics {
namespace {

/// For a second from when the first disc has counted, or from when the second one has been held for 0.7
/// s.
Slip for_a_second(bool held, std::function<void(sim::Input&, double since)> what) {
  return [=, since = -1.0, steady = 0.0](sim::Input& input, const sim::State& state, const Monitor& monitor) mutable {
    const double now = double(state.tick) * sim::kTick;
    steady += monitor.steps()[0].done ? sim::kTick : 0;
    const bool begins = held ? monitor.rules().steps()[1].done_for.held >= 0.7 : steady >= 0.05;
    if (since < 0 && begins) since = now;
    if (since >= 0 && now < since + 1) what(input, now - since);
  };
}

/// Turns the camera head, pushes the lens forwards, looks elsewhere. @param push  [m]
std::vector<Flaw> of_camera(const char* exercise, float push) {
  return {
      {exercise, "C1", {}, for_a_second(false, [](sim::Input& in, double) { in.scope.roll += float(25 * kDegree); })},
      {exercise,
       "C2",
       {},
       for_a_second(false, [push](sim::Input& in, double since) { in.scope.depth += since < 0.4 ? push : 0; })},
      {exercise, "C3", {}, for_a_second(true, [](sim::Input& in, double) { in.scope.yaw += 0.9f; })},
  };
}

TEST(BasicSkills, DemonstrationsOfTheCameraPassWhateverTheOrder) {
  for (const char* exercise : {"camera-0", "camera-30"})
    for (const std::uint64_t seed : {0, 7}) expect_passes(exercise, seed);
}

std::vector<Flaw> all_flaws() {
  std::vector<Flaw> all = of_camera("camera-0", 0.047f), oblique = of_camera("camera-30", 0.065f);
  all.insert(all.end(), oblique.begin(), oblique.end());
  return all;
}
class CameraFlaw : public testing::TestWithParam<Flaw> {};
TEST_P(CameraFlaw, TriggersItsErrorAndOnlyWhatTheTableSaysItImplies) { expect_only(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Codes, CameraFlaw, testing::ValuesIn(all_flaws()), word);

TEST(CameraFlaws, ThereIsOneForEveryCode) {
  for (const char* exercise : {"camera-0", "camera-30"}) expect_complete(exercise, of_camera(exercise, 0));
}

/// A disc at the bottom of its tube is seen from straight ahead and from no other side.
TEST(BasicSkills, ANicheHidesItsDiscFromAllButOneTurnOfTheLightPost) {
  const Lesson lesson("camera-30");
  const sim::Model& model = lesson.model;
  sim::State state = sim::initial_state(model);
  const sim::Work work = sim::make_work(model);
  for (const sim::MarkModel& mark : model.marks) {
    if (mark.name.rfind("niche_", 0) != 0) continue;
    const sim::MarkPose pose = pose_of(model, state, mark);
    const Vec3d aside = normalised(cross(pose.normal, Vec3d{1, 0, 0})), beside = cross(pose.normal, aside);
    const auto seen = [&](double off, double around) {
      const Vec3d way = std::cos(around) * aside + std::sin(around) * beside;
      const Vec3d eye = pose.place + 0.05 * (std::cos(off) * pose.normal + std::sin(off) * way);
      return sim::unoccluded(model, state, work, eye, pose.place, 0.0015, -1, -1);
    };
    for (int k = 0; k < 12; ++k) {
      EXPECT_TRUE(seen(15 * kDegree, k * 30 * kDegree)) << mark.name << " " << k;
      EXPECT_FALSE(seen(25 * kDegree, k * 30 * kDegree)) << mark.name << " " << k;
    }
  }
}

TEST(BasicSkills, ThePageHasEveryErrorAndItsPoints) {
  std::ifstream in(TROCAR_SOURCE_DIR "/docs/guides/exercise_basics.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  for (const char* exercise : {"camera-0", "camera-30", "clip-application", "pulse-palpation"}) {
    const Lesson lesson(exercise);
    for (const Penalty& p : lesson.exercise.penalties) {
      if (p.code[0] == 'E' && p.code != "E12") continue;
      const std::size_t at = page.find("|" + p.code + "|");
      ASSERT_NE(at, page.npos) << exercise << " " << p.code;
      const std::string row = page.substr(at, page.find('\n', at) - at);
      const std::string points = fmt::format("|{:g}|", p.points);
      EXPECT_EQ(row.substr(row.size() - points.size()), points) << row;
    }
  }
}

}  // namespace
}  // namespace trocar::training::basics
