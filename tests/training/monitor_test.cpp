// Which records of an attempt make which step, error and score. The records are written by hand: what the step makes
// of hands is tested elsewhere.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/training/monitor.hpp>

#include "../sim/small_scene.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

/// The shipped exercise's thresholds and penalties, on the small scene's tube.
const Exercise& exercise() {
  static const Exercise made = [] {
    Exercise e = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
    e.goal.tube = "tube";
    return e;
  }();
  return made;
}

/// An attempt whose State is made up as it goes.
struct Attempt {
  const sim::Model& model = small::model();
  sim::State state = sim::initial_state(model);
  Monitor monitor{exercise(), model};

  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick({});
  }
  void tick(const sim::StepReport& report) {
    ++state.tick;
    monitor.update(model, state, report);
  }
  void event(sim::Event::Kind kind, int tool, int index) {
    sim::StepReport report;
    report.events[0] = {kind, tool, index};
    report.event_count = 1;
    tick(report);
  }
  void seconds(double s) { ticks(int(s * 1000)); }
  void move_a_tool() { state.tools[small::kGrasper].depth += 0.002; }

  void hold(double s, double pull) {
    interactions::ToolState& grasper = state.tools[small::kGrasper];
    grasper.holds = 1;
    grasper.hold[0].body = small::kTube;
    grasper.hold[0].element = interactions::place_at(model.bodies[small::kTube], s).element;
    grasper.pull[2] = pull;
  }
  void present() {
    move_a_tool();
    hold(0.055, 1.0);
    seconds(0.3);
  }
  interactions::Clip good_clip(double s) const {
    interactions::Clip c;
    c.s = s;
    c.cover = 1;
    c.closing_time = 2;
    c.tips_visible = 2;
    c.strand = small::kTube;
    c.tool = small::kApplier;
    return c;
  }
  void clip(const interactions::Clip& c) {
    state.clips[size_t(state.clip_count++)] = c;
    event(c.strand < 0 ? sim::Event::dropped_clip : sim::Event::clipped, small::kApplier, state.clip_count - 1);
  }
  interactions::Cut good_cut(double s) const {
    interactions::Cut c;
    c.s = s;
    c.fraction = 1;
    c.beyond = 0.001;
    c.tips_visible = 1;
    c.strand = small::kTube;
    c.tool = small::kScissors;
    return c;
  }
  void cut(const interactions::Cut& c) {
    if (c.strand >= 0 && c.fraction >= 0.99) {
      const interactions::StrandPlace place = interactions::place_at(model.bodies[size_t(c.strand)], c.s);
      tissue::cut_element(state.strands[size_t(c.strand)], place.element);
    }
    state.cuts[size_t(state.cut_count++)] = c;
    event(sim::Event::cut, small::kScissors, state.cut_count - 1);
  }
  void both_clips() {
    clip(good_clip(0.016));
    clip(good_clip(0.025));
  }
  void all() {
    present();
    both_clips();
    cut(good_cut(0.0205));
  }
};

TEST(Monitor, APerfectAttemptEarnsAllPointsAndHasNoError) {
  Attempt a;
  EXPECT_EQ(a.monitor.current(), 0);
  a.present();
  EXPECT_EQ(a.monitor.current(), 1);
  a.clip(a.good_clip(0.016));
  EXPECT_EQ(a.monitor.current(), 2);
  a.clip(a.good_clip(0.025));
  EXPECT_EQ(a.monitor.current(), 3);
  EXPECT_FALSE(a.monitor.finished());
  a.cut(a.good_cut(0.0205));
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.errors().empty());
  const Score score = a.monitor.score();
  EXPECT_DOUBLE_EQ(score.total, 100);
  EXPECT_TRUE(score.passed);
  EXPECT_FALSE(score.failed);
}

TEST(Monitor, PresentingNeedsTheGrasperOnTheAmpulla) {
  Attempt a;
  a.hold(0.010, 1.0);  // the isthmus
  a.seconds(1);
  EXPECT_EQ(a.monitor.current(), 0);
  a.state.tools[small::kGrasper].hold[0].body = small::kCord;
  a.seconds(1);
  EXPECT_EQ(a.monitor.current(), 0);
  a.hold(0.055, 1.0);
  a.seconds(1);
  EXPECT_EQ(a.monitor.current(), 1);
}

