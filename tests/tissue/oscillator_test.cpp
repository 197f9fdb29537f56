// One mass on one spring against closed forms: the discrete law of the integrator, and the motion it stands for.
// In double and in float, which by SpringNetwork.KernelGivesTheBitsOfThePlainReference is what the kernels compute.
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

constexpr double kMass = 0.01, kStiffness = 40, kReach = 0.01;  // [kg] [N/m] [m]
const double kOmega = std::sqrt(kStiffness / kMass);

template <class Real>
struct Oscillator {
  double rest = 0.1;
  ReferenceNetwork<Real> network;
  Oscillator(double mass, double damping, double gamma)
      : network(description(mass, damping, gamma), build(description(mass, damping, gamma), 1e-3)) {
    network.node(1).x.x += Real(kReach);
  }
  static NetworkDescription description(double mass, double damping, double gamma) {
    NetworkDescription d = test::oscillator(mass, kStiffness, damping);
    d.global_damping = gamma;
    return d;
  }
  double elongation() const { return double(network.node(1).x.x) - double(network.node(0).x.x) - rest; }
  /// Elongations from the start on, one a step.
  std::vector<double> course(int steps, double dt) {
    std::vector<double> x{elongation()};
    for (int n = 0; n < steps; ++n) network.step(dt), x.push_back(elongation());
    return x;
  }
};

// ---- undamped

/// Largest distance from x0 cos((n + 1/2) theta) / cos(theta / 2), cos(theta) = 1 - (w dt)^2 / 2, over x0.
template <class Real>
double off_discrete_law(double w_dt) {
  Oscillator<Real> o(kMass, 0, 0);
  const double x0 = o.elongation(), theta = std::acos(1 - w_dt * w_dt / 2);
  const std::vector<double> x = o.course(5000, w_dt / kOmega);
  double worst = 0;
  for (std::size_t n = 0; n < x.size(); ++n)
    worst = std::max(worst, std::fabs(x[n] / x0 - std::cos((double(n) + 0.5) * theta) / std::cos(theta / 2)));
  return worst;
}

/// Mean time between the first and the last crossing of zero, twice; relative to 2 pi sqrt(m / k), less 1.
template <class Real>
double period_error(double w_dt) {
  const std::vector<double> x = Oscillator<Real>(kMass, 0, 0).course(int(130 / w_dt), w_dt / kOmega);
  double first = 0, last = 0;
  int crossings = 0;
  for (std::size_t n = 1; n < x.size(); ++n) {
    if ((x[n] > 0) == (x[n - 1] > 0)) continue;
    last = double(n) - x[n] / (x[n] - x[n - 1]);
    if (crossings++ == 0) first = last;
  }
  return 2 * w_dt * (last - first) / (crossings - 1) / (2 * kPi) - 1;
}

template <class Real>
void expect_discrete_law(double tolerance) {
  for (const double w_dt : {0.05, 0.3, 1.0, 1.9}) {
    const std::string what = "row 1, discrete law, 5000 steps at w dt = " + std::to_string(w_dt).substr(0, 4);
    expect_within(what, precision<Real>(), off_discrete_law<Real>(w_dt), tolerance);
  }
}

TEST(Oscillator, UndampedFollowsTheDiscreteLawOfTheIntegrator) {  // [KCM99 eq.3]
  expect_discrete_law<double>(1e-9);
  expect_discrete_law<float>(1e-2);  // constants rounded to 24 bits: a frequency 1e-7 off, 9500 radians at 1.9
}

template <class Real>
void expect_period() {
  std::vector<double> errors;
  for (const double w_dt : {0.3, 0.15, 0.075}) errors.push_back(period_error<Real>(w_dt));
  expect_within("row 1, period at w dt = 0.3", precision<Real>(), errors[0], 0.01);
  expect_order("row 1, period at w dt = 0.3, 0.15, 0.075", precision<Real>(), errors, 2, 0.1);
}

TEST(Oscillator, ThePeriodConvergesWithTheSquareOfTheStep) {
  expect_period<double>();
  expect_period<float>();
}

/// Largest distance from x0 cos(w t) over one period, over x0.
template <class Real>
double course_error(double w_dt) {
  Oscillator<Real> o(kMass, 0, 0);
  const double x0 = o.elongation();
  const std::vector<double> x = o.course(int(2 * kPi / w_dt), w_dt / kOmega);
  double worst = 0;
  for (std::size_t n = 0; n < x.size(); ++n) worst = std::max(worst, std::fabs(x[n] / x0 - std::cos(double(n) * w_dt)));
  return worst;
}

TEST(Oscillator, TheCourseConvergesWithTheStep) {
  // Released at rest its velocity is half a step early: order 1, while the period is of order 2.
  for (const bool wide : {true, false}) {
    std::vector<double> errors;
    for (const double w_dt : {0.04, 0.02, 0.01})
      errors.push_back(wide ? course_error<double>(w_dt) : course_error<float>(w_dt));
    expect_order("row 1, course at w dt = 0.04, 0.02, 0.01", wide ? "f64" : "f32", errors, 1, 0.1);
  }
}

// ---- damped

