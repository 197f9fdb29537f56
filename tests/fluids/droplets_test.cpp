// Drops: forces between them, running down, films, falling in.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>

#include "plates.hpp"
#include "within.hpp"

namespace trocar::fluids {
namespace {

using test::Plate;
using test::Scene;
using test::small_scene;

const float kNan = std::numeric_limits<float>::quiet_NaN();

void put_drop(Scene& b, Vec3f p, Vec3f v, std::int64_t blood) {
  ASSERT_TRUE(add_drop(b.m.droplets, p, v, {.blood = blood}, b.s.droplets));
  receive(b.s.ledger, Source::kBled, Place::kDroplets, {.blood = blood});
}

FluidsDescription weightless() {
  FluidsDescription d = small_scene();
  d.droplets.gravity = {0, 0, 0};
  d.droplets.gas_density = 0;
  return d;
}

TEST(Drops, KeepTheirMomentumWhateverPassesBetweenThem) {
  Scene b(weightless());
  core::Random r(5);
  for (int i = 0; i < 600; ++i)
    put_drop(b, {float(r.uniform(-0.01, 0.01)), float(r.uniform(-0.01, 0.01)), float(r.uniform(0.05, 0.07))},
             {float(r.uniform(-0.3, 0.3)), float(r.uniform(-0.3, 0.3)), float(r.uniform(-0.3, 0.3))},
             200'000 + std::int64_t(r.uniform() * 3e6));
  const auto momentum = [&] {
    Vec3d sum{0, 0, 0};
    double size = 0;
    for (int i = 0; i < b.s.droplets.count; ++i) {
      const double m = mass(widened(b.s.droplets.volume[i]), b.m.droplets.density);
      const Vec3d p = m * Vec3d{b.s.droplets.vx[i], b.s.droplets.vy[i], b.s.droplets.vz[i]};
      sum += p;
      size += length(p);
    }
    return std::pair{sum, size};
  };
  const auto [before, size] = momentum();
  const int count = b.s.droplets.count;
  for (int t = 0; t < 60; ++t) b.tick();
  EXPECT_LT(length(momentum().first - before), 1e-5 * size);
  EXPECT_LT(b.s.droplets.count, count) << "some have become one";
  EXPECT_LT(momentum().second, 0.9 * size) << "forces have been at work";
  EXPECT_TRUE(audit(b.m, b.s));
}

TEST(Drops, ThatTouchComeToRestBesideOneAnother) {
  FluidsDescription d = weightless();
  d.droplets.largest = 1'100'000;  // so that two of these do not become one
  Scene b(d);
  const float r = radius_of(1'000'000);
  put_drop(b, {0, 0, 0.06f}, {0, 0, 0}, 1'000'000);
  put_drop(b, {2.4f * r, 0, 0.06f}, {0, 0, 0}, 1'000'000);
  put_drop(b, {0, 0.05f, 0.06f}, {0, 0, 0}, 1'000'000);
  for (int t = 0; t < 500; ++t) b.tick();
  EXPECT_NEAR(double(b.s.droplets.x[1] - b.s.droplets.x[0]), 0.9 * 2 * double(r), 0.05 * double(r));
  EXPECT_LT(std::fabs(b.s.droplets.vx[0]), 1e-3);
  EXPECT_EQ(b.s.droplets.y[2], 0.05f) << "one that is far away feels nothing";
}

TEST(Drops, FindEveryNeighbourWithinReachOnce) {
  // Against all pairs: what the grid finds is what there is, for any place in space.
  core::Random r(11);
  for (const Vec3f centre : {Vec3f{0, 0, 0.05f}, Vec3f{-0.07f, 0.03f, 0.1f}, Vec3f{1.3f, -2.1f, 0.4f}}) {
    FluidsDescription d = weightless();
    d.droplets.largest = 1'000'001;
    Scene b(d);
    for (int i = 0; i < 300; ++i)
      put_drop(b,
               centre + Vec3f{float(r.uniform(-0.012, 0.012)), float(r.uniform(-0.012, 0.012)),
                              float(r.uniform(-0.012, 0.012))},
               {0, 0, 0}, 1'000'000);
    const DropletState s0 = b.s.droplets;
    const float reach = std::min(1.5f * (2 * s0.radius[0]), 2.6e-3f), rest = 0.9f * (2 * s0.radius[0]);
    std::vector<Vec3d> v(300);
    const double dt = 4e-3, k = std::numbers::pi * 0.056;
    const double m = mass(widened(s0.volume[0]), b.m.droplets.density), both = m / 2;
    const double damping = dt * k + std::sqrt(k * both);
    const auto way = [&s0](int i, int j) {
      return Vec3d{double(s0.x[j]) - s0.x[i], double(s0.y[j]) - s0.y[i], double(s0.z[j]) - s0.z[i]};
    };
    std::vector<int> neighbours(300, 0);
    for (int i = 0; i < 300; ++i)
      for (int j = 0; j < 300; ++j) neighbours[i] += i != j && length(way(i, j)) < double(reach);
    for (int i = 0; i < 300; ++i)
      for (int j = 0; j < 300; ++j) {
        const Vec3d to = way(i, j);
        const double far = length(to);
        if (i == j || far >= double(reach)) continue;
        const double weight = far > double(rest) ? (double(reach) - far) / double(reach - rest) : 1.0;
        const double others = std::max(neighbours[i], neighbours[j]);
        v[i] += (weight / others * dt * k * (far - double(rest)) / (1 + dt * damping / both) / m / far) * to;
      }
    EXPECT_EQ(detail::pull_together(b.m.droplets, {}, dt, b.s.droplets, b.w.droplets).flags, 0u);
    for (int i = 0; i < 300; ++i) {
      EXPECT_NEAR(double(b.s.droplets.vx[i]), v[i].x, 1e-3);
      EXPECT_NEAR(double(b.s.droplets.vy[i]), v[i].y, 1e-3);
      EXPECT_NEAR(double(b.s.droplets.vz[i]), v[i].z, 1e-3);
    }
  }
}

/// A plate that falls towards +x by `slope` radians.
Plate slope(double angle) {
  Plate p;
  p.normal = {float(std::sin(angle)), 0, float(std::cos(angle))};
  p.centre = {0, 0, 0.08f};
  p.first_film = 0, p.film_cells = 25;
  return p;
}

TEST(Drops, RunDownWithTheSpeedOfTheirViscousFilm) {
  FluidsDescription d = small_scene();
  d.droplets.film_thickness = 0;
  Scene b(d);
  b.plates = {slope(0.7)};
  const std::int64_t pl = 2'000'000;
  put_drop(b, {0, 0, 0.0815f}, {0, 0, 0}, pl);
  for (int t = 0; t < 400; ++t) b.tick();
  ASSERT_EQ(b.s.droplets.body[0], 0);
  const double r = double(radius_of(pl)), h = 0.3 * r, tau = 1060 * h * h / (3 * 3.5e-3), m = 1060 * 1e-15 * double(pl);
  const double wanted = tau * (9.81 * std::sin(0.7) - 0.056 * 0.08 * 2 * r / m);
  const Vec3f v{b.s.droplets.vx[0], b.s.droplets.vy[0], b.s.droplets.vz[0]};
  test::expect_within("speed of a running drop", double(length(v)), wanted, 0.03);
  EXPECT_GT(wanted, 0.01);
}

TEST(Drops, SmallOnesCling) {
  Scene b(small_scene());
  b.plates = {slope(0.5)};
  put_drop(b, {0, 0, 0.0805f}, {0, 0, 0}, 60'000);
  for (int t = 0; t < 100; ++t) b.tick();
  ASSERT_EQ(b.s.droplets.count, 1);
  const float x = b.s.droplets.x[0];
  for (int t = 0; t < 1000; ++t) b.tick();
  EXPECT_EQ(b.s.droplets.x[0], x);
}

TEST(Drops, LeaveAFilmBehind) {
  Scene b(small_scene());
  b.plates = {slope(1.0)};
  put_drop(b, {0, 0, 0.0815f}, {0, 0, 0}, 2'000'000);
  for (int t = 0; t < 1500; ++t) {
    b.tick();
    ASSERT_TRUE(audit(b.m, b.s));
  }
  int stained = 0;
  for (const SmallMix& f : b.s.droplets.film) stained += f.blood > 0;
  EXPECT_GT(stained, 2);
  EXPECT_GT(b.millilitres(Place::kFilm), 1e-4);
}

TEST(Film, IsAsOldAsTheBloodThatLiesThere) {
  Scene b(small_scene());
  b.plates = {slope(1.0)};
  put_drop(b, {0, 0, 0.0815f}, {0, 0, 0}, 2'000'000);
  for (int t = 0; t < 1500; ++t) b.tick();
  const auto places = [&b](float from, float to) {
    int n = 0;
    for (std::size_t c = 0; c < b.s.droplets.film.size(); ++c)
      n += b.s.droplets.film[c].blood > 0 && b.s.droplets.film_blood[c].born >= from &&
           b.s.droplets.film_blood[c].born <= to;
    return n;
  };
  const int all = places(-1, 10);
  EXPECT_GT(all, 2);
  EXPECT_EQ(places(0, 0), all) << "of a drop from the very beginning";
  put_drop(b, {0, 0, 0.0815f}, {0, 0, 0}, 2'000'000);
  for (int t = 0; t < 1500; ++t) b.tick();
  EXPECT_GT(places(0.1f, 1.45f), 2) << "what another drop has left is younger, but old blood is in it too";
}

TEST(Film, OfAVeinsAndAnArterysDropsIsPartlyVenous) {
  Scene b(small_scene());
  b.plates = {slope(1.0)};
  for (const float venous : {1.0f, 0.0f}) {
    put_drop(b, {0, 0, 0.0815f}, {0, 0, 0}, 2'000'000);
    b.s.droplets.blood[std::size_t(b.s.droplets.count - 1)].venous = venous;
    for (int t = 0; t < 1500; ++t) b.tick();
    int all = 0, dark = 0, mixed = 0;
    for (std::size_t c = 0; c < b.s.droplets.film.size(); ++c) {
      if (b.s.droplets.film[c].blood == 0) continue;
      const float share = b.s.droplets.film_blood[c].venous;
      ++all, dark += share == 1, mixed += share > 0.05f && share < 0.95f;
    }
    EXPECT_GT(all, 2);
    EXPECT_TRUE(venous == 1 ? dark == all : mixed > 2) << dark << " and " << mixed << " of " << all;
  }
}

TEST(Film, IsWashedByWaterThatRunsOverIt) {
  Scene b(small_scene());
  b.plates = {slope(1.0)};
  for (int c = 0; c < 25; ++c) {
    b.s.droplets.film[std::size_t(c)].blood = 200'000;
    receive(b.s.ledger, Source::kBled, Place::kFilm, {.blood = 200'000});
  }
  b.tools = {{.tip = {0, 0, 0.09f}, .direction = {0, 0, -1}, .irrigation = 0.2}};
  for (int t = 0; t < 2000; ++t) b.tick();
  double blood = 0, all = 0;
  for (int c = 2; c < 20; ++c) {
    blood += b.s.droplets.film[std::size_t(c)].blood;
    all += double(b.s.droplets.film[std::size_t(c)].total());
  }
  EXPECT_LT(blood, 0.2 * all);
  EXPECT_TRUE(audit(b.m, b.s));
}

TEST(Film, ThatHoldsTooMuchLetsDropsGo) {
  Scene b(small_scene());
  b.plates = {slope(1.0)};
  Outlet ooze;
  ooze.flow.blood = 20'000, ooze.film = 3, ooze.area = 1e-6;
  b.openings = {ooze};
  int most = 0;
  for (int t = 0; t < 500; ++t) {
    b.tick();
    ASSERT_TRUE(audit(b.m, b.s));
    most = std::max(most, b.s.droplets.count);
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(b.s.droplets.film[3].total(), 1'500'000);
}

TEST(Drops, TooHeavyForAnOverhangFallOff) {
  Scene b(small_scene());
  b.plates = {{.centre = {0, 0, 0.05f}, .normal = {0, 0, -1}, .radius = 0.05f}};
  put_drop(b, {0, 0, 0.049f}, {0, 0, 0.3f}, 100'000);
  put_drop(b, {0.02f, 0, 0.049f}, {0, 0, 0.3f}, 7'900'000);
  for (int t = 0; t < 50; ++t) b.tick();
  EXPECT_EQ(b.s.droplets.body[0], 0);
  EXPECT_EQ(b.s.droplets.body[1], 0) << "2 pi r sigma holds 8 microlitres";
  b.s.droplets.volume[1].blood += 30'000'000;
  b.s.droplets.radius[1] = radius_of(37'900'000);
  receive(b.s.ledger, Source::kBled, Place::kDroplets, {.blood = 30'000'000});
  for (int t = 0; t < 5; ++t) b.tick();
  EXPECT_EQ(b.s.droplets.body[1], -1);
}

TEST(Drops, RideOnSurfacesThatMove) {
  Scene b(small_scene());
  b.plates = {{.centre = {0, 0, 0.05f}, .velocity = {0, 0.1f, 0.05f}, .radius = 0.5f, .body = 3}};
  put_drop(b, {0, 0, 0.0505f}, {0, 0, 0}, 60'000);
  for (int t = 0; t < 200; ++t) {
    b.plates[0].centre += 1e-3f * b.plates[0].velocity;
    b.tick();
  }
  EXPECT_EQ(b.s.droplets.body[0], 3);
  EXPECT_NEAR(b.s.droplets.y[0], 0.02f, 0.001f);
  EXPECT_NEAR(b.s.droplets.z[0], b.plates[0].centre.z, 0.001f);
}

TEST(Drops, ClingToInstrumentsAndAreCarriedByThem) {
  Scene b(small_scene());
  b.capsules = {{.a = {-0.05f, 0, 0.05f}, .b = {0.05f, 0, 0.05f}, .radius = 0.0025f, .body = 9}};
  put_drop(b, {0, 0, 0.06f}, {0, 0, 0}, 80'000);
  for (int t = 0; t < 100; ++t) b.tick();
  ASSERT_EQ(b.s.droplets.count, 1);
  ASSERT_EQ(b.s.droplets.body[0], 9);
  for (int t = 0; t < 100; ++t) {
    for (Vec3f* end : {&b.capsules[0].a, &b.capsules[0].b}) end->z += 1e-4f;
    b.capsules[0].va = b.capsules[0].vb = {0, 0, 0.1f};
    b.tick();
  }
  EXPECT_EQ(b.s.droplets.body[0], 9);
  EXPECT_NEAR(b.s.droplets.z[0], 0.0627f, 0.0006f);
  b.capsules.clear();
  for (int t = 0; t < 8; ++t) b.tick();
  EXPECT_EQ(b.s.droplets.body[0], -1);
}

TEST(Drops, ThatFallIntoThePoolSplashAndMakeRipples) {
  Scene b(small_scene());
  const std::int64_t each = 5 * kMicrolitre * 6;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) {
      receive(b.s.ledger, Source::kIrrigated, Place::kPool, {.saline = each});
      pour(b.m.pool, i, j, {.saline = each}, b.s.pool);
    }
  put_drop(b, {0, 0, 0.16f}, {0, 0, 0}, 4'000'000);
  std::set<std::uint32_t> ids;
  float highest = 0;
  for (int t = 0; t < 600; ++t) {
    b.tick();
    for (int i = 0; i < b.s.droplets.count; ++i) ids.insert(b.s.droplets.id[i]);
    highest = std::max(highest, std::fabs(depth_at(b.m.pool, b.s.pool, 38, 32) - 0.0048f));
    ASSERT_TRUE(audit(b.m, b.s));
  }
  EXPECT_GE(ids.size(), 4u) << "one fell, three were thrown up";
  EXPECT_GT(highest, 1e-5f) << "a ripple has passed 15 mm away";
  EXPECT_EQ(b.s.droplets.count, 0);
  EXPECT_EQ(at(b.s.ledger, Place::kPool).blood, 4'000'000);
}

// ---- what nobody should send

TEST(Drops, WithoutRoomGoStraightIntoThePoolAndSayIt) {
  FluidsDescription d = small_scene();
  d.droplets.capacity = 5;
  Scene b(d);
  b.openings = {test::bleeding({0, 0, 0.1f}, {1, 0, 0}, 20e-6, 2e-6)};
  std::uint32_t flags = 0;
  for (int t = 0; t < 50; ++t) {
    flags |= b.tick().report.flags;
    ASSERT_TRUE(audit(b.m, b.s));
  }
  EXPECT_TRUE(flags & FluidReport::kDropletsFull);
  EXPECT_NEAR(double(b.s.ledger.in[0].blood), 20e-6 * 0.05 * 1e15, 100);
  EXPECT_GT(b.millilitres(Place::kPool), 0.5);
}

TEST(Drops, HostileOpeningsAreBoundedAndBooked) {
  Scene b(small_scene());
  Outlet endless = test::bleeding({0, 0, 0.1f}, {1, 0, 0}, 1e-6, 1e-6);
  endless.flow.blood = std::numeric_limits<std::int64_t>::max();
  Outlet nowhere = test::bleeding({kNan, 0, 0.1f}, {1, 0, 0}, 1e-6, 1e-6);
  Outlet aimless = test::bleeding({0, 0, 0.1f}, {0, 0, kNan}, 1e-6, 1e-6);
  Outlet negative = test::bleeding({0, 0, 0.1f}, {1, 0, 0}, -1e-6, 1e-6);
  Outlet pinhole = test::bleeding({0, 0, 0.1f}, {1, 0, 0}, 1e-6, double(kNan));
  Outlet lost = test::bleeding({0, 0, 0.1f}, {1, 0, 0}, 1e-6, 1e-6);
  lost.film = 4711;
  b.openings = {endless, nowhere, aimless, negative, pinhole, lost};
  for (int t = 0; t < 30; ++t) {
    const std::uint32_t flags = b.tick().report.flags;
    EXPECT_TRUE(flags & FluidReport::kFlowBounded);
    EXPECT_TRUE(flags & FluidReport::kBadOpening);
    ASSERT_TRUE(audit(b.m, b.s)) << t;
  }
  EXPECT_LE(b.s.ledger.in[0].blood, 30 * (kMostAtOnce / 4 + 5'000'000));
  for (int i = 0; i < b.s.droplets.count; ++i) ASSERT_TRUE(std::isfinite(b.s.droplets.x[i]));
}

TEST(Drops, ThatAreNowhereGoIntoThePool) {
  Scene b(small_scene());
  put_drop(b, {0, 0, 0.05f}, {kNan, 0, 0}, 1'000'000);
  put_drop(b, {0, 0, 0.05f}, {0, std::numeric_limits<float>::infinity(), 0}, 1'000'000);
  put_drop(b, {0, 0, 0.05f}, {0, 0, 0}, 1'000'000);
  const FluidsReport r = b.tick();
  EXPECT_TRUE(r.report.flags & FluidReport::kBadDroplet);
  EXPECT_EQ(b.s.droplets.count, 1);
  EXPECT_EQ(at(b.s.ledger, Place::kPool).blood, 2'000'000);
  EXPECT_TRUE(audit(b.m, b.s));
}

TEST(Drops, AnswersThatAreNonsenseAreLeftOut) {
  Scene b(small_scene());
  put_drop(b, {0, 0, 0.05f}, {0, 0, 0}, 1'000'000);
  const Contact wrong[] = {{{kNan, 0, 0}, {0, 0, 1}, {0, 0, 0}, 1, -1},
                           {{0, 0, 1}, {0, 0, 2}, {0, 0, 0}, 1, -1},
                           {{0, 0, 1}, {0, 0, 1}, {0, 0, 0}, 1, 4711}};
  for (const Contact& c : wrong) {
    begin_tick(b.m, b.input(), b.s, b.w);
    ASSERT_EQ(b.w.droplets.questions, 1);
    b.w.droplets.answers[0] = c;
    const FluidsReport r = finish_tick(b.m, b.input(), b.s, b.w);
    EXPECT_TRUE(r.report.flags & FluidReport::kBadContact);
    EXPECT_EQ(b.s.droplets.body[0], -1);
  }
}

TEST(Drops, InOnePlaceCostNoMoreThanTheirBound) {
  FluidsDescription d = weightless();
  d.droplets.capacity = 20000;
  d.droplets.largest = 1'000'001;
  Scene b(d);
  for (int i = 0; i < 20000; ++i) put_drop(b, {1e-7f * float(i % 100), 0, 0.05f}, {0, 0, 0}, 1'000'000);
  const FluidReport r = detail::pull_together(b.m.droplets, {}, 4e-3, b.s.droplets, b.w.droplets);
  EXPECT_TRUE(r.flags & FluidReport::kCrowded);
  for (int i = 0; i < b.s.droplets.count; ++i) ASSERT_TRUE(std::isfinite(b.s.droplets.vx[i]));
}

TEST(Drops, RadiusIsThatOfABall) {
  for (std::int64_t pl = 1; pl < 2'000'000'000; pl = pl * 3 / 2 + 1) {
    const double r = double(radius_of(pl));
    EXPECT_NEAR(4.0 / 3 * std::numbers::pi * r * r * r * 1e15 / double(pl), 1, 1e-5);
  }
}

TEST(Drops, DescriptionsOutOfRangeAreRefused) {
  for (const auto& change :
       {+[](DropletDescription& d) { d.capacity = 0; }, +[](DropletDescription& d) { d.capacity = 70000; },
        +[](DropletDescription& d) { d.pair_period = 3; }, +[](DropletDescription& d) { d.run_period = 1; },
        +[](DropletDescription& d) { d.viscosity = double(kNan); }, +[](DropletDescription& d) { d.largest = 1; }}) {
    DropletDescription d;
    change(d);
    EXPECT_THROW(build(d), std::invalid_argument);
  }
}

}  // namespace
}  // namespace trocar::fluids
