// One mass on one spring, and one mass on nothing: the integrator against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network_reference.hpp>
#include <trocar/tissue/stability.hpp>

#include "test_bodies.hpp"

namespace trocar::tissue {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Oscillator {
  double rest = 0.1;
  ReferenceNetwork<double> network;
  Oscillator(double mass, double k, double damping, double gamma, double x0)
      : network(description(mass, k, damping, gamma), build(description(mass, k, damping, gamma), 1e-3)) {
    network.node(1).x.x += x0;
  }
  static NetworkDescription description(double mass, double k, double damping, double gamma) {
    NetworkDescription d = test::oscillator(mass, k, damping);
    d.global_damping = gamma;
    return d;
  }
  double elongation() const { return network.node(1).x.x - network.node(0).x.x - rest; }
};

TEST(Oscillator, UndampedFollowsTheDiscreteLawOfTheIntegrator) {  // [KCM99 eq.3]
  for (double w_dt : {0.05, 0.3, 1.0, 1.9}) {
    const double m = 0.01, k = 40, w = std::sqrt(k / m), dt = w_dt / w, x0 = 1e-3;
    Oscillator o(m, k, 0, 0, x0);
    const double theta = std::acos(1 - w_dt * w_dt / 2);
    for (int n = 1; n <= 5000; ++n) {
      o.network.step(dt);
      const double expected = x0 * std::cos((n + 0.5) * theta) / std::cos(theta / 2);
      ASSERT_NEAR(o.elongation(), expected, 1e-9 * x0 * 100) << w_dt << " " << n;
    }
    if (w_dt <= 0.3) {
      EXPECT_NEAR(theta / w_dt, 1, 0.01);  // period within 1 % of 2 pi sqrt(m/k)
    }
  }
}

TEST(Oscillator, DampedAlongTheSpringDecaysByItsLogarithmicDecrement) {  // [KCM99 eq.1]
  for (double zeta : {0.02, 0.1, 0.3, 0.7}) {
    const double m = 0.01, k = 40, w = std::sqrt(k / m), dt = 0.002 / w, x0 = 1e-3;
    Oscillator o(m, k, 2 * zeta * std::sqrt(m * k), 0, x0);
    const double damped = w * std::sqrt(1 - zeta * zeta);
    double last_peak = x0;
    double before = o.elongation(), now = before;
    int peaks = 0;
    for (int n = 0; n < 20000 && peaks < 3; ++n) {
      o.network.step(dt);
      const double next = o.elongation();
      if (now > before && now > next && now > 1e-9) {
        EXPECT_NEAR(std::log(last_peak / now), 2 * kPi * zeta / std::sqrt(1 - zeta * zeta),
                    0.02 * 2 * kPi * zeta / std::sqrt(1 - zeta * zeta));
        EXPECT_NEAR(n * dt, (peaks + 1) * 2 * kPi / damped, 0.02 * (peaks + 1) * 2 * kPi / damped);
        last_peak = now;
        ++peaks;
      }
      before = now;
      now = next;
    }
    EXPECT_GE(peaks, zeta < 0.5 ? 3 : 1);
  }
}

TEST(Oscillator, HeavilyDampedCreepsBack) {
  const double m = 0.001, k = 40, gamma = std::sqrt(200 * m * k), x0 = 1e-3;
  for (double dt : {1e-4, 1e-3}) {
    Oscillator o(m, k, 0, gamma / m, x0);
    for (int n = 1; n * dt <= 0.1; ++n) {
      o.network.step(dt);
      ASSERT_NEAR(o.elongation(), x0 * std::exp(-k * n * dt / gamma), 0.02 * x0);
    }
  }
}

// ---- stability

bool blows_up(double mass, double k, double damping, double gamma, double dt) {
  Oscillator o(mass, k, damping, gamma, 1e-6);
  for (int n = 0; n < 4000; ++n) {
    o.network.step(dt);
    if (!(std::fabs(o.elongation()) < 1e-4)) return true;
  }
  return false;
}
/// The boundary between calm and blow-up, bisected.
double measured_limit(double mass, double k, double damping, double gamma) {
  double calm = 0.1 * std::sqrt(mass / k), wild = 20 * std::sqrt(mass / k);
  for (int i = 0; i < 40; ++i) {
    const double mid = 0.5 * (calm + wild);
    (blows_up(mass, k, damping, gamma, mid) ? wild : calm) = mid;
  }
  return calm;
}

TEST(Stability, LimitsAreThoseTheIntegratorHas) {
  const double m = 0.01, k = 40;
  for (double zeta : {0.0, 0.144, 0.5, 1.0}) {
    const double d = 2 * zeta * std::sqrt(m * k);
    const double along = measured_limit(m, k, d, 0), space = measured_limit(m, k, 0, d / m);
    EXPECT_NEAR(along, dt_limit_explicit_damping(m, k, d), 0.01 * along) << zeta;
    EXPECT_NEAR(space, dt_limit_implicit_damping(m, k, d), 0.01 * space) << zeta;
  }
}

TEST(Stability, ThePrintedCriterionIsUnsafeWithDampingAlongTheSpring) {  // [KCM99 eq.4]
  const double m = 0.01, k = 40, unit = std::sqrt(m / k);
  EXPECT_NEAR(dt_limit_as_printed(m, k, 0) / unit, 1.414, 1e-3);
  EXPECT_NEAR(dt_limit_as_printed(m, k, 2 * 0.5 * std::sqrt(m * k)) / unit, 2.73, 0.01);
  EXPECT_NEAR(dt_limit_as_printed(m, k, 2 * std::sqrt(m * k)) / unit, 4.45, 0.01);
  for (double zeta : {0.3, 0.5, 1.0}) {
    const double d = 2 * zeta * std::sqrt(m * k), dt = 0.95 * dt_limit_as_printed(m, k, d);
    EXPECT_TRUE(stable_as_printed(m, k, d, dt));
    EXPECT_TRUE(blows_up(m, k, d, 0, dt));
  }
  // (4a) and (4b) are the same statement.
  for (double d : {0.1, 0.6, 1.3}) {
    const double limit = dt_limit_as_printed(m, k, d);
    EXPECT_TRUE(stable_as_printed(m, k, d, 0.999 * limit));
    EXPECT_FALSE(stable_as_printed(m, k, d, 1.001 * limit));
  }
}

TEST(Stability, EigenvalueOfAKnownMatrix) {
  EXPECT_NEAR(largest_eigenvalue(2, 2, 2, 0, 0, 0), 2, 1e-14);
  EXPECT_NEAR(largest_eigenvalue(2, 2, 2, 1, 1, 1), 4, 1e-12);
  EXPECT_NEAR(largest_eigenvalue(1, 2, 9, 0, 0, 0), 9, 1e-14);
  EXPECT_NEAR(largest_eigenvalue(4, 1, 0, 2, 0, 0), 5, 1e-12);  // n n^T for n = (2, 1, 0)
}

TEST(Stability, SubstepsFitTheTick) {
  EXPECT_EQ(substeps_for(1e-3, 1), 1);
  EXPECT_EQ(substeps_for(1e-3, 1e-3), 2);
  EXPECT_EQ(substeps_for(1e-3, 1e-3, 1.0), 1);
  EXPECT_EQ(substeps_for(1e-3, 2.9e-5), 39);
}

NetworkDescription shaken_lattice(double damping_time) {
  const BoxLattice box = box_lattice(7, 7, 7, 0.005);
  return lattice_network(box.corners, box.cells, {},
                         {.youngs_modulus = 30e3, .density = 1050, .damping_time = damping_time})
      .network;
}
bool lattice_blows_up(const NetworkDescription& d, double dt) {
  ReferenceNetwork<double> network(d, build(d, 1e-3));
  core::Random random(7);
  const int n = int(d.positions.size());
  for (int i = 0; i < n; ++i)
    for (int axis = 0; axis < 3; ++axis) network.node(i).v[axis] = random.uniform(-1e-4, 1e-4);
  for (int t = 0; t < 1500; ++t) network.step(dt);
  for (int i = 0; i < n; ++i)
    if (!(length(network.node(i).v) < 1e-2)) return true;
  return false;
}

TEST(Stability, ALatticeIsCalmAtItsCompiledLimitAndNotFarBeyond) {
  for (double damping_time : {0.0, 1e-4, 5e-4}) {
    const NetworkDescription d = shaken_lattice(damping_time);
    const NetworkModel m = build(d, 1e-3);
    EXPECT_FALSE(lattice_blows_up(d, m.dt_limit)) << damping_time;
    EXPECT_TRUE(lattice_blows_up(d, 1.4 * m.dt_limit)) << damping_time;
    EXPECT_LE(m.dt, 0.9 * m.dt_limit);
  }
  // Without damping: 0.71 l / c inside the body (the corners and faces are no worse).
  const double c = std::sqrt(30e3 / 1050);
  EXPECT_NEAR(build(shaken_lattice(0), 1e-3).dt_limit, 0.71 * 0.005 / c, 0.05 * 0.005 / c);
}

// ---- bodies in space

TEST(Motion, FreeFallCoversHalfGTSquared) {
  NetworkDescription d = test::wobbly_block(3, 3, 3);
  d.fixed.clear();
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  double mass = 0;
  const auto height = [&] {
    double z = 0;
    mass = 0;
    for (int i = 0; i < m.nodes; ++i) z += m.mass[i] * position(m, s, i).z, mass += m.mass[i];
    return z / mass;
  };
  const double before = height();
  for (int t = 0; t < 1000; ++t) advance(m, {}, {}, s, w);
  EXPECT_NEAR(before - height(), 0.5 * 9.81, 1e-3 * 0.5 * 9.81);
}

TEST(Motion, APendulumKeepsItsPeriod) {
  NetworkDescription d = test::oscillator(0.01, 2000, 0.05, 0.2);
  d.gravity = {0, 0, -9.81};
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  const double angle = 0.1;
  set_position(m, s, 1, {0.2 * std::sin(angle), 0, -0.2 * std::cos(angle) - 0.01 * 9.81 / 2000});
  double first = 0, last = 0, before = position(m, s, 1).x;
  int crossings = 0;
  for (int t = 1; t < 6000; ++t) {
    advance(m, {}, {}, s, w);
    const double now = position(m, s, 1).x;
    if ((now > 0) != (before > 0)) {
      last = t - now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  const double period = 2e-3 * (last - first) / (crossings - 1);
  const double expected = 2 * kPi * std::sqrt(0.2 / 9.81) * (1 + angle * angle / 16);
  EXPECT_NEAR(period, expected, 0.01 * expected);
}

TEST(Motion, MomentumIsConservedWithoutForceFromOutside) {  // [KCM99 eq.2]
  NetworkDescription d = test::wobbly_block(4, 4, 4);
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  ReferenceNetwork<double> network(d, m);
  double moved = 0;
  Vec3d sum{};
  for (int t = 0; t < 500; ++t) network.step(m.dt);
  for (int i = 0; i < m.nodes; ++i) {
    sum += m.mass[i] * network.node(i).v;
    moved += m.mass[i] * length(network.node(i).v);
  }
  EXPECT_GT(moved, 1e-7);
  EXPECT_LT(length(sum), 1e-9 * moved);
}

TEST(Motion, TheTwoEndsOfASpringFeelOppositeForces) {  // [KCM99 eq.2]
  const NetworkDescription d = test::oscillator(0.01, 40, 0.3);
  ReferenceNetwork<float> network(d, build(d, 1e-3));
  network.node(1).x = {0.07f, 0.03f, -0.02f};
  network.node(1).v = {-0.2f, 0.5f, 0.1f};
  const Vec3f a = network.force(network.row_of(0)), b = network.force(network.row_of(1));
  EXPECT_EQ(a.x, -b.x);
  EXPECT_EQ(a.y, -b.y);
  EXPECT_EQ(a.z, -b.z);
  EXPECT_GT(a.x * a.x, 0);
}

TEST(Motion, ASpringWithoutDampingKeepsItsEnergy) {
  NetworkDescription d = test::wobbly_block(4, 4, 4);
  for (auto& e : d.springs) e.damping = 0;
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  const auto total = [&] {
    const NetworkEnergy e = energy(m, s);
    return e.kinetic + e.elastic;
  };
  for (int t = 0; t < 100; ++t) advance(m, {}, {}, s, w);
  const double start = total();
  for (int t = 0; t < 5000; ++t) advance(m, {}, {}, s, w);
  EXPECT_NEAR(total(), start, 0.1 * start);
}

}  // namespace
}  // namespace trocar::tissue
