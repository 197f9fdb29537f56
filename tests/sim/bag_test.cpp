// A retrieval bag in the step: it opens, takes in, holds, is drawn shut and goes out, and obeys the laws of the step.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/parallel.hpp>
#include <trocar/interactions/objects/bag_contents.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;
using interactions::Bag;
using interactions::BagModel;
using interactions::BagPoint;
using interactions::BagState;
using interactions::Rigid;
using interactions::RigidState;

namespace {

constexpr int kLeft = 0, kRight = 1;  // hands
const Vec3d kMouth{0.0, 0.1, -0.030}, kLowMouth{0.0, 0.1, -0.067};

scene::RigidSetting pebble(int number, Vec3d at) {
  scene::RigidSetting s;
  s.name = "stone_" + std::to_string(number);
  s.look = "gallstone";
  s.pebble = {0.006, 0.005, 0.0045};
  s.thick = s.pebble.z;
  s.mass = 0.0001;
  s.place = at;
  return s;
}

/// A box without pegs: five stones on its floor, a grasper in the left hand, a bag in the right one.
scene::Description box() {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/peg_transfer/scene.json");
  d.walls.resize(1);
  auto& stones = settings_of(scene::RigidScene{}, d.objects);
  stones.clear();
  for (int i = 0; i < 5; ++i) stones.push_back(pebble(i, {-0.05 + 0.01 * i, 0.06, -0.117}));
  scene::BagSetting bag;
  bag.name = "bag";
  bag.look = "bag_film";
  bag.deep = 0.070;
  settings_of(scene::BagScene{}, d.objects).push_back(bag);
  scene::Instrument sleeve = small::instrument("retrieval_bag", interactions::ToolKind::bag);
  sleeve.shaft_radius = 0.005;
  sleeve.jaw_length = 0.004;
  sleeve.opening = 0;
  d.instruments.push_back(sleeve);
  d.ports[2].diameter = 0.010;
  d.placements[1].instrument = "retrieval_bag";
  d.placements[1].tip = {0.045, 0.060, -0.020};
  return d;
}
const Model& box_model() {
  static const Model made = scene::compile(box());
  return made;
}

/// And a gallbladder, 50 mm tall and 24 mm wide, upright over a mouth that is 50 mm above the floor: the cloth lies in
/// folds.
const Model& box_with_gallbladder() {
  static const Model made = [] {
    scene::Description d = box();
    const scene::Description from = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy_extract/scene.json");
    d.tissues = from.tissues;
    d.pouches = {from.pouches.front()};
    d.pouches.front().sections.clear();
    for (int i = 0; i <= 10; ++i) {
      const double r = 0.012 * std::sqrt(portable::sin(portable::pi * (0.06 + 0.088 * i)));
      d.pouches.front().sections.push_back({kLowMouth + Vec3d{0.008, 0, 0.006 + 0.005 * i}, {r, 0, 0}, {0, r, 0}});
    }
    settings_of(scene::BagScene{}, d.objects).front().deep = 0.090;
    return scene::compile(d);
  }();
  return made;
}

const BagModel& bag_model() { return interactions::part_of<Bag>(box_model()).list.front(); }
const BagState& bag(const State& s) { return interactions::part_of<Bag>(s).front(); }
RigidState& stone(State& s, size_t i) { return interactions::part_of<Rigid>(s)[i]; }
bool inside(const State& s, size_t i) { return share_in(bag_model(), bag(s), BodyId(BodyKind::rigid, i)).inside == 1; }
double fastest(const BagState& s) {
  double most = 0;
  for (const Vec3d& v : s.v) most = std::max(most, length(v));
  return most;
}
double lowest(const BagState& s) {
  double least = 1;
  for (const Vec3d& x : s.x) least = std::min(least, x.z);
  return least;
}
double longest(const BagState& s) {
  double most = 0;
  for (const interactions::BagThread& t : bag_model().threads)
    most = std::max(most, length(s.x[size_t(t.b)] - s.x[size_t(t.a)]) / t.length);
  return most;
}

struct Bagged : small::Table {
  Vec3d tip;
  explicit Bagged(const Model& of = box_model()) : Table(of) {
    tip = kinematics::forward(model.hands[kRight].port, pose_of(input.tools[kRight])).tip;
  }

