// A suction-irrigator in a scene: water is booked and lands, the pool is sucked away, tissue plugs the port, the jet
// pushes what it hits.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/core/parallel.hpp>
#include <trocar/fluids/fluids.hpp>
#include <trocar/interactions/verbs/irrigate.hpp>
#include <trocar/numerics/portable.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;
using fluids::Place;
using fluids::Source;

namespace {

constexpr int kHand = 1;                                         // its trocar is where a test wants it
constexpr double kEnd = 0.0009;                                  // [m] the bore ends so far beyond the tip that is led
constexpr double kFloor = -0.020;                                // [m]
constexpr double kX = 0.080, kY = -0.030;                        // [m] above the floor, clear of all bodies
const double kJet = 1005 * (1e-3 / 60) * (1e-3 / 60) / 7.07e-6;  // [N] rho Q^2 / A

/// The small scene with a suction-irrigator in one hand.
Model with_irrigator(Vec3d port, Vec3d tip, bool bleeding = false) {
  scene::Description d = small::description();
  if (!bleeding) d.vessels.clear();
  scene::Instrument i = small::instrument("suction_irrigator", interactions::ToolKind::suction_irrigator);
  i.jaw_length = 0.004;
  i.jaw_width = 0.005;
  i.jaw_thickness = 0.0018;
  i.opening = 0;
  i.pinch_max = 0;
  i.friction = 0.1;
  d.instruments.push_back(i);
  d.ports[kHand].position = port;
  d.placements[kHand] = {"suction_irrigator", "b", tip, 0, {}};
  return scene::compile(d);
}
/// Its trocar is above (x, y).
Model with_irrigator(double x, double y, bool bleeding = false) {
  return with_irrigator({x, y, small::kHeight}, {x, y, 0.04}, bleeding);
}
const Model& above_floor() {
  static const Model made = with_irrigator(kX, kY);
  return made;
}

struct Bench : small::Table {
  explicit Bench(const Model& m, double x = kX, double y = kY) : Table(m), m_x(x), m_y(y) {}

  /// The bore's end comes to that height.
  void lower(double to, double speed = 0.2) {
    carry(kHand, {m_x, m_y, m_at}, {m_x, m_y, to + kEnd}, speed);
    m_at = to + kEnd;
    steps(30);
  }
  void press(std::uint32_t pedals, int ticks) {
    input.pedals = pedals;
    steps(ticks);
    input.pedals = 0;
  }
  const fluids::Mix& at(Place place) const { return fluids::at(state.fluids.ledger, place); }
  std::int64_t irrigated() const { return state.fluids.ledger.in[std::size_t(Source::kIrrigated)].total(); }
  std::int64_t sucked() const { return at(Place::kSucked).total(); }
  bool balanced() const { return audit(model.wet.model, state.fluids); }

 private:
  double m_x, m_y, m_at = 0.04;
};

/// A pool on the floor, and the port in it.
Bench in_a_pool() {
  Bench b(above_floor());
  b.lower(0);
  b.press(irrigates(kHand), 600);
  b.lower(kFloor + 0.002);
  b.steps(300);
  return b;
}

}  // namespace

TEST(Irrigation, ALitreAMinuteIsBookedAndLandsOnTheFloor) {
  Bench b(above_floor());
  b.lower(0);
  b.press(irrigates(kHand), 600);
  EXPECT_EQ(b.state.valves[kHand], kIrrigates);
  b.steps(400);
  EXPECT_EQ(b.state.valves[kHand], 0);
  EXPECT_NEAR(double(b.irrigated()), 10 * double(fluids::kMillilitre), 1) << "0.6 s of 1 L/min, to the picolitre";
  EXPECT_EQ(b.state.fluids.ledger.in[std::size_t(Source::kIrrigated)].saline, b.irrigated());
  EXPECT_GT(b.at(Place::kPool).total(), 9 * fluids::kMillilitre) << "it has fallen and gathered";
  EXPECT_EQ(b.sucked(), 0);
  EXPECT_TRUE(b.balanced());
}

