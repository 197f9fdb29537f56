// What leaves openings: Poiseuille and orifice, alone and in series; what pulse, clips, clots, veins and a lost litre
// do to it; and that every picolitre is told.
#include <algorithm>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

constexpr double kMean = 93 * kMmHg, kCavity = 12 * kMmHg;

double disc(double diameter) { return kPi / 4 * diameter * diameter; }

/// rho / 2 (Q / Cd A)^2 + R Q = p
double series_flow(double pressure, double area, double resistance) {
  const double k = 1060 / (2 * 0.61 * 0.61 * area * area);
  return 2 * pressure / (resistance + std::sqrt(resistance * resistance + 4 * k * pressure));
}
double poiseuille(double length, double diameter) {
  return 128 * 3.5e-3 * length / (kPi * diameter * diameter * diameter * diameter);
}

/// 100 mm of a stiff vessel from a constant 93 mmHg, its far end closed.
VesselGraph stump(double diameter) {
  VesselGraph g;
  g.nodes = 2;
  g.segments = {pipe(0, 1, 0.1, diameter)};
  g.sources = {constant_pressure(0, kMean)};
  return g;
}

double steady_flow(Simulation& sim, double seconds = 1.5) {
  sim.run(seconds);
  return sim.flows[0].flow[0];
}

Opening cut(int segment, double s, double diameter) {
  return {.segment = segment, .s = s, .kind = Opening::Kind::cut, .area = disc(diameter), .outside = kCavity};
}
Opening hole(int segment, double s, double diameter) {
  return {.segment = segment, .s = s, .area = disc(diameter), .outside = kCavity};
}

struct Row {
  double diameter, orifice, poiseuille, series;  // [mm], [mL/min], the published table's rounded figures
};
const Row kTable[] = {
    {0.5, 32, 2.8, 2.8}, {1.0, 130, 45, 41}, {1.2, 187, 94, 78}, {1.6, 332, 298, 195}, {2.0, 519, 727, 366}};

TEST(Bleeding, ThroughAHoleInAWideVesselIsTheOrificesFlow) {
  for (const Row& row : kTable) {
    const double d = 1e-3 * row.diameter;
    VesselGraph g = stump(0.03);
    g.settings.clot_area = 0;
    Simulation sim(g);
    sim.openings = {hole(0, 0.3, d)};
    const double q = steady_flow(sim);
    const double formula = 0.61 * disc(d) * std::sqrt(2 * (kMean - kCavity) / 1060);
    expect_within("row 19, orifice of " + std::to_string(row.diameter) + " mm", q / formula - 1, 0.005);
    EXPECT_NEAR(q / kMlPerMinute, row.orifice, 0.01 * row.orifice + 0.5);
  }
}

TEST(Bleeding, FlowThroughAVesselBetweenTwoPressuresIsPoiseuilles) {
  for (const Row& row : kTable) {
    const double d = 1e-3 * row.diameter;
    VesselGraph g = stump(d);
    g.sources.push_back(constant_pressure(1, kCavity));
    Simulation sim(g);
    sim.run(1.5);
    const double q = read_wall(sim.model, sim.state, 0, 0.5).flow;
    expect_within("row 19, Poiseuille of " + std::to_string(row.diameter) + " mm",
                  q / ((kMean - kCavity) / poiseuille(0.1, d)) - 1, 0.005);
    EXPECT_NEAR(q / kMlPerMinute, row.poiseuille, 0.01 * row.poiseuille + 0.5);
  }
}

TEST(Bleeding, OutOfACutEndIsOrificeAndVesselInSeries) {
  for (const Row& row : kTable) {
    const double d = 1e-3 * row.diameter;
    VesselGraph g = stump(d);
    g.settings.clot_area = 0;
    Simulation sim(g);
    sim.openings = {cut(0, 1, d)};
    const double q = steady_flow(sim);
    expect_within("row 19, series of " + std::to_string(row.diameter) + " mm",
                  q / series_flow(kMean - kCavity, disc(d), poiseuille(0.1, d)) - 1, 0.005);
    EXPECT_NEAR(q / kMlPerMinute, row.series, 0.01 * row.series + 0.5);
  }
}

