// From the State to what a device renders, and from the device to the input.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/attempt/haptics/haptic_source.hpp>
#include <trocar/attempt/press.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

namespace trocar::attempt {
namespace {

using devices::SimulatedDevice;

const attempt::Lesson& scene() {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("gynaecology");
  return *lesson;
}

Press press() {
  const sim::Model& model = scene().model;
  return plan_press(model, model.organ_index("uterus"), 0.004);
}

/// A press by a device that is led.
struct PressingDevice {
  explicit PressingDevice(const Press& plan)
      : hands(scene().model, plan),
        hand(scene().model, plan.hand, std::make_unique<SimulatedDevice>(), HapticHand::Pace::with_ticks,
             HapticHand::Feel{.seal_friction = 0}),
        source(hands, hand) {}
  PressSource hands;
  HapticHand hand;
  HapticSource source;
};

/// What the local model pushes with where the hand is [N].
Vec3d rendered(const devices::LocalModel& m, Vec3d at) {
  const std::span<const devices::ContactPlane> planes(m.plane, size_t(m.planes));
  Vec3d f = m.stiffness * (devices::nearest_allowed(at, planes) - at);
  if (m.holds) f += m.held_stiffness * (m.held_at - at);
  return f;
}

TEST(ContactModeller, AtTheHandsPlaceTheModelPushesWithTheForceOfTheLastFourTicksAcrossTheSurface) {
  const Press plan = press();
  PressSource hands(scene().model, plan);
  attempt::Session session(scene(), 1);
  ContactModeller modeller(scene().model, plan.hand);
  sim::Input input;
  int compared = 0;
  double most = 0;
  std::array<Vec3d, 4> last{};
  while (compared < 400 && hands.next(session.state(), input)) {
    session.advance(input);
    const Vec3d wanted =
        kinematics::forward(scene().model.hands[size_t(plan.hand)].port, pose_of(input.tools[plan.hand])).tip;
    const devices::LocalModel m = modeller.of(session.state(), wanted, 0);
    ASSERT_LE(m.planes, devices::kMostPlanes);
    last[session.state().tick % 4] = forces_at_tip(scene().model, session.state(), plan.hand).contact;
    const Vec3d force = 0.25 * (last[0] + last[1] + last[2] + last[3]);
    if (!(length(force) > 0.05) || m.planes != 1) continue;
    const Vec3d felt = rendered(m, wanted);
    EXPECT_NEAR(dot(felt, m.plane[0].normal), dot(force, m.plane[0].normal), 0.02 * length(force) + 1e-6);
    EXPECT_GE(m.stiffness, 30);
    EXPECT_LE(m.stiffness, 1000);
    most = std::max(most, length(felt));
    ++compared;
  }
  std::printf("    %d ticks compared, most %.2f N\n", compared, most);
  EXPECT_GT(compared, 200);
}

TEST(ContactModeller, AForceAcrossTheShaftIsFeltAtTheTipByItsLever) {
  sim::State state = sim::initial_state(scene().model);
  interactions::ToolState& tool = state.tools[0];
  const interactions::ToolModel& held = scene().model.tool(state, 0);
  const interactions::ToolShape shape = interactions::shape_of(held, tool.pose(), tool.aperture);
  const Vec3d across = shape.frame.opening(), axis = shape.frame.axis();
  const Vec3d f = 2.0 * across + 0.5 * axis;
  tool.contact_force[0] = f.x, tool.contact_force[1] = f.y, tool.contact_force[2] = f.z;
  const Vec3d at = forces_at_tip(scene().model, state, 0).contact;  // nothing says where: at the tip
  EXPECT_NEAR(dot(at, across), 2, 1e-12);
  EXPECT_NEAR(dot(at, axis), 0.5, 1e-12);
  interactions::TouchBook& book = state.touches[0];
  book.count = 1;
  book.touch[0] = {};
  book.touch[0].anchored = 1;
  book.touch[0].part = interactions::kShaft;
  book.touch[0].force = 1;
  const double share = dot(place_of(shape, book.touch[0]) - held.port, axis) / tool.depth;
  ASSERT_LT(share, 0.95);
  const Vec3d nearer = forces_at_tip(scene().model, state, 0).contact;
  EXPECT_NEAR(dot(nearer, across), 2 * share, 1e-12);
  EXPECT_NEAR(dot(nearer, axis), 0.5, 1e-12);
}

TEST(StiffnessEstimate, FindsASpringThatIsMovedAndKeepsToItsBoundsWhereItIsNot) {
  StiffnessEstimate found(200), still(200);
  for (int i = 0; i < 400; ++i) {
    const double x = 0.002 * std::sin(0.05 * i);
    found.add(x, 1 - 600 * x);
    still.add(0.001, 1);
  }
  EXPECT_NEAR(found.stiffness(), 600, 20);
  EXPECT_EQ(still.stiffness(), 200);
}

/// A press until it has lasted half a second.
struct Run {
  std::vector<sim::Input> inputs;
  std::uint64_t mark = 0;
  Json said;
};
Run run_of(InputSource& source, int hand) {
  attempt::Session session(scene(), 1);
  Run run;
  int touched = 0;
  sim::Input input;
  while (touched < 500 && source.next(session.state(), input)) {
    source.after(session.state(), session.advance(input));
    run.inputs.push_back(input);
    touched += length(forces_at_tip(scene().model, session.state(), hand).contact) > 0.01;
  }
  run.mark = session.mark();
  run.said = source.describe();
  return run;
}
const Run& felt() {
  static const Run run = [] {
    const Press plan = press();
    PressingDevice device(plan);
    return run_of(device.source, plan.hand);
  }();
  return run;
}

TEST(HapticHand, ADeviceThatPressesIsPushedBack) {
  const Json said = felt().said["haptics"];
  EXPECT_GT(said["most_force_N"].get<double>(), 0.1);
  EXPECT_LT(said["most_force_N"].get<double>(), 10);
  EXPECT_GT(said["impulse_Ns"].get<double>(), 0.005);
  EXPECT_EQ(said["device"], "simulated");
}

TEST(HapticHand, WhatADeviceDidIsReplayedFromInputsAloneToTheSameBits) {
  attempt::Session again(scene(), 1);
  for (const sim::Input& i : felt().inputs) again.advance(i);
  EXPECT_EQ(again.mark(), felt().mark);
}

/// A device that says what a test wants.
class Scripted : public devices::HapticDevice {
 public:
  explicit Scripted(devices::HapticSample& sample) : m_sample(sample) { m_capabilities.own_damping = 5; }
  void open() override {}
  void close() noexcept override {}
  const devices::HapticCapabilities& capabilities() const noexcept override { return m_capabilities; }
  bool read(devices::HapticSample& sample) noexcept override {
    sample = m_sample;
    return true;
  }
  void write(const devices::HapticForce&) noexcept override {}

