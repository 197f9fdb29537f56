// The short form of the abuse soak: one organ of each kind for a moment, and all come back.
#include "abuse.hpp"

#include <gtest/gtest.h>

#include "shipped.hpp"

using namespace trocar;

TEST(Abuse, OrgansBearSomeSecondsAndReturnToTheirShape) {
  const sim::Model model = abuse::untearable(shipped("gynaecology"));
  abuse::Attack attack(model, 3);
  const abuse::Round r = attack.round(abuse::number_of(model, "tube_left"), 3, 2500);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.grasps, 0);
  EXPECT_TRUE(r.let_go);
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to them";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}

TEST(Abuse, ALiverThatCanBeCutBearsItAndReturnsToItsShape) {
  const sim::Model model = abuse::untearable(shipped("cutting"));
  abuse::Attack attack(model, 4);
  const abuse::Round r = attack.round(0, 4, 2500);
  std::printf("%d grasps, at most %.3f J and %.1f N, %.2f %% off after the rest\n", r.grasps, r.most_energy,
              r.most_force, 100 * r.worst().share);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to it";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  EXPECT_TRUE(r.let_go);
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}

TEST(Abuse, ALiverCutAtRandomStaysFinite) {
  const sim::Model& model = shipped("cutting");
  abuse::Attack attack(model, 5, true);
  const abuse::Round r = attack.round(0, 6, 0);
  std::printf("%d cuts, at most %.3f J and %.1f N\n", attack.state().cut_count, r.most_energy, r.most_force);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(attack.state().cut_count, 0);
  EXPECT_LT(r.most_energy, 5) << "[J]";
}

TEST(Abuse, TissueThatTearsStaysFinite) {
  const sim::Model& model = shipped("gynaecology");
  int tears = 0;
  for (const std::uint64_t seed : {1, 3}) {
    abuse::Attack attack(model, seed);
    const abuse::Round r = attack.round(abuse::number_of(model, "tube_left"), 2.5, 0);
    std::printf("%d tears, at most %.3f J and %.1f N\n", r.tears, r.most_energy, r.most_force);
    EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, 5) << "[J]";
    tears += r.tears;
  }
  EXPECT_GT(tears, 0);
}

TEST(Abuse, WildFeetOnPedalsAndValvesLeaveNumbersFiniteAndTheAccountExact) {
  const sim::Model& model = shipped("bleeding");
  abuse::Attack attack(model, 8, true);
  for (int round = 0; round < 2; ++round) {
    const abuse::Round r = attack.round(size_t(round), 1.5, 0);
    EXPECT_EQ(r.first_bad_tick, 0u) << r.organ << ", flags " << r.flags;
    EXPECT_LT(r.most_energy, 5) << "[J] " << r.organ;
    EXPECT_EQ(abuse::broken(model, attack.state()), "") << r.organ;
  }
  const sim::State& s = attack.state();
  const double irrigated = 1e-9 * double(s.fluids.ledger.in[size_t(fluids::Source::kIrrigated)].total());
  std::printf("pedals %x, %.1f mL of water, %.2f mL of blood, %d bricks of heat awake, fog %.2g\n", attack.pressed(),
              irrigated, 1e-9 * double(s.flow.bled), tissue::bricks_awake(s.heat), s.fluids.smoke.fog);
  EXPECT_NE(attack.pressed() & sim::kBlue, 0u);
  EXPECT_NE(attack.pressed() & sim::kYellow, 0u);
  EXPECT_NE(attack.pressed() & sim::kWipe, 0u);
  EXPECT_GT(irrigated, 0.1) << "[mL] a valve was open with the irrigator in hand";
}

