// Walls stop instruments, and what all of it does at the trocar.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "../sim/small_scene.hpp"

using namespace trocar;
using namespace trocar::interactions;
using small::kGrasper;

namespace {

constexpr double kFloor = -0.020;      ///< of the small scene [m]
constexpr double kSide = 0.095;        ///< where a test puts an upright wall: it faces -x [m]
constexpr double kJawRadius = 0.0018;  ///< of its grasper's closed jaws [m]

Vec3d tip_of(const small::Table& t) { return t.work.shapes[kGrasper].frame.tip; }
Vec3d force_on(const small::Table& t) {
  const double* f = t.tool(kGrasper).contact_force;
  return {f[0], f[1], f[2]};
}

/// The closed grasper above a free place of the floor, then 15 mm into it.
struct Pressed : small::Table {
  Pressed() : Table(small::model()) {
    close(kGrasper, 1);
    carry(kGrasper, {0.055, 0, 0.04}, {0.085, -0.030, 0.010}, 0.2);
    carry(kGrasper, {0.085, -0.030, 0.010}, {0.085, -0.030, kFloor - 0.015}, 0.3);
    steps(50);
  }
};

TEST(Walls, HideWhatIsBehindThemFromTheFrontAlone) {
  small::Table t(small::model());
  t.step();
  const Vec3d above{0.090, -0.040, 0.010}, below{0.090, -0.040, kFloor - 0.010};
  const auto seen = [&t](Vec3d eye, Vec3d point) {
    return sim::unoccluded(t.model, t.state, t.work, eye, point, 0.0015, -1, -1);
  };
  EXPECT_TRUE(seen(above, {0.090, -0.040, kFloor + 0.002}));
  EXPECT_FALSE(seen(above, below));
  EXPECT_TRUE(seen(below, above)) << "an endoscope that is drawn back into its trocar looks through the wall";
}

TEST(Walls, StopAnInstrumentAndPressBackWithABoundedForce) {
  Pressed t;
  EXPECT_NEAR(tip_of(t).z, kFloor + kJawRadius, 1e-4);
  EXPECT_GT(force_on(t).z, 5);
  EXPECT_LE(length(force_on(t)), 15);
}

/// A leaning hook is held above the floor and turned all around.
TEST(Walls, StopAHooksFootAsItsWire) {
  scene::Description d = small::description();
  scene::Instrument& i = d.instruments[kGrasper];
  i.kind = ToolKind::hook;
  i.jaw_length = 0.012, i.jaw_thickness = 0.0012, i.opening = 0, i.foot = 0.004;
  const sim::Model model = scene::compile(d);
  small::Table t(model);
  t.carry(kGrasper, {0.055, 0, 0.04}, {0.090, -0.040, 0}, 0.2);
  t.carry(kGrasper, {0.090, -0.040, 0}, {0.090, -0.040, kFloor - 0.003}, 0.1);
  double lowest = 1, highest = -1;
  for (int turn = 0; turn < 600; ++turn) {
    t.input.tools[kGrasper].roll += 0.0105f;
    t.step();
    const ToolShape& s = t.work.shapes[kGrasper];
    double z = 1;
    for (const int part : {kJawA, kJawB}) z = std::min(z, s.part[part].b.z - s.part[part].radius);
    lowest = std::min(lowest, z), highest = std::max(highest, z);
  }
  EXPECT_GT(lowest, kFloor - 2e-4);
  EXPECT_LT(highest, kFloor + 2e-4) << "whichever is lower rests on it";
}

TEST(Walls, LetGoOfAnInstrumentAsSoonAsTheHandWithdraws) {
  Pressed t;
  t.point(kGrasper, {0.085, -0.030, kFloor + 0.010});
  t.steps(60);
  EXPECT_NEAR(tip_of(t).z, kFloor + 0.010, 1e-5);
  EXPECT_EQ(length(force_on(t)), 0);
}

TEST(Walls, LetAnInstrumentSlideAlongThem) {
  Pressed t;
  const double from = tip_of(t).x;
  t.carry(kGrasper, {0.085, -0.030, kFloor - 0.005}, {0.065, -0.030, kFloor - 0.005}, 0.1);
  t.steps(100);
  EXPECT_LT(tip_of(t).x, from - 0.014);
  EXPECT_NEAR(tip_of(t).z, kFloor + kJawRadius, 2e-4);
}

/// The small scene with an upright wall beside the floor, which leans over it by so much.
sim::Model with_corner(double leans) {
  scene::Description d = small::description();
  scene::Wall side;
  side.name = "side";
  side.rows = side.columns = 3;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      const double up = -0.010 + 0.015 * c;
      side.net.push_back({kSide - std::sin(leans) * up, 0.05 - 0.05 * r, kFloor + std::cos(leans) * up});
    }
  d.walls.push_back(side);
  return scene::compile(d);
}
/// Into that corner, `beyond` the side and `below` the floor.
small::Table pressed_into_corner(const sim::Model& model, double beyond, double below) {
  small::Table t(model);
  const Vec3d above{0.080, -0.030, 0.0}, over{0.080, -0.030, kFloor + 0.005};
  t.close(kGrasper, 1);
  t.carry(kGrasper, {0.055, 0, 0.04}, above, 0.2);
  t.carry(kGrasper, above, over, 0.2);
  t.carry(kGrasper, over, {kSide + beyond, -0.030, kFloor - below}, 0.1);
  t.steps(100);
  return t;
}

