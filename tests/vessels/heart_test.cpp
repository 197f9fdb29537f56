#include <algorithm>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

TEST(Heart, BeatHasItsPeakNotchAndMean) {
  const std::vector<double> beat = textbook_beat(1000);
  const double ms = 1000 * 60.0 / 72 / 1000;  // of a step
  double mean = 0;
  for (const double w : beat) mean += w / 1000;
  EXPECT_NEAR(mean, 1.0 / 3, 1e-12);
  const int peak = int(std::max_element(beat.begin(), beat.end()) - beat.begin());
  EXPECT_NEAR(peak * ms, 150, 1);
  EXPECT_NEAR(beat[peak], 1, 1e-4);
  EXPECT_EQ(beat[0], 0);
  const int notch = int(350 / ms);
  EXPECT_LT(beat[notch], beat[notch - 20]);
  EXPECT_LT(beat[notch], beat[notch + 40]) << "a second wave follows the notch";
  EXPECT_LT(beat.back(), 0.01);
  for (const double w : beat) EXPECT_GE(w, 0);
}

TEST(Heart, AortaHasTheHeartsPressuresRateAndMean) {
  VesselGraph g;
  g.nodes = 2;
  g.segments = {artery(0, 1, 0.15, 20e-3, 0.4e6, 1.6e-3)};
  g.sources = {{.node = 0}};
  g.ends = {matched_end(g, 0, 93 * kMmHg, 2e-5, 1)};
  g.heart.arterial_swing = 0;
  Simulation sim(g, 3);
  const auto p = trace(sim, 50, [&] { return node_pressure(sim.model, sim.state, 0); });
  double mean = 0;
  int beats = 0;
  for (std::size_t i = 0; i < p.size(); ++i) mean += p[i] / double(p.size());
  for (std::size_t i = 1; i < p.size(); ++i) beats += p[i - 1] < 90 * kMmHg && p[i] >= 90 * kMmHg && p[i] > p[i - 1];
  EXPECT_NEAR(mean / kMmHg, 93.3, 0.3);
  EXPECT_NEAR(*std::max_element(p.begin(), p.end()) / kMmHg, 120, 0.5);
  EXPECT_NEAR(*std::min_element(p.begin(), p.end()) / kMmHg, 80, 0.5);
  EXPECT_NEAR(beats, 60, 1);
}

TEST(Heart, BreathingMovesArteriesAndVeins) {
  VesselGraph g;
  g.nodes = 4;
  g.segments = {artery(0, 1, 0.15, 20e-3, 0.4e6, 1.6e-3), artery(2, 3, 0.1, 5e-3, 0.1e6, 0.5e-3)};
  g.segments[1].vein = true;
  g.segments[1].reference_pressure = 8 * kMmHg;
  g.sources = {{.node = 0}, constant_pressure(2, 8 * kMmHg)};
  g.sources[1].venous = true;
  Simulation sim(g, 3);
  double low = 1e9, high = 0;
  for (int i = 0; i < 9000; ++i) {
    sim.tick();
    const double p = node_pressure(sim.model, sim.state, 3);
    low = std::min(low, p), high = std::max(high, p);
  }
  EXPECT_NEAR((high - low) / kMmHg, 4, 0.1);
}

TEST(Heart, FileShapeIsScaledToItsPressures) {
  VesselGraph g;
  g.nodes = 2;
  g.segments = {artery(0, 1, 0.15, 20e-3, 0.4e6, 1.6e-3)};
  g.sources = {{.node = 0}};
  for (int i = 0; i < 100; ++i) g.heart.shape.push_back(7 + 3 * std::sin(2 * kPi * i / 100));
  g.heart.arterial_swing = 0;
  Simulation sim(g, 3);
  const auto p = trace(sim, 5, [&] { return node_pressure(sim.model, sim.state, 0); });
  EXPECT_NEAR(*std::max_element(p.begin(), p.end()) / kMmHg, 120, 1);
  EXPECT_NEAR(*std::min_element(p.begin(), p.end()) / kMmHg, 80, 1);
}

}  // namespace
}  // namespace trocar::vessels
