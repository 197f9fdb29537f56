// A strip that is peeled off what it is bonded to: force, energy, and that nothing heals.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/couplings/bonds.hpp>

#include "few_bodies.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

using core::kTick;

constexpr double kToughness = 50, kOpens = 0.003, kSpacing = 0.0015, kModulus = 8e6, kThickness = 0.0005;
constexpr int kColumns = 31, kRows = 5;  // along the strip, and across it

/// A strip in the plane z = 0, bonded to space but for its first column, which a jaw holds.
struct Strip {
  test::FewBodies few;
  tissue::MembraneModel& sheet = few.models.membranes.emplace_back().sheet;
  tissue::MembraneState& state = few.states.membranes.emplace_back();
  tissue::MembraneWork& work = few.work.membranes.emplace_back().body;
  NetworkLoads& loads = few.work.membranes.back().loads;
  BondSet set;
  std::vector<BondState> bonds;
  std::vector<Vec3d> targets;
  double width = kSpacing * (kRows - 1);

  Strip() {
    tissue::MembraneDescription d;
    d.columns = kColumns, d.rows = kRows;
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c) d.positions.push_back({kSpacing * c, kSpacing * r, 0});
    d.held.assign(d.positions.size(), 0);
    for (int r = 0; r < kRows; ++r) d.held[std::size_t(r * kColumns)] = 1;
    d.thickness = kThickness, d.youngs_modulus = kModulus, d.density = 4000;  // it is peeled slowly: few sub-steps
    d.damping_time = d.bending_damping_time = 5e-5;
    d.global_damping = 40;  // the jaw starts with a jerk
    sheet = build(d, kTick);
    state = rest_state(sheet);
    work = make_work(sheet, d.positions.size());
    loads.reserve(d.positions.size());
    set.law = tissue::CohesiveLaw::of(kToughness, kOpens);
    for (int i = 0; i < sheet.nodes(); ++i) {
      const int column = i % kColumns, row = i / kColumns;
      if (column == 0) continue;
      const double side = row == 0 || row == kRows - 1 ? 0.5 : 1.0;
      set.bonds.push_back({at_node(few.all(), BodyId::membrane(0), i), in_space(d.positions[std::size_t(i)]),
                           side * kSpacing * kSpacing});
    }
    bonds.resize(set.bonds.size());
    for (int node : sheet.held_nodes) targets.push_back(d.positions[std::size_t(node)]);
  }
  /// One tick, the jaw carried on. @return its pull [N]
  Vec3d pull(Vec3d way) {
    for (Vec3d& target : targets) target += way;
    loads.clear();
    bond_loads(few.all(), set, bonds, kTick);
    loads.sort();
    EXPECT_FALSE(loads.overflowed);
    EXPECT_TRUE(tissue::advance(sheet, targets, loads.sorted, loads.reaction, state, work).fine());
    std::vector<tissue::BorderPull> pulls(sheet.held_nodes.size());
    tissue::border_pulls(sheet, state, work, pulls);
    Vec3d force;
    for (const tissue::BorderPull& p : pulls) force += p.force;
    return -force;
  }
};

/// Peeled at right angles: the jaw goes up as fast as the front runs away from it.
struct Peeled {
  /// Work for a way of the front, where it has become steady: the pull upwards and, as the strip bends around its front
  /// and does not stand quite upright, a little of it along [N]
  double force = 0;
  double share = 0, most_share_step = 0;
  double work = 0, kept = 0, spent = 0;  ///< of the jaw; in the strip; on bonds [J]
};
Peeled peel(double speed, double way) {
  Strip strip;
  Peeled out;
  int steady = 0;
  const int ticks = int(way / (speed * kTick));
  double share = 1;
  for (int t = 0; t < ticks; ++t) {
    const Vec3d step = speed * kTick * Vec3d{1, 0, 1}, force = strip.pull(step);
    out.work += dot(force, step);
    if (t > ticks / 2) out.force += force.x + force.z, ++steady;
    const double now = holding_share(strip.set, strip.bonds);
    EXPECT_LE(now, share) << "no bond heals";
    share = now;
  }
  out.force /= steady;
  out.share = share;
  out.kept = tissue::energy(strip.sheet, strip.state).stretch;
  out.spent = energy_spent(strip.set, strip.bonds);
  return out;
}

const Peeled& slow() {
  static const Peeled made = peel(0.008, 0.024);
  return made;
}

/// Of a strip of width b, at right angles: R = F/b + (F/b)^2 / 2 E d.  [Kendall 75]
double kendall(double width) {
  const double stiff = kModulus * kThickness;
  return width * (std::sqrt(stiff * stiff + 2 * stiff * kToughness) - stiff);
}

}  // namespace

TEST(Bonds, AStripIsPeeledOffWithToughnessTimesWidth) {
  const Strip strip;
  RecordProperty("force_N", std::to_string(slow().force));
  EXPECT_NEAR(slow().force, kendall(strip.width), 0.05 * kendall(strip.width));
}

TEST(Bonds, TheJawsWorkIsInTheStripAndInWhatWasParted) {
  RecordProperty("work_J", std::to_string(slow().work));
  EXPECT_LT(slow().share, 0.7);
  EXPECT_NEAR(slow().kept + slow().spent, slow().work, 0.10 * slow().work)
      << "the rest is damping, and bonds that are stretched";
  EXPECT_LT(slow().kept + slow().spent, slow().work);
}

TEST(Bonds, TheForceDoesNotDependOnTheSpeedOfAHand) {
  EXPECT_NEAR(peel(0.004, 0.024).force, slow().force, 0.10 * slow().force);
}

TEST(Bonds, PressedBackWhatHasPartedDoesNotHold) {
  Strip strip;
  for (int t = 0; t < 1500; ++t) strip.pull(0.01 * kTick * Vec3d{1, 0, 1});
  const double share = holding_share(strip.set, strip.bonds);
  for (int t = 0; t < 1500; ++t) strip.pull(-0.01 * kTick * Vec3d{1, 0, 1});
  EXPECT_LE(holding_share(strip.set, strip.bonds), share);
  Vec3d force;
  for (int t = 0; t < 100; ++t) force = strip.pull(0.01 * kTick * Vec3d{0, 0, 1});
  EXPECT_LT(force.z, 0.05 * kendall(strip.width)) << "loose as far as it was peeled";
}

TEST(Bonds, OneThatIsTougherThanItsBaseTearsThatOnlyWhereItIsTornOff) {
  BondSet set;
  set.bonds.resize(4);
  for (Bond& bond : set.bonds) bond.area = 2e-5;
  std::vector<BondState> states{
      {1, BondState::pulled}, {0.5f, BondState::pulled}, {1, BondState::cut}, {1, BondState::burnt}};
  EXPECT_EQ(breached_area(set, states), 0) << "these part themselves";
  set.breaches = true;
  EXPECT_DOUBLE_EQ(breached_area(set, states), 2e-5) << "torn off, not half torn, cut or burnt";
  EXPECT_TRUE(states[0].raw());
  for (BondState& state : states)
    if (!state.holds()) staunch(set, state);
  EXPECT_DOUBLE_EQ(breached_area(set, states), 2e-5) << "coagulated it is dry, and still torn";
  EXPECT_FALSE(states[0].raw());
  EXPECT_EQ(states[2].cause, BondState::burnt);
}