TEST(Monitor, PresentingNeedsAPullWithinItsRangeForItsTime) {
  Attempt a;
  a.hold(0.055, 0.1);
  a.seconds(1);
  EXPECT_EQ(a.monitor.current(), 0) << "too weak";
  a.hold(0.055, 3.0);
  a.seconds(1);
  EXPECT_EQ(a.monitor.current(), 0) << "too strong";
  for (int i = 0; i < 10; ++i) {  // in range, but never for 0.2 s
    a.hold(0.055, 1.0);
    a.ticks(150);
    a.hold(0.055, 0.1);
    a.ticks(10);
  }
  EXPECT_EQ(a.monitor.current(), 0) << "too short";
  a.hold(0.055, 1.0);
  a.ticks(210);
  EXPECT_EQ(a.monitor.current(), 1);
}

TEST(Monitor, PresentingNeedsAStraightIsthmus) {
  Attempt a;
  tissue::StrandState& tube = a.state.strands[small::kTube];
  const std::vector<Vec3d> straight = tube.x;
  for (size_t n = 0; n < tube.x.size(); ++n)
    tube.x[n].z = 0.012 * (n % 6 < 3 ? double(n % 3) : 3.0 - double(n % 3)) / 3;
  a.hold(0.055, 1.0);
  a.seconds(1);
  EXPECT_LT(a.monitor.isthmus_straightness(), 0.9);
  EXPECT_EQ(a.monitor.current(), 0);
  tube.x = straight;
  a.seconds(1);
  EXPECT_NEAR(a.monitor.isthmus_straightness(), 1.0, 1e-6);
  EXPECT_EQ(a.monitor.current(), 1);
}

struct Mistake {
  const char* code;
  std::function<void(Attempt&)> make;
};
void PrintTo(const Mistake& m, std::ostream* os) { *os << m.code; }

class MonitorError : public testing::TestWithParam<Mistake> {};

TEST_P(MonitorError, IsMadeOnceByItsCauseAndCostsWhatTheExerciseSays) {
  Attempt a;
  GetParam().make(a);
  ASSERT_EQ(a.monitor.errors().size(), 1u);
  const ErrorMade& e = a.monitor.errors()[0];
  EXPECT_EQ(e.code, GetParam().code);
  const Penalty* p = exercise().penalty(e.code);
  ASSERT_NE(p, nullptr) << "the exercise prices it";
  EXPECT_EQ(e.points, p->points);
  EXPECT_EQ(e.fail, p->fail);
  EXPECT_EQ(e.meaning, p->meaning);
  EXPECT_EQ(a.monitor.score().penalties, p->points);
  EXPECT_EQ(a.monitor.score().failed, p->fail);
}

constexpr double kDegree = 3.14159265358979323846 / 180;

Mistake clip_mistake(const char* code, void (*spoil)(interactions::Clip&)) {
  return {code, [spoil](Attempt& a) {
            interactions::Clip c = a.good_clip(0.016);
            spoil(c);
            a.clip(c);
          }};
}

const Mistake kMistakes[] = {
    {"E1",
     [](Attempt& a) {
       a.hold(0.055, 4.5);
       a.seconds(1);
     }},
    {"E3", [](Attempt& a) { a.event(sim::Event::slipped, small::kGrasper, -1); }},
    clip_mistake("E4", [](interactions::Clip& c) { c.tips_visible = 1; }),
    {"E4",
     [](Attempt& a) {
       a.both_clips();
       interactions::Cut c = a.good_cut(0.0205);
       c.tips_visible = 0;
       a.cut(c);
     }},
    clip_mistake("E11", [](interactions::Clip& c) { c.strand = small::kCord; }),
    {"E11",
     [](Attempt& a) {
       interactions::Cut c = a.good_cut(0.02);
       c.strand = small::kCord;
       a.cut(c);
     }},
    {"E11",
     [](Attempt& a) {  // into an organ
       interactions::Cut c = a.good_cut(0);
       c.strand = -1;
       c.solid = 0;
       a.cut(c);
     }},
    clip_mistake("E12", [](interactions::Clip& c) { c.strand = -1; }),
    clip_mistake("A1.ampulla", [](interactions::Clip& c) { c.s = 0.031; }),
    clip_mistake("A1.cornu", [](interactions::Clip& c) { c.s = 0.009; }),
    clip_mistake("A1.cover", [](interactions::Clip& c) { c.cover = 0.9; }),
    clip_mistake("A1.angle", [](interactions::Clip& c) { c.theta = 20 * kDegree; }),
    clip_mistake("A1.oblique", [](interactions::Clip& c) { c.theta = 31 * kDegree; }),
    {"A1.outside",
     [](Attempt& a) {
       a.both_clips();
       a.cut(a.good_cut(0.030));
     }},
    {"A1.outside",
     [](Attempt& a) {
       a.both_clips();
       a.cut(a.good_cut(0.0175));  // between, but 1.5 mm from the first
     }},
    {"A1.outside", [](Attempt& a) { a.cut(a.good_cut(0.0205)); }},
};
INSTANTIATE_TEST_SUITE_P(Codes, MonitorError, testing::ValuesIn(kMistakes));

