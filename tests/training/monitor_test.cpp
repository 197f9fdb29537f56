// What the monitor makes of a State: steps, in whichever order they come, and the score with its components. The State
// is written by hand; what the step makes of hands is tested elsewhere, and errors have their own file.
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/training/observe/hands.hpp>

#include "two_sides.hpp"

using namespace trocar;
using namespace trocar::training;
using two_sides::Attempt;
using two_sides::exercise;
using two_sides::kLeft;
using two_sides::kRight;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Monitor, APerfectAttemptEarnsAllPointsAndHasNoError) {
  Attempt a;
  EXPECT_EQ(a.monitor.steps().size(), 14u);
  EXPECT_EQ(a.monitor.current(), 0);
  a.all();
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_EQ(a.codes(), std::vector<std::string>{});
  EXPECT_EQ(a.monitor.current(), 14);
  const Score score = a.monitor.score();
  EXPECT_DOUBLE_EQ(score.total, 100);
  EXPECT_TRUE(score.passed);
  EXPECT_FALSE(score.failed);
}

TEST(Monitor, EitherSideMayComeFirst) {
  Attempt a;
  a.survey();
  a.identify();
  a.one_side(kRight);
  EXPECT_EQ(a.monitor.steps()[size_t(a.monitor.current())].side, "left");
  a.one_side(kLeft);
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_DOUBLE_EQ(a.monitor.score().total, 100);
}

TEST(Monitor, TheGuideStaysOnTheSideThatIsWorkedOn) {
  Attempt a;
  a.survey();
  a.identify();
  a.present(kRight);
  const StepStatus& next = a.monitor.steps()[size_t(a.monitor.current())];
  EXPECT_EQ(next.side, "right");
  EXPECT_EQ(next.task, "first_clip");
}

TEST(Monitor, TheSurveyNeedsEveryOrganForASecondEachButNotAtOnce) {
  for (const char* hidden : {"organ", "pad", "tube_left.trace", "tube_right.trace"}) {
    Attempt a;
    a.look(hidden, false);
    a.seconds(3);
    EXPECT_FALSE(a.done("survey")) << hidden;
    a.look_away();
    a.look(hidden, true);
    a.seconds(0.9);
    EXPECT_FALSE(a.done("survey")) << hidden;
    a.seconds(0.2);
    EXPECT_TRUE(a.done("survey")) << hidden;
  }
}

TEST(Monitor, AGlanceIsNoSurvey) {
  Attempt a;
  for (int i = 0; i < 5; ++i) {
    a.look("pad", true);
    a.seconds(0.8);
    a.look("pad", false);
    a.seconds(0.1);
  }
  EXPECT_FALSE(a.done("survey"));
}

TEST(Monitor, IdentifyingBeginsAtTheFimbriaeAndTakesTheTimeOfALook) {
  Attempt a;
  a.look("tube_left.fimbria", false);
  a.seconds(5);
  EXPECT_FALSE(a.done("identify")) << "all of the tube in view, but not its end";
  a.look("tube_left.fimbria", true);
  a.seconds(1.5);
  EXPECT_FALSE(a.done("identify")) << "60 mm at 30 mm/s";
  a.seconds(1);
  EXPECT_TRUE(a.done("identify"));
  EXPECT_TRUE(a.done("identify", "right"));
}

TEST(Monitor, LostForASecondTheTubeIsFollowedFromTheFimbriaeAgain) {
  Attempt a;
  a.seconds(1.5);
  a.look("tube_left", false);
  a.seconds(1.2);
  a.look("tube_left.trace", true);
  a.seconds(3);
  EXPECT_FALSE(a.done("identify")) << "the fimbriae have not been seen again";
  a.look("tube_left.fimbria", true);
  a.seconds(3);
  EXPECT_TRUE(a.done("identify"));
}

TEST(Monitor, WhatIsCoveredAnInstrumentsTipCanFollow) {
  Attempt a;
  const auto& body = a.model.strand_bodies[kLeft];
  a.look("tube_left.trace", false);
  a.look("tube_left.fimbria", true);
  const auto lay_tip = [&](double s) {
    const Vec3d at = interactions::point_at(body, a.state.strands[kLeft], interactions::place_at(body, s));
    const kinematics::FulcrumPose p = kinematics::inverse(a.model.hands[0].port, at + Vec3d{0, 0, 0.006}, 0);
    interactions::ToolState& t = a.state.tools[0];
    t.yaw = p.yaw;
    t.pitch = p.pitch;
    t.depth = p.depth;
  };
  for (int i = 0; i <= 3500; ++i) {
    lay_tip(0.085 - 0.020e-3 * i);
    a.tick();
  }
  EXPECT_TRUE(a.done("identify"));
}

