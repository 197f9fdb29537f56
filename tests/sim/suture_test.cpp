// Needle and thread among tissue and instruments: the box trainer's pad with its slit.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/sim/recording/keyframe.hpp>

#include "needle_driver.hpp"
#include "shipped.hpp"

namespace trocar {
namespace {

const sim::Model& box() { return shipped("box_suture"); }
int right_hand() { return box().hand_index("right"); }
const Vec3d kIn{0, 0.077, -0.070}, kOut{0, 0.063, -0.070};

/// Driven through both lips once for all tests that look at it.
const NeedleDriver& driven() {
  static const NeedleDriver done = [] {
    NeedleDriver d(box(), right_hand());
    d.rest(0.2);
    d.drive(kIn, kOut, 2.5, 3.2);
    return d;
  }();
  return done;
}

TEST(Suture, HeldFromTheStartStaysInTheJaws) {
  NeedleDriver d(box(), right_hand());
  const Vec3d before = d.suture().needle.x;
  d.rest(0.3);
  ASSERT_GT(d.state.tools[size_t(right_hand())].holds, 0);
  EXPECT_TRUE(d.state.tools[size_t(right_hand())].hold[0].at.body.is(BodyKind::suture));
  EXPECT_LT(length(d.suture().needle.x - before), 0.0005);
}

TEST(Suture, ItsThreadLeavesTheSwageAsTheWireEnds) {
  NeedleDriver d(box(), right_hand());
  const auto apart = [&] {
    const suture::NeedleModel& m = d.model().needle;
    const Vec3d leaves = normalised(d.suture().thread.x[1] - d.suture().thread.x[0]);
    return dot(leaves, -suture::needle_direction(m, d.suture().needle, m.length));
  };
  EXPECT_GT(apart(), 0.98);
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    d.step();
    for (int e = 0; e < 4; ++e) most = std::max(most, suture::tension(d.model().thread, d.suture().thread, e));
  }
  EXPECT_GT(apart(), 0.98);
  EXPECT_LT(most, 0.5);  // [N]: it has not sprung round
}

TEST(Suture, LetGoFallsWithItsThread) {
  NeedleDriver d(box(), right_hand());
  d.input.tools[right_hand()].handle = 0;
  d.rest(0.8);
  EXPECT_EQ(d.state.tools[size_t(right_hand())].holds, 0);
  EXPECT_LT(d.suture().needle.x.z, -0.066);  // on the pad or on the plate
  EXPECT_LT(length(d.suture().needle.v), 0.05);
}

TEST(Suture, GoesThroughBothLipsOfASlitByAnEntryAndAnExitEach) {
  const interactions::SutureState& s = driven().suture();
  ASSERT_EQ(s.bite_count, 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(s.bites[size_t(i)].stage, interactions::SutureBite::through);
    EXPECT_EQ(s.bites[size_t(i)].body, BodyId::organ(0));
  }
  EXPECT_FALSE(s.inside.exists());
}

TEST(Suture, PiercesNoSoonerThanAtItsTissuesForceAndSoonAfterThat) {
  const double bears = box().objects.sutures.organs[0].puncture;
  EXPECT_GT(driven().before_entry, 0.95 * bears);  // a tick before
  EXPECT_LT(driven().before_entry, 1.15 * bears);  // its force is not all along the way that it is driven
}

TEST(Suture, OutOfThePadTheTipStandsBeyondTheNearMark) {
  const Vec3d tip = driven().tip();
  EXPECT_GT(tip.z, -0.0705);
  EXPECT_LT(tip.y, 0.064);
}

TEST(Suture, LeavesNoHoleWithoutForcesThatAddUpToThoseOfTheJaws) {
  NeedleDriver d = driven();
  d.rest(0.3);
  Vec3d on_tissue, by_jaws;
  for (int i = 0; i < d.suture().hole_count; ++i) {
    const auto& f = d.suture().holes[size_t(i)].force;
    on_tissue += Vec3d{double(f[0]), double(f[1]), double(f[2])};
  }
  const interactions::ToolState& tool = d.state.tools[size_t(right_hand())];
  for (int i = 0; i < tool.holds; ++i)
    by_jaws += Vec3d{double(tool.hold[i].force[0]), double(tool.hold[i].force[1]), double(tool.hold[i].force[2])};
  EXPECT_GT(length(on_tissue), 0.02);
  EXPECT_LT(length(by_jaws - on_tissue), 0.05 + 0.1 * length(on_tissue));
}

TEST(Suture, TurnsInJawsWhereItsTipIsPushedAside) {
  NeedleDriver d(box(), right_hand());
  d.rest(0.1);
  const interactions::ToolShape before = sim::shape_of(box(), d.state, size_t(right_hand()));
  const Vec3d was = to_jaw(before, d.tip());
  // over the pad, and down on it
  const Vec3d x = d.suture().needle.x;
  const Quatd q = d.suture().needle.q;
  for (int i = 0; i < 900; ++i) {
    d.lead(x + std::min(1.0, i / 400.0) * Vec3d{-0.02, 0, 0} + std::max(0.0, (i - 400) / 500.0) * Vec3d{0, 0, -0.022},
           q);
    d.step();
  }
  const interactions::ToolShape after = sim::shape_of(box(), d.state, size_t(right_hand()));
  EXPECT_GT(length(to_jaw(after, d.tip()) - was), 0.002);
  EXPECT_GT(d.state.tools[size_t(right_hand())].holds, 0);
}

/// A shaft in its way: the needle is held no faster than friction and pinch hold it, however fast the hand is.
TEST(Suture, ANeedleSwungAgainstSteelSlipsInItsJawsAtTheirGrip) {  // [needle in jaws]
  const int right = right_hand(), left = 1 - right;
  sim::Model smooth = box();
  for (interactions::ToolModel& tool : smooth.hands[size_t(right)].rack) tool.friction = 0.2;
  NeedleDriver d(smooth, right);
  d.rest(0.1);
  const Vec3d across{0.050, 0.0653, -0.0543};
  d.input.tools[left] = sim::tool_input(kinematics::inverse(box().hands[size_t(left)].port, across, 0), 1.0f);
  d.rest(0.8);
  const double bears = smooth.placed(size_t(right)).friction * d.state.tools[size_t(right)].pinch;
  const Vec3d x = d.suture().needle.x;
  const Quatd q = d.suture().needle.q;
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    d.lead(x + (0.4 * i * sim::kTick) * Vec3d{0, -1, 0}, q);
    d.step();
    const double* pull = d.state.tools[size_t(right)].pull;
    most = std::max(most, length(Vec3d{pull[0], pull[1], pull[2]}));
  }
  std::printf("at most %.1f N in jaws that hold %.1f N\n", most, bears);
  EXPECT_GT(most, 5);
  EXPECT_LT(most, 1.03 * bears);
}