TEST(Bleeding, PlaceOfTheCutSetsTheResistanceHoweverCoarseTheCells) {
  for (const double s : {0.1, 0.33, 0.5, 0.9}) {
    Simulation sim(stump(1.6e-3));
    ASSERT_EQ(sim.model.cells.size(), 1u);
    sim.openings = {cut(0, s, 1.6e-3)};
    expect_within("cut at " + std::to_string(s),
                  steady_flow(sim) / series_flow(kMean - kCavity, disc(1.6e-3), poiseuille(0.1 * s, 1.6e-3)) - 1,
                  0.005);
  }
}

TEST(Bleeding, SeveralOpeningsInOneCellShareWhatTheVesselBears) {
  VesselGraph g = stump(1.6e-3);
  g.settings.clot_area = 0;
  Simulation sim(g);
  sim.openings = {hole(0, 0.7, 1e-3), hole(0, 0.4, 1.1e-3), cut(0, 0.9, 1.6e-3), hole(0, 0.95, 1e-3)};
  sim.run(2);
  // By hand: pressures behind resistances of 40, 30 and 20 mm, from the last opening backwards.
  const auto through = [](double pressure, double d) {
    return pressure > 0 ? 0.61 * disc(d) * std::sqrt(2 * pressure / 1060) : 0.0;
  };
  double low = 0, high = kMean - kCavity;
  double q1 = 0, q2 = 0, q3 = 0;
  for (int i = 0; i < 200; ++i) {
    const double p3 = 0.5 * (low + high);  // over the cavity's, at the cut
    q3 = through(p3, 1.6e-3);
    const double p2 = p3 + poiseuille(0.02, 1.6e-3) * q3;
    q2 = through(p2, 1e-3);
    const double p1 = p2 + poiseuille(0.03, 1.6e-3) * (q2 + q3);
    q1 = through(p1, 1.1e-3);
    const double p0 = p1 + poiseuille(0.04, 1.6e-3) * (q1 + q2 + q3);
    (p0 > kMean - kCavity ? high : low) = p3;
  }
  expect_within("hole at 0.4", sim.flows[1].flow[0] / q1 - 1, 0.005);
  expect_within("hole at 0.7", sim.flows[0].flow[0] / q2 - 1, 0.005);
  expect_within("cut at 0.9", sim.flows[2].flow[0] / q3 - 1, 0.005);
  EXPECT_EQ(sim.flows[3].flow[0], 0) << "behind the cut nothing comes";
  EXPECT_EQ(sim.flows[2].flow[1], 0);
}

TEST(Bleeding, PartialClipLeavesAboutTheSquareOfWhatItLeavesOpen) {
  for (const double d : {1.0e-3, 1.6e-3}) {
    Simulation free(stump(d));
    free.openings = {cut(0, 1, d)};
    const double q0 = steady_flow(free);
    for (const double cover : {0.25, 0.5, 0.75, 0.9}) {
      Simulation sim(stump(d));
      sim.openings = {cut(0, 1, d)};
      sim.clips = {{.segment = 0, .s = 0.5, .cover = cover}};
      const double ratio = steady_flow(sim) / q0, square = (1 - cover) * (1 - cover);
      record("clip of cover " + std::to_string(cover), "%.4f of the flow, square %.4f", ratio, square);
      EXPECT_GT(ratio, 0.8 * square);
      EXPECT_LT(ratio, 1.5 * square);
    }
  }
}

/// One side's supply of uterus and ovary: aorta, iliac and uterine artery; the ovarian artery; the arcade between them.
VesselGraph pelvis() {
  VesselGraph g;
  g.nodes = 7;
  enum { heart, ovarian_origin, fork, uterine_origin, cervix, cornu, ovary };
  g.segments = {artery(heart, ovarian_origin, 0.1, 20e-3, 0.4e6, 1.6e-3),
                artery(ovarian_origin, fork, 0.05, 20e-3, 0.4e6, 1.6e-3),
                artery(fork, uterine_origin, 0.1, 5.4e-3, 0.7e6, 0.5e-3),
                artery(uterine_origin, cervix, 0.06, 1.6e-3, 1e6, 0.15e-3),
                artery(cervix, cornu, 0.06, 1.6e-3, 1e6, 0.15e-3),
                artery(ovarian_origin, ovary, 0.2, 1.3e-3, 1e6, 0.12e-3),
                artery(ovary, cornu, 0.06, 1.0e-3, 1.2e6, 0.08e-3)};
  g.sources = {{.node = heart}};
  g.ends = {matched_end(g, 1, kMean, 2000 * kMlPerMinute, 1.0), matched_end(g, 2, kMean, 300 * kMlPerMinute, 1.0),
            matched_end(g, 4, 85 * kMmHg, 25 * kMlPerMinute, 1.0),
            matched_end(g, 5, 85 * kMmHg, 10 * kMlPerMinute, 1.0)};
  return g;
}
constexpr int kUterine = 4, kArcade = 6;

