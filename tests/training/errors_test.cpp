// Each error is made by its cause, costs what the exercise says, and brings with it only what the exercise's table says
// it implies. Here the State is written by hand, quickly; flaws_soak.cpp has the demonstration make each for real.
#include <algorithm>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/sim/model/bodies.hpp>

#include "two_sides.hpp"

using namespace trocar;
using namespace trocar::training;
using two_sides::Attempt;
using two_sides::exercise;
using two_sides::kCord;
using two_sides::kLeft;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Mistake {
  const char* code;
  std::function<void(Attempt&)> make;
  const char* what = "";
};
void PrintTo(const Mistake& m, std::ostream* os) { *os << m.code << " " << m.what; }

class AnError : public testing::TestWithParam<Mistake> {};

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

TEST_P(AnError, IsMadeOnceByItsCauseAndBringsOnlyWhatItImplies) {
  Attempt a;
  a.up_to_clips(kLeft);
  a.let_go();
  GetParam().make(a);
  const Penalty* p = exercise().penalty(GetParam().code);
  ASSERT_NE(p, nullptr) << "the exercise prices it";
  int made = 0;
  for (const ErrorMade& e : a.monitor.errors()) {
    if (e.code != p->code) {
      EXPECT_TRUE(has(p->implies, e.code) || has(p->may, e.code)) << e.code << " is not in the table for " << p->code;
      continue;
    }
    ++made;
    EXPECT_EQ(e.points, p->points);
    EXPECT_EQ(e.fail, p->fail);
    EXPECT_EQ(e.meaning, p->meaning);
    EXPECT_EQ(e.name, p->name);
  }
  EXPECT_EQ(made, 1);
  for (const std::string& code : p->implies) EXPECT_TRUE(has(a.codes(), code)) << code;
  EXPECT_EQ(a.monitor.score().failed, p->fail);
  for (const std::string& step : p->leaves) EXPECT_FALSE(a.done(step)) << step << " was completed by a faulty act";
}

Mistake clip_mistake(const char* code, void (*spoil)(interactions::Clip&)) {
  return {code, [spoil](Attempt& a) {
            interactions::Clip c = a.good_clip(kLeft, 0.016);
            spoil(c);
            a.clip(c);
          }};
}

Mistake cut_mistake(const char* code, void (*spoil)(interactions::Cut&), const char* what = "") {
  return {code,
          [spoil](Attempt& a) {
            a.both_clips(kLeft);
            interactions::Cut c = a.good_cut(kLeft);
            spoil(c);
            a.cut(c);
          },
          what};
}

/// Moves the hand's tip sideways at `speed` [m/s] for `time` [s].
void wave(Attempt& a, int hand, double speed, double time) {
  interactions::ToolState& t = a.state.tools[size_t(hand)];
  for (int i = 0; i < int(time * 1000); ++i) {
    t.yaw += speed / t.depth * 1e-3;
    a.tick();
  }
}

BodyId pad(const Attempt& a) { return sim::body_of(a.model, "pad"); }