TEST(Walls, InACornerBothStopItAndTheirForcesAdd) {  // [wall corner]
  const sim::Model model = with_corner(0);
  const double beyond = 0.008, below = 0.012;
  const small::Table t = pressed_into_corner(model, beyond, below);
  EXPECT_NEAR(tip_of(t).x, kSide - kJawRadius, 1e-4);
  EXPECT_NEAR(tip_of(t).z, kFloor + kJawRadius, 1e-4);
  EXPECT_NEAR(force_on(t).x, -500 * (beyond + kJawRadius), 0.2);
  EXPECT_NEAR(force_on(t).y, 0, 0.2);
  EXPECT_NEAR(force_on(t).z, 500 * (below + kJawRadius), 0.2);
}

TEST(Walls, InACornerTheirForceIsBoundedAsOfOneWall) {
  const sim::Model model = with_corner(0);
  EXPECT_NEAR(length(force_on(pressed_into_corner(model, 0.03, 0.03))), 15, 1e-6);
}

TEST(Walls, InAnAcuteCornerItIsInFrontOfBoth) {  // [wall corner]
  const double leans = 0.35;
  const sim::Model model = with_corner(leans);
  const small::Table t = pressed_into_corner(model, 0.006, 0.010);
  const Vec3d out{-std::cos(leans), 0, -std::sin(leans)};
  EXPECT_NEAR(dot(tip_of(t) - Vec3d{kSide, -0.030, kFloor}, out), kJawRadius, 2e-4);
  EXPECT_NEAR(tip_of(t).z, kFloor + kJawRadius, 2e-4);
}

TEST(Walls, AreNotPassedWhateverTheHandDoes) {
  small::Table t(small::model());
  t.close(kGrasper, 1);
  core::Random random(3);
  double lowest = 1;
  for (int move = 0; move < 40; ++move) {
    t.point(kGrasper, {random.uniform(0.07, 0.095), random.uniform(-0.045, -0.025), random.uniform(-0.06, 0.0)});
    for (int i = 0; i < 60; ++i) {
      t.step();
      if (std::fabs(tip_of(t).y) < 0.048 && tip_of(t).x < 0.098) lowest = std::min(lowest, tip_of(t).z);
    }
  }
  EXPECT_GT(lowest, kFloor);
}

ToolState deep(double depth) {
  ToolState s;
  s.depth = depth;
  s.aperture = 0;
  return s;
}

TEST(Lever, AForceAcrossTheTipIsBornByHandAndAbdominalWallAsTheLeverRuleSays) {
  const ToolModel m;  // straight down, 310 mm long
  ToolState s = deep(0.200);
  s.contact_force[0] = 1;
  const TrocarLoad load = load_at_trocar(m, s, TouchBook{});
  EXPECT_NEAR(load.by_hand.x, 200.0 / 110, 1e-9);
  EXPECT_NEAR(load.on_wall.x, 1 + 200.0 / 110, 1e-9);
  EXPECT_NEAR(length(load.moment), 0.200, 1e-12);
  EXPECT_NEAR(load.turning, 0, 1e-12);
}

TEST(Lever, AForceAlongTheShaftIsTheHandsAlone) {
  const ToolModel m;
  ToolState s = deep(0.150);
  s.contact_force[2] = 2;
  const TrocarLoad load = load_at_trocar(m, s, TouchBook{});
  EXPECT_NEAR(load.by_hand.z, -2, 1e-12);
  EXPECT_LT(length(load.on_wall), 1e-12);
}

TEST(Lever, HandTissueAndAbdominalWallAreInEquilibrium) {
  core::Random random(5);
  const auto any = [&random] { return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
  ToolModel m;
  m.port = {0.1, -0.07, -0.01};
  for (int trial = 0; trial < 50; ++trial) {
    ToolState s = deep(random.uniform(0.06, 0.25));
    s.yaw = random.uniform(-1, 1);
    s.pitch = random.uniform(-1, 1);
    const Vec3d f = any();
    s.contact_force[0] = f.x, s.contact_force[1] = f.y, s.contact_force[2] = f.z;
    s.holds = 2;
    for (int h = 0; h < 2; ++h) {
      const Vec3d g = any();
      s.hold[h].local[2] = float(random.uniform(0, 0.02));
      s.hold[h].force[0] = float(g.x), s.hold[h].force[1] = float(g.y), s.hold[h].force[2] = float(g.z);
    }
    const TrocarLoad load = load_at_trocar(m, s, TouchBook{});
    const Vec3d axis = kinematics::forward(m.port, s.pose()).axis();
    EXPECT_LT(length(load.force + load.by_hand - load.on_wall), 1e-9);
    const Vec3d handle = -(m.shaft_length - s.depth) * axis;
    EXPECT_LT(length(load.moment + cross(handle, load.by_hand) - load.turning * axis), 1e-9);
    EXPECT_LT(std::fabs(dot(load.on_wall, axis)), 1e-9);
  }
}

TEST(Lever, APressOnTheFloorIsFeltAtTheHandle) {
  Pressed t;
  const TrocarLoad load = load_at_trocar(t.model.placed(kGrasper), t.tool(kGrasper), t.state.touches[kGrasper]);
  EXPECT_LT(length(load.force - force_on(t)), 1e-12);
  const Vec3d arm = tip_of(t) - t.model.hands[kGrasper].port;
  EXPECT_LT(length(load.moment - cross(arm, load.force)), 1e-3 * length(arm) * length(load.force));
  EXPECT_GT(length(load.by_hand), 1);
}

}  // namespace