struct Spurts {
  double mean = 0, low = 1e9, high = 0;
};
/// Of a side of opening 0 over whole beats.
Spurts spurts(Simulation& sim, int side) {
  Spurts s;
  const int ticks = 5000;  // 6 beats
  for (int i = 0; i < ticks; ++i) {
    sim.tick();
    const double q = sim.flows[0].flow[side];
    s.mean += q / ticks, s.low = std::min(s.low, q), s.high = std::max(s.high, q);
  }
  return s;
}

TEST(Bleeding, SpurtsWithThePulseAndNeverStopsInDiastole) {
  Simulation sim(pelvis(), 8);
  sim.openings = {cut(kUterine, 0.2, 1.6e-3)};
  sim.run(2);
  const Spurts s = spurts(sim, 0);
  record("uterine artery cut", "%.0f mL/min, least %.0f", s.mean / kMlPerMinute, s.low / kMlPerMinute);
  EXPECT_GT(s.low, 0.5 * s.mean);
  EXPECT_GT(s.high, 1.2 * s.low);
  EXPECT_GT(s.mean, 150 * kMlPerMinute);
  EXPECT_LT(s.mean, 400 * kMlPerMinute);
}

TEST(Bleeding, DistalStumpBleedsBackThroughTheArcade) {
  Simulation sim(pelvis(), 8);
  sim.openings = {cut(kUterine, 0.2, 1.6e-3)};
  sim.run(2);
  Simulation other = sim;
  const Spurts near = spurts(sim, 0), far = spurts(other, 1);
  record("back-bleeding", "%.3f of the proximal flow, %.0f mL/min", far.mean / near.mean, far.mean / kMlPerMinute);
  EXPECT_GT(far.mean, 0.1 * near.mean);
  EXPECT_LT(far.mean, 0.3 * near.mean);
}

TEST(Bleeding, CollateralBedBleedsBackWithoutAPulse) {
  // What small vessels bring in from elsewhere: a constant pressure behind a resistance, at the end of an end artery.
  VesselGraph g = pelvis();
  g.segments.pop_back();
  g.sources.push_back(constant_pressure(5, 60 * kMmHg, 1.2e10));
  g.nodes = 7;
  Simulation sim(g, 8);
  sim.openings = {cut(kUterine, 0.2, 1.6e-3)};
  sim.run(2);
  Simulation other = sim;
  const Spurts near = spurts(sim, 0), far = spurts(other, 1);
  record("back-bleeding from a collateral bed", "%.3f of the proximal flow, pulse %.4f of its mean",
         far.mean / near.mean, (far.high - far.low) / far.mean);
  EXPECT_GT(far.mean, 0.1 * near.mean);
  EXPECT_LT(far.mean, 0.3 * near.mean);
  EXPECT_LT(far.high - far.low, 0.02 * far.mean);
}

TEST(Bleeding, OneSolutionATickIsEnoughButWhereSomethingOpens) {
  Simulation sim(pelvis(), 8);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(sim.tick().solves, 1);
  sim.openings = {cut(kUterine, 0.2, 1.6e-3), hole(2, 0.5, 1e-3)};
  int more = 0, late = 0;
  for (int i = 0; i < 3000; ++i) {
    const bool again = sim.tick().solves > 1;
    more += again, late += again && i > 50;
  }
  record("ticks solved more than once after a cut", "%.0f, %.0f of them later than 50 ms", more, late);
  EXPECT_LT(more, 50);
  EXPECT_EQ(late, 0);
}

TEST(Bleeding, AnastomosisNeedsAClipOnEitherSide) {
  const auto flow_with = [](std::vector<Occlusion> clips) {
    Simulation sim(pelvis(), 5);
    sim.openings = {hole(kUterine, 0.5, 1e-3)};
    sim.clips = std::move(clips);
    sim.run(2);
    return sim.flows[0].flow[0];
  };
  const Occlusion near{.segment = kUterine, .s = 0.3, .cover = 1}, far{.segment = kUterine, .s = 0.7, .cover = 1};
  const Occlusion arcade{.segment = kArcade, .s = 0.5, .cover = 1};
  EXPECT_GT(flow_with({}), flow_with({near}));
  EXPECT_GT(flow_with({near}), 10 * kMlPerMinute);
  EXPECT_GT(flow_with({far}), 10 * kMlPerMinute);
  EXPECT_EQ(flow_with({near, far}), 0);
  EXPECT_EQ(flow_with({near, arcade}), 0);
}

