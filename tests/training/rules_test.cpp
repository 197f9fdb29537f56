// What the runtime of rules makes of an exercise: small files of steps and errors, on States written by hand.
#include <gtest/gtest.h>

#include <trocar/training/exercise/monitor.hpp>

#include "../count_allocations.hpp"
#include "two_sides.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

/// An exercise of these steps and errors in the small scene.
Exercise exercise_of(const std::string& steps, const std::string& errors = "", const std::string& sets = "") {
  return read_exercise(kChanged, files_with(R"({"format": 3, "name": "small", "title": "Small", "scene": "scene.json",
    "score": {"quality": 60, "time": 25, "motion": 15, "source": "ours"}, "hold_s": 0.2, "expert_s": 10,
    "longest_s": 100, "pass_mark": 50, "sets": {)" +
                                            sets + R"(}, "steps": [)" + steps + R"(], "errors": [)" + errors + "]}"));
}

/// Done while the left tube's fimbriae are in view.
std::string seen(const std::string& name, const std::string& more = "") {
  return R"({"step": ")" + name + R"(", "title": ")" + name +
         R"(", "when": {"fact": "mark.in_view", "of": "tube_left.fimbria"})" + (more.empty() ? "" : ", " + more) + "}";
}
std::string pulled(const std::string& name, const std::string& more = "") {
  return R"({"step": ")" + name + R"(", "title": ")" + name + R"(", "when": {"fact": "hand.pull_N", "hand": ")" +
         two_sides::model().hands[0].name + R"(", "min": 1})" + (more.empty() ? "" : ", " + more) + "}";
}
const std::string kPull =
    R"({"fact": "hand.pull_N", "hand": ")" + two_sides::model().hands[0].name + R"(", "above": 2})";

struct Small {
  Exercise e;
  two_sides::Attempt a;
  explicit Small(Exercise of) : e(std::move(of)), a(Mode::assessed, e) {}
  void pull(double newtons) { a.hold_tube(two_sides::kLeft, 0.055, newtons); }
  const StepStatus& step(const std::string& name) const {
    for (const StepStatus& s : a.monitor.steps())
      if (s.task == name) return s;
    throw std::logic_error("no step " + name);
  }
};

TEST(Rules, AStepCountsAfterItsTimeWithoutABreak) {
  Small s(exercise_of(seen("look", R"("for_s": 1)")));
  s.a.seconds(0.9);
  s.a.look("tube_left.fimbria", false);
  s.a.seconds(0.1);
  s.a.look("tube_left.fimbria", true);
  s.a.seconds(0.9);
  EXPECT_FALSE(s.step("look").done);
  s.a.seconds(0.2);
  EXPECT_TRUE(s.step("look").done);
}

TEST(Rules, AStepThatWasDoneStaysDoneUnlessTheFileOpensItAgain) {
  const std::string gone = R"({"not": {"fact": "mark.in_view", "of": "tube_left.fimbria"}})";
  Small s(exercise_of(seen("once") + "," + seen("while_seen", R"("undone_when": )" + gone) + "," + pulled("end")));
  s.a.seconds(1);
  EXPECT_TRUE(s.step("once").done && s.step("while_seen").done);
  s.a.look("tube_left.fimbria", false);
  s.a.seconds(1);
  EXPECT_TRUE(s.step("once").done);
  EXPECT_FALSE(s.step("while_seen").done);
}

TEST(Rules, WhatIsUnknownSatisfiesNeitherAConditionNorItsNegation) {
  // nothing is held: there is no pull
  const std::string hand = two_sides::model().hands[0].name;
  const std::string weak = R"({"fact": "hand.pull_N", "hand": ")" + hand + R"(", "max": 1})";
  Small s(exercise_of(R"({"step": "weak", "title": "w", "when": )" + weak + R"(},
                         {"step": "strong", "title": "s", "when": {"not": )" +
                      weak + "}}"));
  s.a.seconds(1);
  EXPECT_FALSE(s.step("weak").done || s.step("strong").done);
  s.pull(2);
  s.a.seconds(1);
  EXPECT_FALSE(s.step("weak").done);
  EXPECT_TRUE(s.step("strong").done);
}

TEST(Rules, AllAndAnyKnowTheUnknown) {
  const std::string unknown =
      R"({"fact": "hand.pull_N", "hand": ")" + two_sides::model().hands[0].name + R"(", "min": 0})";
  const std::string yes = R"({"fact": "attempt.time_s", "min": 0})", no = R"({"fact": "attempt.time_s", "max": 0})";
  const auto step = [](const char* name, const std::string& when) {
    return std::string(R"({"step": ")") + name + R"(", "title": "t", "when": )" + when + "}";
  };
  Small s(exercise_of(step("all_unknown", R"({"all": [)" + yes + "," + unknown + "]}") + "," +
                      step("any_yes", R"({"any": [)" + unknown + "," + yes + "]}") + "," +
                      step("any_unknown", R"({"any": [)" + unknown + "," + no + "]}") + "," +
                      step("not_all_no", R"({"not": {"all": [)" + unknown + "," + no + "]}}")));
  s.a.seconds(1);
  EXPECT_FALSE(s.step("all_unknown").done);
  EXPECT_TRUE(s.step("any_yes").done);
  EXPECT_FALSE(s.step("any_unknown").done);
  EXPECT_TRUE(s.step("not_all_no").done) << "whatever the unknown one is";
}

TEST(Rules, AfterOrdersAndNeedsGates) {
  Small s(exercise_of(pulled("first") + "," + seen("then", R"("after": "previous")")));
  s.a.seconds(1);
  EXPECT_FALSE(s.step("then").done);
  EXPECT_EQ(s.a.monitor.current(), 0);
  s.pull(1.5);
  s.a.seconds(1);
  EXPECT_TRUE(s.step("then").done);

  const std::string late = R"("missed_when": {"fact": "attempt.time_s", "min": 1})";
  Small gated(exercise_of(pulled("first", late) + "," + seen("needs", R"("needs": ["first"])") + "," +
                          seen("after", R"("after": ["first"])")));
  gated.a.seconds(3);
  EXPECT_TRUE(gated.step("first").missed);
  EXPECT_TRUE(gated.step("needs").missed) << "what it needs cannot be done any more";
  EXPECT_TRUE(gated.step("after").done) << "what it comes after is over";
  EXPECT_TRUE(gated.a.monitor.finished());
}

TEST(Rules, AnOptionalStepDoesNotCountAgainstWhoLeavesIt) {
  Small s(exercise_of(seen("must") + "," + pulled("may", R"("optional": true)")));
  s.a.seconds(1);
  EXPECT_TRUE(s.a.monitor.finished());
  EXPECT_DOUBLE_EQ(s.a.monitor.score().quality, 1);
}

TEST(Rules, AnErrorOfAConditionIsMadeOnceAnExcursion) {
  const auto made = [](const std::string& per) {
    Small s(exercise_of(
        pulled("end", R"("missed_when": {"fact": "attempt.time_s", "min": 100}, "after": "other")") + "," +
            pulled("other", R"("for_s": 50)"),
        R"({"code": "X", "name": "x", "meaning": "m", "source": "ours", "points": 1, "for_s": 0.1, "when": )" + kPull +
            per + "}"));
    for (int i = 0; i < 3; ++i) {
      s.pull(3);
      s.a.seconds(0.05);
      s.pull(0.5);
      s.a.seconds(0.1);
      s.pull(3);
      s.a.seconds(0.5);
      s.pull(0.5);
      s.a.seconds(0.1);
    }
    return s.a.monitor.errors().size();
  };
  EXPECT_EQ(made(""), 3u) << "and not for less than its time";
  EXPECT_EQ(made(R"(, "once_per": "attempt")"), 1u);
}

TEST(Rules, AnErrorClosesTheStepsThatItMisses) {
  Small s(exercise_of(pulled("first") + "," + pulled("other"),
                      R"({"code": "X", "name": "x", "meaning": "m", "source": "ours", "points": 1,
                          "on": {"event": "clipped"}, "misses": ["first"]})"));
  s.a.clip(s.a.good_clip(two_sides::kCord, 0.02));
  EXPECT_TRUE(s.step("first").missed);
  EXPECT_FALSE(s.step("other").missed);
}

TEST(Rules, AStepForEachOfASetIsMadeForEveryElementOfIt) {
  const std::string step = R"({"step": "see", "for_each": "end", "title": "End {n} of {of}", "hint": "{name}",
                               "when": {"fact": "mark.in_view", "of": "$end"}})";
  Small s(exercise_of(step, "", R"("end": {"marks": "*.fimbria"})"));
  ASSERT_EQ(s.a.monitor.steps().size(), 2u);
  EXPECT_EQ(s.a.monitor.steps()[1].name, "End 2 of 2");
  EXPECT_EQ(s.a.monitor.steps()[1].hint, "tube_right.fimbria");
  s.a.look("tube_right.fimbria", false);
  s.a.seconds(1);
  EXPECT_TRUE(s.a.monitor.steps()[0].done);
  EXPECT_FALSE(s.a.monitor.steps()[1].done);
}

TEST(Rules, TheOrderOfASetIsTheSeeds) {
  const std::string step =
      R"({"step": "see", "for_each": "end", "title": "{name}", "when": {"fact": "mark.in_view", "of": "$end"}})";
  const Exercise e = exercise_of(step, "", R"("end": {"marks": "*.*", "order": "by_seed"})");
  const auto names = [&](std::uint64_t seed) {
    const Monitor m(e, two_sides::model(), Mode::assessed, seed);
    std::string all;
    for (const StepStatus& s : m.steps()) all += s.name + " ";
    return all;
  };
  EXPECT_EQ(names(7), names(7));
  EXPECT_NE(names(7), names(8));
}

TEST(Rules, StepsBeyondWhatIsShownAreAFault) {
  std::string steps;
  for (int i = 0; i <= kMaxSteps; ++i) steps += (i ? "," : "") + seen("step_" + std::to_string(i));
  try {
    exercise_of(steps);
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("at most 64 items for \"steps\""), std::string::npos) << bad.what();
  }
}