TEST(Monitor, PresentingNeedsTheGrasperOnTheAmpulla) {
  Attempt a;
  a.hold_tube(kLeft, 0.010, 1.0);  // the isthmus
  a.seconds(1);
  EXPECT_FALSE(a.done("present"));
  a.hold_tube(two_sides::kCord, 0.05, 1.0);
  a.seconds(1);
  EXPECT_FALSE(a.done("present"));
  a.hold_tube(kLeft, 0.055, 1.0);
  a.seconds(1);
  EXPECT_TRUE(a.done("present"));
  EXPECT_FALSE(a.done("present", "right"));
}

TEST(Monitor, PresentingNeedsAPullWithinItsRangeForItsTime) {
  Attempt a;
  a.hold_tube(kLeft, 0.055, 0.1);
  a.seconds(1);
  EXPECT_FALSE(a.done("present")) << "too weak";
  a.hold_tube(kLeft, 0.055, 3.0);
  a.seconds(1);
  EXPECT_FALSE(a.done("present")) << "too strong";
  for (int i = 0; i < 10; ++i) {  // in range, but never for 0.2 s
    a.hold_tube(kLeft, 0.055, 1.0);
    a.seconds(0.15);
    a.hold_tube(kLeft, 0.055, 0.1);
    a.seconds(0.05);
  }
  EXPECT_FALSE(a.done("present")) << "too short";
  a.hold_tube(kLeft, 0.055, 1.0);
  a.seconds(0.25);
  EXPECT_TRUE(a.done("present"));
}

TEST(Monitor, PresentingNeedsAStraightIsthmus) {
  Attempt a;
  tissue::StrandState& tube = a.state.strands[kLeft];
  const std::vector<Vec3d> straight = tube.x;
  for (size_t n = 0; n < tube.x.size(); ++n)
    tube.x[n].z = 0.012 * (n % 6 < 3 ? double(n % 3) : 3.0 - double(n % 3)) / 3;
  a.hold_tube(kLeft, 0.055, 1.0);
  a.seconds(1);
  EXPECT_LT(straightness_of(a.model, a.state, kLeft, 0.025), 0.9);
  EXPECT_FALSE(a.done("present"));
  tube.x = straight;
  a.seconds(1);
  EXPECT_NEAR(straightness_of(a.model, a.state, kLeft, 0.025), 1.0, 1e-6);
  EXPECT_TRUE(a.done("present"));
}

TEST(Monitor, TheOuterClipMayComeFirst) {
  for (double inner : {0.0135, 0.016, 0.019}) {
    Attempt a;
    a.up_to_clips(kLeft);
    a.clip(a.good_clip(kLeft, 0.0255));
    EXPECT_FALSE(a.done("first_clip"));
    EXPECT_TRUE(a.done("second_clip"));
    a.clip(a.good_clip(kLeft, inner));
    EXPECT_TRUE(a.done("first_clip")) << inner;
    EXPECT_EQ(a.codes(), std::vector<std::string>{});
  }
}

TEST(Monitor, AClipThatFitsBothPlacesIsTheInnerOrTheOuterOneByWhatFollows) {
  Attempt a, b;
  for (Attempt* x : {&a, &b}) {
    x->up_to_clips(kLeft);
    x->clip(x->good_clip(kLeft, 0.019));
  }
  a.clip(a.good_clip(kLeft, 0.027));
  b.clip(b.good_clip(kLeft, 0.0125));
  for (Attempt* x : {&a, &b}) {
    EXPECT_TRUE(x->done("first_clip"));
    EXPECT_TRUE(x->done("second_clip"));
    EXPECT_EQ(x->codes(), std::vector<std::string>{});
  }
}

TEST(Monitor, AClipThatIsNotGoodEnoughIsNotAStep) {
  const std::function<void(interactions::Clip&)> spoilers[] = {
      [](interactions::Clip& c) { c.cover = 0.9; },      [](interactions::Clip& c) { c.theta = 16 * kDegree; },
      [](interactions::Clip& c) { c.tips_visible = 1; }, [](interactions::Clip& c) { c.closing_time = 0.9; },
      [](interactions::Clip& c) { c.s = 0.011; },        [](interactions::Clip& c) { c.s = 0.0305; },
      [](interactions::Clip& c) { c.strand = -1; },      [](interactions::Clip& c) { c.strand = two_sides::kCord; }};
  for (const auto& spoil : spoilers) {
    Attempt a;
    a.up_to_clips(kLeft);
    interactions::Clip c = a.good_clip(kLeft, 0.016);
    spoil(c);
    a.clip(c);
    EXPECT_FALSE(a.done("first_clip"));
    EXPECT_EQ(a.codes().size(), 1u) << "and it is told why";
    a.clip(a.good_clip(kLeft, 0.016));
    EXPECT_TRUE(a.done("first_clip")) << "another good one makes it";
  }
}

