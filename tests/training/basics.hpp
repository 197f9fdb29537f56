// The basic skills of scenes/basics performed: the demonstration, and runs with one flaw each, which must trigger its
// error and only what the table says that may come with it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>

#include "flaws.hpp"

namespace trocar::training::basics {

inline constexpr double kDegree = portable::pi / 180;

/// An exercise with its scene and a plan to be spoilt.
struct Lesson {
  Exercise exercise;
  sim::Model model;
  std::uint64_t seed;
  Demonstration demonstration;

  explicit Lesson(const std::string& name, std::uint64_t of = 0)
      : exercise(read_exercise(TROCAR_SOURCE_DIR "/scenes/basics/" + name + ".json")),
        model(scene::compile(varied(scene::read_scene(exercise.scene), of))),
        seed(of),
        demonstration(read_demonstration(exercise, model, seed)) {}

 private:
  static scene::Description varied(scene::Description d, std::uint64_t seed) {
    scene::vary(d, seed);
    return d;
  }
};

/// What a hand at the camera does beside what the plan says.
using Slip = std::function<void(sim::Input& input, const sim::State& state, const Monitor& monitor)>;

struct Performed {
  Monitor monitor;
  sim::State state;
  sim::Input last{};  ///< where hands are at the end
  bool gave_up = false;
  std::string difficulties;

  /// @param until  ends 2.5 s after this code was made; empty: when the plan is done
  Performed(Lesson& lesson, const std::string& until, const Slip& slip = {}, const Tremor& tremor = {0.0002, 1})
      : monitor(lesson.exercise, lesson.model, Mode::assessed, lesson.seed), state(sim::initial_state(lesson.model)) {
    const sim::Model& model = lesson.model;
    Performer performer(model, std::move(lesson.demonstration), {tremor});
    sim::Work work = sim::make_work(model);
    constexpr int kAfter = 2500, kLongest = 600000;  // ticks
    for (int after = 0; !performer.done() && after < kAfter && int(state.tick) < kLongest;) {
      sim::Input input = performer.next(model, state);
      if (slip) slip(input, state, monitor);
      last = input;
      const sim::StepReport report = step(model, input, state, work);
      performer.after(model, state, report);
      monitor.update(model, state, report);
      after += made(until);
    }
    gave_up = performer.gave_up();
    for (const std::string& d : performer.difficulties()) difficulties += d + "\n";
  }
  int made(const std::string& code) const {
    return int(std::count_if(monitor.errors().begin(), monitor.errors().end(),
                             [&code](const ErrorMade& e) { return e.code == code; }));
  }
};

/// One flaw of one exercise.
struct Flaw {
  const char *exercise, *code;
  std::function<void(Lesson& lesson)> plan;  ///< what is wrong in it
  Slip slip;                                 ///< what the hand at the camera does wrong
};

inline void expect_passes(const char* exercise, std::uint64_t seed, const Tremor& tremor = {0.0002, 1}) {
  Lesson lesson(exercise, seed);
  const Performed run(lesson, "", {}, tremor);
  for (const ErrorMade& e : run.monitor.errors()) ADD_FAILURE() << e.code << " at " << e.at << " s: " << e.detail;
  for (const StepStatus& s : run.monitor.steps()) EXPECT_TRUE(s.done) << s.name;
  EXPECT_FALSE(run.gave_up) << run.difficulties;
  EXPECT_TRUE(run.monitor.score().passed) << run.monitor.score().total;
  std::printf("%s, seed %d, tremor %d: S = %.0f in %.0f s\n%s", exercise, int(seed), int(tremor.seed),
              run.monitor.score().total, double(run.state.tick) * sim::kTick, run.difficulties.c_str());
}

inline void expect_only(const Flaw& flaw) {
  SCOPED_TRACE(std::string(flaw.exercise) + " " + flaw.code);
  Lesson lesson(flaw.exercise);
  const Penalty* p = lesson.exercise.penalty(flaw.code);
  ASSERT_NE(p, nullptr);
  if (flaw.plan) flaw.plan(lesson);
  const Performed run(lesson, flaw.code, flaw.slip);
  EXPECT_EQ(run.made(flaw.code), 1) << run.difficulties;
  for (const ErrorMade& e : run.monitor.errors()) {
    std::printf("%s: %s at %.1f s\n", flaw.code, e.code.c_str(), e.at);
    const auto has = [&e](const std::vector<std::string>& codes) {
      return std::find(codes.begin(), codes.end(), e.code) != codes.end();
    };
    EXPECT_TRUE(e.code == flaw.code || has(p->implies) || has(p->may)) << e.code << " at " << e.at << " s";
  }
  EXPECT_FALSE(run.monitor.score().failed);
}

/// There is one for every code of the exercise's own.
inline void expect_complete(const char* exercise, const std::vector<Flaw>& flaws) {
  const Lesson lesson(exercise);
  for (const Penalty& p : lesson.exercise.penalties) {
    if (p.code[0] == 'E' && p.code != "E12") continue;  // common ones: flaws_soak.cpp
    const bool there = std::any_of(flaws.begin(), flaws.end(), [&](const Flaw& f) { return f.code == p.code; });
    EXPECT_TRUE(there) << exercise << " " << p.code;
  }
}

inline std::string word(const testing::TestParamInfo<Flaw>& info) {
  std::string name = std::string(info.param.exercise) + "_" + info.param.code;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace trocar::training::basics