TEST(Rules, WhatTheSceneLacksIsAFaultAtItsPlace) {
  const Exercise e = exercise_of(R"({"step": "dry", "title": "Dry", "when": {"fact": "hand.active", "hand": ")" +
                                 two_sides::model().hands[0].name + R"("}})");
  sim::Model calm = two_sides::model();
  calm.energy.there = false;
  try {
    const Monitor m(e, calm);
    FAIL();
  } catch (const core::BadInput& bad) {
    ASSERT_EQ(bad.faults().size(), 1u);
    EXPECT_NE(bad.faults()[0].message.find("energy"), std::string::npos);
    EXPECT_GT(bad.faults()[0].at.line, 0);
  }
}

struct Hopeless {
  const char* name;
  const char* how;  ///< a step is done
  void (*change)(sim::Model& scene);
  const char* saying;
};
void PrintTo(const Hopeless& h, std::ostream* os) { *os << h.name; }

class AStepThat : public testing::TestWithParam<Hopeless> {};

TEST_P(AStepThat, TheSceneCanNeverMakeTrueIsAFaultAtItsPlace) {
  const Exercise e = exercise_of(std::string(R"({"step": "do", "title": "Do", )") + GetParam().how + "}");
  sim::Model model = two_sides::model();
  if (GetParam().change) GetParam().change(model);
  Faults faults;
  check_in_scene(e, model, faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find(GetParam().saying), std::string::npos) << faults[0].message;
  EXPECT_GT(faults[0].at.line, 0);
  EXPECT_GT(faults[0].at.column, 0);
}

