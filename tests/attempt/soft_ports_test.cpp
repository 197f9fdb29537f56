// A box of software whose rubber ports give and wander: by how much what is read of it is beside what hands do.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/attempt/box/soft_ports.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::attempt {
namespace {

constexpr int kHand = small::kGrasper;

sim::Input leaning(float yaw) {
  sim::Input in = small::model().start;
  in.tools[kHand].yaw = yaw;
  in.tools[kHand].pitch = 0.2f;
  in.tools[kHand].depth = 0.12f;
  return in;
}

TEST(SoftPorts, RigidOnesChangeNoInput) {
  const std::vector<sim::Input> inputs(3, leaning(0.4f));
  const std::vector<sim::Input> same = measured_through(small::model(), {}, inputs);
  EXPECT_EQ(same[2].tools[kHand].yaw, inputs[2].tools[kHand].yaw);
  EXPECT_EQ(same[2].tools[kHand].depth, inputs[2].tools[kHand].depth);
}

TEST(SoftPorts, TheTipIsTakenForBesideWhereItIsByJustThePortsDisplacement) {
  const sim::Model& model = small::model();
  const interactions::ToolModel& tool = model.placed(kHand);
  const SoftPorts ports{1000, 0.003, 4};
  const std::vector<sim::Input> meant(60'000, leaning(0.4f));
  const std::vector<sim::Input> read = measured_through(model, ports, meant);
  double most = 0;
  for (const std::size_t i : {std::size_t(0), std::size_t(25'000), std::size_t(59'000)}) {
    const kinematics::FulcrumPose pose = pose_of(meant[i].tools[kHand]), measured = pose_of(read[i].tools[kHand]);
    const Vec3d shift = displaced(ports, kHand, tool, pose, 1e-3 * double(i));
    // where the instrument is: from the hand's handle through the displaced port
    const Vec3d handle = tool.port - (tool.shaft_length - pose.depth) * kinematics::forward({}, pose).axis();
    const Vec3d real = handle + tool.shaft_length * normalised(tool.port + shift - handle);
    const Vec3d taken_for = kinematics::forward(tool.port, measured).tip;
    EXPECT_LT(length(real - taken_for - shift), 1e-7) << i;
    const Vec3d meant_at = kinematics::forward(tool.port, pose).tip;
    const double lever = pose.depth / (tool.shaft_length - pose.depth);
    EXPECT_NEAR(length(taken_for - meant_at), lever * length(shift), 0.15 * lever * length(shift) + 1e-6) << i;
    most = std::max(most, length(shift));
  }
  EXPECT_GT(most, 0.0005);
}

TEST(SoftPorts, GiveAsTheRubberPressesDividedByItsStiffness) {
  const sim::Model& model = small::model();
  const interactions::ToolModel& tool = model.placed(kHand);
  const kinematics::FulcrumPose pose{0.6, 0, 0, 0.12};
  const double firm = length(displaced({4000, 0, 1}, kHand, tool, pose, 0));
  const double soft = length(displaced({1000, 0, 1}, kHand, tool, pose, 0));
  EXPECT_NEAR(soft, 4 * firm, 1e-12);
  // 0.3 N m/rad * 0.6 rad / 0.19 m across, and a quarter of 1.5 N, both in the plane of the lean
  const double rubber = 0.3 * 0.6 / 0.19 * std::cos(0.6), weight = 0.25 * 1.5 * std::sin(0.6);
  EXPECT_NEAR(soft, (rubber + weight) / 1000, 1e-6);
  EXPECT_LT(length(displaced({1000, 0, 1}, kHand, tool, {0, 0, 0, 0.12}, 0)), 1e-12) << "upright nothing presses";
}

TEST(SoftPorts, WanderNoFartherThanOrderedAndOfASeedAlwaysAlike) {
  const sim::Model& model = small::model();
  for (double s = 0; s < 300; s += 1.7) {
    const Vec3d a = displaced({0, 0.003, 8}, kHand, model.placed(kHand), {}, s);
    EXPECT_LE(length(a), 0.003 + 1e-12);
    EXPECT_EQ(a.x, displaced({0, 0.003, 8}, kHand, model.placed(kHand), {}, s).x);
  }
  EXPECT_NE(displaced({0, 0.003, 8}, 0, model.placed(0), {}, 30).x,
            displaced({0, 0.003, 8}, 1, model.placed(1), {}, 30).x)
      << "each port by itself";
}

}  // namespace
}  // namespace trocar::attempt