TEST(Monitor, ACutThatIsNotGoodEnoughIsNotAStep) {
  const std::function<void(interactions::Cut&)> spoilers[] = {
      [](interactions::Cut& c) { c.fraction = 0.9; }, [](interactions::Cut& c) { c.beyond = 0.006; },
      [](interactions::Cut& c) { c.s = 0.017; }, [](interactions::Cut& c) { c.strand = two_sides::kCord; }};
  for (const auto& spoil : spoilers) {
    Attempt a;
    a.up_to_clips(kLeft);
    a.both_clips(kLeft);
    interactions::Cut c = a.good_cut(kLeft);
    spoil(c);
    a.cut(c);
    EXPECT_FALSE(a.done("cut"));
    EXPECT_EQ(a.codes().size(), 1u);
  }
}

TEST(Monitor, WhatACutMadeImpossibleIsMissedAndTheAttemptCanStillEnd) {
  Attempt a;
  a.up_to_clips(kLeft);
  a.clip(a.good_clip(kLeft, 0.016));
  a.cut(a.good_cut(kLeft, 0.022));
  const auto status = [&a](const char* task) {
    for (const StepStatus& s : a.monitor.steps())
      if (s.task == task && s.side == "left") return s;
    return StepStatus{};
  };
  EXPECT_TRUE(status("second_clip").missed);
  EXPECT_TRUE(status("cut").missed);
  EXPECT_TRUE(status("first_clip").done);
  a.seconds(3);
  EXPECT_FALSE(a.done("check")) << "the outer stump is open";
  a.clip(a.good_clip(kLeft, 0.026));
  a.let_go();
  a.seconds(2.1);
  EXPECT_TRUE(a.done("check")) << "closed with a clip of its own";
  a.one_side(kRight);
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_LT(a.monitor.score().quality, 1);
}

TEST(Monitor, TheCheckNeedsBothStumpsInViewAndClosed) {
  Attempt a;
  a.up_to_clips(kLeft);
  a.both_clips(kLeft);
  a.cut(a.good_cut(kLeft));
  a.look("tube_left.trace", false);
  a.seconds(3);
  EXPECT_FALSE(a.done("check"));
  a.look("tube_left.trace", true);
  a.seconds(1.9);
  EXPECT_FALSE(a.done("check"));
  a.seconds(0.2);
  EXPECT_TRUE(a.done("check"));
}

TEST(Monitor, TheCheckWaitsUntilNothingBleeds) {
  Attempt a;
  a.up_to_clips(kLeft);
  a.both_clips(kLeft);
  a.cut(a.good_cut(kLeft));
  a.bleed(0.1, 5);
  EXPECT_FALSE(a.done("check")) << "6 mL/min";
  a.seconds(2.8);  // a rate is that of a second
  EXPECT_FALSE(a.done("check"));
  a.seconds(0.5);
  EXPECT_TRUE(a.done("check"));
}

TEST(Monitor, ItEndsWhenWhatHasRunOutIsSuckedOff) {
  Attempt a;
  a.survey();
  a.identify();
  a.one_side(kLeft);
  EXPECT_FALSE(a.done("clear")) << "last of all";
  a.one_side(kRight, [](Attempt& at) { at.bleed(12, 1); });
  a.seconds(2);
  EXPECT_TRUE(a.done("check", "right"));
  EXPECT_FALSE(a.monitor.finished()) << "12 mL";
  move(a.state.fluids.ledger, fluids::Place::kPool, fluids::Place::kSucked,
       at(a.state.fluids.ledger, fluids::Place::kPool));
  a.seconds(0.1);
  EXPECT_TRUE(a.monitor.finished());
}