struct Peak {
  double time, height;
};
/// The course's maxima after its start, each at the top of the parabola through three steps.
std::vector<Peak> peaks_of(const std::vector<double>& x, double dt) {
  std::vector<Peak> peaks;
  for (std::size_t n = 1; n + 1 < x.size(); ++n) {
    const double a = x[n - 1], b = x[n], c = x[n + 1];
    if (b <= a || b < c || b <= 0) continue;
    const double shift = 0.5 * (a - c) / (a - 2 * b + c);
    peaks.push_back({(double(n) + shift) * dt, b - 0.25 * (a - c) * shift});
  }
  return peaks;
}

enum class Damper { along_spring, against_space };

struct Decay {
  double decrement, period;  ///< relative errors
};
/// Of the first three swings (the first one alone where damping leaves little).
template <class Real>
Decay decay_errors(double zeta, double w_dt, Damper damper) {
  const double d = 2 * zeta * std::sqrt(kMass * kStiffness), dt = w_dt / kOmega;
  Oscillator<Real> o =
      damper == Damper::along_spring ? Oscillator<Real>(kMass, d, 0) : Oscillator<Real>(kMass, 0, d / kMass);
  const double slower = std::sqrt(1 - zeta * zeta), swings = zeta < 0.2 ? 3 : 1;
  const std::vector<double> x = o.course(int((swings + 0.5) * 2 * kPi / slower / w_dt), dt);
  const std::vector<Peak> peaks = peaks_of(x, dt);
  EXPECT_GE(double(peaks.size()), swings);
  if (double(peaks.size()) < swings) return {1, 1};
  const Peak last = peaks[size_t(swings) - 1];
  return {std::log(x[0] / last.height) / (swings * 2 * kPi * zeta / slower) - 1,
          last.time * kOmega * slower / (swings * 2 * kPi) - 1};
}

template <class Real>
void expect_decay(Damper damper, const std::string& where) {
  for (const double zeta : {0.02, 0.1, 0.3, 0.7}) {
    const Decay error = decay_errors<Real>(zeta, 0.005, damper);
    const std::string at = ", damped " + where + ", zeta = " + std::to_string(zeta).substr(0, 4);
    expect_within("row 2, decrement at w dt = 0.005" + at, precision<Real>(), error.decrement, 0.02);
    expect_within("row 2, period at w dt = 0.005" + at, precision<Real>(), error.period, 0.02);
  }
  std::vector<double> errors;
  for (const double w_dt : {0.08, 0.04, 0.02}) errors.push_back(decay_errors<Real>(0.3, w_dt, damper).decrement);
  expect_order("row 2, decrement at w dt = 0.08, 0.04, 0.02, damped " + where, precision<Real>(), errors, 1, 0.15);
}

TEST(Oscillator, DampedAlongTheSpringDecaysByItsLogarithmicDecrement) {  // [KCM99 eq.1]
  expect_decay<double>(Damper::along_spring, "along the spring");
  expect_decay<float>(Damper::along_spring, "along the spring");
}

TEST(Oscillator, DampedAgainstSpaceDecaysByItsLogarithmicDecrement) {  // [KCM99 eq.1]
  expect_decay<double>(Damper::against_space, "against space");
  expect_decay<float>(Damper::against_space, "against space");
}

// ---- heavily damped

/// Largest distance from `expected(t)` over 0.1 s, over x0.
template <class Real, class Expected>
double creep_error(double ratio, double dt, Expected&& expected) {
  const double m = 0.001, gamma = std::sqrt(ratio * m * kStiffness);
  Oscillator<Real> o(m, 0, gamma / m);
  const double x0 = o.elongation();
  const std::vector<double> x = o.course(int(0.1 / dt), dt);
  double worst = 0;
  for (std::size_t n = 0; n < x.size(); ++n)
    worst = std::max(worst, std::fabs(x[n] / x0 - expected(m, gamma, double(n) * dt)));
  return worst;
}
double creeping(double, double gamma, double t) { return std::exp(-kStiffness * t / gamma); }
/// m x'' + gamma x' + k x = 0 from rest.
double overdamped(double m, double gamma, double t) {
  const double root = std::sqrt(gamma * gamma - 4 * m * kStiffness), slow = 2 * kStiffness / (gamma + root),
               fast = (gamma + root) / (2 * m);
  return (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow);
}

template <class Real>
void expect_creep() {
  const std::string real = precision<Real>();
  for (const double dt : {1e-4, 1e-3})
    expect_within("row 4, creep, gamma^2 = 200 m k, dt = " + std::string(dt < 5e-4 ? "0.1 ms" : "1 ms"), real,
                  creep_error<Real>(200, dt, creeping), 0.02);
  std::vector<double> by_step, by_mass;
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) by_step.push_back(creep_error<Real>(200, dt, overdamped));
  expect_order("row 4, against m x'' + gamma x' + k x = 0, dt = 1, 0.5, 0.25 ms", real, by_step, 1, 0.2);
  for (const double ratio : {200, 400, 800}) by_mass.push_back(creep_error<Real>(ratio, 5e-6, creeping));
  expect_order("row 4, what mass adds, gamma^2 = 200, 400, 800 m k", real, by_mass, 1, 0.2);
}

TEST(Oscillator, HeavilyDampedCreepsBack) {  // [KCM99 eq.1]
  expect_creep<double>();
  expect_creep<float>();
}

}  // namespace
}  // namespace trocar::tissue
