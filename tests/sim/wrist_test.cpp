// Instruments that bend, in the whole tick.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/sim/recording/input_code.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "small_scene.hpp"

namespace trocar::sim {
namespace {

using small::kGrasper;
using small::Table;

/// The small scene, its grasper with a wrist.
Model bending(bool flexible = false) {
  scene::Description d = small::description();
  for (scene::Instrument& i : d.instruments) {
    if (i.name != "grasper") continue;
    i.jaw_length = 0.012;
    i.wrist.there = true;
    if (!flexible) continue;
    i.wrist.mechanism.file = "flexible_instrument.json";
    i.wrist.mechanism.description = std::make_shared<const kinematics::MechanismDescription>(
        scene::read_mechanism(TROCAR_SOURCE_DIR "/scenes/mechanisms/flexible_instrument.json"));
  }
  return scene::compile(d);
}
const Model& wristed() {
  static const Model model = bending();
  return model;
}
const Model& redundant() {
  static const Model model = bending(true);
  return model;
}

TEST(Wrist, BendsNoFasterThanItMayAndAsFarAsItCan) {
  Table t(wristed());
  t.steps(5);
  t.input.wrists[kGrasper] = {2.5f, -0.3f};
  double last = 0;
  for (int i = 0; i < 600; ++i) {
    t.step();
    const double now = joints_of(t.state, kGrasper).angle[0];
    EXPECT_LE(now - last, 6e-3 + 1e-12);
    last = now;
  }
  const interactions::ToolModel& tool = t.model.placed(kGrasper);
  EXPECT_NEAR(last, tool.bends.high[0], 1e-9);
  EXPECT_NEAR(joints_of(t.state, kGrasper).angle[1], -0.3, 1e-6);
  const interactions::ToolShape shape = shape_of(t.model, t.state, kGrasper);
  EXPECT_NEAR(dot(shape.frame.axis(), shape.shaft.axis()), std::cos(last) * std::cos(0.3), 1e-6);
  EXPECT_LT(length(shape.part[interactions::kShaft].b - shape.link[0].a), 1e-15) << "links begin where the shaft ends";
  EXPECT_LT(length(shape.link[shape.links - 1].b - shape.pivot), 1e-15) << "and end at the jaws";
}

TEST(Wrist, IsStraightInItsSleeve) {
  Table t(wristed());
  t.input.wrists[kGrasper] = {0.8f, 0.4f};
  t.input.tools[kGrasper].depth = 0.020f;
  t.steps(1500);
  EXPECT_FALSE(joints_of(t.state, kGrasper).bent());
}

TEST(Wrist, StraightensBeforeItIsExchanged) {
  Table t(wristed());
  t.input.wrists[kGrasper] = {0.8f, 0};
  t.steps(400);
  ASSERT_TRUE(joints_of(t.state, kGrasper).bent());
  const double depth = t.tool(kGrasper).depth;
  t.input.tools[kGrasper].instrument = 1;
  while (joints_of(t.state, kGrasper).bent()) {
    t.step();
    ASSERT_LT(t.state.tick, 2000u);
    EXPECT_GT(t.tool(kGrasper).depth, depth - 0.001) << "not drawn back while it is bent";
  }
  t.steps(1500);
  EXPECT_EQ(t.tool(kGrasper).instrument, 1);
}

TEST(Wrist, ARedundantChainBringsTheTipWhereTheHandLeadsIt) {
  Table t(redundant());
  t.input.tools[kGrasper].depth = 0.095f;  // out of its sleeve, and beside all tissue
  t.input.tools[kGrasper].yaw = -0.9f;
  t.steps(800);
  t.input.wrists[kGrasper] = {0.7f, -0.5f};
  t.steps(1500);
  const ToolInput& in = t.input.tools[kGrasper];
  const kinematics::TipFrame led =
      kinematics::led(t.model.hands[kGrasper].port, pose_of(in), double(0.7f), double(-0.5f));
  const kinematics::TipFrame now = tip_frame_of(t.model, t.state, kGrasper);
  EXPECT_LT(length(now.tip - led.tip), 5e-4);
  EXPECT_GT(dot(now.axis(), led.axis()), std::cos(0.02));
  const interactions::ToolShape shape = shape_of(t.model, t.state, kGrasper);
  const Vec3d shaft = shape.part[interactions::kShaft].b - t.model.hands[kGrasper].port;
  EXPECT_LT(length(cross(shaft, shape.shaft.axis())), 1e-12) << "through its trocar";
}

TEST(Wrist, WhatIsNoNumberMovesNothing) {
  Table t(wristed());
  t.steps(5);
  const State before = t.state;
  t.input.wrists[kGrasper].pitch = std::nanf("");
  t.step();
  EXPECT_TRUE(t.flags & StepReport::kBadInput);
  EXPECT_EQ(t.state.joints[kGrasper].angle[0], before.joints[kGrasper].angle[0]);
}

TEST(Wrist, GripsAndLiftsBentAsItDoesStraight) {
  Table t(wristed());
  const interactions::StrandBody& tube = t.model.strand_bodies[small::kTube];
  const Vec3d at = interactions::point_at(tube, t.state.strands[small::kTube], interactions::place_at(tube, 0.056));
  // Bent by half a radian in the plane across the tube, the jaws still come from above.
  const interactions::ToolModel& tool = t.model.placed(kGrasper);
  const Vec3d out = normalised(tool.port - at);
  const Vec3d in = -out;
  kinematics::Goal goal;
  goal.turn_too = false;
  const Vec3d bent = normalised(in + 0.4 * cross(in, Vec3d{1, 0, 0}));
  const Vec3d x = any_perpendicular(-bent);
  goal.rotation = Mat3d::from_columns(x, cross(-bent, x), -bent);
  kinematics::Arm arm{t.tool(kGrasper).pose(), {}};
  const auto go = [&](double before, int ticks) {
    goal.tip = at + (tool.jaw_length - 0.007 - before) * bent;
    arm = kinematics::reach(tool.bends, tool.limits, tool.port, tool.jaw_length, goal, arm, 60);
    t.input.tools[kGrasper] = tool_input(arm.pose, t.input.tools[kGrasper].handle);
    t.input.wrists[kGrasper] = {float(arm.joints.angle[0]), float(arm.joints.angle[1])};
    t.steps(ticks);
  };
  go(0.03, 800);
  for (int i = 30; i >= 0; --i) go(0.001 * i, 20);
  t.close_slowly(kGrasper, 0.95, 400);
  EXPECT_GT(t.tool(kGrasper).holds, 0);
}

TEST(Wrist, KeyframesShowHowItIsBent) {
  Table t(wristed());
  t.input.wrists[kGrasper] = {0.6f, 0.2f};
  t.steps(300);
  const std::vector<std::uint8_t> bytes = display_bytes(t.model, t.state);
  State shown = initial_state(t.model);
  ASSERT_TRUE(restore_display(t.model, bytes, shown));
  EXPECT_EQ(shown.joints[kGrasper].angle[0], t.state.joints[kGrasper].angle[0]);
}

TEST(Wrist, InputsWithoutOneAreCodedAsTheyWere) {
  InputCode code;
  Input input;
  input.tools[1].yaw = 0.3f;
  code.add(input);
  const core::ByteView bytes = code.bytes();
  EXPECT_LE(bytes.size(), 8u) << "a mask of the first words, one word";
  std::vector<Input> read;
  ASSERT_TRUE(append_inputs(bytes, 1, read));
  EXPECT_FALSE(read[0].bends());
}

TEST(Wrist, TwiceTheSameHandsGiveTheSameBits) {
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    Table t(redundant());
    t.input.tools[kGrasper].depth = 0.095f;
    t.input.tools[kGrasper].yaw = -0.9f;
    t.steps(600);
    for (int i = 0; i < 800; ++i) {
      t.input.wrists[kGrasper] = {float(0.8 * std::sin(0.01 * i)), float(0.6 * std::sin(0.013 * i))};
      t.step();
    }
    hash = hash_of(t.state);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace trocar::sim