/// Open scissors in the other hand, which the thread hangs before.
struct Scissors {
  NeedleDriver d{box(), right_hand()};
  int hand = 1 - right_hand();
  int node = 80;
  std::int32_t number = 0;
  double roll = 0;
  Vec3d at, opens;

  Scissors() {
    const sim::HandModel& mine = box().hands[size_t(hand)];
    const auto cuts = [](const interactions::ToolModel& m) { return m.can().cut; };
    number = std::int32_t(std::find_if(mine.rack.begin(), mine.rack.end(), cuts) - mine.rack.begin());
    at = d.suture().thread.x[size_t(node)];
    go(at, 0.04);
    d.rest(0.8);
    // open across the thread, and over it along the shaft
    const std::vector<Vec3d>& x = d.suture().thread.x;
    at = x[size_t(node)];
    const Vec3d along = normalised(x[size_t(node) + 2] - x[size_t(node) - 2]);
    double least = 2;
    for (int k = 0; k < 24; ++k) {
      const kinematics::FulcrumPose pose = pose_of(at, 0.04, k * portable::pi / 24);
      const Vec3d way = direction_from_jaw(shape_of(mine.rack[size_t(number)], pose, 1), {1, 0, 0});
      if (std::fabs(dot(way, along)) < least) least = std::fabs(dot(way, along)), roll = pose.roll, opens = way;
    }
    for (int i = 0; i < 1400; ++i) {
      at = d.suture().thread.x[size_t(node)];
      go(at, std::max(0.0, 0.04 - std::max(0, i - 400) * 5e-5));
      d.step();
    }
  }
  interactions::ToolShape shape() const { return sim::shape_of(box(), d.state, size_t(hand)); }
  kinematics::FulcrumPose pose_of(Vec3d to, double before, double turn) const {
    const Vec3d port = box().hands[size_t(hand)].port;
    return kinematics::inverse(port, to + (0.007 - before) * normalised(to - port), turn);
  }
  /// With its blades' middles to a place, or so much before it.
  void go(Vec3d to, double before = 0) {
    d.input.tools[hand] = sim::tool_input(pose_of(to, before, roll), d.input.tools[hand].handle, number);
  }
  /// How far thread's axis lies below a blade's surface at most [m].
  double deepest() const {
    double most = 0;
    for (const int part : {interactions::kJawA, interactions::kJawB})
      for (const Vec3d& x : d.suture().thread.x) {
        const collision::Capsule rod = shape().rod(part);
        most = std::max(most, rod.radius - length(x - collision::nearest_on_axis(rod, x)));
      }
    return most;
  }
};

