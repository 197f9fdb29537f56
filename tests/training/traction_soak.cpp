// Which way the infundibulum is drawn decides whether the triangle opens: to the right hip it does, forwards and up it
// closes. With the fat still in it and hands that hold 2 N, as in docs/guides/cholecystectomy.md.
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/expert/expert.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/fat.hpp>

namespace trocar::training {
namespace {

/// Takes the neck and draws it one way with 2 N, for some seconds.
std::string drawing(const std::string& towards) {
  return R"({
    "format": 3, "name": "traction", "title": "Traction", "scene": "scene.json",
    "steps": [{"step": "hold", "title": "Hold", "when": {"fact": "hand.holds", "hand": "midclavicular"}, "for_s": 60}],
    "demonstration": [
      {"goal": "look", "tries": 1, "do": [{"skill": "look_at", "mark": "neck", "from_mm": 55, "for_s": 0.5}]},
      {"goal": "hold", "until": {"fact": "hand.holds", "hand": "midclavicular"}, "tries": 8,
       "do": [{"skill": "take_hold", "hand": "midclavicular", "mark": "neck", "deep_mm": 10}]},
      {"goal": "draw", "tries": 1, "do": [{"skill": "draw", "hand": "midclavicular", "towards": ")" +
         towards + R"(", "by_mm": 40, "pull_N": 2, "at_most_s": 8, "if_late": "go_on"}]},
      {"goal": "wait", "tries": 1, "do": [{"skill": "view", "mark": "neck", "from_mm": 55, "for_s": 2}]}],
    "score": {"quality": 60, "time": 25, "motion": 15, "source": "ours"},
    "hold_s": 0.2, "expert_s": 10, "longest_s": 60, "pass_mark": 80})";
}

struct Drawn {
  double before = 0, angle = 0;  ///< [degrees]
  double area_before = 0, area = 0, pull = 0;
  double septa = 0;  ///< share that holds
};

Drawn draw(const std::string& towards) {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json"));
  const scene::MemoryFiles files{{"scenes/changed/exercise.json", drawing(towards)}};
  const Exercise exercise = read_exercise("scenes/changed/exercise.json", &files);
  const std::unique_ptr<Expert> surgeon = make_expert(exercise, model);
  sim::State s = sim::initial_state(model);
  sim::Work w = sim::make_work(model);
  const Arguments ducts{{true, model.strand_index("cystic_duct"), 0, 0, "", {}},
                        {true, model.strand_index("common_duct"), 0, 0, "", {}}};
  const auto degrees = [&] {
    return kTriangleAngle.watch(model, ducts)->value({model, s}).number * 180 / portable::pi;
  };
  const auto mm2 = [&] { return kTriangleArea.watch(model, ducts)->value({model, s}).number * 1e6; };
  Drawn out{degrees(), 0, mm2(), 0, 0, 0};
  while (!surgeon->done() && !surgeon->gave_up() && s.tick < 30000) {
    const sim::StepReport report = step(model, surgeon->next(model, s), s, w);
    EXPECT_TRUE(report.fine());
    surgeon->after(model, s, report);
  }
  const double* pull = s.tools[0].pull;
  out.pull = length(Vec3d{pull[0], pull[1], pull[2]});
  out.angle = degrees();
  out.area = mm2();
  const interactions::FatBody& fat = model.fat.front();
  const tissue::FatState& left = s.fat.front();
  for (int i = 0; i < fat.fat.septa(); ++i) out.septa += holding(fat.fat, left, i) / fat.fat.septa();
  std::printf("%s: %.2f N, %.1f to %.1f degrees, %.0f to %.0f mm2, %.3f of the septa hold\n", towards.c_str(), out.pull,
              out.before, out.angle, out.area_before, out.area, out.septa);
  return out;
}

}  // namespace

TEST(TractionSoak, TheRightWayOpensTheTriangleAndTheWrongWayClosesIt) {
  const Drawn hip = draw("right_hip"), forwards = draw("up"), head = draw("head");
  for (const Drawn* d : {&hip, &forwards, &head}) {
    EXPECT_NEAR(d->pull, 2, 0.6);
    EXPECT_GT(d->septa, 0.9) << "it is drawn, not torn";
  }
  EXPECT_GT(hip.angle, hip.before + 6);
  EXPECT_GT(hip.area, 1.15 * hip.area_before);
  EXPECT_LT(forwards.angle, forwards.before);
  EXPECT_LT(head.angle, head.before - 6);
}

}  // namespace trocar::training