 private:
  devices::HapticSample& m_sample;
  devices::HapticCapabilities m_capabilities;
};

TEST(HapticHand, MovesTheTipByThePicturesDirectionsClosesByItsSwitchAndStaysWhileItIsLifted) {
  const sim::Model& model = scene().model;
  sim::State state = sim::initial_state(model);
  devices::HapticSample sample;
  HapticHand hand(model, 0, std::make_unique<Scripted>(sample), HapticHand::Pace::with_ticks, {});
  const auto tip_of_input = [&model](const sim::Input& i) {
    return kinematics::forward(model.hands[0].port, pose_of(i.tools[0])).tip;
  };
  const kinematics::ScopeFrame view =
      kinematics::scope_frame(model.scope.port, pose_of(state.scope), model.scope.angle, state.scope.post);
  const Vec3d start = tip_of_input(model.start);
  sim::Input input = model.start;
  hand.lead(state, input);
  EXPECT_LT(length(tip_of_input(input) - start), 1e-5) << "no jump when it takes over";
  sample.position = {0.004, 0.003, -0.002};
  sample.switches = 1;
  float handle = 0;
  for (int i = 0; i < 100; ++i) {
    input = model.start;
    input.tools[0].handle = 0;
    hand.lead(state, input);
    EXPECT_GE(input.tools[0].handle, handle);
    handle = input.tools[0].handle;
  }
  const Vec3d moved = tip_of_input(input) - start;
  EXPECT_NEAR(dot(moved, view.right), 0.004, 1e-5);
  EXPECT_NEAR(dot(moved, view.forward), 0.003, 1e-5);
  EXPECT_NEAR(dot(moved, view.up), -0.002, 1e-5);
  EXPECT_NEAR(handle, 0.16, 0.01);
  sample.switches = 8;  // lifted
  sample.position = {0, 0, 0};
  input = model.start;
  hand.lead(state, input);
  sample.switches = 0;
  hand.lead(state, input);
  EXPECT_LT(length(tip_of_input(input) - start - moved), 1e-5);
}

TEST(HapticHand, IsChosenByItsTrocarAndOneThatIsNotThereIsToldWithThoseThatAre) {
  const sim::Model& model = scene().model;
  EXPECT_EQ(haptic_hand_of(model, model.hands[1].name, "--haptics-hand"), 1);
  EXPECT_GE(haptic_hand_of(model, "", "--haptics-hand"), 0);
  try {
    haptic_hand_of(model, "nobody", "--haptics-hand");
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find(model.hands[0].name), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::attempt