TEST(Monitor, ATubeIsOccludedByAWholeClipOrACutAndByNothingLess) {
  Attempt open;
  interactions::Clip partial = open.good_clip(kLeft, 0.016);
  partial.cover = 0.9;
  open.clip(partial);
  open.seconds(0.1);
  EXPECT_EQ(open.detail("left", "occluded"), false);
  open.clip(open.good_clip(kLeft, 0.025));
  open.seconds(0.1);
  EXPECT_EQ(open.detail("left", "occluded"), true);
  EXPECT_EQ(open.detail("right", "occluded"), false);

  Attempt severed;
  severed.cut(severed.good_cut(kRight));
  severed.seconds(0.1);
  EXPECT_EQ(severed.detail("right", "occluded"), true);
}

TEST(Monitor, TimeCountsFromTheFirstMotionToTheEnd) {
  Attempt a;
  a.seconds(30);
  EXPECT_EQ(a.monitor.seconds(), 0);
  a.all();
  const double end = a.monitor.seconds();
  EXPECT_GT(end, 5);
  a.seconds(10);
  EXPECT_EQ(a.monitor.seconds(), end);
}

TEST(Monitor, WhatComesAfterTheLastStepIsJudgedNoMore) {
  Attempt a;
  a.all();
  const double seconds = a.monitor.seconds();
  interactions::Clip late = a.good_clip(kLeft, 0.05);
  late.tips_visible = 0;
  a.clip(late);
  a.event(sim::Event::of_hand(sim::Event::slipped, 0));
  a.seconds(1);
  EXPECT_EQ(a.codes(), std::vector<std::string>{});
  EXPECT_DOUBLE_EQ(a.monitor.score().total, 100);
  EXPECT_DOUBLE_EQ(a.monitor.seconds(), seconds);
}

TEST(Monitor, AClipBesideTheCutInTheSameElementStillClosesItsStump) {
  // The closest that a good cut may come to a clip: both within one element of the strand.
  for (const bool outer : {false, true}) {
    Attempt a;
    a.survey();
    a.identify();
    a.present(kLeft);
    const interactions::StrandBody& tube = a.model.strand_bodies[size_t(kLeft)];
    double cut = 0;
    for (double s = 0.0185; s < 0.0225; s += 0.0001) {
      const double clip = s + (outer ? 0.0021 : -0.0021);
      if (interactions::place_at(tube, s).element == interactions::place_at(tube, clip).element) cut = s;
    }
    if (cut == 0) GTEST_FAIL() << "no element is as long as the margin between clip and cut";
    a.clip(a.good_clip(kLeft, outer ? cut - 0.0055 : cut - 0.0021));
    a.clip(a.good_clip(kLeft, outer ? cut + 0.0021 : cut + 0.0055));
    a.cut(a.good_cut(kLeft, cut));
    a.look("tube_left", true);
    a.seconds(1.5);
    EXPECT_EQ(a.detail("left", "stumps_closed"), true)
        << (outer ? "outer" : "inner") << " clip beside the cut at " << cut;
  }
}

TEST(Monitor, TheDistanceOfTheClipsIsThatOfThePairThatCounts) {
  Attempt a;
  a.survey();
  a.identify();
  a.present(kLeft);
  for (const double s : {0.014, 0.019, 0.027}) a.clip(a.good_clip(kLeft, s));
  a.seconds(0.1);
  EXPECT_NEAR(double(a.detail("left", "clip_distance_mm")), 8, 1e-9);
  const nlohmann::json clips = a.detail("left", "clipped");
  EXPECT_TRUE(bool(clips[0]["good"]));
  EXPECT_FALSE(bool(clips[1]["good"])) << "too near to the first: A1.9";
  EXPECT_TRUE(bool(clips[2]["good"]));
}

TEST(Score, TimeEarnsInProportionBetweenExpertAndLongest) {
  Attempt a;
  a.survey();
  a.identify();
  a.one_side(kLeft);
  a.seconds(570 - a.monitor.seconds() - 2.4);
  a.one_side(kRight);
  const Score s = a.monitor.score();
  EXPECT_NEAR(s.time, (900.0 - 570.0) / (900 - 240), 1e-3);
  EXPECT_NEAR(s.total, (60 + 25 * s.time) * 100 / 85, 1e-9);
}

TEST(Score, AnUnfinishedAttemptEarnsItsStepsByTheirWeightAndNoTime) {
  Attempt a;
  a.up_to_clips(kLeft);
  const auto weight = [](const char* step) { return exercise().step(step)->weight; };
  double whole = 0;
  for (const StepText& t : exercise().steps) whole += (t.for_each.empty() ? 1 : 2) * t.weight;
  const double done = weight("survey") + 2 * weight("identify") + weight("present");
  const Score s = a.monitor.score();
  EXPECT_DOUBLE_EQ(s.quality, done / whole);
  EXPECT_DOUBLE_EQ(s.time, 0);
  EXPECT_NEAR(s.total, 60 * s.quality * 100 / 85, 1e-9);
  EXPECT_FALSE(s.passed);
}