TEST(Irrigation, SuctionLowersThePoolByWhatItBooks) {
  Bench b = in_a_pool();
  const std::int64_t before = b.at(Place::kPool).total() + b.at(Place::kDroplets).total();
  ASSERT_GT(before, 9 * fluids::kMillilitre);
  b.press(sucks(kHand), 300);
  EXPECT_EQ(b.state.valves[kHand] & kSucks, kSucks);
  EXPECT_EQ(b.state.valves[kHand] & kPlugged, 0);
  const std::int64_t after = b.at(Place::kPool).total() + b.at(Place::kDroplets).total();
  EXPECT_GT(b.sucked(), fluids::kMillilitre / 2) << "10 mL on a level floor are a shallow puddle";
  EXPECT_LE(b.sucked(), 7.5 * fluids::kMillilitre + 1) << "0.3 s of 1.5 L/min at most";
  EXPECT_NEAR(double(before - after), double(b.sucked()), 0.05 * double(fluids::kMillilitre)) << "the rest is film";
  EXPECT_TRUE(b.balanced());
}

TEST(Irrigation, WhereNothingIsToBeSuckedItSucksGas) {
  Bench b(above_floor());
  b.lower(0);
  b.press(sucks(kHand), 10);
  EXPECT_EQ(b.state.valves[kHand], kSucks | kSucksGas);
  EXPECT_EQ(b.sucked(), 0);
}

TEST(Irrigation, GasThatIsSuckedLowersThePressureInTheAbdomen) {
  Bench b(above_floor());
  b.lower(0);
  const double full = b.state.fluids.gas.pressure;
  b.press(sucks(kHand), 2000);
  const double after = b.state.fluids.gas.pressure;
  // 25 L/min are sucked, at most 20 given; 0.3 L/mmHg.
  EXPECT_LT(after, full - 0.5 * 133.3);
  EXPECT_GT(after, full - 2.8 * 133.3);
  b.press(0, 9000);
  EXPECT_GT(b.state.fluids.gas.pressure, full - 0.2 * 133.3) << "the insufflator fills it again";
}

TEST(Irrigation, APortOnTheFloorSucksNothing) {
  Bench b = in_a_pool();
  b.lower(kFloor + 0.0004);
  const std::int64_t pool = b.at(Place::kPool).total();
  b.press(sucks(kHand), 300);
  EXPECT_EQ(b.state.valves[kHand], kSucks | kPlugged);
  EXPECT_EQ(b.sucked(), 0);
  EXPECT_EQ(b.at(Place::kPool).total() + b.at(Place::kDroplets).total() + b.at(Place::kFilm).total(), b.irrigated());
  EXPECT_GE(b.at(Place::kPool).total(), pool) << "what still falls";
}

TEST(Irrigation, OrgansStrandsAndFoldsPlugThePort) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  step(m, m.start, s, w);
  for (std::size_t i = 0; i < w.surfaces.size(); ++i)
    if (int(i) < m.organs()) w.surfaces[i].nodes = w.organs[i].nodes;
  const interactions::WetGround ground{{m, s, &w}, m.wet.film, m.wet.grids};
  const auto plugged = [&](Vec3d p) { return covered(ground, p, interactions::kPlugs); };
  const Vec3d tube = 0.5 * (s.strands[small::kTube].x[20] + s.strands[small::kTube].x[21]);
  const Vec3d up{0, 0, 1};
  EXPECT_TRUE(plugged(tube + (small::kTubeRadius + 0.0005) * up));
  EXPECT_FALSE(plugged(tube + (small::kTubeRadius + 0.0015) * up));
  const interactions::Surface& organ = w.surfaces[0];
  const int v = organ.skin->size() / 2;
  EXPECT_TRUE(plugged(organ.position(v) + 0.0005 * organ.normal(v)));
  EXPECT_TRUE(plugged(organ.position(v) - 0.0005 * organ.normal(v))) << "pressed in";
  const interactions::Surface& fold = w.membranes[0].sheet.surface;
  const int f = fold.skin->size() / 2;
  EXPECT_TRUE(plugged(fold.position(f) + 0.0007 * fold.normal(f)));
  EXPECT_TRUE(plugged(fold.position(f) - 0.0007 * fold.normal(f))) << "from either side";
  EXPECT_FALSE(plugged({kX, kY, 0}));
}

