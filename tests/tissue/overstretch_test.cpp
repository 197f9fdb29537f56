// Tissue tears beyond its failure strain: not before, not at a jerk, and there where it is stretched most.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/tissue/failure/overstretch.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

namespace trocar::tissue {
namespace {

constexpr double kFailure = 0.4;

/// A bar of 8 x 3 x 3 cells of 4 mm along x, stretched evenly.
struct Bar {
  NetworkModel model;
  NetworkState state;
  std::vector<std::uint8_t> counters, scratch;

  Bar() {
    const BoxLattice box = box_lattice(8, 3, 3, 0.004, {0, 0, 0});
    LatticeMaterial material;
    material.youngs_modulus = 8e3;
    material.density = 1050;
    model = build(lattice_network(box.corners, box.cells, {}, material).network, 1e-3);
    state = rest_state(model);
    counters.assign(size_t(model.rows), 0);
    scratch = counters;
  }
  /// The part beyond x = from by a strain.
  void stretch(double strain, double from = 0) {
    for (int i = 0; i < model.nodes; ++i) {
      Vec3d p = model.rest[size_t(i)];
      if (p.x > from) p.x = from + (1 + strain) * (p.x - from);
      set_position(model, state, i, p);
    }
  }
  /// The first tear within so many ticks, and when.
  Overstretch look(int ticks, int* when = nullptr) {
    for (int tick = 0; tick < ticks; ++tick) {
      const Overstretch tear =
          find_overstretch(springs_of(model, state), kFailure, std::uint64_t(m_tick++), counters, scratch);
      if (when) *when = tick;
      if (tear.found) return tear;
    }
    return {};
  }

