// An assistant's grasper that holds the gallbladder's fundus from the start, and lets it go.
#include <gtest/gtest.h>

#include <trocar/sim/stages/step.hpp>

#include "shipped.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr size_t kAssistant = 2;

const Model& operation() { return shipped("cholecystectomy_operation"); }

Vec3d middle_of_held(const Model& m, const State& s) {
  const HandModel& hand = m.hands[kAssistant];
  const tissue::NetworkModel& wall = m.membranes[size_t(hand.membrane)].sheet.network;
  Vec3d sum;
  for (const std::int32_t node : hand.held)
    sum += position(wall, s.membranes[size_t(hand.membrane)].network, node) / double(hand.held.size());
  return sum;
}

/// Where the fundus is after so long, the assistant's hand at `tip_up` above where it began, its handle so far closed.
Vec3d fundus_after(int ticks, double up, float handle) {
  const Model& m = operation();
  State s = initial_state(m);
  Work w = make_work(m);
  Input input = m.start;
  const Vec3d port = m.hands[kAssistant].port;
  const ToolInput& placed = m.start.tools[kAssistant];
  const kinematics::FulcrumPose pose{placed.yaw, placed.pitch, placed.roll, placed.depth};
  const Vec3d tip = kinematics::forward(port, pose).tip;
  for (int t = 0; t < ticks; ++t) {
    const double share = double(t + 1) / ticks;
    input.tools[kAssistant] =
        tool_input(kinematics::inverse(port, tip - Vec3d{0, share * up, 0}, double(placed.roll)), handle);
    step(m, input, s, w);
  }
  EXPECT_EQ(s.tools[kAssistant].slipped, 0);
  EXPECT_EQ(s.tools[kAssistant].holds > 0, handle > 0);
  return middle_of_held(m, s);
}

}  // namespace

TEST(Assistant, HoldsTheFundusWhereItWasDrawn) {
  const Vec3d before = middle_of_held(operation(), initial_state(operation()));
  EXPECT_LT(length(fundus_after(500, 0, 1) - before), 0.002);
}

TEST(Assistant, TheFundusGoesWhereTheHandGoes) {
  const Vec3d before = middle_of_held(operation(), initial_state(operation()));
  const Vec3d after = fundus_after(1000, 0.010, 1);
  EXPECT_NEAR(before.y - after.y, 0.010, 0.002) << "10 mm towards the feet";
}

TEST(Assistant, OpenJawsLetItFall) {
  const Vec3d before = middle_of_held(operation(), initial_state(operation()));
  const Vec3d after = fundus_after(600, 0, 0);
  EXPECT_GT(dot(after - before, normalised(operation().gravity)), 0.002);
}

TEST(Assistant, NothingElseHoldsWhatIsInTheHand) {
  const Model& m = operation();
  const HandModel& hand = m.hands[kAssistant];
  ASSERT_GE(hand.membrane, 0);
  const std::vector<std::int32_t>& fixed = m.membranes[size_t(hand.membrane)].sheet.held_nodes;
  for (const std::int32_t node : hand.held) EXPECT_EQ(std::count(fixed.begin(), fixed.end(), node), 0);
}
