// Running the bowel: stations along it, how far a run has come, and what the gut and its mesentery do when they are
// lifted.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/expert/performer.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/marks.hpp>
#include <trocar/training/observe/stations.hpp>

#include "../sim/shipped.hpp"

namespace trocar::training {
namespace {

constexpr int kRightHand = 0, kLeftHand = 1, kStations = 64;
constexpr double kSpacing = 0.010, kLongestStep = 0.100;  // [m]

const sim::Model& bowel() { return shipped("bowel"); }
int gut() { return bowel().organ_index("jejunum"); }

/// Targets of the stations on one of the gut's faces.
std::vector<std::int32_t> stations(char face) {
  std::vector<std::int32_t> out;
  for (int k = 1; k <= kStations; ++k) {
    std::string name = std::to_string(10 * k);
    name = "station_" + std::string(3 - name.size(), '0') + name + "_" + face;
    std::int32_t index = -1;
    std::vector<std::string> known;
    EXPECT_TRUE(find_named(bowel(), ArgumentKind::mark, name, index, known)) << name;
    out.push_back(index);
  }
  return out;
}
/// Of the skin, the one nearest to the station.
int vertex_of(std::int32_t target) {
  const sim::MarkModel& mark = bowel().marks[size_t(bowel().targets[size_t(target)].index)];
  const tissue::Skin& skin = bowel().skin(mark.body());
  int best = 0;
  for (int v = 0; v < skin.size(); ++v)
    if (length(skin.rest[size_t(v)] - vec_cast<float>(mark.place)) <
        length(skin.rest[size_t(best)] - vec_cast<float>(mark.place)))
      best = v;
  return best;
}

Argument number(double v) { return {true, -1, v, v, {}, {}}; }
Argument marks(std::vector<std::int32_t> of) { return {true, -1, 0, 0, {}, {}, std::move(of)}; }

void hold(sim::State& state, int hand, int station) {
  interactions::ToolState& tool = state.tools[size_t(hand)];
  tool.holds = station < 0 ? 0 : 1;
  if (station < 0) return;
  tool.hold[0].at.body = BodyId::organ(size_t(gut()));
  tool.hold[0].at.element = vertex_of(stations('a')[size_t(station)]);
}

TEST(Stations, TellHowFarAlongAHoldIsThoughLoopsLieAgainstEachOther) {
  const Stations along(bowel(), stations('a'), kSpacing);
  sim::State state = sim::initial_state(bowel());
  EXPECT_EQ(along.held_at(bowel(), state, kLeftHand), -1);
  for (int k = 0; k < kStations; ++k) {
    hold(state, kLeftHand, k);
    EXPECT_DOUBLE_EQ(along.held_at(bowel(), state, kLeftHand), (k + 1) * kSpacing);
  }
  // what lies next to a station across its own gut is that station's, too: nearer along the skin than the next loop's
  // wall
  const std::vector<std::int32_t> far = stations('b');
  for (int k = 2; k + 2 < kStations; ++k) {
    state.tools[kLeftHand].hold[0].at.element = vertex_of(far[size_t(k)]);
    EXPECT_NEAR(along.held_at(bowel(), state, kLeftHand), (k + 1) * kSpacing, 1.01 * kSpacing) << k;
  }
}

TEST(Stations, AreDiscsOnOneOrgan) {
  EXPECT_EQ(no_stations(bowel(), stations('a')), "");
  std::vector<std::int32_t> mixed = stations('a');
  std::vector<std::string> known;
  ASSERT_TRUE(find_named(bowel(), ArgumentKind::mark, "liver", mixed[3], known));
  EXPECT_NE(no_stations(bowel(), mixed), "");
  EXPECT_NE(no_stations(bowel(), {}), "");
}

/// All facts of a run on one State that a test writes.
struct RunFacts {
  sim::State state = sim::initial_state(bowel());
  Arguments with{marks(stations('a')), number(kSpacing), number(kLongestStep)};
  std::unique_ptr<Observer> reached = kRunReached.watch(bowel(), with), lost = kRunLost.watch(bowel(), with),
                            grasps = kRunGrasps.watch(bowel(), with);