TEST(Bleeding, CutOffVesselRunsDryByWhatItsWallHoldsAndThenStops) {
  VesselGraph g = pelvis();
  g.ends.erase(g.ends.begin() + 2, g.ends.end());
  Simulation sim(g, 8);
  sim.openings = {hole(kUterine, 0.5, 1e-3)};
  sim.run(1);
  sim.clips = {{.segment = kUterine, .s = 0.1, .cover = 1}, {.segment = kArcade, .s = 0.5, .cover = 1}};
  // All that 60 mm of uterine artery and half the arcade hold between the pressure of systole and the cavity's.
  double held = 0;
  for (const auto& [segment, share] : {std::pair{4, 0.9}, std::pair{6, 0.5}}) {
    const VesselSegment& v = g.segments[segment];
    const double b = wall_stiffness(v, g.blood);
    held += kPi * v.radius * v.radius * v.length * share * 2 * (115 * kMmHg - kCavity) / b;
  }
  double drained = 0;
  int last = 0;
  for (int i = 1; i <= 1000; ++i) {
    sim.tick();
    EXPECT_FALSE(sim.flows[0].fed[0]);
    drained += double(sim.flows[0].picolitres[0]) * 1e-15;
    if (sim.flows[0].picolitres[0] > 0) last = i;
    if (i > 250) {
      ASSERT_EQ(sim.flows[0].flow[0], 0);
      ASSERT_EQ(sim.flows[0].picolitres[0], 0);
    }
  }
  record("drained after the clips", "%.1f uL, %.0f ms", drained * 1e9, last);
  EXPECT_GT(drained, 0.1 * held);
  EXPECT_LT(drained, 1.2 * held);
}

TEST(Bleeding, EveryPicolitreIsToldOnce) {
  Simulation sim(pelvis(), 5);
  sim.openings = {cut(kUterine, 0.4, 1.6e-3), hole(2, 0.5, 0.3e-3)};
  double flowed[3] = {0, 0, 0};
  std::int64_t told[3] = {0, 0, 0};
  for (int i = 0; i < 5000; ++i) {
    sim.tick();
    const OpeningFlow &a = sim.flows[0], &b = sim.flows[1];
    flowed[0] += a.flow[0] * 1e12, flowed[1] += a.flow[1] * 1e12, flowed[2] += b.flow[0] * 1e12;
    told[0] += a.picolitres[0], told[1] += a.picolitres[1], told[2] += b.picolitres[0];
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(told[k], 0);
    EXPECT_NEAR(double(told[k]), flowed[k], 1 + 1e-9 * flowed[k]);
  }
  EXPECT_EQ(sim.state.bled, told[0] + told[1] + told[2]);
}

/// Of all rows: what they hold beyond their volume at no pressure [m^3].
double stored(const Simulation& sim) {
  double sum = 0;
  for (std::size_t i = 0; i < sim.state.p.size(); ++i)
    sum += row_volume(sim.model, int(i), 0, sim.state.p[i]) + sim.state.owed[i];
  return sum;
}

TEST(Bleeding, WhatEntersIsStoredOrLeaves) {
  VesselGraph g = pelvis();
  g.ends.clear();
  g.sources = {{.node = 0, .kind = VesselSource::Kind::pump, .wave = {6e-5, 0, 2e-5, 0}}};
  for (LossResponse& r : g.heart.response) r.mean = r.pulse = r.rate = 1;
  Simulation sim(g);
  sim.openings = {cut(kUterine, 0.4, 1.6e-3), hole(2, 0.5, 2e-3), hole(2, 0.8, 1e-3)};
  sim.run(0.5);
  const double before = stored(sim);
  double in = 0, out = 0;
  for (int i = 0; i < 2000; ++i) {
    const double phase = sim.state.beat + sim.model.settings.implicitness * 1e-3 * 72 / 60;
    const double x = (phase - std::floor(phase)) * 4;
    const double wave[] = {6e-5, 0, 2e-5, 0, 6e-5};
    in += (wave[int(x)] + (x - int(x)) * (wave[int(x) + 1] - wave[int(x)])) * 1e-3;
    sim.tick();
    for (const OpeningFlow& f : sim.flows) out += (f.flow[0] + f.flow[1]) * 1e-3;
    EXPECT_GT(sim.state.p[0], 0);
  }
  expect_within("volume: in - out - stored, of what went in", (in - out - (stored(sim) - before)) / in, 1e-9);
}