 private:
  int m_tick = 0;
};

TEST(Overstretch, BelowTheFailureStrainNothingTears) {
  Bar bar;
  bar.stretch(0.98 * kFailure);
  EXPECT_FALSE(bar.look(1000).found);
}

TEST(Overstretch, BeyondItTissueTearsAfterFiveHundredthsOfASecond) {
  Bar bar;
  bar.stretch(1.05 * kFailure);
  int when = 0;
  const Overstretch tear = bar.look(200, &when);
  ASSERT_TRUE(tear.found);
  EXPECT_GE(when, 50);
  EXPECT_LE(when, 75);
  EXPECT_NEAR(std::fabs(tear.along.x), 1, 1e-9) << "across the stretch";
  EXPECT_NEAR(tear.length, 1.42 * 0.004, 1e-5);
}

TEST(Overstretch, AJerkTearsNothing) {
  Bar bar;
  for (int i = 0; i < 20; ++i) {
    bar.stretch(2 * kFailure);
    EXPECT_FALSE(bar.look(40).found);
    bar.stretch(0);
    EXPECT_FALSE(bar.look(30).found);
  }
}

TEST(Overstretch, TheTearIsWhereTheStretchIs) {
  Bar bar;
  bar.stretch(1.2 * kFailure, 0.020);
  const Overstretch tear = bar.look(200);
  ASSERT_TRUE(tear.found);
  EXPECT_GT(tear.middle.x, 0.020);
}

TEST(Overstretch, OneSpringAloneTearsNothing) {
  Bar bar;
  bar.stretch(0);
  for (int s = 0; s < bar.model.springs; ++s) {  // all but one of the stretched node's springs are cut already
    const int a = bar.model.spring_nodes[size_t(2 * s)], b = bar.model.spring_nodes[size_t(2 * s) + 1];
    if ((a == 0 || b == 0) && !(a == 0 && b == 1) && !(a == 1 && b == 0)) cut_spring(bar.model, bar.state, s);
  }
  set_position(bar.model, bar.state, 0, bar.model.rest[0] - Vec3d{0.004, 0, 0});
  EXPECT_FALSE(bar.look(500).found);
}

StrandDescription cord() {
  StrandDescription d;
  for (int i = 0; i <= 20; ++i) d.positions.push_back({0.003 * i, 0, 0});
  d.radius.assign(20, 0.002);
  d.youngs_modulus = 60e3;
  d.law = {4, 40, 0.3};
  d.density = 1050;
  d.prescribed.assign(21, 0);
  d.prescribed.front() = d.prescribed.back() = 1;
  d.damping_time = 0.005;
  return d;
}

TEST(Overstretch, AStrandTearsAtTheForceThatItsLawGivesAtItsFailureStrain) {
  constexpr double kTube = 0.8;
  const StrandDescription d = cord();
  const StrandModel model = build(d, 1e-3);
  StrandState state = rest_state(model);
  StrandWork work = make_work(model);
  std::vector<std::uint8_t> counters(21, 0);
  StrandEnd ends[2] = {{model.rest.front()}, {model.rest.back()}};
  StrandReaction reaction[2];
  double force = 0;
  int element = -1;
  for (int tick = 0; tick < 20'000 && element < 0; ++tick) {
    ends[1].x.x += 1e-5;
    ASSERT_TRUE(advance(model, ends, {}, reaction, {}, state, work).fine());
    force = length(reaction[0].force);
    element = find_overstretch(model, state, kTube, counters);
  }
  ASSERT_GE(element, 0);
  const double expected = 60e3 * std::numbers::pi * 4e-6 * d.law.shape(kTube);
  EXPECT_NEAR(force, expected, 0.03 * expected) << "6.7 N: tubes are torn out at 5 to 9 N";
  cut_element(state, element);
  for (int tick = 0; tick < 200; ++tick) ASSERT_TRUE(advance(model, ends, {}, reaction, {}, state, work).fine());
  EXPECT_LT(length(reaction[0].force), 0.05 * expected) << "then nothing holds it";
  EXPECT_EQ(find_overstretch(model, state, kTube, counters), -1);
}

TEST(Overstretch, ABarOfCellsThatIsPulledApartComesApart) {
  const BoxLattice box = box_lattice(10, 3, 3, 0.004);
  CuttableDescription d;
  d.points = box.corners;
  constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
  for (const auto& c : box.cells)
    for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
  d.material = {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.1, .damping_time = 1e-3};
  d.fixed.assign(d.points.size(), kFree);
  for (size_t i = 0; i < d.points.size(); ++i)
    if (d.points[i].x < 0.0041 || d.points[i].x > 0.0359) d.fixed[i] = kHeld;
  const CuttableModel model = build(d, 1e-3);
  CuttableState state = rest_state(model);
  CuttableWork work = make_work(model);
  std::vector<std::uint8_t> counters(size_t(model.rows), 0), scratch = counters;
  int tears = 0;
  const auto is_right = [&](int node) { return d.points[size_t(node)].x > 0.0359; };
  for (int tick = 0; tick < 3000; ++tick) {
    for (int i = 0; i < model.own_nodes; ++i)
      if (d.fixed[size_t(i)] && is_right(i))
        set_position(model, state, i, position(model, state, i) + Vec3d{1e-5, 0, 0});
    ASSERT_TRUE(advance(model, {}, {}, state, work).fine()) << tick;
    const Overstretch tear =
        find_overstretch(springs_of(model, state, work), kFailure, std::uint64_t(tick), counters, scratch);
    if (!tear.found) continue;
    EXPECT_GT(tick, int(0.02 * kFailure / 1e-5)) << "not before the whole is stretched so far";
    ++tears;
    cut(model, tear.blade(), state, work);
  }
  EXPECT_GT(tears, 0);
  // Cells that hang together by faces: none leads from the left to the right any more.
  std::vector<bool> seen(state.tets.cells.size(), false);
  std::vector<int> way;
  for (size_t t = 0; t < state.tets.cells.size(); ++t)
    if (d.points[size_t(d.cells[t][0])].x < 0.001) seen[t] = true, way.push_back(int(t));
  bool through = false;
  for (size_t head = 0; head < way.size(); ++head) {
    const auto& cell = state.tets.cells[size_t(way[head])];
    for (const std::int32_t node : cell) through = through || (node < model.own_nodes && is_right(node));
    for (const std::int32_t u : state.tets.across[size_t(way[head])])
      if (u >= 0 && !seen[size_t(u)]) seen[size_t(u)] = true, way.push_back(int(u));
  }
  EXPECT_FALSE(through) << tears << " tears";
}

}  // namespace
}  // namespace trocar::tissue