  void look() {
    for (Observer* each : {reached.get(), lost.get(), grasps.get()}) each->sample({bowel(), state}, 0.02);
  }
  void holding(int hand, int station) {
    hold(state, hand, station);
    look();
  }
  double value(const Observer& fact) const { return fact.value({bowel(), state}).number; }
};

TEST(Run, GoesOnFromHoldToHoldWhileTheLastOneKeepsThePlace) {
  RunFacts run;
  run.look();
  EXPECT_EQ(run.value(*run.reached), 0);
  run.holding(kLeftHand, 7);  // 80 mm: no beginning
  EXPECT_EQ(run.value(*run.reached), 0);
  run.holding(kLeftHand, -1);
  run.holding(kLeftHand, 1);
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.020);
  run.holding(kRightHand, 7);
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.080);
  run.holding(kLeftHand, -1);
  run.holding(kLeftHand, 20);  // 130 mm on: no step shows what lies between
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.080);
  run.holding(kLeftHand, -1);
  run.holding(kLeftHand, 16);
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.170);
  EXPECT_EQ(run.value(*run.lost), 0);
  EXPECT_EQ(run.value(*run.grasps), 5);
}

TEST(Run, ThePlaceIsLostWithBothHandsOffAndFoundWhereItWas) {
  RunFacts run;
  run.holding(kLeftHand, 1);
  run.holding(kRightHand, 8);
  run.holding(kLeftHand, -1);
  run.holding(kRightHand, -1);
  EXPECT_EQ(run.value(*run.lost), 1);
  run.look();
  EXPECT_EQ(run.value(*run.lost), 1);
  run.holding(kLeftHand, 15);  // 160 mm, 70 mm beyond: anywhere
  run.holding(kRightHand, 20);
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.090);
  run.holding(kRightHand, -1);
  run.holding(kLeftHand, -1);
  run.holding(kLeftHand, 9);
  run.holding(kRightHand, 15);
  EXPECT_DOUBLE_EQ(run.value(*run.reached), 0.160);
  EXPECT_EQ(run.value(*run.lost), 1);
}

TEST(Run, FacesCountWhenTheyHaveBeenSeenWithoutABreak) {
  sim::State state = sim::initial_state(bowel());
  const std::vector<std::int32_t> faces = stations('a');
  const std::unique_ptr<Observer> seen = kMarksSeen.watch(bowel(), {marks(faces), number(0.2)});
  const auto show = [&](int station, bool yes) {
    const sim::VisibilityTarget& t = bowel().targets[size_t(faces[size_t(station)])];
    for (int i = t.first; i < t.first + t.count; ++i) state.seen[size_t(i)] = yes;
  };
  const auto share = [&] { return seen->value({bowel(), state}).number; };
  show(3, true), show(4, true);
  for (int i = 0; i < 5; ++i) seen->sample({bowel(), state}, 0.02);
  EXPECT_EQ(share(), 0);
  show(4, false);
  seen->sample({bowel(), state}, 0.02);
  show(4, true);
  for (int i = 0; i < 5; ++i) seen->sample({bowel(), state}, 0.02);
  EXPECT_DOUBLE_EQ(share(), 1.0 / kStations);
  for (int i = 0; i < 5; ++i) seen->sample({bowel(), state}, 0.02);
  EXPECT_DOUBLE_EQ(share(), 2.0 / kStations);
  show(3, false), show(4, false);
  seen->sample({bowel(), state}, 0.02);
  EXPECT_DOUBLE_EQ(share(), 2.0 / kStations);  // what was seen stays so
}

TEST(Stations, WhatJawsHoldOfTwoLoopsBeginsAndEndsFarApart) {
  const Stations along(bowel(), stations('a'), kSpacing);
  sim::State state = sim::initial_state(bowel());
  interactions::ToolState& tool = state.tools[kLeftHand];
  EXPECT_FALSE(along.held_span(bowel(), state, kLeftHand));
  const auto hold_also = [&](int station) {
    interactions::Hold& h = tool.hold[tool.holds++];
    h = {};
    h.at.body = along.body();
    h.at.element = vertex_of(stations('a')[size_t(station)]);
  };
  hold_also(11);
  hold_also(12);
  EXPECT_NEAR(along.held_span(bowel(), state, kLeftHand)->from, 0.120, 1e-9);
  EXPECT_NEAR(along.held_span(bowel(), state, kLeftHand)->to, 0.130, 1e-9);
  hold_also(22);  // the next loop: half way between the two is nothing that is held
  EXPECT_NEAR(along.held_span(bowel(), state, kLeftHand)->from, 0.120, 1e-9);
  EXPECT_NEAR(along.held_span(bowel(), state, kLeftHand)->to, 0.230, 1e-9);
}

// ---- the gut itself
// ---------------------------------------------------------------------------------------------------

