// A hook with a foot: what lies in its crook comes along and is parted there, what lies anywhere else is not. A band, a
// slack strand of 1.4 mm, lies along x below the trocar; the hook goes down beside it, its foot comes below it or not.
#include <algorithm>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "small_energy.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kHand = 0;
constexpr double kFoot = 0.0026, kWire = 0.0012, kBand = 0.0007;  ///< [m] reach, thickness, radius
constexpr double kBandY = 0.020, kMiddle = 0.0375;                ///< [m]
constexpr BodyId kTheBand = BodyId::strand(0);

scene::Description description(double foot) {
  scene::Description d = small::energy_description();
  d.walls.clear(), d.solids.clear(), d.membranes.clear(), d.vessels.clear();
  d.fluids.reset();
  scene::Strand band = small::cord();
  band.stations = {{0, kBand, 0}};
  band.foundation = 5;
  band.cuttable = true;
  d.strands = {band};
  d.ports = {{"above", {kMiddle, kBandY, small::kHeight}, 0.005, {}}, d.ports.back()};
  d.instruments = {d.instruments.back()};
  d.instruments[0].foot = foot;
  d.instruments[0].electrode.seals = 0.001;
  d.placements = {{"hook", "above", {kMiddle, kBandY - 0.006, 0.02}, 0, {}}};
  return d;
}

const Model& with_foot() {
  static const Model compiled = scene::compile(description(kFoot));
  return compiled;
}
const Model& without_foot() {
  static const Model compiled = scene::compile(description(0));
  return compiled;
}

constexpr double kTowards = 0.5 * std::numbers::pi, kAway = -kTowards;  ///< the foot's way: to the band, off it

struct Bench : small::Table {
  Vec3d tip;

  /// @param roll  with which the hook is held
  Bench(const Model& m, double roll) : Table(m), tip{kMiddle, kBandY - 0.006, 0.02} {
    input.tools[kHand].roll = float(roll);
    point(kHand, tip);
    steps(600);
  }
  void go(Vec3d to, double speed = 0.03) {
    carry(kHand, tip, to, speed);
    tip = to;
  }
  /// Down beside the band, the wire to its side, and back up by 13 mm.
  void hook_and_lift() {
    go({kMiddle, kBandY - 0.006, -0.003});
    go({kMiddle, kBandY - 0.5 * kWire - kBand - 0.0002, -0.003});
    go({kMiddle, tip.y, 0.010});
    steps(100);
  }
  const tissue::StrandState& band() const { return state.strands[0]; }
  /// Of the band's highest node.
  std::size_t top() const {
    const auto lower = [](Vec3d a, Vec3d b) { return a.z < b.z; };
    return std::size_t(std::max_element(band().x.begin(), band().x.end(), lower) - band().x.begin());
  }
  double lifted() const { return band().x[top()].z; }
  Vec3d force() const {
    const double* f = tool(kHand).contact_force;
    return {f[0], f[1], f[2]};
  }
};

TEST(Hook, CatchesABandWithItsFootAndDrawsItAlong) {
  Bench b(with_foot(), kTowards);
  b.hook_and_lift();
  std::printf("    lifted by %.1f mm with %.0f mN\n", 1e3 * b.lifted(), 1e3 * length(b.force()));
  EXPECT_NEAR(b.lifted(), b.tip.z + kWire + kBand, 0.0007) << "it lies on the foot";
  EXPECT_LT(b.force().z, 0) << "it pulls the hook back";
}

TEST(Hook, TurnedByHalfATurnItCatchesNothing) {
  Bench b(with_foot(), kAway);
  b.hook_and_lift();
  EXPECT_LT(b.lifted(), 0.001);
  EXPECT_EQ(length(b.force()), 0);
}

TEST(Hook, WithoutAFootItCatchesNothing) {
  Bench b(without_foot(), kTowards);
  b.hook_and_lift();
  EXPECT_LT(b.lifted(), 0.001);
}

TEST(Hook, SlidesToAndFroAlongWhatItHasCaught) {
  Bench b(with_foot(), kTowards);
  b.hook_and_lift();
  const Vec3d middle = b.tip;
  double most = 0;
  for (const double x : {0.008, -0.008, 0.0}) {
    const std::vector<Vec3d> before = b.band().x;
    b.go(middle + Vec3d{x, 0, 0}, 0.02);
    EXPECT_NEAR(b.band().x[b.top()].x, b.tip.x, 0.0026) << "what is up is where the hook is";
    EXPECT_GT(b.lifted(), b.tip.z);
    for (std::size_t i = 0; i < before.size(); ++i) most = std::max(most, std::fabs(b.band().x[i].x - before[i].x));
  }
  std::printf("    goes along by %.2f mm at most on ways of 8 and 16 mm\n", 1e3 * most);
  EXPECT_LT(most, 0.0025);
}

TEST(Hook, LetsGoOfABandThatItTurnsItsFootAwayFrom) {
  Bench b(with_foot(), kTowards);
  b.hook_and_lift();
  ASSERT_GT(b.lifted(), 0.010);
  b.input.tools[kHand].roll = float(kAway);
  b.steps(1500);
  EXPECT_LT(b.lifted(), 0.001);
}

TEST(Hook, HeatsWhatLiesInItsCrookAndNothingBesideIt) {
  for (const double roll : {kTowards, kAway}) {
    Bench b(with_foot(), roll);
    b.hook_and_lift();
    b.input.pedals = kBlue;
    b.steps(500);
    const double arc = b.model.strand_bodies[0].arc[b.top()];
    const float warm = tissue::reading(b.model.energy.heat, b.state.heat, kTheBand, {arc, 0, 0}).temperature;
    if (roll == kAway) {
      EXPECT_EQ(b.state.heat.books.given, 0);
    } else {
      EXPECT_EQ(b.state.electrodes[kHand].body, kTheBand);
      EXPECT_GT(warm, 60);
    }
  }
}

TEST(Hook, PartsABandThatItDrawsTautWhenTheYellowPedalIsPressed) {
  Bench b(with_foot(), kTowards);
  b.hook_and_lift();
  ASSERT_EQ(b.count(Event::parted), 0);
  b.input.pedals = kYellow;
  for (int i = 0; i < 3000 && b.count(Event::parted) == 0; ++i) b.step();
  EXPECT_GT(b.count(Event::parted), 0);
  b.input.pedals = 0;
  b.steps(300);
  EXPECT_EQ(length(b.force()), 0) << "its ends have sprung away";
}

}  // namespace
