// How long a step may be: the boundary between calm and blow-up, bisected with the integrator itself, against the
// formulas of tissue/network/stability.hpp; one spring, and a lattice.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/network_reference.hpp>
#include <trocar/tissue/network/stability.hpp>

#include "linear_solve.hpp"
#include "test_bodies.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::precision;

constexpr double kMass = 0.01, kStiffness = 40;  // [kg] [N/m]
const double kUnit = std::sqrt(kMass / kStiffness);

/// The boundary between calm and blow-up, bisected. @param wild_at  tells whether a step blows up
template <class Blows>
double bisected(double calm, double wild, int rounds, Blows&& wild_at) {
  for (int i = 0; i < rounds; ++i) {
    const double mid = 0.5 * (calm + wild);
    (wild_at(mid) ? wild : calm) = mid;
  }
  return calm;
}

// ---- one spring

template <class Real>
bool blows_up(double along_spring, double against_space, double dt, int steps) {
  NetworkDescription d = test::oscillator(kMass, kStiffness, along_spring);
  d.global_damping = against_space / kMass;
  ReferenceNetwork<Real> network(d, build(d, 1e-3));
  const auto elongation = [&] { return double(network.node(1).x.x) - double(network.node(0).x.x) - 0.1; };
  network.node(1).x.x += Real(1e-6);
  for (int n = 0; n < steps; ++n) {
    network.step(dt);
    if (!(std::fabs(elongation()) < 1e-4)) return true;
  }
  return false;
}

template <class Real>
double measured_limit(double along_spring, double against_space, int steps) {
  return bisected(0.1 * kUnit, 20 * kUnit, 30,
                  [&](double dt) { return blows_up<Real>(along_spring, against_space, dt, steps); });
}

template <class Real>
void expect_limits() {
  for (const double zeta : {0.0, 0.144, 0.5, 1.0}) {
    const double d = 2 * zeta * std::sqrt(kMass * kStiffness);
    const std::string at = ", zeta = " + std::to_string(zeta).substr(0, 5);
    const double along = dt_limit_explicit_damping(kMass, kStiffness, d),
                 space = dt_limit_implicit_damping(kMass, kStiffness, d);
    expect_within("row 3, boundary, damped along the spring" + at, precision<Real>(),
                  measured_limit<Real>(d, 0, 4000) / along - 1, 0.01);
    expect_within("row 3, boundary, damped against space" + at, precision<Real>(),
                  measured_limit<Real>(0, d, 4000) / space - 1, 0.01);
  }
}

TEST(Stability, LimitsAreThoseTheIntegratorHas) {
  expect_limits<double>();
  expect_limits<float>();
}

TEST(Stability, TheLimitIsApproachedTheLongerOneWatches) {
  // The formula is exact for the linear map; what is left is blow-up too slow to show in so many steps.
  const double d = 2 * 0.5 * std::sqrt(kMass * kStiffness), limit = dt_limit_explicit_damping(kMass, kStiffness, d);
  std::vector<double> errors;
  for (const int steps : {500, 1000, 2000}) errors.push_back(measured_limit<double>(d, 0, steps) / limit - 1);
  expect_order("row 3, boundary by 500, 1000, 2000 steps, zeta = 0.5", "f64", errors, 1, 0.15);
}