/// Middle of the gut at each station, half way between its two faces [m].
std::vector<Vec3d> middles(const sim::State& state) {
  const std::vector<std::int32_t> a = stations('a'), b = stations('b');
  std::vector<Vec3d> out;
  for (size_t k = 0; k < a.size(); ++k)
    out.push_back(0.5 * (place_of_mark(bowel(), state, a[k]) + place_of_mark(bowel(), state, b[k])));
  return out;
}
/// How near two loops come that are at least 50 mm apart along the gut [m].
double nearest_loops(const std::vector<Vec3d>& middle) {
  double least = 1;
  for (size_t i = 0; i < middle.size(); ++i)
    for (size_t j = i + 5; j < middle.size(); ++j) least = std::min(least, length(middle[i] - middle[j]));
  return least;
}

/// A hand takes the gut at a station and draws it up.
struct Lift {
  sim::State state = sim::initial_state(bowel());
  sim::Work work = sim::make_work(bowel());
  double most_pull = 0, nearest = 1;

  Lift(int station, double up, const char* parted = nullptr) {
    if (parted) {
      const size_t band = size_t(bowel().strand_index(parted));
      std::vector<std::uint8_t>& alive = state.strands[band].alive;
      alive[alive.size() / 2] = 0;
    }
    PlanTask take = PlanTask::of(kTakeHold), draw = PlanTask::of(kDraw);
    take.set_index("hand", kLeftHand).set_index("mark", stations('b')[size_t(station)]).set("deep_mm", 0.007);
    draw.set_index("hand", kLeftHand)
        .set("towards", std::string("up"))
        .set("by_mm", up)
        .set("speed_mm_s", 0.020)
        .set("pull_N", 6);
    Demonstration d;
    d.plan.parts.emplace_back();
    d.plan.parts[0].goals.resize(1);
    d.plan.parts[0].goals[0].todo = {take, draw};
    d.plan.parts[0].goals[0].tries = 1;
    Performer performer(bowel(), std::move(d));
    while (!performer.done() && state.tick < 12000) {
      const sim::StepReport report = step(bowel(), performer.next(bowel(), state), state, work);
      performer.after(bowel(), state, report);
      fine = fine && report.fine();
      if (state.tick % 50 == 0) note();
    }
  }
  bool fine = true;

 private:
  void note() {
    const interactions::ToolState& tool = state.tools[kLeftHand];
    most_pull = std::max(
        most_pull, std::sqrt(tool.pull[0] * tool.pull[0] + tool.pull[1] * tool.pull[1] + tool.pull[2] * tool.pull[2]));
    nearest = std::min(nearest, nearest_loops(middles(state)));
  }
};

TEST(BowelLift, ALoopComesUpWithItsNeighboursAndIsCarriedByItsMesentery) {
  const std::vector<Vec3d> before = middles(sim::initial_state(bowel()));
  const Lift lift(41, 0.060);
  ASSERT_TRUE(lift.fine);
  ASSERT_GT(lift.state.tools[kLeftHand].holds, 0);
  const std::vector<Vec3d> after = middles(lift.state);
  const auto risen = [&](int k) { return after[size_t(k)].z - before[size_t(k)].z; };
  EXPECT_GT(risen(41), 0.040);
  EXPECT_GT(risen(37), 0.010);
  EXPECT_GT(risen(45), 0.010);
  // and its neighbours are those along it: the loops beside it, and the gut's beginning, stay
  EXPECT_LT(std::fabs(risen(10)), 0.004);
  EXPECT_LT(std::fabs(risen(20)), 0.010);
  EXPECT_GT(lift.most_pull, 0.5);
  EXPECT_LT(lift.most_pull, 4);  // no error of the exercise
  // loops are 20 mm thick: they may be pressed flat against each other, not into each other
  EXPECT_GT(nearest_loops(before), 0.016);
  EXPECT_GT(lift.nearest, 0.013);
}

TEST(BowelLift, ABandDrawsTheNextLoopAlongUntilItIsCut) {
  const std::vector<Vec3d> before = middles(sim::initial_state(bowel()));
  const Lift tied(12, 0.040), freed(12, 0.040, "band_loops");
  ASSERT_TRUE(tied.fine && freed.fine);
  ASSERT_GT(tied.state.tools[kLeftHand].holds, 0);
  ASSERT_GT(freed.state.tools[kLeftHand].holds, 0);
  const auto risen = [&](const Lift& lift, int k) { return middles(lift.state)[size_t(k)].z - before[size_t(k)].z; };
  EXPECT_GT(risen(tied, 12), 0.020);
  EXPECT_GT(risen(freed, 12), 0.020);
  EXPECT_GT(risen(tied, 22), risen(freed, 22) + 0.005);
  EXPECT_GT(tied.most_pull, freed.most_pull);
}

}  // namespace
}  // namespace trocar::training