TEST(Irrigation, TheJetPushesWhatItHitsWithDensityTimesFlowTimesSpeed) {
  const double x = 0.050, y = 0.006;  // the pad's middle, beside the tube
  const Model m = with_irrigator(x, y);
  Bench b(m, x, y);
  b.lower(0.015);
  const int pad = m.organ_index("pad");
  const auto height = [&] {
    double sum = 0;
    for (int n = 0; n < m.solids[std::size_t(pad)].network.nodes; ++n)
      sum += tissue::position(m.solids[std::size_t(pad)].network, b.state.solids[std::size_t(pad)], n).z;
    return sum / m.solids[std::size_t(pad)].network.nodes;
  };
  b.steps(200);
  const double before = height();
  b.input.pedals = irrigates(kHand);
  b.steps(60);
  double down = 0;
  for (int t = 0; t < 40; ++t) {
    b.step();
    for (int i = 0; i < b.state.impact_count; ++i)
      if (b.state.impacts[std::size_t(i)].body == pad) down -= double(b.state.impacts[std::size_t(i)].impulse.z);
  }
  EXPECT_NEAR(down / (40 * kTick), kJet, 0.15 * kJet);
  EXPECT_LT(height(), before - 50e-6) << "0.04 N on a pad that hangs in springs";
}