  /// The right hand's tip there, its mouth turned by `turn` from facing up [rad].
  void hold(Vec3d to, double turn) {
    kinematics::FulcrumPose pose = kinematics::inverse(model.hands[kRight].port, to, 0);
    pose.roll = kinematics::roll_towards(pose, {0, 0, 1}) + turn;
    const float handle = input.tools[kRight].handle;
    input.tools[kRight] = tool_input(pose, handle);
    tip = to;
  }
  void move(Vec3d to, double turn, int ticks) {
    const Vec3d from = tip;
    for (int i = 1; i <= ticks; ++i) hold(from + double(i) / ticks * (to - from), turn), step();
  }
  Vec3d before_mouth(Vec3d mouth = kMouth) const {
    const Vec3d along = normalised(mouth - model.hands[kRight].port);
    return mouth - 0.030 * along;
  }
  void open(Vec3d mouth = kMouth) {
    move(before_mouth(mouth), 0, 600);
    steps(2600);
  }
  /// Lets stones fall through the mouth, one after the other.
  void fill(int stones) {
    for (int i = 0; i < stones; ++i) {
      RigidState& s = stone(state, size_t(i));
      s = {bag(state).middle(bag_model()) + Vec3d{0.004 * (i - 2), 0.003 * (i % 2), 0.012}, s.q, {}, {}, 0};
      steps(250);
    }
    steps(500);
  }
};

/// It begins above the mouth again once the bag is open.
struct BaggedGallbladder : Bagged {
  BaggedGallbladder() : Bagged(box_with_gallbladder()) {
    const auto over_mouth = state.membranes[0].network;
    open(kLowMouth);
    state.membranes[0].network = over_mouth;
  }
  double inside() const {
    const interactions::BagShare share =
        share_in(interactions::part_of<Bag>(model).list.front(), bag(state), BodyId::membrane(0));
    return double(share.inside) / share.all;
  }
  /// Of its nodes, root mean square over a tenth of a second [m/s].
  double speed() {
    double sum = 0;
    const int nodes = model.membranes[0].sheet.network.nodes;
    for (int i = 0; i < 100; ++i) {
      step();
      const tissue::NodeView view = view_of(model.membranes[0].sheet.network, state.membranes[0].network);
      for (int n = 0; n < nodes; ++n) sum += dot(view.velocity(n), view.velocity(n)) / nodes;
    }
    return std::sqrt(sum / 100);
  }
};

TEST(Bag, AGallbladderThatFallsIntoItLiesStillInIt) {
  BaggedGallbladder t;
  t.steps(4000);
  EXPECT_EQ(t.inside(), 1);
  const double speed = t.speed();
  EXPECT_LT(speed, 0.03);
  t.steps(4000);
  EXPECT_EQ(t.inside(), 1) << "it has climbed out";
}

TEST(Bag, DrawnShutAndTurnedItKeepsAGallbladder) {
  BaggedGallbladder t;
  t.steps(3000);
  t.close_slowly(kRight, 1, 2000);
  t.steps(1500);
  EXPECT_TRUE(bag(t.state).shut());
  for (int i = 1; i <= 1500; ++i) t.hold(t.tip, portable::pi * i / 1500), t.step();
  t.steps(1500);
  EXPECT_EQ(t.inside(), 1);
  EXPECT_LT(t.speed(), 0.05);
}

}  // namespace

TEST(Bag, ItComesOutOnlyOnceItsSleeveIsWellInside) {
  Bagged t;
  t.steps(500);
  EXPECT_EQ(bag(t.state).hoop, 0);
  t.open();
  EXPECT_TRUE(bag(t.state).open());
  EXPECT_LT(length(bag(t.state).middle(bag_model()) - kMouth), 1e-3);
}

TEST(Bag, TheClothHangsFromItsHoopAndComesToRest) {
  Bagged t;
  t.open();
  const BagState& s = bag(t.state);
  EXPECT_NEAR(lowest(s), kMouth.z - bag_model().deep, 0.008);
  EXPECT_LT(longest(s), 1.02);
  EXPECT_LT(fastest(s), 0.005);
  EXPECT_EQ(t.flags, 0u);
}

TEST(Bag, StonesThatFallThroughItsMouthAreInside) {
  Bagged t;
  t.open();
  t.fill(5);
  for (size_t i = 0; i < 5; ++i) EXPECT_TRUE(inside(t.state, i)) << i;
  t.steps(1000);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_LT(stone(t.state, i).x.z, kMouth.z - 0.03) << i;
    EXPECT_LT(length(stone(t.state, i).v), 0.02) << i << ": they come to rest";
  }
}

TEST(Bag, WhatIsInsideStaysWhileItIsSwungAndTipped) {
  Bagged t;
  t.open();
  t.fill(5);
  const Vec3d at = t.before_mouth();
  for (int i = 0; i < 4000; ++i) {
    const double a = 2 * portable::pi * i / 800;
    t.hold(at + Vec3d{0.02 * portable::sin(a), 0.012 * portable::sin(1.7 * a), 0.004 * portable::sin(a)},
           0.6 * portable::sin(0.5 * a));
    t.step();
    for (size_t k = 0; k < 5; ++k) ASSERT_TRUE(inside(t.state, k)) << k << " at " << i;
  }
  t.move(at, 0, 300);
  t.steps(1500);
  for (size_t i = 0; i < 5; ++i) EXPECT_GT(stone(t.state, i).x.z, lowest(bag(t.state))) << i;
}