const Scissors& ready_scissors() {
  static const Scissors ready;
  return ready;
}

TEST(Suture, AnOpenBladePushesThreadAsideAndIsNotEntered) {
  Scissors s = ready_scissors();
  const Vec3d from = s.at;
  double deepest = 0;
  for (int i = 0; i < 1200; ++i) {
    s.go(from - (0.01 * i * sim::kTick) * s.opens);
    s.d.step();
    deepest = std::max(deepest, s.deepest());
  }
  EXPECT_LT(dot(s.d.suture().thread.x[size_t(s.node)] - from, s.opens), -0.002);
  EXPECT_LT(deepest, 0.25 * s.d.model().thread.stuff.diameter);
}

TEST(Suture, ThreadBetweenBladesStaysThereUntilTheyCutIt) {
  Scissors s = ready_scissors();
  const auto cuts = [&s] {
    const auto& alive = s.d.suture().thread.alive;
    return std::count(alive.begin(), alive.end(), 0);
  };
  ASSERT_EQ(cuts(), 0);
  for (int i = 0; i < 400; ++i) s.d.input.tools[s.hand].handle = std::min(1.0f, 0.005f * float(i)), s.d.step();
  ASSERT_EQ(cuts(), 1);
  const auto& alive = s.d.suture().thread.alive;
  EXPECT_NEAR(double(std::find(alive.begin(), alive.end(), 0) - alive.begin()), s.node, 12);
}

TEST(Suture, ThreadFoundDeepInThePadComesOutAndIsNotThrown) {
  NeedleDriver d(box(), right_hand());
  suture::ThreadState& thread = d.state.objects.sutures.front().thread;
  const Vec3d swage = thread.x[0], deep{0.028, 0.080, -0.0715}, end{-0.028, 0.080, -0.0715};
  thread = suture::laid(d.model().thread, std::vector<Vec3d>{swage, deep, end});
  suture::take_hold(d.model().thread, thread, interactions::kSwageSlot, 0);
  const int first = int((length(deep - swage) + 0.005) / d.model().thread.spacing), last = first + 80;
  ASSERT_LT(last, d.model().thread.nodes);
  double farthest = 0;  // in ten ticks: a jerk of one or two is not a throw
  for (int i = 0; i < 10; ++i) {
    const std::vector<Vec3d> before = d.suture().thread.x;
    for (int k = 0; k < 10; ++k) d.step();
    for (int n = first; n < last; ++n)
      farthest = std::max(farthest, length(d.suture().thread.x[size_t(n)] - before[size_t(n)]));
  }
  for (int n = first; n < last; ++n) EXPECT_GT(d.suture().thread.x[size_t(n)].z, -0.0703) << n;
  RecordProperty("farthest_mm", std::to_string(1e3 * farthest));
  EXPECT_LT(farthest, 0.003) << "[m]";
}

TEST(Suture, KeyframesHoldNeedleAndThread) {
  const NeedleDriver& d = driven();
  const std::vector<std::uint8_t> bytes = sim::display_bytes(box(), d.state);
  sim::State read = sim::initial_state(box());
  ASSERT_TRUE(sim::restore_display(box(), bytes, read));
  const interactions::SutureState &a = d.suture(), &b = read.objects.sutures.front();
  EXPECT_EQ(a.needle.x, b.needle.x);
  ASSERT_EQ(a.thread.x.size(), b.thread.x.size());
  for (size_t i = 0; i < a.thread.x.size(); ++i) EXPECT_LT(length(a.thread.x[i] - b.thread.x[i]), 2e-5);
}

TEST(Suture, IsTheSameWhateverWorkWasBeforeATick) {
  NeedleDriver a = driven(), b = driven();
  for (int i = 0; i < 50; ++i) {
    sim::poison(b.work);
    a.step(), b.step();
    ASSERT_EQ(sim::hash_of(a.state), sim::hash_of(b.state)) << sim::first_difference(a.state, b.state);
  }
}

}  // namespace
}  // namespace trocar