TEST(Score, PenaltiesAddUpAndCannotMakeItNegative) {
  const auto after_slips = [](int slips) {
    Attempt a;
    for (int i = 0; i < slips; ++i) a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper));
    a.all();
    return a.monitor.score();
  };
  EXPECT_DOUBLE_EQ(after_slips(3).total, 97);
  EXPECT_DOUBLE_EQ(after_slips(200).total, 0);
  EXPECT_FALSE(after_slips(200).passed);
}

TEST(Score, AnErrorThatFailsFailsWhateverThePoints) {
  Attempt a;
  a.survey();
  a.identify();
  a.clip(a.good_clip(two_sides::kCord, 0.016));
  a.one_side(kLeft);
  a.one_side(kRight);
  const Score s = a.monitor.score();
  EXPECT_DOUBLE_EQ(s.total, 100);
  EXPECT_TRUE(s.failed);
  EXPECT_FALSE(s.passed);
}

TEST(Score, FamiliarisationTellsStepsAndErrorsAndScoresNothing) {
  Attempt a(Mode::familiarisation);
  a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper));
  a.all();
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_EQ(a.codes(), std::vector<std::string>{"E3"});
  EXPECT_FALSE(a.monitor.score().passed);
  const nlohmann::json j = nlohmann::json::parse(a.monitor.result_json());
  EXPECT_EQ(j["mode"], "familiarisation");
  EXPECT_TRUE(j["passed"].is_null());
  EXPECT_FALSE(j["score"].contains("total"));
}

TEST(Monitor, ResultIsJsonThatSaysTheSame) {
  Attempt a;
  a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper));
  a.all();
  const nlohmann::json j = nlohmann::json::parse(a.monitor.result_json());
  EXPECT_EQ(j["exercise"], "sterilisation");
  EXPECT_EQ(j["finished"], true);
  EXPECT_EQ(j["passed"], true);
  EXPECT_DOUBLE_EQ(j["score"]["total"].get<double>(), a.monitor.score().total);
  EXPECT_TRUE(j["score"]["motion"].is_null());
  EXPECT_DOUBLE_EQ(j["exercise_seconds"].get<double>(), a.monitor.seconds());
  ASSERT_EQ(j["steps"].size(), 14u);
  for (const auto& step : j["steps"]) EXPECT_EQ(step["done"], true);
  ASSERT_EQ(j["errors"].size(), 1u);
  EXPECT_EQ(j["errors"][0]["code"], "E3");
  EXPECT_EQ(j["errors"][0]["place_mm"].size(), 3u);
  EXPECT_NEAR(double(a.detail("left", "clip_distance_mm")), 9, 1e-9);
  EXPECT_EQ(a.detail("left", "cut").size(), 1u);
  EXPECT_EQ(a.detail("right", "stumps_closed"), true);
  EXPECT_EQ(j["thresholds"].size(), exercise().limits.size());
  EXPECT_DOUBLE_EQ(j["thresholds"]["clip_angle_deg"]["value"].get<double>(), 15);
  EXPECT_EQ(j["tools"].size(), a.model.hands.size());
  EXPECT_DOUBLE_EQ(j["tools"][0]["max_pull_N"].get<double>(), 1.0);
}

TEST(Monitor, SaysAllThatTheSceneLacks) {
  const Exercise e = two_sides::exercise_with({{"\"tube\": \"tube_left\"", "\"tube\": \"no such tube\""},
                                               {"\"ovary\": \"pad\"", "\"ovary\": \"no such ovary\""},
                                               {"\"mesosalpinx\": []", "\"mesosalpinx\": \"no such fold\""},
                                               {"\"to\": \"isthmus\"", "\"to\": \"no such landmark\""}});
  try {
    const Monitor monitor(e, two_sides::model());
    FAIL() << "took a scene without its tube";
  } catch (const core::BadInput& bad) {
    std::string all;
    for (const core::Fault& f : bad.faults()) all += to_string(f) + "\n";
    for (const char* missing : {"no such tube", "no such ovary", "no such fold", "no such landmark"})
      EXPECT_NE(all.find(missing), std::string::npos) << missing << "\n" << all;
    EXPECT_NE(all.find("exercise.json:"), std::string::npos);
  }
}

}  // namespace