const Mistake kMistakes[] = {
    {"E1",
     [](Attempt& a) {
       a.hold_tube(kLeft, 0.055, 4.5);
       a.seconds(1);
     },
     "tube"},
    {"E1",
     [](Attempt& a) {
       a.hold_tube(kCord, 0.05, 7.9);
       a.seconds(1);
       a.hold_tube(kCord, 0.05, 8.1);
       a.seconds(1);
     },
     "other tissue"},
    {"E1.2",
     [](Attempt& a) {
       a.event(sim::Event::on_body(sim::Event::torn, two_sides::kGrasper, BodyId::strand(kLeft)));
       a.event(
           sim::Event::on_body(sim::Event::torn, two_sides::kGrasper, BodyId::strand(kLeft)));  // the same tear goes on
     },
     ""},
    {"E2",
     [](Attempt& a) {
       a.hold(pad(a), 0, 1);
       a.state.tools[two_sides::kGrasper].pinch = 15.5;
       a.seconds(2);
     },
     "force"},
    {"E2",
     [](Attempt& a) {
       a.hold(pad(a), 0, 1);
       a.state.tools[two_sides::kGrasper].pinch = 14;
       a.seconds(21.4);
       EXPECT_TRUE(a.codes().empty());
       a.seconds(0.1);
     },
     "force and time"},
    {"E3", [](Attempt& a) { a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper)); }},
    {"E4.1",
     [](Attempt& a) {
       a.look(a.model.hands[1].name, false);
       a.state.tools[1].depth = 0.08;
       wave(a, 1, 0.02, 1.5);
     }},
    clip_mistake("E4.2", [](interactions::Clip& c) { c.tips_visible = 1; }),
    cut_mistake(
        "E4.2", [](interactions::Cut& c) { c.tips_visible = 0; }, "cut"),
    {"E5",
     [](Attempt& a) {
       // the second hand's instrument swings into the first one; the third is out of the way
       for (int h : {0, 1}) a.state.tools[size_t(h)].aperture = 0;
       a.state.tools[2].depth = 0.02;
       interactions::ToolState &t = a.state.tools[0], &u = a.state.tools[1];
       const Vec3d tip = kinematics::forward(a.model.hands[0].port, t.pose()).tip;
       for (int i = 100; i >= 0; --i) {
         const kinematics::FulcrumPose p =
             kinematics::inverse(a.model.hands[1].port, tip + Vec3d{0, 0.0002 * i, 0}, u.roll);
         u.yaw = p.yaw;
         u.pitch = p.pitch;
         u.depth = p.depth;
         a.tick();
         a.tick();
       }
     }},
    {"E11", [](Attempt& a) { a.clip(a.good_clip(kCord, 0.02)); }, "clip"},
    {"E11", [](Attempt& a) { a.cut(a.good_cut(kCord, 0.02)); }, "cut"},
    {"E11",
     [](Attempt& a) {
       interactions::Cut c = a.good_cut(-1);
       c.solid = 0;
       a.cut(c);
     },
     "organ"},
    clip_mistake("E12", [](interactions::Clip& c) { c.strand = -1; }),
    {"E13",
     [](Attempt& a) {
       a.state.tools[1].depth = 0.012;
       a.event(sim::Event::exchange(1, 0));
       a.look(a.model.hands[1].name, false);
       for (int i = 0; i < 900; ++i) {
         a.state.tools[1].depth += 0.05e-3;
         a.tick();
       }
     }},
    {"E6", [](Attempt& a) { a.press(0.5); }},
    {"E7", [](Attempt& a) { a.press(0.5, BodyId::strand(kCord)); }},
    {"E7.1", [](Attempt& a) { a.press(0.1, pad(a)); }},
    {"E7.2",
     [](Attempt& a) {
       sim::ElectrodeHand& hand = a.state.electrodes[0];
       hand.current.now.hot_touch = 1;
       hand.body = BodyId::strand(kCord);
       a.seconds(1);
     }},
    {"E8",
     [](Attempt& a) {
       // a cell of the tube 10 mm from where it was treated
       constexpr int kCells = 20;
       a.press(0.1, BodyId::strand(kLeft));
       a.state.heat.key[0] = {BodyId::strand(kLeft), kCells / tissue::kBrickSide, 0, 0};
       a.state.heat.slot[0] = tissue::HeatState::kAsleep;
       a.state.heat.cells[kCells % tissue::kBrickSide] = tissue::HeatState::kTissue;
       a.state.heat.damage[kCells % tissue::kBrickSide] = 1;
       a.seconds(1);
     }},
    {"E9.1", [](Attempt& a) { a.bleed(11, 1); }},
    {"E9.2", [](Attempt& a) { a.bleed(51, 1); }},
    {"E9", [](Attempt& a) { a.bleed(201, 1); }},
    {"E9.3", [](Attempt& a) { a.bleed(0.02, 61); }},
    {"E10",
     [](Attempt& a) {
       a.drown(two_sides::kApplier);
       a.clip(a.good_clip(kLeft, 0.016));
     },
     "clip"},
    {"E10",
     [](Attempt& a) {
       a.both_clips(kLeft);
       a.drown(two_sides::kScissors);
       a.cut(a.good_cut(kLeft));
     },
     "a cut"},
    {"E10",
     [](Attempt& a) {
       a.one_side(kLeft);
       a.one_side(two_sides::kRight, [](Attempt& before_the_check) { before_the_check.bleed(11, 1); });
       a.seconds(63);
     },
     "left in the pool"},
    clip_mistake("A1.1", [](interactions::Clip& c) { c.s = 0.031; }),
    clip_mistake("A1.2", [](interactions::Clip& c) { c.s = 0.009; }),
    clip_mistake("A1.3", [](interactions::Clip& c) { c.cover = 0.9; }),
    clip_mistake("A1.4", [](interactions::Clip& c) { c.theta = 20 * kDegree; }),
    clip_mistake("A1.5", [](interactions::Clip& c) { c.theta = 31 * kDegree; }),
    cut_mistake(
        "A1.6", [](interactions::Cut& c) { c.s = 0.030; }, "outside"),
    cut_mistake(
        "A1.6", [](interactions::Cut& c) { c.s = 0.0175; }, "1.5 mm from a clip"),
    {"A1.6", [](Attempt& a) { a.cut(a.good_cut(kLeft)); }, "no clips"},
    cut_mistake("A1.7", [](interactions::Cut& c) { c.beyond = 0.0055; }),
    clip_mistake("A1.8", [](interactions::Clip& c) { c.closing_time = 0.9; }),
    clip_mistake("A1.9", [](interactions::Clip& c) { c.s = 0.011; }),
    {"A1.9",
     [](Attempt& a) {
       a.clip(a.good_clip(kLeft, 0.016));
       a.clip(a.good_clip(kLeft, 0.0205));
       EXPECT_TRUE(a.done("first_clip"));
       EXPECT_FALSE(a.done("second_clip"));
     },
     "4.5 mm apart"},
    cut_mistake("A1.10", [](interactions::Cut& c) { c.fraction = 0.9; }),
};