void only_probes(sim::Model& scene) {
  for (sim::HandModel& hand : scene.hands)
    for (interactions::ToolModel& tool : hand.rack) tool.kind = interactions::ToolKind::probe;
}
void one_instrument_each(sim::Model& scene) {
  for (sim::HandModel& hand : scene.hands) hand.rack.resize(1);
}
void without_energy(sim::Model& scene) { scene.energy.there = false; }
void with_a_stripe(sim::Model& scene) {
  sim::MarkModel stripe;
  stripe.name = "stripe";
  stripe.at.body = BodyId::strand(0);
  scene.targets.push_back({sim::VisibilityTarget::mark, "stripe", std::int32_t(scene.marks.size()), 0, 0});
  scene.marks.push_back(stripe);
}
void with_a_drawn_fold(sim::Model& scene) { scene.drawn_folds.emplace_back().name = "veil"; }

INSTANTIATE_TEST_SUITE_P(
    Of, AStepThat,
    testing::Values(
        Hopeless{"GraspingWithoutJaws", R"("on": {"event": "grasped"})", only_probes, "an instrument that grips"},
        Hopeless{"LettingGoWithoutJaws", R"("on": {"event": "released"})", only_probes, "an instrument that grips"},
        Hopeless{"SlippingWithoutJaws", R"("on": {"event": "slipped"})", only_probes, "an instrument that grips"},
        Hopeless{"ExchangingWithoutAChoice", R"("on": {"event": "exchanged"})", one_instrument_each,
                 "a rack of several"},
        Hopeless{"PartingWithoutEnergy", R"("on": {"event": "parted"})", without_energy, "scene with energy"},
        Hopeless{"PartingWithoutAnElectrode", R"("on": {"event": "parted"})", nullptr, "an electrode"},
        Hopeless{"AnInstrumentThatIsNotInTheRack", R"("when": {"fact": "hand.has", "hand": "a", "kind": "hook"})",
                 nullptr, "the rack at the trocar \"a\" holds"},
        Hopeless{"ClipsOfAHandWithoutAnApplier", R"("when": {"fact": "hand.clips_left", "hand": "a", "min": 1})",
                 nullptr, "a hand with a clip applier"},
        Hopeless{"AStripeThatFacesSomewhere", R"("when": {"fact": "mark.facing_deg", "of": "stripe", "max": 20})",
                 with_a_stripe, "\"stripe\", which has no single normal"},
        Hopeless{"ATubeThatFacesSomewhere",
                 R"("when": {"fact": "mark.facing_deg", "of": "tube_left.fimbria", "max": 20})", nullptr,
                 "no single normal"},
        Hopeless{"APairOfClipsWithoutAnApplier",
                 R"("when": {"fact": "clips.first_set", "of": "tube_left", "first_mm": [12, 20], "second_mm": [18, 30],
                             "apart_mm": [6, 12], "stretch_mm": [10, 30], "angle_deg": 15, "cover": 0.9, "closing_s": 1})",
                 only_probes, "a clip applier"},
        Hopeless{"StumpsOfAStrandWithoutLandmarks",
                 R"("when": {"fact": "strand.stumps_in_view", "of": "cord", "cover": 0.9})", nullptr,
                 "a strand with landmarks"},
        Hopeless{"AnEventOnAFoldThatIsDrawnOnly", R"("on": {"event": "clipped", "on": "veil"})", with_a_drawn_fold,
                 "got one on no body"},
        Hopeless{"AnEventOnNobody", R"("on": {"event": "clipped", "on": []})", nullptr, "got one on no body"}),
    [](const auto& of) { return of.param.name; });