TEST(Bleeding, ClipThatClosesAtOnceHammersAndKeepsTheVolume) {
  // Blood that runs on pulls the pressure behind the clip down, by rho c u and the friction it no longer has to bear.
  VesselGraph g = stump(1.6e-3);
  g.segments = {artery(0, 1, 0.4, 1.6e-3, 1e6, 0.15e-3)};
  Simulation sim(g, 0.1);
  sim.openings = {cut(0, 0.9, 1.6e-3)};
  sim.run(1);
  sim.clips = {{.segment = 0, .s = 0.305, .cover = 1}};
  const FlowSegment& v = sim.model.segments[0];
  const int clipped = int(0.305 * v.cells), opened = int(0.9 * v.cells);
  const auto held = [&] {  // by the rows between the clip's cell and the cut's
    double sum = 0;
    for (int i = clipped; i < opened; ++i) {
      const int row = sim.model.cells[i].b;
      sum += row_volume(sim.model, row, 0, sim.state.p[row]) + sim.state.owed[row];
    }
    return sum;
  };
  const double full = held();
  double lowest = 1e9, out = 0;
  for (int i = 0; i < 300; ++i) {
    sim.tick();
    out += sim.flows[0].flow[0] * 1e-3;
    for (const double p : sim.state.p) lowest = std::min(lowest, p);
  }
  record("lowest pressure behind it, and what ran out", "%.0f mmHg, %.1f uL", lowest / kMmHg, out * 1e9);
  EXPECT_LT(lowest, 0);
  EXPECT_GT(lowest, -150 * kMmHg);
  expect_within("volume behind the clip: lost - out, of out", (full - held() - out) / out, 1e-9);
}

TEST(Bleeding, PressureFallsWithTheLoss) {
  const Heart heart;
  EXPECT_EQ(response_to(heart, 0).mean, 1);
  EXPECT_GT(response_to(heart, 0.7e-3).mean, 0.95) << "class I: hardly";
  EXPECT_GT(response_to(heart, 1.4e-3).mean, 0.85) << "class II: the pulse narrows first";
  EXPECT_LT(response_to(heart, 1.4e-3).pulse, 0.8);
  EXPECT_LT(response_to(heart, 1.9e-3).mean, 0.8) << "class III";
  EXPECT_LT(response_to(heart, 2.2e-3).mean, 0.65) << "class IV";
  EXPECT_LT(response_to(heart, 10).mean, 0.2);
  double last = 2;
  for (double loss = 0; loss < 4e-3; loss += 1e-5) {
    const double mean = response_to(heart, loss).mean;
    EXPECT_LE(mean, last);
    last = mean;
  }
  Simulation whole(pelvis(), 5), bled(pelvis(), 5);
  whole.openings = bled.openings = {cut(kUterine, 0.2, 1.6e-3)};
  bled.state.bled = std::int64_t(2.2e12);
  whole.run(3), bled.run(3);
  const Spurts a = spurts(whole, 0), b = spurts(bled, 0);
  EXPECT_LT(b.mean, 0.7 * a.mean);
  VesselGraph child = pelvis();
  child.blood.volume = 1e-3;
  Simulation small(child, 5);
  small.openings = whole.openings;
  small.state.bled = std::int64_t(0.44e12);
  small.run(3);
  EXPECT_NEAR(spurts(small, 0).mean, b.mean, 0.1 * b.mean) << "a fifth of the blood, a fifth of the loss";
  bled.state.infused = std::int64_t(2.2e12);
  bled.run(3);
  EXPECT_NEAR(spurts(bled, 0).mean, a.mean, 0.03 * a.mean) << "and comes back with what is given";
}