std::string word(const testing::TestParamInfo<Mistake>& info) {
  std::string name = std::to_string(info.index) + "_" + info.param.code;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

// leaves: first_clip of the second example of A1.9 is done by the clip before it, so that one is checked by hand.
std::vector<Mistake> checked_by_table() {
  std::vector<Mistake> list(std::begin(kMistakes), std::end(kMistakes));
  list.erase(std::remove_if(list.begin(), list.end(),
                            [](const Mistake& m) {
                              return std::string(m.what) == "4.5 mm apart" || std::string(m.what) == "cut";
                            }),
             list.end());
  return list;
}
INSTANTIATE_TEST_SUITE_P(Codes, AnError, testing::ValuesIn(checked_by_table()), word);

TEST(Errors, ALaterMistakeAddsOnlyItsOwnCode) {
  for (const Mistake& m : kMistakes)
    if (std::string(m.what) == "4.5 mm apart" || std::string(m.what) == "cut") {
      Attempt a;
      a.up_to_clips(kLeft);
      m.make(a);
      EXPECT_EQ(a.codes(), std::vector<std::string>{m.code});
    }
}

TEST(Errors, ATubeThatIsClippedBeforeItWasFollowedIsNotIdentified) {
  Attempt a;
  a.look("tube_left.fimbria", false);
  a.survey();
  a.clip(a.good_clip(kLeft, 0.016));
  EXPECT_EQ(a.codes(), std::vector<std::string>{"A1.11"});
  a.look("tube_left", true);
  a.seconds(5);
  EXPECT_FALSE(a.done("identify")) << "too late";
  EXPECT_TRUE(a.done("first_clip")) << "a step of its own";
  a.clip(a.good_clip(kLeft, 0.025));
  EXPECT_EQ(a.codes().size(), 1u) << "once a side";
}

TEST(Errors, EveryCodeThatTheExercisePricesIsMadeHere) {
  for (const Penalty& p : exercise().penalties)
    EXPECT_TRUE(p.code == "A1.11" || std::any_of(std::begin(kMistakes), std::end(kMistakes),
                                                 [&p](const Mistake& m) { return m.code == p.code; }))
        << p.code;
}

TEST(Errors, ASlipBelongsToTheSideThatWasHeld) {
  Attempt a;
  a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper));
  a.hold_tube(kLeft, 0.055, 1);
  a.seconds(0.1);
  a.let_go();
  a.event(sim::Event::of_hand(sim::Event::slipped, two_sides::kGrasper));
  ASSERT_EQ(a.monitor.errors().size(), 2u);
  EXPECT_EQ(a.monitor.errors()[0].side, "") << "nothing was ever held";
  EXPECT_EQ(a.monitor.errors()[1].side, "left");
}