TEST(Abuse, HandsThatJumpWithAnyBitsOfPedalsLeaveNumbersFiniteAndTheAccountExact) {
  const sim::Model& model = shipped("bleeding");
  sim::State s = sim::initial_state(model);
  sim::Work w = sim::make_work(model);
  core::Random random(10);
  sim::Input in = model.start;
  for (int t = 0; t < 1500; ++t) {
    if (random.uniform() < 0.1)
      for (size_t h = 0; h < model.hands.size(); ++h) {
        const Vec3d tip{random.uniform(-0.06, 0.06), random.uniform(-0.19, -0.12), random.uniform(-0.16, -0.06)};
        const auto instrument = std::int32_t(t / 500 * 3 + int(h)) % std::int32_t(model.hands[h].rack.size());
        in.tools[h] = sim::tool_input(kinematics::inverse(model.hands[h].port, tip, random.uniform(-3, 3)),
                                      random.uniform() < 0.5 ? 0.0f : 1.0f, instrument);
      }
    if (random.uniform() < 0.02) in.pedals = std::uint32_t(random.next());
    const sim::StepReport report = step(model, in, s, w);
    ASSERT_TRUE(report.fine()) << "tick " << t << " body " << report.first_bad_body.code();
    if (t % 50 != 0) continue;
    ASSERT_EQ(abuse::broken(model, s), "") << "tick " << t;
  }
  EXPECT_GT(s.fluids.ledger.in[size_t(fluids::Source::kIrrigated)].total(), 0);
}

TEST(Abuse, AFilledGallbladderBearsItAndKeepsItsContents) {
  const sim::Model model = abuse::untearable(shipped("gallbladder"));
  abuse::Attack attack(model, 6);
  const abuse::Round r = attack.round(abuse::number_of(model, "gallbladder"), 4, 5000);
  EXPECT_EQ(r.organ, "gallbladder");
  std::printf("%d grasps, at most %.3f J and %.1f N, %.2f %% off after the rest\n", r.grasps, r.most_energy,
              r.most_force, 100 * r.worst().share);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to it";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  const tissue::EnclosureState& inside = attack.state().membranes[0].enclosure;
  EXPECT_EQ(inside.leaking, 0u);
  EXPECT_NEAR(inside.pressure, 1000, 100);
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}

/// Loops lie loosely: they need not come back to where they lay to the tenth of a millimetre, but as loops, and whole.
TEST(Abuse, SmallBowelBearsRoughHandsAndSettlesNearItsPlace) {
  const sim::Model model = abuse::untearable(shipped("bowel"));
  abuse::Attack attack(model, 16);
  const abuse::Round r = attack.round(abuse::number_of(model, "jejunum"), 4, 4000);
  EXPECT_EQ(r.organ, "jejunum");
  std::printf("%d grasps, at most %.3f J and %.1f N, %.2f %% (%.2f mm) off after the rest\n", r.grasps, r.most_energy,
              r.most_force, 100 * r.worst().share, 1000 * r.worst().distance);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.grasps, 0);
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to it";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  EXPECT_TRUE(r.let_go);
  for (const abuse::Left& left : r.left) EXPECT_LT(left.distance, 0.010) << left.name;
}

/// Shreds beside a shaft that goes through an organ once flew off three times as fast tick by tick.
TEST(Abuse, AnInstrumentDrivenThroughALiverLeavesNumbersFinite) {
  const sim::Model& model = shipped("gallbladder");
  sim::State s = sim::initial_state(model);
  sim::Work w = sim::make_work(model);
  sim::Input in = model.start;
  const Vec3d port = model.hands[0].port, place{-0.015, 0.163, -0.125};
  const Vec3d behind = place + 0.4 * model.placed(0).jaw_length * normalised(place - port);
  const Vec3d from = kinematics::forward(port, sim::pose_of(in.tools[0])).tip;
  const double rest = abuse::energy(model, s);
  double most = 0;
  for (int t = 0; t < 1200; ++t) {
    const double way = std::min(1.0, 1e-3 * (t + 1));
    in.tools[0] = sim::tool_input(kinematics::inverse(port, from + way * (behind - from), 0.0), 0);
    const sim::StepReport report = sim::step(model, in, s, w);
    ASSERT_TRUE(report.fine()) << "tick " << t << " body " << report.first_bad_body.code();
    most = std::max(most, abuse::energy(model, s) - rest);
  }
  const int tears = int(s.cuttables[0].tets.nodes) - model.cuttables[0].body.own_nodes;
  std::printf("%d nodes more, at most %.3f J above rest\n", tears, most);
  EXPECT_GT(tears, 0);
  EXPECT_LT(most, 5) << "[J]";
}