TEST(Bleeding, SmallOpeningsClotWithinMinutesAndArteriesCutThroughDoNot) {
  for (const double d : {0.2e-3, 0.6e-3, 0.95e-3}) {
    VesselGraph g = stump(2e-3);
    g.settings.tick = 5e-3;
    Simulation sim(g);
    sim.openings = {hole(0, 0.5, d)};
    double stopped = 0;
    for (double t = 0; t < 320 && stopped == 0; t += 5e-3) {
      sim.tick();
      if (sim.flows[0].flow[0] == 0 && t > 1) stopped = t;
    }
    record("hole of " + std::to_string(d * 1e3) + " mm stops bleeding", "after %.0f s, clot %.2f", stopped,
           sim.flows[0].clot);
    EXPECT_GE(stopped, 179);
    EXPECT_LE(stopped, 301);
  }
  VesselGraph g = stump(1.6e-3);
  g.settings.tick = 5e-3;
  Simulation sim(g);
  sim.openings = {cut(0, 0.5, 1.6e-3)};
  sim.run(320);
  EXPECT_EQ(sim.flows[0].clot, 0);
  EXPECT_GT(sim.flows[0].flow[0], 100 * kMlPerMinute);
}

TEST(Bleeding, SealedOpeningsLetLessOutAndFullySealedNothing) {
  Simulation sim(stump(0.03));
  sim.openings = {hole(0, 0.5, 2e-3)};
  const double open = steady_flow(sim);
  sim.openings[0].sealed = 0.5;
  EXPECT_NEAR(steady_flow(sim), 0.5 * open, 0.01 * open);
  sim.openings[0].sealed = 1;
  EXPECT_EQ(steady_flow(sim), 0);
}

TEST(Bleeding, VeinsOozeAndBleedMoreUnderSuction) {
  VesselGraph g;
  g.nodes = 2;
  g.segments = {pipe(0, 1, 0.1, 4e-3)};
  g.segments[0].wall.wave_speed = 3;
  g.segments[0].reference_pressure = 8 * kMmHg;
  g.segments[0].vein = true;
  g.sources = {constant_pressure(0, 8 * kMmHg), constant_pressure(1, 8 * kMmHg)};
  g.sources[0].venous = g.sources[1].venous = true;
  Simulation sim(g);
  sim.openings = {hole(0, 0.5, 2e-3)};
  sim.run(5);
  const double ooze = sim.flows[0].flow[0];
  const double below = 4 * kMmHg + 267;  // by the veins' pressure, and up to the breath's 2 mmHg
  EXPECT_GT(ooze, 5e-3 * disc(2e-3) * (1 - below / 2000)) << "below the cavity's pressure";
  EXPECT_LT(ooze, 5e-3 * disc(2e-3));
  sim.openings[0].outside = 3 * kMmHg;
  EXPECT_GT(steady_flow(sim), 20 * ooze) << "suction has lowered it";
  sim.openings[0].outside = kCavity;
  sim.clips = {{.segment = 0, .s = 0.2, .cover = 1}, {.segment = 0, .s = 0.8, .cover = 1}};
  EXPECT_EQ(steady_flow(sim), 0);
}

TEST(Bleeding, NothingEntersAVesselBelowThePressureAround) {
  VesselGraph g = stump(3e-3);
  g.sources[0].pressure = 5 * kMmHg;
  Simulation sim(g);
  sim.openings = {hole(0, 0.5, 2e-3), cut(0, 0.8, 3e-3)};
  for (int i = 0; i < 500; ++i) {
    sim.tick();
    ASSERT_EQ(sim.flows[0].flow[0], 0);
    ASSERT_EQ(sim.flows[1].flow[0], 0);
  }
  EXPECT_TRUE(sim.flows[0].fed[0]);
}

TEST(Bleeding, BadOpeningsAndClipsAreLeftOutAndTold) {
  Simulation sim(pelvis());
  const double nan = std::nan("");
  sim.openings = {{.segment = 99, .area = 1e-6},
                  {.segment = 0, .s = nan, .area = 1e-6},
                  {.segment = 0, .area = nan},
                  {.segment = 0, .s = 2, .area = 1e-6},
                  {},
                  hole(3, 0.5, 1e-3)};
  sim.clips = {{.segment = -7, .cover = 1}, {.segment = 1, .s = 0.5, .cover = nan}, {}};
  const FlowReport r = sim.tick();
  EXPECT_EQ(r.flags, FlowReport::kBadOpening | FlowReport::kBadClip);
  EXPECT_FALSE(r.fine());
  EXPECT_GT(sim.flows[5].flow[0], 0);
  sim.openings.assign(65, Opening{});
  sim.clips.clear();
  EXPECT_EQ(sim.tick().flags, FlowReport::kBadOpening) << "more than the model has slots";
}

}  // namespace
}  // namespace trocar::vessels
