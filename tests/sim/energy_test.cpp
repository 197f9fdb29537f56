// Current and heat within the step: what a hook and bipolar forceps do to the small scene, against what heat alone says
// (docs/science/heat.md), and the laws of the step while they do it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/sim/verbs/heating.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

#include "small_energy.hpp"

using namespace trocar;
using namespace trocar::sim;
using small::kBipolar, small::kHook;

namespace {

constexpr BodyId kOrgan = BodyId::organ(0);

tissue::HeatReading reading_at(const small::Table& t, BodyId body, Vec3d at) {
  return tissue::reading(t.model.energy.heat, t.state.heat, body, at);
}

/// How far below the organ's top tissue is coagulated by half [m].
double coagulated_depth(const small::Table& t, Vec3d top) {
  double deepest = 0;
  for (double deep = 0; deep < 0.01; deep += 5e-5)
    if (reading_at(t, kOrgan, top - Vec3d{0, 0, deep}).coagulated > 0.5f) deepest = deep;
  return deepest;
}

small::Table hook_on_organ(std::uint32_t pedals, double seconds) {
  small::Table t(small::energy());
  small::put_hook_down(t);
  t.input.pedals = pedals;
  t.steps(int(seconds * 1000));
  return t;
}

TEST(Energy, AHookOnAnOrganFor2SecondsCoagulatesAsDeepAsHeatAloneSays) {
  const small::Table t = hook_on_organ(kBlue, 2);
  ASSERT_EQ(t.state.electrodes[kHook].body, kOrgan);
  const Vec3d at = t.state.electrodes[kHook].at;
  const double deep = coagulated_depth(t, {at.x, at.y, 0.012});
  const tissue::DischargeFigures& now = t.state.electrodes[kHook].current.now;
  std::printf("    40 W, 2 s: coagulated %.2f mm deep, %.1f W into tissue, %.0f Ohm, %.1f J\n", 1e3 * deep, now.tissue,
              now.impedance, t.state.electrodes[kHook].current.joules);
  // Heat alone, in a half space: 3.0 mm (docs/science/heat.md). A cell for the place of the contact, one for the curved
  // skin.
  EXPECT_NEAR(deep, 3.0e-3, 1e-3);
  EXPECT_EQ(t.flags & StepReport::kHeatFull, 0u);
}

TEST(Energy, WithoutAPedalNothingIsHeated) {
  const small::Table t = hook_on_organ(0, 0.5);
  EXPECT_EQ(t.state.heat.books.given, 0);
  EXPECT_EQ(t.state.heat.listed, 0);
}

TEST(Energy, BothPedalsAtOnceGiveNothing) {
  const small::Table t = hook_on_organ(kBlue | kYellow, 0.5);
  EXPECT_EQ(t.state.heat.books.given, 0);
}

TEST(Energy, KeysOfThePanelSetThePowerWhileItRuns) {
  small::Table t = hook_on_organ(kBlue, 0.4);
  const double before = t.state.electrodes[kHook].current.now.output;
  EXPECT_NEAR(before, 40, 1);
  for (int i = 0; i < 4; ++i) {
    t.input.pedals = kBlue | std::uint32_t(tissue::kBlueLess) << kPanelBit;
    t.steps(50);
    t.input.pedals = kBlue;
    t.steps(50);
  }
  EXPECT_EQ(t.state.panel.blue_watts, 20);
  EXPECT_NEAR(t.state.electrodes[kHook].current.now.output, 0.5 * before, 2);
  State other = initial_state(t.model);
  EXPECT_EQ(other.panel.blue_watts, 40) << "each attempt begins as the scene says";
}

TEST(Energy, PedalsDoNothingInASceneWithoutAGenerator) {
  small::Table with(small::model()), without(small::model());
  with.input.pedals = kBlue;
  with.steps(50), without.steps(50);
  EXPECT_EQ(hash_of(with.state), hash_of(without.state));
}

TEST(Energy, AHookInTheAirGivesNothing) {
  small::Table t(small::energy());
  t.input.pedals = kBlue;
  t.steps(300);
  EXPECT_EQ(t.state.heat.books.given, 0);
  EXPECT_EQ(t.state.electrodes[kHook].current.now.flows, 0);
  EXPECT_EQ(t.state.electrodes[kHook].current.now.mode, tissue::EnergyMode::coag);
}

TEST(Energy, SmokeHoldsTheWaterThatBoiledLessWhatHasFaded) {
  small::Table t(small::energy());
  small::put_hook_down(t);
  t.input.pedals = kBlue;
  const fluids::SmokeModel& smoke = t.model.wet.model.smoke;
  double expected = 0, before = 0;
  for (int i = 0; i < 3000; ++i) {
    t.step();
    const double steam = t.state.heat.books.steam;
    expected = expected * (1 - kTick / smoke.tau_still) + (steam - before);
    before = steam;
  }
  const double content = fluids::content(smoke, t.state.fluids.smoke);
  std::printf("    %.2f mg boiled, %.2f mg in the air\n", 1e6 * before, 1e6 * content);
  EXPECT_GT(before, 1e-6);
  EXPECT_NEAR(content, expected, 0.01 * expected);
}

TEST(Energy, SmokeAtTheLensFogsItWhileCurrentFlowsAndNotWithout) {
  double fog[2];
  std::uint64_t hash[2];
  for (const bool current : {false, true}) {
    small::Table t(small::energy());
    small::put_hook_down(t);
    fluids::SmokeState& smoke = t.state.fluids.smoke;
    ASSERT_TRUE(boil(t.model.wet.model.smoke, scope_of(t.model, t.state).eye, 50e-6, smoke));
    t.input.pedals = current ? kBlue : 0u;
    t.steps(1000);
    fog[current] = smoke.fog;
    smoke.fog = 0;
    hash[0] = hash_of(t.state);
    smoke.fog = fog[current];
    hash[1] = hash_of(t.state);
  }
  EXPECT_EQ(fog[0], 0);
  EXPECT_GT(fog[1], 1e-3);
  EXPECT_NE(hash[0], hash[1]) << "it is State";
}

TEST(Energy, AHookDrawnInPureCutPartsTheOrganAndCoagulationDoesNot) {
  const auto parted = [](std::uint32_t pedals) {
    small::Table t(small::energy());
    small::put_hook_down(t);
    t.input.pedals = pedals;
    t.carry(kHook, small::kOnOrgan, small::kOnOrgan + Vec3d{0.006, 0, -0.001}, 0.004);
    return std::pair{std::count(t.state.parted[0].begin(), t.state.parted[0].end(), 1), t.count(Event::parted)};
  };
  const auto [cut, told] = parted(kYellow);
  const auto [coagulated, told_of] = parted(kBlue);
  EXPECT_GT(cut, 0);
  EXPECT_GT(told, 0);
  EXPECT_EQ(coagulated, 0);
  EXPECT_EQ(told_of, 0);
}

/// The hook comes from `from` to `to`, then with that pedal to `end` at 4 mm/s.
small::Table drawn_hook(std::uint32_t pedals, Vec3d from, Vec3d to, Vec3d end) {
  small::Table t(small::energy());
  t.carry(kHook, {0.026, 0.02, 0.05}, from, 0.2);
  t.carry(kHook, from, to, 0.05);
  t.input.pedals = pedals;
  t.carry(kHook, to, end, 0.004);
  return t;
}
bool is_open(const small::Table& t, int vessel) {
  return std::any_of(t.state.openings.begin(), t.state.openings.begin() + t.state.opening_count,
                     [vessel](const auto& o) { return o.vessel == vessel; });
}

TEST(Energy, AHookPressedOnATubeInPureCutGoesThroughItAndItsArteryAndCoagulationDoesNot) {
  const auto pressed = [](std::uint32_t pedals) {
    return drawn_hook(pedals, {0.045, 0, 0.020}, {0.045, 0, 0.003}, {0.045, 0, 0.0005});
  };
  const small::Table cut = pressed(kYellow), coagulated = pressed(kBlue);
  const auto parts = [](const small::Table& t) {
    const std::vector<std::uint8_t>& alive = t.state.strands[small::kTube].alive;
    return std::count(alive.begin(), alive.end(), 0);
  };
  std::printf("    cut with %.1f J\n", cut.state.electrodes[kHook].current.joules);
  EXPECT_GT(parts(cut), 0);
  EXPECT_GT(cut.count(Event::parted), 0);
  EXPECT_TRUE(is_open(cut, small::kTubeArtery));
  EXPECT_EQ(parts(coagulated), 0);
  EXPECT_EQ(coagulated.count(Event::parted), 0);
  EXPECT_FALSE(is_open(coagulated, small::kTubeArtery));
  EXPECT_GT(coagulated.state.electrodes[kHook].current.joules, cut.state.electrodes[kHook].current.joules / 2);
}

TEST(Energy, AHookDrawnThroughAFoldInPureCutPartsItAndItsArteryAndCoagulationDoesNot) {
  const auto drawn = [](std::uint32_t pedals) {
    return drawn_hook(pedals, {0.017, 0.020, -0.005}, {0.017, 0.0008, -0.010}, {0.017, 0.0008, -0.004});
  };
  const small::Table cut = drawn(kYellow), coagulated = drawn(kBlue);
  const auto torn = [](const small::Table& t) { return std::count(t.state.torn[0].begin(), t.state.torn[0].end(), 1); };
  EXPECT_GT(torn(cut), 0);
  EXPECT_GT(cut.count(Event::parted), 0);
  EXPECT_TRUE(is_open(cut, small::kFoldArtery));
  EXPECT_EQ(torn(coagulated), 0);
  EXPECT_FALSE(is_open(coagulated, small::kFoldArtery));
  EXPECT_GT(coagulated.state.heat.books.given, 1) << "it has been there";
}

TEST(Energy, AHookDrawnOverABodyThatCanBeCutPartsItInPureCutAndCoagulationDoesNot) {
  const auto drawn = [](std::uint32_t pedals) {
    return drawn_hook(pedals, {0.020, 0.041, 0.020}, {0.020, 0.041, 0.0035}, {0.020, 0.049, 0.0035});
  };
  const small::Table cut = drawn(kYellow), coagulated = drawn(kBlue);
  const int drawn_nodes = small::energy().cuttables[0].body.own_nodes;
  EXPECT_GT(cut.state.cuttables[0].tets.nodes, drawn_nodes) << "nodes part where cells do";
  EXPECT_GT(cut.count(Event::parted), 0);
  EXPECT_EQ(coagulated.state.cuttables[0].tets.nodes, drawn_nodes);
  EXPECT_GT(coagulated.state.heat.books.given, 1);
}

/// The small scene's tube artery with another lumen, cut through below the hook, which then coagulates for 1.5 s.
struct Stump {
  double outer = 0, before = 0, after = 0;  ///< [m], [mL/min]
};
double bleeding(const small::Table& t) {
  double sum = 0;
  for (int i = 0; i < t.work.bleed_count; ++i) sum += double(t.work.bleeds[size_t(i)].picolitres) * 1e-9 * 60e3;
  return sum;
}
Stump stump_of(double radius, std::uint32_t pedals) {
  scene::Description d = small::energy_description();
  d.vessels.front().graph.segments[small::kTubeArtery].radius = radius;
  const Model model = scene::compile(d);
  small::Table t(model);
  const interactions::VesselPath& path = model.vessels.list[small::kTubeArtery].path;
  interactions::VesselOpening& o = t.state.openings[0];
  o.vessel = small::kTubeArtery;
  o.s = 0.25;
  o.through = 1;
  o.area = std::numbers::pi * radius * radius;
  t.state.opening_count = 1;
  const double x = 0.001 + 0.25 * path.length;
  t.carry(kHook, {0.026, 0.02, 0.05}, {x, 0, 0.020}, 0.2);
  t.carry(kHook, {x, 0, 0.020}, {x, 0, 0.0012}, 0.1);
  t.steps(200);
  Stump s;
  s.outer = 2 * vessel_radius(path, 0.25);
  const auto mean = [&t](int ticks) {
    double sum = 0;
    for (int i = 0; i < ticks; ++i) {
      t.step();
      sum += bleeding(t) / ticks;
    }
    return sum;
  };
  s.before = mean(300);
  t.input.pedals = pedals;
  t.steps(1500);
  t.input.pedals = 0;
  s.after = mean(300);
  std::printf("    outer %.2f mm: %.2f mL/min before, %.3f after; body %d, %.0f C, %d seals\n", 1e3 * s.outer, s.before,
              s.after, t.state.electrodes[kHook].body.code(), t.state.electrodes[kHook].current.tip,
              t.state.seal_count);
  return s;
}

TEST(Energy, AHookSealsTheStumpsOfAnArteryOf1Millimetre) {
  const Stump s = stump_of(0.00038, kBlue);
  EXPECT_LT(s.outer, 1.0e-3);
  EXPECT_GT(s.before, 0.5);
  EXPECT_EQ(s.after, 0);
}

TEST(Energy, AHookDoesNotSealAnArteryOf2AndAHalfMillimetres) {
  const Stump s = stump_of(0.0010, kBlue);
  EXPECT_GT(s.outer, 1.5e-3);
  EXPECT_GT(s.after, 0.3 * s.before);
}

TEST(Energy, WithoutCurrentAStumpBleedsOn) {
  const Stump s = stump_of(0.00038, 0);
  EXPECT_GT(s.after, 0.3 * s.before);
}

TEST(Energy, BipolarJawsSealTheArteryInATubeThatTheyHold) {
  small::Table t(small::energy());
  const double x = 0.050;
  t.close_slowly(kBipolar, 0, 10);
  t.carry(kBipolar, {0.055, 0, 0.04}, {x, 0, -0.010}, 0.1);
  t.close_slowly(kBipolar, 1, 300);
  t.steps(100);
  ASSERT_GT(t.tool(kBipolar).holds, 0);
  ASSERT_EQ(t.tool(kBipolar).hold[0].at.body, BodyId::strand(small::kTube));
  t.input.pedals = kBlue;
  t.steps(3000);
  ASSERT_GT(t.state.seal_count, 0);
  const interactions::VesselSeal& seal = t.state.seals[0];
  std::printf("    pinch %.1f N, S %.0f, char %.2f, bears %.0f kPa\n", t.tool(kBipolar).pinch, seal.state.damage,
              seal.state.char_, 1e-3 * tissue::burst_pressure({}, seal.state));
  EXPECT_EQ(seal.vessel, small::kTubeArtery);
  EXPECT_TRUE(holds(seal));
  const std::vector<double>& scale = t.state.strands[small::kTube].scale;
  EXPECT_GT(*std::max_element(scale.begin(), scale.end()), 2) << "what is coagulated is stiffer";
}

/// Mean distance of an organ's or fold's points that were drawn within 4 mm of a place from their own middle [m].
double spread_of(const tissue::NetworkModel& model, const tissue::NetworkState& state, Vec3d middle_drawn) {
  std::vector<Vec3d> near;
  Vec3d middle;
  for (int n = 0; n < model.nodes; ++n)
    if (length(model.rest[size_t(n)] - middle_drawn) < 0.004) near.push_back(position(model, state, n));
  for (const Vec3d& p : near) middle += p / double(near.size());
  double sum = 0;
  for (const Vec3d& p : near) sum += length(p - middle) / double(near.size());
  return sum;
}

TEST(Energy, AFoldThatIsCoagulatedDrawsTogetherAndStaysSo) {
  const Vec3d there{0.017, 0, -0.007};
  small::Table t(small::energy());
  const tissue::NetworkModel& fold = t.model.membranes[0].sheet.network;
  const auto spread = [&] { return spread_of(fold, t.state.membranes[0].network, there); };
  const double drawn = spread();
  t.carry(kHook, {0.026, 0.02, 0.05}, {0.017, 0.020, -0.005}, 0.2);
  t.carry(kHook, {0.017, 0.020, -0.005}, {0.017, 0.0008, -0.009}, 0.05);
  t.input.pedals = kBlue;
  t.carry(kHook, {0.017, 0.0008, -0.009}, {0.017, 0.0008, -0.005}, 0.004);
  t.input.pedals = 0;
  t.carry(kHook, {0.017, 0.0008, -0.005}, {0.017, 0.020, -0.005}, 0.05);
  t.steps(1000);
  std::printf("    %.1f J: %d springs have shrunk, spread %.3f instead of %.3f mm\n", t.state.heat.books.given,
              t.state.scarred_count, 1e3 * spread(), 1e3 * drawn);
  EXPECT_GT(t.state.scarred_count, 10);
  EXPECT_LT(spread(), 0.97 * drawn);
  EXPECT_GT(spread(), 0.78 * drawn) << "by a fifth at most";
  EXPECT_EQ(t.flags & StepReport::kHeatFull, 0u);
}

TEST(Energy, AnOrganThatIsCoagulatedShrinksByATenthOfWhatIs) {
  const small::Table t = hook_on_organ(kBlue, 2);
  ASSERT_GT(t.state.scarred_count, 0);
  for (int i = 0; i < t.state.scarred_count; ++i) {
    EXPECT_EQ(t.state.scarred[size_t(i)].body, kOrgan);
    EXPECT_GE(t.state.scarred[size_t(i)].share, 0.79f);
  }
  const Scar& most = *std::min_element(t.state.scarred.begin(), t.state.scarred.begin() + t.state.scarred_count,
                                       [](const auto& a, const auto& b) { return a.share < b.share; });
  const tissue::NetworkModel& organ = t.model.solids[0].network;
  const double strain = tissue::spring_strain(organ, t.state.solids[0], most.spring);
  std::printf("    %d springs, the most to %.3f of its length; it stands at %.3f\n", t.state.scarred_count,
              double(most.share), 1 + strain);
  EXPECT_LT(most.share, 0.97f);
  EXPECT_LT(strain, -0.2 * (1 - double(most.share))) << "what is around it holds against it";
}

/// How long the edges of the cells that heat has shrunk to below a share are, over how they were drawn.
double scarred_edges(const small::Table& t, float share) {
  const tissue::CuttableModel& m = t.model.cuttables[0].body;
  const tissue::CuttableState& bar = t.state.cuttables[0];
  double now = 0, drawn = 0;
  for (int i = 0; i < t.state.scarred_count; ++i) {
    const Scar& scar = t.state.scarred[size_t(i)];
    if (scar.body != BodyId::organ(small::kBar) || scar.share > share) continue;
    const geometry::Tet& cell = bar.tets.cells[size_t(scar.spring)];
    for (const auto& edge : tissue::kCellEdges) {
      const int a = cell[size_t(edge[0])], b = cell[size_t(edge[1])];
      now += length(position(m, bar, a) - position(m, bar, b));
      drawn += length(bar.tets.rest[size_t(a)] - bar.tets.rest[size_t(b)]);
    }
  }
  return drawn > 0 ? now / drawn : 0;
}

TEST(Energy, ABodyThatCanBeCutShrinksWhereItIsCoagulatedAndCanBeCutThere) {
  small::Table t(small::energy());
  const Vec3d high{0.020, 0.045, 0.020}, on{0.020, 0.045, 0.0035};
  t.carry(kHook, {0.026, 0.02, 0.05}, high, 0.2);
  t.carry(kHook, high, on, 0.1);
  t.input.pedals = kBlue;
  t.steps(4000);
  t.input.pedals = 0;
  t.carry(kHook, on, high, 0.05);
  t.steps(500);
  const int scars = t.state.scarred_count;
  const double whole = scarred_edges(t, 0.95f);
  std::printf("    %.1f J: %d cells, edges at %.3f of their length\n", t.state.heat.books.given, scars, whole);
  EXPECT_GT(scars, 3);
  EXPECT_LT(whole, 0.97);
  EXPECT_GT(whole, 0.78);
  const Vec3d beside{0.020, 0.041, 0.0035};
  t.carry(kHook, high, {0.020, 0.041, 0.020}, 0.1);
  t.carry(kHook, {0.020, 0.041, 0.020}, beside, 0.1);
  t.input.pedals = kYellow;
  t.carry(kHook, beside, {0.020, 0.049, 0.0035}, 0.01);
  t.input.pedals = 0;
  t.carry(kHook, {0.020, 0.049, 0.0035}, {0.020, 0.049, 0.020}, 0.05);
  t.steps(1000);
  EXPECT_GT(t.count(Event::parted), 0);
  EXPECT_GE(t.state.scarred_count, scars);
  EXPECT_GT(scarred_edges(t, 0.95f), 0.7);
  EXPECT_LT(scarred_edges(t, 0.95f), 1);
  EXPECT_EQ(t.flags & (StepReport::kTooManyLoads | StepReport::kHeatFull), 0u);
  const tissue::CuttableModel& bar = t.model.cuttables[0].body;
  for (int n = 0; n < t.state.cuttables[0].tets.nodes; ++n)
    ASSERT_LT(length(velocity(bar, t.state.cuttables[0], n)), 0.2) << "it has come to rest, or swings";
}

/// Strains of an organ's springs at two depths of the wire, which has been there with those pedals for 4 s.
struct Pressed {
  std::vector<double> less, more;
  std::vector<Scar> scars;
};
Pressed pressed_organ(std::uint32_t pedals) {
  small::Table t = hook_on_organ(pedals, 4);
  t.input.pedals = 0;
  const tissue::NetworkModel& organ = t.model.solids[0].network;
  const auto strains_at = [&](double deeper) {
    t.point(kHook, small::kOnOrgan - Vec3d{0, 0, deeper});
    t.steps(600);
    std::vector<double> strains;
    for (int s = 0; s < organ.springs; ++s) strains.push_back(tissue::spring_strain(organ, t.state.solids[0], s));
    return strains;
  };
  Pressed p;
  p.less = strains_at(0.8e-3), p.more = strains_at(1.8e-3);
  p.scars.assign(t.state.scarred.begin(), t.state.scarred.begin() + t.state.scarred_count);
  return p;
}

TEST(Energy, WhatIsCoagulatedGivesWayLessUnderTheSameWire) {
  const Pressed raw = pressed_organ(0), burnt = pressed_organ(kBlue);
  double before = 0, after = 0, stiff = 0, heavier = 0;  // [kg], as network_scars.hpp says
  for (const Scar& scar : burnt.scars) {
    const size_t s = size_t(scar.spring);
    const tissue::NetworkModel& organ = small::energy().solids[0].network;
    heavier += (double(scar.stiff) - 1) * tissue::spring_stiffness(organ, scar.spring) * organ.dt * organ.dt;
    before += std::fabs(raw.more[s] - raw.less[s]);
    after += std::fabs(burnt.more[s] - burnt.less[s]);
    stiff += double(scar.stiff) / double(burnt.scars.size());
  }
  std::printf(
      "    %zu springs, %.1f times as stiff in the mean, give way by %.2f of what they did; heavier by %.2f g\n",
      burnt.scars.size(), stiff, after / before, 1e3 * heavier);
  EXPECT_LT(heavier, 0.005) << "[kg]";
  EXPECT_TRUE(raw.scars.empty());
  EXPECT_GT(stiff, 1.5);
  EXPECT_LT(after, 0.8 * before) << "softer neighbours do the more";
}

TEST(Energy, ATubeThatIsCoagulatedAcrossIsShorterThere) {
  small::Table t(small::energy());
  t.close_slowly(kBipolar, 0, 10);
  t.carry(kBipolar, {0.055, 0, 0.04}, {0.050, 0, -0.010}, 0.1);
  t.close_slowly(kBipolar, 1, 300);
  t.input.pedals = kBlue;
  t.steps(3000);
  const std::vector<double>& shrunk = t.state.strands[small::kTube].shrunk;
  const auto element = std::min_element(shrunk.begin(), shrunk.end());
  const int e = int(element - shrunk.begin());
  const tissue::StrandState& s = t.state.strands[small::kTube];
  const double now =
      length(s.x[size_t(e) + 1] - s.x[size_t(e)]) / t.model.strand_bodies[small::kTube].model.rest_length[size_t(e)];
  std::printf("    element %d: %.3f of its length at rest, %.3f as it is\n", e, *element, now);
  EXPECT_LT(*element, 0.95);
  EXPECT_GE(*element, 0.8 - 1e-6);
  EXPECT_LT(now, 0.99);
}

TEST(Energy, CharSticksToTheWireUntilItIsTornOff) {
  scene::Description d = small::energy_description();
  d.energy->blue_watts = 100;
  const Model model = scene::compile(d);
  small::Table t(model);
  small::put_hook_down(t);
  t.input.pedals = kBlue;
  t.steps(3000);
  t.input.pedals = 0;
  const ElectrodeHand& hand = t.state.electrodes[kHook];
  ASSERT_EQ(hand.stuck.at.body, kOrgan);
  const tissue::Skin& skin = model.solids[0].skin;
  const auto height = [&](int v) { return skin_point(nodes_of(model, t.state, 0), skin, v).z; };
  const int vertex = hand.stuck.at.element;
  const double before = height(vertex);
  double highest = 0, hardest = 0;
  for (int i = 0; i < 800 && hand.stuck.at.body.exists(); ++i) {
    t.point(kHook, small::kOnOrgan + Vec3d{0, 0, 2e-5 * i});
    t.step();
    highest = std::max(highest, height(vertex) - before);
    hardest = std::max(hardest, t.tool(kHook).contact_force[2] * -1);
  }
  std::printf("    stuck %.2f: tissue came %.2f mm along, %.2f N\n", hand.current.stuck, 1e3 * highest, hardest);
  EXPECT_GT(highest, 0.5e-3);
  EXPECT_FALSE(hand.stuck.at.body.exists()) << "2 N tear it off";
  EXPECT_EQ(hand.current.stuck, 0);
  EXPECT_LT(hardest, 2.5);
}

// The laws of the step.

/// A hook goes down, cuts and coagulates; every hundredth tick's hash.
struct Recorded {
  std::vector<Input> inputs;
  std::vector<std::uint64_t> hash;
};
const Recorded& recorded() {
  static const Recorded done = [] {
    Recorded r;
    small::Table t(small::energy());
    for (int i = 0; i < 1500; ++i) {
      const double share = std::min(1.0, i / 400.0), along = std::clamp((i - 600) / 900.0, 0.0, 1.0);
      const Vec3d from{0.026, 0.02, 0.05}, high{-0.022, 0, 0.030};
      Vec3d tip = from + share * (high - from);
      if (i > 400) tip = high + std::min(1.0, (i - 400) / 200.0) * (small::kOnOrgan - high);
      t.point(kHook, tip + Vec3d{0.004 * along, 0, 0});
      t.input.pedals = i <= 600 ? 0u : i < 1100 ? std::uint32_t(kYellow) : std::uint32_t(kBlue);
      r.inputs.push_back(t.input);
      t.step();
      if (t.state.tick % 100 == 0) r.hash.push_back(hash_of(t.state));
    }
    EXPECT_GT(t.state.heat.books.given, 5);
    EXPECT_GT(t.count(Event::parted), 0);
    return r;
  }();
  return done;
}
/// The first mark that differs, or 0.
template <class Before>
std::uint64_t first_difference(State& s, Work& w, Before&& before) {
  while (s.tick < recorded().inputs.size()) {
    before(s, w);
    step(small::energy(), recorded().inputs[s.tick], s, w);
    if (s.tick % 100 == 0 && hash_of(s) != recorded().hash[s.tick / 100 - 1]) return s.tick;
  }
  return 0;
}

TEST(Energy, ThreadsChangeNoBitOfIt) {
  core::ThreadPool pool(4);
  State s = initial_state(small::energy());
  Work w = make_work(small::energy(), &pool);
  EXPECT_EQ(first_difference(s, w, [](State&, Work&) {}), 0u);
}

TEST(Energy, NonsenseInTheScratchChangesNoBitOfIt) {
  State s = initial_state(small::energy());
  Work w = make_work(small::energy());
  EXPECT_EQ(first_difference(s, w, [](State&, Work& work) { poison(work); }), 0u);
}

TEST(Energy, ASavedStateGoesOnWithTheSameBits) {
  State s = initial_state(small::energy());
  Work w = make_work(small::energy());
  const std::uint64_t differs = first_difference(s, w, [](State& state, Work& work) {
    if (state.tick != 1003) return;
    const State saved = state;
    state = initial_state(small::energy());
    state = saved;
    work = make_work(small::energy());
  });
  EXPECT_EQ(differs, 0u);
}

}  // namespace
