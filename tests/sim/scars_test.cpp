// A burnt wall hangs as still as a raw one, however stiff the burn is: a gallbladder that is free of its bed.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

const Model& bed() {
  static const Model made = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json"));
  return made;
}

State off_its_bed() {
  State s = initial_state(bed());
  for (auto& b : s.bonds.at(0)) b = {1, interactions::BondState::burnt};
  return s;
}

/// What a hook leaves behind: dry and six times as stiff in the middle, raw at the rim.
void burn(State& s, Vec3d middle) {
  constexpr double kRim = 0.014;  // [m]
  const tissue::NetworkModel& wall = bed().membranes.at(0).sheet.network;
  for (int i = 0; i < wall.springs; ++i) {
    const Vec3d a = wall.rest[size_t(wall.spring_nodes[size_t(2 * i)])],
                b = wall.rest[size_t(wall.spring_nodes[size_t(2 * i + 1)])];
    const double hot = 1 - length(0.5 * (a + b) - middle) / kRim;
    if (hot > 0 && s.scarred_count < kMaxScarred)
      s.scarred[size_t(s.scarred_count++)] = {BodyId::membrane(0), i, float(1 - 0.14 * hot), float(1 + 5.3 * hot)};
  }
}

double speed(const State& s) {
  double sum = 0;
  const auto& nodes = s.membranes.at(0).network.nodes;
  for (const auto& n : nodes) sum += double(n.vx) * n.vx + double(n.vy) * n.vy + double(n.vz) * n.vz;
  return std::sqrt(sum / double(nodes.size()));
}

double speed_after(State s, int ticks) {
  Work work = make_work(bed());
  for (int i = 0; i < ticks; ++i) step(bed(), bed().start, s, work);
  return speed(s);
}

TEST(Scars, ABurntWallHangsAsStillAsARawOne) {
  State burnt = off_its_bed();
  burn(burnt, {-0.070, 0.112, -0.078});
  ASSERT_GT(burnt.scarred_count, 40);
  const double raw = speed_after(off_its_bed(), 3000), with = speed_after(burnt, 3000);
  std::printf("    %d springs burnt: nodes go at %.3f m/s, raw at %.3f (root of the mean square)\n",
              burnt.scarred_count, with, raw);
  EXPECT_LT(with, raw + 0.01);
}

}  // namespace