TEST(Monitor, EveryCodeThatTheExercisePricesCanBeMade) {
  for (const Penalty& p : exercise().penalties)
    EXPECT_TRUE(std::any_of(std::begin(kMistakes), std::end(kMistakes), [&p](const Mistake& m) {
      return m.code == p.code;
    })) << p.code;
}

TEST(Monitor, EachExcursionOfForceCountsOnce) {
  Attempt a;
  a.hold(0.055, 4.5);
  a.ticks(90);
  EXPECT_TRUE(a.monitor.errors().empty()) << "a jerk of less than 0.1 s";
  a.hold(0.055, 3.9);
  a.ticks(10);
  for (int excursion = 1; excursion <= 3; ++excursion) {
    a.hold(0.055, 4.5);
    a.seconds(0.5);
    a.hold(0.055, 1.0);
    a.seconds(0.1);
    EXPECT_EQ(a.monitor.errors().size(), size_t(excursion));
  }
}

TEST(Monitor, AClipThatIsNotGoodEnoughIsNotAStep) {
  const std::function<void(interactions::Clip&)> spoilers[] = {
      [](interactions::Clip& c) { c.cover = 0.9; },      [](interactions::Clip& c) { c.theta = 16 * kDegree; },
      [](interactions::Clip& c) { c.tips_visible = 1; }, [](interactions::Clip& c) { c.closing_time = 0.9; },
      [](interactions::Clip& c) { c.s = 0.011; },        [](interactions::Clip& c) { c.s = 0.0205; },
      [](interactions::Clip& c) { c.strand = -1; },      [](interactions::Clip& c) { c.strand = small::kCord; }};
  for (const auto& spoil : spoilers) {
    Attempt a;
    a.present();
    interactions::Clip c = a.good_clip(0.016);
    spoil(c);
    a.clip(c);
    EXPECT_EQ(a.monitor.current(), 1);
    a.clip(a.good_clip(0.016));
    EXPECT_EQ(a.monitor.current(), 2) << "another good one makes it";
  }
}

TEST(Monitor, TheSecondClipMustSitAtItsDistance) {
  for (double s : {0.019, 0.0291}) {  // nearer than 6 mm, farther than 12 mm from 16 mm
    Attempt a;
    a.present();
    a.clip(a.good_clip(0.016));
    a.clip(a.good_clip(s));
    EXPECT_EQ(a.monitor.current(), 2) << s;
  }
}

TEST(Monitor, ACutThatIsNotGoodEnoughIsNotAStep) {
  const std::function<void(interactions::Cut&)> spoilers[] = {
      [](interactions::Cut& c) { c.fraction = 0.9; }, [](interactions::Cut& c) { c.beyond = 0.006; },
      [](interactions::Cut& c) { c.s = 0.017; }, [](interactions::Cut& c) { c.strand = small::kCord; }};
  for (const auto& spoil : spoilers) {
    Attempt a;
    a.present();
    a.both_clips();
    interactions::Cut c = a.good_cut(0.0205);
    spoil(c);
    a.cut(c);
    EXPECT_FALSE(a.monitor.finished());
  }
}

TEST(Monitor, TheTubeIsOccludedByAWholeClipOrACutAndByNothingLess) {
  Attempt open;
  interactions::Clip partial = open.good_clip(0.016);
  partial.cover = 0.9;
  open.clip(partial);
  EXPECT_FALSE(open.monitor.occluded());
  open.clip(open.good_clip(0.025));
  EXPECT_TRUE(open.monitor.occluded());

  Attempt severed;
  EXPECT_FALSE(severed.monitor.occluded());
  severed.cut(severed.good_cut(0.0205));
  EXPECT_TRUE(severed.monitor.occluded());
}

