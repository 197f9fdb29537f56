// What runs out of a closed sheet that is open: against the law of its hole, and its balance.
#include <numeric>

#include <trocar/core/tick.hpp>
#include <trocar/tissue/membrane/leak.hpp>

#include "closed_sheets.hpp"
#include "validation.hpp"

using namespace trocar;
using namespace trocar::tissue;
using test::expect_within;

namespace {

using core::kTick;
using test::filled;
using test::kRadius;
using test::sphere;

constexpr double kBile = 1010;  // [kg/m^3]

/// A sphere of bile, its upper cap held, or all of it.
struct Pouch {
  MembraneModel model;
  MembraneState state;
  MembraneWork work;
  std::vector<std::uint8_t> parted;

  Pouch(double pressure, double held_above, double bulk = 1e5) {
    MembraneDescription d = filled(sphere(2), pressure, bulk);
    d.enclosure.density = kBile;
    d.gravity = {0, 0, -9.81};
    d.held.resize(d.positions.size());
    for (size_t i = 0; i < d.positions.size(); ++i) d.held[i] = d.positions[i].z > held_above * kRadius;
    model = build(d, kTick);
    state = rest_state(model);
    work = make_work(model);
    parted.assign(model.triangles.size(), 0);
  }
  Leak tick() {
    EXPECT_TRUE(advance(model, {}, {}, {}, state, work).fine());
    return leak(model, parted, work, state);
  }
  double volume() const { return model.enclosure.volume; }

  /// The triangle whose middle is farthest that way.
  size_t triangle(Vec3d way) const {
    const auto along = [&](const std::array<int, 3>& t) {
      return std::accumulate(t.begin(), t.end(), 0.0,
                             [&](double sum, int node) { return sum + dot(model.network.rest[size_t(node)], way); });
    };
    return size_t(std::max_element(model.triangles.begin(), model.triangles.end(),
                                   [&](const auto& a, const auto& b) { return along(a) < along(b); }) -
                  model.triangles.begin());
  }
  void open(Vec3d way) {
    parted[triangle(way)] = 1;
    tear_bends(model, parted, state);
  }
  /// Draws the corners of that triangle apart from its middle until its area has grown by so much.
  void gape(Vec3d way, double by) {
    const std::array<int, 3>& t = model.triangles[triangle(way)];
    const Vec3d *x = model.network.rest.data(), a = x[t[0]], b = x[t[1]], c = x[t[2]];
    const double drawn = 0.5 * length(cross(b - a, c - a)), wider = std::sqrt(1 + by / drawn);
    const Vec3d middle = (a + b + c) / 3.0;
    for (const int node : t) set_position(model.network, state.network, node, middle + wider * (x[node] - middle));
  }
};

constexpr Vec3d kDown{0, 0, -1}, kUp{0, 0, 1};

}  // namespace

TEST(Leak, AWholeWallKeepsAll) {
  Pouch p(1000, 0.8);
  for (int t = 0; t < 50; ++t) EXPECT_EQ(p.tick().picolitres, 0);
  EXPECT_EQ(p.state.enclosure.left, 1);
}

TEST(Leak, ThroughTwoSquareMillimetresAtAKilopascalGo17MillilitresASecond) {
  Pouch p(1000, -2);  // all of it is held
  p.open(kUp);
  p.gape(kUp, 2e-6);
  p.state.enclosure.volume = p.volume();
  p.work.place = p.model.network.rest;
  p.state.enclosure.pressure = 1000 + kBile * 9.81 * kRadius;  // so that there are 1000 Pa at the top
  const Leak out = leak(p.model, p.parted, p.work, p.state);
  expect_within("area of the hole [mm2]", "f32", 1e6 * out.area / 2 - 1, 1e-3);
  expect_within("mL/s through it, Torricelli's law", "f32", 1e-9 * double(out.picolitres) / kTick / 1.717 - 1, 0.02);
  EXPECT_GT(dot(out.direction, kUp), 0.97);
}

TEST(Leak, AStiffVesselDrainsInTorricellisTime) {
  Pouch p(0, -2);
  p.open(kDown);
  p.gape(kDown, 4e-6);
  int ticks = 0;
  Leak out;
  while (p.state.enclosure.left > 0.04 && ticks < 60000) {
    out = p.tick();
    ++ticks;
  }
  // As a vessel with upright walls: the liquid stands `left` times its height above the bottom.
  const double height = 2 * kRadius, hole = out.place.z + kRadius;
  const double time = 2 * p.volume() / (height * 0.61 * out.area * std::sqrt(2 * 9.81)) *
                      (std::sqrt(height - hole) - std::sqrt(0.04 * height - hole));
  expect_within("time to a twenty-fifth, Torricelli's law", "f32", ticks * kTick / time - 1, 0.02);
}

TEST(Leak, AHoleAboveTheLiquidLosesNoneWithoutPressure) {
  Pouch p(0, -2);
  p.open(kUp);
  p.gape(kUp, 4e-6);
  for (int t = 0; t < 100; ++t) p.tick();
  EXPECT_GT(p.state.enclosure.left, 0.999);
}

TEST(Leak, WhatRanOutIsWhatIsMissingAndTheWallSlackens) {
  Pouch p(800, 0.8);
  p.open(kDown);
  p.parted[p.triangle({0.3, 0, -1})] = 1;
  p.gape(kDown, 6e-6);
  std::int64_t out = 0;
  double last = 1;
  for (int t = 0; t < 1500; ++t) {
    const Leak now = p.tick();
    EXPECT_GE(now.picolitres, 0);
    EXPECT_LE(p.state.enclosure.left, last);
    last = p.state.enclosure.left;
    out += now.picolitres;
  }
  expect_within("what ran out and what is left, of all", "f64", 1e-15 * double(out) / p.volume() + last - 1, 1e-9);
  EXPECT_LT(last, 0.98);
  EXPECT_LT(p.state.enclosure.pressure, 790);
  expect_within("the wall follows what is left", "f32", p.state.enclosure.volume / (last * p.volume()) - 1, 0.01);
  EXPECT_LT(energy(p.model, p.state).kinetic, 1e-4);
}

TEST(Leak, ALargerHoleLosesMore) {
  double lost[2];
  for (const int k : {0, 1}) {
    Pouch p(500, -2);
    p.open(kDown);
    p.gape(kDown, k == 0 ? 1e-6 : 4e-6);
    for (int t = 0; t < 200; ++t) p.tick();
    lost[k] = 1 - p.state.enclosure.left;
  }
  expect_within("four times the hole loses four times as much", "f32", lost[1] / lost[0] / 4 - 1, 0.1);
}
