// Couplings between material points: what one body loses the other gains, and the rule that keeps them stable.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/interactions/couplings/coupled.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

#include "../tissue/test_bodies.hpp"
#include "few_bodies.hpp"

namespace trocar::interactions {
namespace {

using core::kTick;

/// Two bodies of one free node each, next to each other, that nothing else holds.
struct TwoNodes : test::FewBodies {
  static constexpr int kNode = 1;
  const MaterialPoint near, far;

  TwoNodes(double light, double heavy) : near(point(0)), far(point(1)) {
    for (const double mass : {light, heavy}) {
      models.solids.emplace_back().network = tissue::build(tissue::test::oscillator(mass, 1e-6, 0), kTick);
      states.solids.push_back(rest_state(models.solids.back().network));
      work.organs.emplace_back().loads.reserve(64);
      work.solids.push_back(tissue::make_work(models.solids.back().network));
    }
  }
  static MaterialPoint point(std::size_t body) {
    MaterialPoint p;
    p.body = BodyId::organ(body);
    p.count = 1;
    p.node[0] = kNode;
    p.weight[0] = 1;
    return p;
  }
  Vec3d v(std::size_t i) { return tissue::velocity(models.solids[i].network, states.solids[i], kNode); }
  Vec3d x(std::size_t i) { return tissue::position(models.solids[i].network, states.solids[i], kNode); }
  /// One tick; f puts the coupling's loads. Far bodies advance first, as in a step.
  template <class F>
  void tick(F&& f) {
    for (OrganWork& organ : work.organs) organ.loads.clear();
    f();
    for (std::size_t i : {1u, 0u}) {
      work.organs[i].loads.sort();
      tissue::advance(models.solids[i].network, work.organs[i].loads.sorted, work.organs[i].loads.reaction,
                      states.solids[i], work.solids[i]);
    }
  }
};

/// Does it stay bounded when the far end resists `share` of the rule's resistance?
bool is_stable(double light, double heavy, double k, double d, double share) {
  TwoNodes two(light, heavy);
  tissue::set_velocity(two.models.solids[1].network, two.states.solids[1], TwoNodes::kNode, {0, 0.01, 0});
  const Vec3d middle = two.x(1);
  for (int i = 0; i < 3000; ++i) {
    two.tick([&] {
      const Coupled ends(two.all(), two.near, two.far);
      put_load(two.all(), two.near, {.k = k, .target = ends.at, .d = d, .u = ends.moves}, {});
      const Vec3d pull = k * ends.apart + d * (ends.v - ends.moves);
      bear(two.all(), two.far, pull, share * resistance_of(k, d, kTick), {});
    });
    const double gone = length(two.x(1) - two.x(0));
    if (!(gone < 0.01) || !(length(two.x(1) - middle) < 1)) return false;
  }
  return true;
}

TEST(Couplings, TheRuleHoldsTheLightestBodies) {
  for (const double k : {10.0, 300.0, 5000.0})
    for (const double damping : {0.0, 2e-4, 2e-3})
      for (const double heavy : {1e-9, 1e-6, 1e-4, 1e-2})
        EXPECT_TRUE(is_stable(1e-9, heavy, k, damping * k, 1)) << k << " " << damping << " " << heavy;
}

TEST(Couplings, AndIsNoMoreThanTheLightestNeeds) {
  // The limit by bisection, for a far body that weighs nothing.
  for (const double damping : {0.0, 2e-4, 1e-3}) {
    double low = 0, high = 1.5;
    for (int i = 0; i < 12; ++i) {
      const double share = 0.5 * (low + high);
      (is_stable(1e-9, 1e-9, 1000, damping * 1000, share) ? high : low) = share;
    }
    RecordProperty("share_at_limit", std::to_string(high));
    EXPECT_LT(high, 1) << damping;
    EXPECT_GT(high, 0.2) << damping << ": the rule would cost ten times the inertia that is needed";
  }
}

/// A block of a lattice; another one beside it, tied to it by bonds over the gap between their faces.
struct TiedBlocks : test::FewBodies {
  BondSet set;
  std::vector<BondState> bonds;