/// The first fault of these steps; empty: there is none.
std::string fault_of(const std::string& steps) {
  try {
    exercise_of(steps);
  } catch (const core::BadInput& bad) {
    EXPECT_GT(bad.faults()[0].at.line, 0);
    EXPECT_EQ(bad.faults().size(), 1u);
    return bad.faults()[0].message;
  }
  return {};
}
std::string step_when(const char* name, const std::string& when) {
  return std::string(R"({"step": ")") + name + R"(", "title": "t", "when": )" + when + "}";
}

TEST(Rules, StepsThatWaitForEachOtherAreAFault) {
  const std::string late = R"({"fact": "attempt.time_s", "min": 1})";
  const std::string circle = R"("a" waits for "b", and "b" waits for "a")";
  const auto both = [](const std::string& a, const std::string& b) {
    return fault_of(step_when("a", a) + "," + step_when("b", b));
  };
  const std::string of_a = R"({"step": "a"})", of_b = R"({"step": "b"})";
  EXPECT_NE(both(of_b, of_a).find(circle), std::string::npos) << both(of_b, of_a);
  EXPECT_NE(both(R"({"all": [)" + late + "," + of_b + "]}", of_a).find(circle), std::string::npos);
  EXPECT_NE(fault_of(step_when("a", of_b) + "," + pulled("b", R"("after": "a")")).find(circle), std::string::npos);
  EXPECT_NE(both(of_a, late).find(R"("a" waits for itself)"), std::string::npos);
  const std::string clip = R"({"step": "a", "title": "t", "on": {"event": "clipped", "while": {"step": "a"}}})";
  EXPECT_NE(fault_of(clip).find(R"("a" waits for itself)"), std::string::npos);
}

TEST(Rules, StepsThatCanBeDoneOtherwiseAreNoCircle) {
  const std::string late = R"({"fact": "attempt.time_s", "min": 1})";
  for (const char* other : {R"({"any": [{"step": "b"}, {"fact": "attempt.time_s", "min": 1}]})",
                            R"({"not": {"step": "b"}})", R"({"step": "b", "is": "open"})"})
    EXPECT_EQ(fault_of(step_when("a", other) + "," + step_when("b", R"({"step": "a"})")), "") << other;
}

TEST(Rules, ASetThatRefersToItselfIsAFault) {
  Faults faults;
  read_exercise(kChanged, faults,
                files_with(changed_text(text_of_scene_file("gynaecology/sterilisation.json"),
                                        {{"\"ovary_right\", \"mesosalpinx_left\"", "\"$delicate\""}})));
  EXPECT_FALSE(faults.empty());
}

TEST(Rules, EqualFactsAreWatchedOnce) {
  Small s(exercise_of(seen("a") + "," + seen("b") + "," + pulled("c")));
  EXPECT_EQ(s.a.monitor.rules().facts().all().size(), 2u);
}

TEST(Rules, JudgingDoesNotAllocateWhileNothingHappens) {
  two_sides::Attempt a;
  a.hold_tube(two_sides::kLeft, 0.055, 0.1);
  a.seconds(1);
  const long before = g_allocations;
  a.seconds(1);
  EXPECT_EQ(g_allocations - before, 0);
}

}  // namespace
