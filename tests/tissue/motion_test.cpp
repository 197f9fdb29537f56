// Bodies in space: free fall, a pendulum, momentum, energy.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/network/network_reference.hpp>

#include "test_bodies.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::kPi;
using test::precision;

constexpr double kGravity = 9.81;  // [m/s^2]

// ---- free fall

/// How far a point falls in so many steps of (3), over what is expected; less 1.
template <class Real>
double fall_error(int steps, double dt, double expected) {
  NetworkDescription d;
  d.positions = {{0, 0, 0}};
  d.mass = {0.01};
  d.gravity = {0, 0, -kGravity};
  ReferenceNetwork<Real> network(d, build(d, 1e-3));
  for (int n = 0; n < steps; ++n) network.step(dt);
  return -double(network.node(0).x.z) / expected - 1;
}

template <class Real>
void expect_fall(double exactly) {
  const int n = 1000;
  expect_within("row 9, fall by the discrete law g dt^2 n (n + 1) / 2, n = 1000", precision<Real>(),
                fall_error<Real>(n, 1e-3, 0.5 * kGravity * 1e-6 * n * (n + 1)), exactly);
  std::vector<double> errors;
  for (const int halved : {1, 2, 4}) errors.push_back(fall_error<Real>(n * halved, 1e-3 / halved, 0.5 * kGravity));
  expect_order("row 9, fall for 1 s, dt = 1, 0.5, 0.25 ms", precision<Real>(), errors, 1, 0.2);
  expect_within("row 9, fall for 1 s, dt = 0.25 ms", precision<Real>(), errors[2], 1e-3);
}

TEST(Motion, APointFallsByTheIntegratorsLaw) {  // [KCM99 eq.3]
  expect_fall<double>(1e-12);
  expect_fall<float>(1e-5);
}

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
  expect_within("row 9, a block falls for 1 s", "f32", (before - height()) / (0.5 * kGravity) - 1, 1e-3);
}

// ---- pendulum