TEST(Irrigation, AJetBendsAFoldAndThrowsNothingAheadOfItsDrops) {
  const Vec3d fold{0.018, 0.001, -0.007}, port{0.018, -0.090, 0.030};
  const Model m = with_irrigator(port, fold + 0.025 * normalised(port - fold));
  Bench b(m);
  const int body = m.surfaces();
  const tissue::NetworkModel& net = m.membranes[0].sheet.network;
  const auto place = [&](int n) { return tissue::position(net, b.state.membranes[0].network, n); };
  b.steps(50);
  std::vector<Vec3d> before;
  for (int n = 0; n < net.nodes; ++n) before.push_back(place(n));
  b.input.pedals = irrigates(kHand);
  double fastest = 0, farthest = 0;
  int hits = 0;
  for (int t = 0; t < 100; ++t) {
    b.step();
    for (int i = 0; i < b.state.impact_count; ++i) hits += b.state.impacts[std::size_t(i)].body == body;
    for (int n = 0; n < net.nodes; ++n) {
      fastest = std::max(fastest, length(tissue::velocity(net, b.state.membranes[0].network, n)));
      farthest = std::max(farthest, length(place(n) - before[std::size_t(n)]));
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(farthest, 0.0005);
  EXPECT_LT(fastest, 2.4) << "a jet of 2.36 m/s";
}

TEST(Irrigation, PedalsOfHandsWithoutSuchAnInstrumentDoNothing) {
  const std::uint32_t all = irrigates(0) | irrigates(1) | irrigates(2) | irrigates(3) | sucks(0) | sucks(1) | sucks(2) |
                            sucks(3) | kBlue | kYellow;
  const Model& m = small::model();
  State s = initial_state(m), t = initial_state(m);
  Work w = make_work(m);
  Input pressed = m.start;
  pressed.pedals = all;
  for (int i = 0; i < 50; ++i) {
    step(m, m.start, s, w);
    step(m, pressed, t, w);
  }
  EXPECT_EQ(hash_of(s), hash_of(t));
  Bench b(above_floor());
  b.press(all & ~(irrigates(kHand) | sucks(kHand)), 50);
  EXPECT_EQ(b.irrigated(), 0);
  EXPECT_EQ(b.state.valves, State{}.valves);
}

TEST(Irrigation, NothingFlowsWhileAHandPutsTheInstrumentAway) {
  Bench b(above_floor());
  b.input.tools[kHand].instrument = 1;
  b.press(irrigates(kHand) | sucks(kHand), 200);
  EXPECT_EQ(b.irrigated(), 0);
  EXPECT_EQ(b.state.valves[kHand], 0);
}

TEST(Irrigation, EveryPicolitreIsBookedWhileItBleedsFlowsAndIsSucked) {
  const Model m = with_irrigator(0.040, -0.008, true);
  Bench b(m, 0.040, -0.008);
  interactions::VesselOpening& cut = b.state.openings[0];
  cut.s = 0.5;
  cut.area = 1e-6;
  cut.vessel = small::kTubeArtery;
  cut.through = 1;
  b.state.opening_count = 1;
  b.lower(0.004);
  for (int i = 0; i < 20; ++i) {
    b.press((i % 2 ? irrigates(kHand) : 0) | (i % 4 < 3 ? sucks(kHand) : 0), 50);
    ASSERT_TRUE(b.balanced()) << b.state.tick;
  }
  EXPECT_EQ(b.state.fluids.ledger.in[std::size_t(Source::kBled)].total(), b.state.flow.bled);
  EXPECT_GT(b.state.flow.bled, 0);
  EXPECT_GT(b.sucked(), 0);
}

TEST(Irrigation, OpenValvesGiveTheSameBitsOnAnyThreadsAndFromAnySavedTick) {
  const Model m = with_irrigator(0.050, 0.006, true);
  const auto pedals = [](std::uint64_t tick) {
    return (tick % 100 < 70 ? irrigates(kHand) : 0u) | (tick % 60 < 40 ? sucks(kHand) : 0u);
  };
  Bench b(m, 0.050, 0.006);
  b.lower(0.006);
  const State start = b.state;
  State saved;
  const auto run = [&](State s, Work w, std::uint64_t until, std::uint64_t save_at) {
    while (s.tick < until) {
      Input in = b.input;
      in.pedals = pedals(s.tick);
      poison(w);
      step(m, in, s, w);
      if (s.tick == save_at) saved = s;
    }
    return hash_of(s);
  };
  const std::uint64_t end = start.tick + 400, middle = start.tick + 215;
  const std::uint64_t expected = run(start, make_work(m), end, middle);
  ASSERT_GT(saved.impact_count, 0) << "drops were landing when it was saved";
  EXPECT_EQ(run(saved, make_work(m), end, 0), expected);
  for (const int threads : {2, 3}) {
    core::ThreadPool pool(threads);
    EXPECT_EQ(run(start, make_work(m, &pool), end, 0), expected) << threads << " threads";
  }
}

TEST(Irrigation, TheWipePedalClearsTheLensOnceAndAgainWhileItIsHeld) {
  Bench b(above_floor());
  b.state.fluids.smoke.fog = 0.8;
  b.press(kWipe, 100);
  const double left = b.state.fluids.smoke.wipe_left;
  EXPECT_NEAR(left, 8 - 0.1, 0.02) << "held, it does not begin again and again";
  b.steps(200);
  EXPECT_LT(b.state.fluids.smoke.wipe_left, left);
  EXPECT_NEAR(b.state.fluids.smoke.fog, 0.8 * (1 - 0.3 / 8), 0.01);
}

TEST(Irrigation, ThePoolsFloorGoesWithTheTissueThatItLiesOn) {
  scene::Description d = small::description();
  d.fluids->pool_on = {"pad"};
  const Model m = scene::compile(d);
  small::Table t(m);
  const fluids::PoolModel& pool = m.wet.model.pool;
  const int pad = m.organ_index("pad");
  ASSERT_EQ(m.wet.floor_organs.size(), 1u);
  const auto floor_above = [&](double x, double y, std::span<const float> floor) {
    const fluids::PoolPoint p = locate(pool, {x, y, 0});
    return double(floor_at(pool, floor, p.i, p.j)) + dot(pool.origin, pool.up);
  };
  const auto skin_at = [&](double x, double y) {  // of the nearest vertex of the pad's upper side
    double nearest = 1, height = 0;
    for (const Vec3f& v : t.work.organs[std::size_t(pad)].pose.position) {
      const double away = std::hypot(double(v.x) - x, double(v.y) - y);
      if (v.z < -0.010f || away >= nearest) continue;
      nearest = away, height = double(v.z);
    }
    return height;
  };
  t.steps(20);
  const double before = floor_above(0.050, 0.007, t.state.pool_floor);
  EXPECT_NEAR(before, floor_above(0.050, 0.007, initial_state(m).pool_floor), 1e-4) << "as drawn";
  t.close(small::kGrasper, 1);
  t.carry(small::kGrasper, {0.055, 0, 0.04}, {0.050, 0.007, 0.010}, 0.2);
  t.carry(small::kGrasper, {0.050, 0.007, 0.010}, {0.050, 0.007, -0.008}, 0.05);
  t.steps(200);
  const double after = floor_above(0.050, 0.007, t.state.pool_floor), skin = skin_at(0.050, 0.007);
  std::printf("    pressed down, the floor goes from %.2f to %.2f mm, the skin is at %.2f\n", 1e3 * before, 1e3 * after,
              1e3 * skin);
  EXPECT_LT(after, before - 0.001);
  EXPECT_NEAR(after, skin, 0.001);
  EXPECT_NEAR(floor_above(0.085, -0.040, t.state.pool_floor), -0.020, 1e-6) << "the wall's floor stays";
}