TEST(Stability, ThePrintedCriterionIsUnsafeWithDampingAlongTheSpring) {  // [KCM99 eq.4]
  const double critical = 2 * std::sqrt(kMass * kStiffness);
  EXPECT_NEAR(dt_limit_as_printed(kMass, kStiffness, 0) / kUnit, 1.414, 1e-3);
  EXPECT_NEAR(dt_limit_as_printed(kMass, kStiffness, 0.5 * critical) / kUnit, 2.73, 0.01);
  EXPECT_NEAR(dt_limit_as_printed(kMass, kStiffness, critical) / kUnit, 4.45, 0.01);
  for (const double zeta : {0.3, 0.5, 1.0}) {
    const double d = zeta * critical, dt = 0.95 * dt_limit_as_printed(kMass, kStiffness, d);
    EXPECT_TRUE(stable_as_printed(kMass, kStiffness, d, dt));
    EXPECT_TRUE(blows_up<double>(d, 0, dt, 4000));
  }
  // (4a) and (4b) are the same statement.
  for (const double d : {0.1, 0.6, 1.3}) {
    const double limit = dt_limit_as_printed(kMass, kStiffness, d);
    EXPECT_TRUE(stable_as_printed(kMass, kStiffness, d, 0.999 * limit));
    EXPECT_FALSE(stable_as_printed(kMass, kStiffness, d, 1.001 * limit));
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

// ---- a lattice

constexpr double kSide = 0.005, kModulus = 30e3, kDensity = 1050;

NetworkDescription lattice(int cells, double damping_time) {
  const BoxLattice box = box_lattice(cells, cells, cells, kSide);
  return lattice_network(box.corners, box.cells, {},
                         {.youngs_modulus = kModulus, .density = kDensity, .damping_time = damping_time})
      .network;
}

template <class Real>
bool lattice_blows_up(const NetworkDescription& d, const NetworkModel& m, double dt, int steps) {
  ReferenceNetwork<Real> network(d, m);
  core::Random random(7);
  for (int i = 0; i < m.nodes; ++i)
    for (int axis = 0; axis < 3; ++axis) network.node(i).v[axis] = Real(random.uniform(-1e-4, 1e-4));
  for (int t = 0; t < steps; ++t) network.step(dt);
  for (int i = 0; i < m.nodes; ++i)
    if (!(length(network.node(i).v) < Real(1e-2))) return true;
  return false;
}

/// Largest eigenvalue of M^-1 K [1/s^2], by powers and Rayleigh's quotient.
double stiffest_mode(const NetworkDescription& d) {
  core::Random random(11);
  std::vector<Vec3d> u(d.positions.size());
  for (Vec3d& v : u) v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  double quotient = 0;
  for (int round = 0; round < 400; ++round) {
    const std::vector<Vec3d> f = forces(d, u);
    double above = 0, below = 0, size = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      above += dot(u[i], f[i]);
      below += d.mass[i] * dot(u[i], u[i]);
      u[i] = f[i] / d.mass[i];
      size = std::max(size, length(u[i]));
    }
    quotient = above / below;
    for (Vec3d& v : u) v = v / size;
  }
  return quotient;
}

template <class Real>
void expect_lattice_limit(double damping_time) {
  const NetworkDescription d = lattice(4, damping_time);
  const NetworkModel m = build(d, 1e-3);
  const double mode = stiffest_mode(d), limit = dt_limit_explicit_damping(1, mode, damping_time * mode);
  const double measured =
      bisected(0.8 * limit, 1.2 * limit, 8, [&](double dt) { return lattice_blows_up<Real>(d, m, dt, 600); });
  char at[64];
  std::snprintf(at, sizeof at, ", damped for %.1f ms", 1e3 * damping_time);
  expect_within("row 3, boundary of a lattice by its stiffest mode" + std::string(at), precision<Real>(),
                measured / limit - 1, 0.01);
  EXPECT_LE(m.dt_limit, measured) << "what is compiled is safe";
  test::record("row 3, compiled limit over the true one" + std::string(at) + ", " + precision<Real>(),
               "%.2f (%.2f l / c)", m.dt_limit / measured, m.dt_limit / kSide * std::sqrt(kModulus / kDensity));
}

TEST(Stability, ALatticesLimitIsThatOfItsStiffestMode) {
  for (const double damping_time : {0.0, 1e-4, 5e-4}) {
    expect_lattice_limit<double>(damping_time);
    expect_lattice_limit<float>(damping_time);
  }
}

TEST(Stability, ALatticeIsCalmAtItsCompiledLimitAndNotFarBeyond) {
  for (const double damping_time : {0.0, 1e-4, 5e-4}) {
    const NetworkDescription d = lattice(7, damping_time);
    const NetworkModel m = build(d, 1e-3);
    EXPECT_FALSE(lattice_blows_up<double>(d, m, m.dt_limit, 1500)) << damping_time;
    EXPECT_TRUE(lattice_blows_up<double>(d, m, 1.4 * m.dt_limit, 1500)) << damping_time;
    EXPECT_LE(m.dt, 0.9 * m.dt_limit);
  }
  // Without damping: 0.71 l / c inside the body (the corners and faces are no worse).
  const double c = std::sqrt(kModulus / kDensity);
  EXPECT_NEAR(build(lattice(7, 0), 1e-3).dt_limit, 0.71 * kSide / c, 0.05 * kSide / c);
}

}  // namespace
}  // namespace trocar::tissue