/// Period of a mass on a spring of stiffness k and length 0.2 m under its weight, swinging by 0.1 rad, stepped by dt.
template <class Real>
double pendulum_period(double k, double dt, double seconds) {
  const double angle = 0.1, long_ = 0.2, mass = 0.01;
  NetworkDescription d = test::oscillator(mass, k, 0.05, long_ - mass * kGravity / k);
  d.gravity = {0, 0, -kGravity};
  ReferenceNetwork<Real> network(d, build(d, 1e-3));
  const auto hinge = network.node(0).x;
  network.node(1).x = {hinge.x + Real(long_ * std::sin(angle)), 0, Real(-long_ * std::cos(angle))};
  const auto aside = [&] { return double(network.node(1).x.x) - double(hinge.x); };
  double first = 0, last = 0, before = aside();
  int crossings = 0;
  for (int t = 1; t * dt < seconds; ++t) {
    network.step(dt);
    const double now = aside();
    if ((now > 0) != (before > 0)) {
      last = t - now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  return 2 * dt * (last - first) / (crossings - 1);
}

/// 2 pi sqrt(l / g) and the amplitude's share.
double pendulum_theory() { return 2 * kPi * std::sqrt(0.2 / kGravity) * (1 + 0.1 * 0.1 / 16); }

TEST(Motion, APendulumKeepsItsPeriod) {
  expect_within("row 9, pendulum for 6 s, dt = 1 ms", "f64",
                pendulum_period<double>(2000, 1e-3, 6) / pendulum_theory() - 1, 0.01);
  expect_within("row 9, pendulum for 6 s, dt = 1 ms", "f32",
                pendulum_period<float>(2000, 1e-3, 6) / pendulum_theory() - 1, 0.01);
}

TEST(Motion, APendulumsPeriodConvergesWithTheSquareOfTheStep) {
  // A soft spring bears steps that are long beside the swing; its own period is the limit for short ones.
  const double limit = pendulum_period<double>(50, 2.5e-4, 20);
  for (const bool wide : {true, false}) {
    std::vector<double> errors;
    for (const double dt : {16e-3, 8e-3, 4e-3})
      errors.push_back((wide ? pendulum_period<double>(50, dt, 20) : pendulum_period<float>(50, dt, 20)) / limit - 1);
    expect_order("row 9, pendulum, dt = 16, 8, 4 ms", wide ? "f64" : "f32", errors, 2, 0.25);
  }
}

TEST(Motion, ASpringPendulumIsTheSlowerTheSofterItsSpring) {
  // What the spring's give adds to the period: of order m g / k l.
  std::vector<double> errors;
  for (const double k : {500, 1000, 2000})
    errors.push_back(pendulum_period<double>(k, 2.5e-4, 10) / pendulum_theory() - 1);
  expect_order("row 9, what the spring's give adds, k = 500, 1000, 2000 N/m", "f64", errors, 1, 0.3);
}

// ---- momentum

template <class Real>
double momentum_share(int steps) {
  NetworkDescription d = test::wobbly_block(4, 4, 4);
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  ReferenceNetwork<Real> network(d, m);
  for (int t = 0; t < steps; ++t) network.step(m.dt);
  double moved = 0;
  Vec3d sum{};
  for (int i = 0; i < m.nodes; ++i) {
    sum += m.mass[i] * vec_cast<double>(network.node(i).v);
    moved += m.mass[i] * double(length(network.node(i).v));
  }
  EXPECT_GT(moved, 1e-7);
  return length(sum) / moved;
}

TEST(Motion, MomentumIsConservedWithoutForceFromOutside) {  // [KCM99 eq.2]
  expect_within("row 9, sum of m v over sum of m |v|, 500 steps", "f64", momentum_share<double>(500), 1e-9);
  expect_within("row 9, sum of m v over sum of m |v|, 500 steps", "f32", momentum_share<float>(500), 1e-6);
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

// ---- energy

struct EnergyOff {
  double swing, drift;  ///< largest distance from the start's; of its mean over the last half from the first half's
};
/// Of a free block whose springs do not fit, without damping, over so many seconds; relative to the start.
template <class Real>
EnergyOff energy_off(double dt, double seconds) {
  NetworkDescription d = test::wobbly_block(3, 3, 3);
  for (auto& e : d.springs) e.damping = 0;
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  ReferenceNetwork<Real> network(d, m);
  const auto total = [&] {
    double sum = 0;
    for (int i = 0; i < m.nodes; ++i) {
      const Vec3d v = vec_cast<double>(network.node(i).v);
      sum += 0.5 * m.mass[i] * dot(v, v);
    }
    for (const auto& e : d.springs) {
      const double r = length(vec_cast<double>(network.node(e.b).x) - vec_cast<double>(network.node(e.a).x));
      sum += e.k * e.rest_length * e.rest_length * SpringLaw{e.p1, e.p2, e.cap}.energy(r / e.rest_length - 1);
    }
    return sum;
  };
  const double start = total();
  const int steps = int(seconds / dt);
  EnergyOff off{0, 0};
  double halves[2] = {0, 0};
  for (int n = 0; n < steps; ++n) {
    network.step(dt);
    const double now = total();
    off.swing = std::max(off.swing, std::fabs(now / start - 1));
    halves[2 * n / steps] += 2 * now / steps;
  }
  off.drift = (halves[1] - halves[0]) / start;
  return off;
}

TEST(Motion, EnergyStaysWithinTheStepsShareOfItself) {
  // Without damping the integrator keeps an energy that differs from the true one by a share of order dt.
  for (const bool wide : {true, false}) {
    std::vector<double> errors;
    for (const double dt : {4e-4, 2e-4, 1e-4})
      errors.push_back((wide ? energy_off<double>(dt, 0.1) : energy_off<float>(dt, 0.1)).swing);
    expect_order("row 9, energy of a shaken block, dt = 0.4, 0.2, 0.1 ms", wide ? "f64" : "f32", errors, 1, 0.2);
    const double drift = (wide ? energy_off<double>(2e-4, 1) : energy_off<float>(2e-4, 1)).drift;
    expect_within("row 9, its drift within 1 s, dt = 0.2 ms", wide ? "f64" : "f32", drift, 0.01);
  }
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