  explicit TiedBlocks(double toughness) {
    for (const double at : {0.0, 0.022}) {
      const tissue::BoxLattice box = tissue::box_lattice(4, 3, 3, 0.005, {at, 0, 0});
      models.solids.emplace_back().network =
          tissue::build(tissue::lattice_network(box.corners, box.cells, {},
                                                {.youngs_modulus = 20e3, .density = 1050, .damping_time = 4e-4})
                            .network,
                        kTick);
      states.solids.push_back(rest_state(models.solids.back().network));
      work.organs.emplace_back().loads.reserve(4096);
      work.solids.push_back(tissue::make_work(models.solids.back().network));
    }
    set.law = tissue::CohesiveLaw::of(toughness, 0.004);
    for (int n = 0; n < models.solids[1].network.nodes; ++n) {
      const Vec3d p = models.solids[1].network.rest[std::size_t(n)];
      if (p.x > 0.0221) continue;
      set.bonds.push_back({at_node(all(), BodyId::organ(1), n), facing(p), 2.5e-5});
    }
    bonds.resize(set.bonds.size());
  }
  /// Rooted in the node of the first block that is nearest to a place.
  MaterialPoint facing(Vec3d place) {
    const std::vector<Vec3d>& at = models.solids[0].network.rest;
    const auto nearest = std::min_element(at.begin(), at.end(),
                                          [place](Vec3d a, Vec3d b) { return length(a - place) < length(b - place); });
    return at_node(all(), BodyId::organ(0), int(nearest - at.begin()), place - *nearest);
  }
  void set_velocity(std::size_t block, Vec3d v) {
    for (int n = 0; n < models.solids[block].network.nodes; ++n)
      tissue::set_velocity(models.solids[block].network, states.solids[block], n, v);
  }
  /// That the far ends' resistance adds, which no body has [kg].
  double added_mass() const {
    double sum = 0;
    for (const Bond& bond : set.bonds) {
      const double k = set.law.stiffness() * bond.area;
      sum += kTick * resistance_of(k, 2e-4 * k, kTick);
    }
    return sum;
  }
  void tick() {
    for (OrganWork& organ : work.organs) organ.loads.clear();
    bond_loads(all(), set, bonds, kTick);
    for (std::size_t i : {0u, 1u}) {
      work.organs[i].loads.sort();
      ASSERT_TRUE(tissue::advance(models.solids[i].network, work.organs[i].loads.sorted, work.organs[i].loads.reaction,
                                  states.solids[i], work.solids[i])
                      .fine());
    }
  }
  Vec3d momentum() const {
    Vec3d p;
    for (std::size_t i : {0u, 1u})
      for (int n = 0; n < models.solids[i].network.nodes; ++n)
        p += models.solids[i].network.mass[std::size_t(n)] *
             tissue::velocity(models.solids[i].network, states.solids[i], n);
    return p;
  }
  double energy() {
    double e = energy_spent(set, bonds);
    for (std::size_t i : {0u, 1u}) {
      const tissue::NetworkEnergy of = tissue::energy(models.solids[i].network, states.solids[i]);
      e += of.kinetic + of.elastic;
    }
    for (std::size_t b = 0; b < set.bonds.size(); ++b) {
      const double open = length(opening_of(all(), set.bonds[b]));
      e += 0.5 * (1 - double(bonds[b].damage)) * set.law.stiffness() * set.bonds[b].area * open * open;
    }
    return e;
  }
};

TEST(Couplings, WhatIsTiedFliesOnAsIfItWereNot) {
  for (const double toughness : {50.0, 2.0}) {
    TiedBlocks blocks(toughness);
    for (const std::size_t i : {0u, 1u}) blocks.set_velocity(i, {0.25, 0.05, 0});
    const Vec3d start = blocks.momentum();
    for (int i = 0; i < 1000; ++i) blocks.tick();
    EXPECT_LT(length(blocks.momentum() - start), 0.003 * length(start)) << "single precision of places";
  }
}

TEST(Couplings, BondsHandMomentumOverAndMakeNoEnergy) {
  for (const double toughness : {50.0, 2.0}) {
    TiedBlocks blocks(toughness);
    blocks.set_velocity(1, {0.25, 0.05, 0});
    const Vec3d start = blocks.momentum();
    const double had = blocks.energy(), speed = length(Vec3d{0.25, 0.05, 0});
    double most = 0;
    for (int i = 0; i < 1500; ++i) {
      blocks.tick();
      most = std::max(most, blocks.energy());
    }
    const double astray = length(blocks.momentum() - start);
    RecordProperty("astray_percent", std::to_string(100 * astray / length(start)));
    RecordProperty("astray_of_added", std::to_string(astray / (speed * blocks.added_mass())));
    EXPECT_LT(astray, 0.6 * speed * blocks.added_mass()) << "that of the far ends' resistance, at the common speed";
    EXPECT_LT(most, 1.02 * had);
    EXPECT_GT(holding_share(blocks.set, blocks.bonds), 0.9);
  }
}

TEST(Couplings, ABondSpendsItsToughnessTimesItsArea) {
  TiedBlocks blocks(2);
  for (int i = 0; i < 200; ++i) {  // drawn apart, as with two hands
    blocks.set_velocity(0, {});
    blocks.set_velocity(1, {0.5, 0, 0});
    blocks.tick();
  }
  ASSERT_EQ(holding_share(blocks.set, blocks.bonds), 0);
  EXPECT_NEAR(energy_spent(blocks.set, blocks.bonds), 2 * blocks.set.area(), 1e-9);
}

}  // namespace
}  // namespace trocar::interactions
