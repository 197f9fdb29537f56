// Trocars that give and wander, in the whole tick.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "small_scene.hpp"

namespace trocar::sim {
namespace {

using small::kGrasper;
using small::Table;

Model with_ports(double stiffness, double drift, std::uint64_t seed = 0) {
  scene::Description d = small::description();
  for (scene::Port& p : d.ports) p.stiffness = stiffness, p.drift = drift;
  scene::vary(d, seed);
  return scene::compile(d);
}
const Model& soft() {
  static const Model model = with_ports(1000, 0);
  return model;
}

/// The grasper takes the tube and draws it aside by 6 mm.
void draw_aside(Table& t) {
  const interactions::StrandBody& tube = t.model.strand_bodies[small::kTube];
  const Vec3d at = interactions::point_at(tube, t.state.strands[small::kTube], interactions::place_at(tube, 0.056));
  const Vec3d tip = at + 0.010 * normalised(at - t.model.hands[kGrasper].port);
  t.carry(kGrasper, tip + Vec3d{0, 0, 0.03}, tip, 0.1);
  t.steps(100);
  t.close_slowly(kGrasper, 0.95, 400);
  t.carry(kGrasper, tip, tip + Vec3d{0.006, 0, 0.004}, 0.02);
}

TEST(Ports, RigidOnesAreNoStateAndLeaveTheHashAsItWas) {
  EXPECT_TRUE(initial_state(small::model()).ports.empty());
  EXPECT_EQ(with_ports(0, 0, 3).hash, with_ports(0, 0, 4).hash);
  EXPECT_NE(with_ports(0, 0.003, 3).hash, with_ports(0, 0.003, 4).hash) << "a seed of its own for what wanders";
  EXPECT_NE(soft().hash, with_ports(0, 0).hash);
}

TEST(Ports, GiveAsTheLeverOfTheInstrumentPressesOnThem) {
  Table t(soft());
  draw_aside(t);
  ASSERT_GT(t.tool(kGrasper).holds, 0);
  t.steps(1500);
  const Vec3d give = t.state.ports[kGrasper].give;
  const interactions::TrocarLoad load =
      interactions::load_at_trocar(t.model.placed(kGrasper), t.tool(kGrasper), t.state.touches[kGrasper]);
  std::printf("    on the wall %.3f N, gives %.3f mm\n", length(load.on_wall), 1e3 * length(give));
  EXPECT_GT(length(give), 1e-4);
  EXPECT_LT(length(give - load.on_wall / 1000.0), 0.02 * length(give)) << "at rest";
  const interactions::ToolShape shape = shape_of(t.model, t.state, kGrasper);
  const Vec3d beside = shape.pivot - (t.model.hands[kGrasper].port + give);
  EXPECT_LT(length(cross(beside, shape.shaft.axis())), 1e-12) << "the shaft goes through the fulcrum as it is";
  for (const size_t other : {size_t(1), size_t(2)}) EXPECT_LT(length(t.state.ports[other].give), 1e-9);
}

TEST(Ports, TheHandlesPlaceIsTheHandsAndThePullIsLessThanAtARigidOne) {
  Table firm(small::model()), yields(soft());
  draw_aside(firm);
  draw_aside(yields);
  for (Table* t : {&firm, &yields}) t->steps(1500);
  EXPECT_LT(length(yields.pull(kGrasper)), 0.98 * length(firm.pull(kGrasper)));
  const auto handle = [](const Table& t) {
    const interactions::ToolModel& tool = t.model.placed(kGrasper);
    const kinematics::TipFrame tip = kinematics::forward(port_of(t.model, t.state, kGrasper), t.tool(kGrasper).pose());
    return tip.tip - tool.shaft_length * tip.axis();
  };
  EXPECT_LT(length(handle(firm) - handle(yields)), 1e-6);
}

TEST(Ports, WanderAsFarAsTheSceneSaysAndTheInstrumentGoesAlong) {
  const Model model = with_ports(0, 0.003, 7);
  Table t(model);
  double far = 0;
  for (int i = 0; i < 21'000; ++i) {
    t.step();
    far = std::max(far, length(port_shift(t.state, kGrasper)));
  }
  EXPECT_GT(far, 0.0005);
  EXPECT_LE(far, 0.003 + 1e-12);
  const interactions::ToolShape shape = shape_of(model, t.state, kGrasper);
  EXPECT_LT(length(cross(shape.pivot - port_of(model, t.state, kGrasper), shape.shaft.axis())), 1e-12);
}

TEST(Ports, KeyframesShowWhereTheyAre) {
  Table t(soft());
  draw_aside(t);
  const std::vector<std::uint8_t> bytes = display_bytes(t.model, t.state);
  State shown = initial_state(t.model);
  ASSERT_TRUE(restore_display(t.model, bytes, shown));
  EXPECT_EQ(shown.ports[kGrasper].shift.x, t.state.ports[kGrasper].shift.x);
  EXPECT_NE(shown.ports[kGrasper].shift.x, 0);
}

TEST(Ports, TwiceTheSameHandsGiveTheSameBits) {
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    const Model model = with_ports(1000, 0.003, 9);
    Table t(model);
    draw_aside(t);
    hash = hash_of(t.state);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace trocar::sim