TEST(Bag, NothingThrownAtTheClothFromOutsideComesIn) {
  for (const double way : {0.0, 0.9, 2.1, 3.3, 4.6}) {
    Bagged t;
    t.open();
    const Vec3d out{portable::cos(way), portable::sin(way), 0}, middle = bag(t.state).middle(bag_model());
    RigidState& s = stone(t.state, 0);
    s = {middle + 0.055 * out - Vec3d{0, 0, 0.030}, s.q, -0.5 * out + Vec3d{0, 0, 0.1}, {}, 0};
    for (int i = 0; i < 600; ++i) {
      t.step();
      ASSERT_FALSE(inside(t.state, 0)) << way << " at " << i;
    }
    EXPECT_LT(stone(t.state, 0).x.z, middle.z - 0.06) << way << ": it has fallen beside the bag";
  }
}

TEST(Bag, ShutItLetsNothingOutUpsideDown) {
  Bagged t;
  t.open();
  t.fill(5);
  t.close_slowly(kRight, 1, 1000);
  t.steps(1500);
  ASSERT_TRUE(bag(t.state).shut());
  for (int i = 1; i <= 1500; ++i) t.hold(t.tip, portable::pi * i / 1500), t.step();
  t.steps(1500);
  for (size_t i = 0; i < 5; ++i) EXPECT_TRUE(inside(t.state, i)) << i;
  EXPECT_LT(longest(bag(t.state)), 1.1);
}

TEST(Bag, OpenUpsideDownItEmptiesItself) {
  Bagged t;
  t.open();
  t.fill(3);
  for (int i = 1; i <= 1500; ++i) t.hold(t.tip, portable::pi * i / 1500), t.step();
  t.steps(3000);
  for (size_t i = 0; i < 3; ++i) EXPECT_FALSE(inside(t.state, i)) << i;
}

TEST(Bag, ItsMouthDoesNotCloseAroundAShaft) {
  Bagged t;
  t.open();
  t.close(kLeft, 1);
  const Vec3d in = normalised(kMouth - box_model().hands[kLeft].port);
  t.carry(kLeft, kMouth - 0.05 * in, kMouth + 0.02 * in, 0.1);
  t.close_slowly(kRight, 1, 1000);
  t.steps(2500);
  EXPECT_FALSE(bag(t.state).shut());
  EXPECT_GT(bag(t.state).hoop * bag_model().hoop, 0.0025);
}

TEST(Bag, ShutItsNeckInThePortItIsOutAndStaysShut) {
  Bagged t;
  t.open();
  t.fill(2);
  const Vec3d port = box_model().hands[kRight].port, along = normalised(t.tip - port);
  t.close_slowly(kRight, 1, 1000);
  t.steps(1500);
  EXPECT_EQ(bag(t.state).out, 0);
  t.move(port + 0.012 * along, 0, 1500);
  t.steps(100);
  EXPECT_EQ(bag(t.state).out, 1);
  t.close(kRight, 0);
  t.steps(1500);
  EXPECT_TRUE(bag(t.state).shut());
  EXPECT_TRUE(inside(t.state, 0) && inside(t.state, 1));
}

TEST(Bag, AClosedBagThatIsExchangedHangsAtThePort) {
  Bagged t;
  t.open();
  t.fill(1);
  ASSERT_GT(box_model().hands[kRight].rack.size(), 1u);
  t.input.tools[kRight].instrument = 1;
  t.steps(4000);
  EXPECT_EQ(t.tool(kRight).instrument, 1);
  EXPECT_EQ(bag(t.state).out, 1) << "a hand draws it shut before it draws it out";
  EXPECT_TRUE(inside(t.state, 0));
  EXPECT_LT(length(bag(t.state).frame.tip - box_model().hands[kRight].port), 0.02);
}

TEST(Bag, BitsAreTheSameOnOneThreadAndOnTwo) {
  core::ThreadPool two(2);
  State s = initial_state(box_model()), other = s;
  Work w = make_work(box_model()), other_work = make_work(box_model(), &two);
  Bagged t;
  t.move(t.before_mouth(), 0, 300);
  for (int i = 0; i < 2500; ++i) {
    step(box_model(), t.input, s, w);
    step(box_model(), t.input, other, other_work);
  }
  EXPECT_GT(bag(s).hoop, 0.9);
  EXPECT_EQ(hash_of(s), hash_of(other));
}

TEST(Bag, SavedAndPoisonedItGoesOnTheSame) {
  Bagged t;
  t.open();
  t.fill(3);
  State saved = t.state;
  Work fresh = make_work(box_model());
  for (int i = 0; i < 300; ++i) {
    t.step();
    poison(fresh);
    step(box_model(), t.input, saved, fresh);
  }
  EXPECT_EQ(hash_of(t.state), hash_of(saved)) << first_difference(t.state, saved);
}

TEST(Bag, AKeyframeHasIt) {
  Bagged t;
  t.open();
  t.fill(2);
  State shown = initial_state(box_model());
  ASSERT_TRUE(restore_display(box_model(), display_bytes(box_model(), t.state), shown));
  const BagState &is = bag(t.state), &was = bag(shown);
  EXPECT_EQ(was.hoop, is.hoop);
  EXPECT_EQ(was.points[1].where, BagPoint::inside);
  for (size_t n = 0; n < is.x.size(); ++n) EXPECT_LT(length(was.x[n] - is.x[n]), 2e-5) << n;
}