TEST(Errors, EachExcursionOfForceCountsOnce) {
  Attempt a;
  a.hold_tube(kLeft, 0.055, 4.5);
  a.seconds(0.09);
  EXPECT_TRUE(a.codes().empty()) << "a jerk of less than 0.1 s";
  for (int excursion = 1; excursion <= 3; ++excursion) {
    a.hold_tube(kLeft, 0.055, 1.0);
    a.seconds(0.1);
    a.hold_tube(kLeft, 0.055, 4.5);
    a.seconds(0.5);
    EXPECT_EQ(a.codes().size(), size_t(excursion));
  }
}

TEST(Errors, OutOfViewAnInstrumentMayRestTrembleAndBeDrawnBack) {
  Attempt a;
  a.look(a.model.hands[1].name, false);
  interactions::ToolState& t = a.state.tools[1];
  t.depth = 0.08;
  a.seconds(3);
  const double yaw = t.yaw;
  for (int i = 0; i < 3000; ++i) {  // 0.3 mm at 10 Hz
    t.yaw = yaw + 0.0003 / t.depth * std::sin(2 * std::numbers::pi * 10 * i * 1e-3);
    a.tick();
  }
  while (t.depth > 0.05) {
    t.depth -= 0.01e-3;
    a.tick();
  }
  EXPECT_TRUE(a.codes().empty());
  a.look(a.model.hands[1].name, true);
  wave(a, 1, 0.05, 2);
  EXPECT_TRUE(a.codes().empty()) << "in view it may move";
}

TEST(Errors, InstrumentsThatMeetSlowlyDoNotCollide) {
  Attempt a;
  interactions::ToolState &t = a.state.tools[0], &u = a.state.tools[1];
  const Vec3d tip = kinematics::forward(a.model.hands[0].port, t.pose()).tip;
  for (int i = 1000; i >= 0; --i) {  // 15 mm/s
    const kinematics::FulcrumPose p = kinematics::inverse(a.model.hands[1].port, tip + Vec3d{0, 15e-6 * i, 0}, u.roll);
    u.yaw = p.yaw;
    u.pitch = p.pitch;
    u.depth = p.depth;
    a.tick();
  }
  EXPECT_TRUE(a.codes().empty());
}

TEST(Errors, AnInstrumentBroughtInUnderTheCamerasEyeIsNotBlind) {
  for (const char* seen : {".jaw_a", ".shaft"}) {
    Attempt a;
    a.state.tools[1].depth = 0.012;
    a.event(sim::Event::exchange(1, 0));
    a.look(a.model.hands[1].name, false);
    a.look(a.model.hands[1].name + seen, true);
    for (int i = 0; i < 500; ++i) {
      a.state.tools[1].depth += 0.1e-3;
      a.tick();
    }
    EXPECT_TRUE(a.codes().empty()) << seen;
  }
}

TEST(Errors, TheTableNamesOnlyWhatThereIs) {
  for (const Penalty& p : exercise().penalties) {
    EXPECT_FALSE(p.name.empty()) << p.code;
    EXPECT_FALSE(p.hint.empty()) << p.code;
    EXPECT_FALSE(has(p.implies, p.code)) << p.code;
    for (const std::string& code : p.implies) EXPECT_FALSE(has(p.may, code)) << p.code;
  }
  for (const LaterError& l : exercise().later) EXPECT_EQ(exercise().penalty(l.code), nullptr) << l.code;
}

}  // namespace