TEST(Monitor, TimeCountsFromTheFirstMotionToTheEnd) {
  Attempt a;
  a.seconds(30);
  EXPECT_EQ(a.monitor.seconds(), 0);
  a.present();
  a.both_clips();
  a.seconds(10);
  a.cut(a.good_cut(0.0205));
  const double end = a.monitor.seconds();
  EXPECT_NEAR(end, 10.3, 0.03);
  a.seconds(10);
  EXPECT_EQ(a.monitor.seconds(), end);
}

TEST(Score, TimeEarnsInProportionBetweenExpertAndLongest) {
  Attempt a;
  a.present();
  a.both_clips();
  a.seconds(569.7);
  a.cut(a.good_cut(0.0205));
  const Score s = a.monitor.score();
  EXPECT_NEAR(s.time, (900.0 - 570.0) / (900 - 240), 1e-3);
  EXPECT_NEAR(s.total, (60 + 25 * s.time) * 100 / 85, 1e-9);
}

TEST(Score, AnUnfinishedAttemptEarnsItsStepsAndNoTime) {
  Attempt a;
  a.present();
  a.clip(a.good_clip(0.016));
  const Score s = a.monitor.score();
  EXPECT_DOUBLE_EQ(s.quality, 0.5);
  EXPECT_DOUBLE_EQ(s.time, 0);
  EXPECT_NEAR(s.total, 30 * 100.0 / 85, 1e-9);
  EXPECT_FALSE(s.passed);
}

TEST(Score, PenaltiesAddUpAndCannotMakeItNegative) {
  Attempt a;
  for (int i = 0; i < 3; ++i) a.event(sim::Event::slipped, small::kGrasper, -1);
  a.all();
  EXPECT_DOUBLE_EQ(a.monitor.score().total, 97);
  for (int i = 0; i < 200; ++i) a.event(sim::Event::slipped, small::kGrasper, -1);
  EXPECT_DOUBLE_EQ(a.monitor.score().total, 0);
  EXPECT_FALSE(a.monitor.score().passed);
}

TEST(Score, AnErrorThatFailsFailsWhateverThePoints) {
  Attempt a;
  interactions::Clip wrong = a.good_clip(0.016);
  wrong.strand = small::kCord;
  a.clip(wrong);
  a.all();
  const Score s = a.monitor.score();
  EXPECT_DOUBLE_EQ(s.total, 100);
  EXPECT_TRUE(s.failed);
  EXPECT_FALSE(s.passed);
}

TEST(Monitor, ResultIsJsonThatSaysTheSame) {
  Attempt a;
  a.event(sim::Event::slipped, small::kGrasper, -1);
  a.all();
  const nlohmann::json j = nlohmann::json::parse(a.monitor.result_json());
  EXPECT_EQ(j["exercise"], "sterilisation");
  EXPECT_EQ(j["finished"], true);
  EXPECT_EQ(j["passed"], true);
  EXPECT_EQ(j["tube_occluded"], true);
  EXPECT_DOUBLE_EQ(j["score"]["total"].get<double>(), a.monitor.score().total);
  EXPECT_DOUBLE_EQ(j["seconds"].get<double>(), a.monitor.seconds());
  ASSERT_EQ(j["steps"].size(), 4u);
  for (const auto& step : j["steps"]) EXPECT_EQ(step["done"], true);
  ASSERT_EQ(j["errors"].size(), 1u);
  EXPECT_EQ(j["errors"][0]["code"], "E3");
  EXPECT_EQ(j["tools"].size(), a.model.tools.size());
  EXPECT_DOUBLE_EQ(j["tools"][0]["max_pull_N"].get<double>(), 1.0);
}

TEST(Monitor, SaysWhatTheSceneLacks) {
  Exercise e = exercise();
  e.goal.tube = "no such tube";
  e.goal.scissors = "no such scissors";
  try {
    const Monitor monitor(e, small::model());
    FAIL() << "took a scene without its tube";
  } catch (const core::BadInput& bad) {
    ASSERT_EQ(bad.faults().size(), 2u) << bad.what();
    EXPECT_NE(bad.faults()[0].message.find("no such tube"), std::string::npos);
    EXPECT_NE(bad.faults()[1].message.find("no such scissors"), std::string::npos);
    EXPECT_NE(bad.faults()[0].at.file.find("sterilisation.json"), std::string::npos);
  }
}

}  // namespace
