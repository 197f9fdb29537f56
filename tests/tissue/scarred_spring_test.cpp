// Springs that heat has changed: what a block of them is like.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/network.hpp>

using namespace trocar;
using namespace trocar::tissue;

namespace {

using core::kTick;
constexpr double kLong = 0.040;

enum class End { loose, slides, held };

/// A bar of 40 x 10 x 10 mm along x; its end at x = 0 may be held, in x or altogether.
struct Bar {
  NetworkModel model;
  NetworkState state;
  NetworkWork work;
  std::uint32_t worst = 0;     ///< flags of all ticks
  std::vector<int> low, high;  ///< nodes of its ends

  explicit Bar(End end, Vec3d gravity = {}) {
    const BoxLattice box = box_lattice(8, 2, 2, 0.005, {0, 0, 0});
    LatticeMaterial material;
    material.youngs_modulus = 20e3;
    material.density = 1050;
    material.damping_time = 4e-4;
    NetworkDescription d = lattice_network(box.corners, box.cells, {}, material).network;
    d.gravity = gravity;
    for (int n = 0; n < int(d.positions.size()); ++n) {
      if (d.positions[size_t(n)].x < 1e-6) low.push_back(n);
      if (d.positions[size_t(n)].x > kLong - 1e-6) high.push_back(n);
    }
    d.fixed.assign(d.positions.size(), 0);
    for (const int n : low) d.fixed[size_t(n)] = end == End::held ? kHeld : end == End::slides ? kHeldX : kFree;
    model = build(d, kTick);
    state = rest_state(model);
    work = make_work(model);
  }

  /// @param force  on the far end in all [N]
  void tick(double share, double stiff, double force) {
    std::vector<NodeLoad> loads;
    for (const int n : high) loads.push_back({.node = n, .f0 = {float(force / double(high.size())), 0, 0}});
    std::vector<ScarredSpring> scars;
    for (int s = 0; s < model.springs && stiff > 1; ++s)
      scars.push_back({model.spring_nodes[size_t(2 * s)], model.spring_nodes[size_t(2 * s + 1)],
                       spring_stiffness(model, s), double(model.spring_rest[size_t(s)]), share, stiff});
    worst |= advance(model, loads, {}, state, work, nullptr, Hands::off, scars).flags;
  }
  double length_now() const { return length(middle(high) - middle(low)); }
  Vec3d middle(const std::vector<int>& nodes) const {
    Vec3d x;
    for (const int n : nodes) x += position(model, state, n) / double(nodes.size());
    return x;
  }
  double length_after(double share, double stiff, double force) {
    for (int i = 0; i < 4000; ++i) tick(share, stiff, force);
    EXPECT_EQ(worst, 0u);
    return length_now();
  }
};

TEST(ScarredSpring, ABarOfThemStretchesAsMuchLessAsItIsStiffer) {
  constexpr double kForce = 0.04;  // a strain of 2 %
  const double before = Bar(End::slides).length_after(1, 1, kForce) - kLong;
  for (const double stiff : {2.0, 4.0, 10.0}) {
    const double after = Bar(End::slides).length_after(1, stiff, kForce) - kLong;
    std::printf("    stiffness times %g: %.4f mm, before %.4f: %.3f times\n", stiff, 1e3 * after, 1e3 * before,
                before / after);
    EXPECT_NEAR(before / after, stiff, 0.03 * stiff) << "the bar's own law is curved by as much";
  }
}

TEST(ScarredSpring, ABarOfThemIsShorterByAsMuchAsTheyAre) {
  for (const auto& [share, stiff] : {std::pair{0.9, 4.0}, std::pair{0.8, 10.0}, std::pair{0.95, 1.6}}) {
    const double after = Bar(End::loose).length_after(share, stiff, 0);
    std::printf("    share %g, stiffness times %g: %.4f of its length\n", share, stiff, after / kLong);
    // The spring that has stayed as it was pushes with k, so both rest where q k (r - s l) vanishes.
    EXPECT_NEAR(after / kLong, share, 0.003);
  }
}

TEST(ScarredSpring, WhatMovesAsAWholeIsNotHeldBack) {
  const auto speed_after = [](double stiff) {
    Bar bar(End::loose);
    for (int n = 0; n < bar.model.nodes; ++n) set_velocity(bar.model, bar.state, n, {0.1, 0.05, -0.2});
    for (int i = 0; i < 500; ++i) bar.tick(0.95, stiff, 0);
    Vec3d momentum;
    double mass = 0;
    for (int n = 0; n < bar.model.nodes; ++n) {
      momentum += bar.model.mass[size_t(n)] * velocity(bar.model, bar.state, n);
      mass += bar.model.mass[size_t(n)];
    }
    return momentum / mass;
  };
  for (const double stiff : {1.0, 4.0, 10.0}) EXPECT_LT(length(speed_after(stiff) - Vec3d{0.1, 0.05, -0.2}), 1e-4);
}

TEST(ScarredSpring, WhatIsShakenComesToRestHoweverStiff) {
  Bar bar(End::loose);
  core::Random random(3);
  const auto speed = [&] {
    double most = 0;
    for (int n = 0; n < bar.model.nodes; ++n) most = std::max(most, length(velocity(bar.model, bar.state, n)));
    return most;
  };
  for (int n = 0; n < bar.model.nodes; ++n)
    set_velocity(bar.model, bar.state, n, {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  for (int i = 0; i < 2000; ++i) bar.tick(0.8, 100, 0);
  std::printf("    fastest node after 2 s: %.2e m/s\n", speed());
  EXPECT_LT(speed(), 0.5) << "momentum and spin stay";
  EXPECT_NEAR(bar.length_now(), 0.8 * kLong, 0.02 * kLong) << "spinning";
}

TEST(ScarredSpring, ABarThatHangsFromOneEndWeighsWhatItDid) {
  const auto stretch = [](double stiff) {
    Bar bar(End::slides, {9.81, 0, 0});
    return bar.length_after(1, stiff, 0) - kLong;
  };
  const double before = stretch(1), after = stretch(4);
  std::printf("    hangs down by %.4f mm, before %.4f\n", 1e3 * after, 1e3 * before);
  EXPECT_NEAR(before / after, 4, 0.1);
}

/// How high the far end of a bar that swings about the other comes, in each second.
std::vector<double> heights(double share, double stiff) {
  Bar bar(End::held, {0, 0, -9.81});
  std::vector<double> highest;
  for (int second = 0; second < 8; ++second) {
    highest.push_back(-1);
    for (int i = 0; i < 1000; ++i) {
      bar.tick(share, stiff, 0);
      highest.back() = std::max(highest.back(), bar.middle(bar.high).z);
    }
  }
  EXPECT_EQ(bar.worst, 0u);
  return highest;
}

TEST(ScarredSpring, WhatSwingsComesToRest) {
  for (const auto& [share, stiff] : {std::pair{1.0, 1.0}, std::pair{0.9, 4.0}, std::pair{0.8, 10.0}}) {
    const std::vector<double> highest = heights(share, stiff);
    std::printf("    share %g, stiffness times %g: highest in the 2nd, 4th, 8th second %.3f, %.3f, %.3f mm\n", share,
                stiff, 1e3 * highest[1], 1e3 * highest[3], 1e3 * highest[7]);
    EXPECT_LE(highest[3], highest[1] + 1e-6);
    EXPECT_LE(highest[7], highest[3] + 1e-6);
  }
}

}  // namespace
