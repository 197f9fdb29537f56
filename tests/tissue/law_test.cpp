#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/network_reference.hpp>

#include "test_bodies.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::precision;

const SpringLaw kLaws[] = {{2, 100, 0.35}, {5, 105, 0.43}, {0, 10, 0.6}, {4, 40, 0.8}, {0, 0, 1}, {-3, 4, 0.5}};

TEST(SpringLaw, IsThePrintedPolynomialUpToTheCap) {  // [KCM99 eq.5]
  for (const SpringLaw& law : kLaws) {
    for (double eps = 0; eps <= law.cap; eps += law.cap / 16) {
      const double printed = eps * (1 + law.p1 * eps + law.p2 * eps * eps);
      EXPECT_NEAR(law.shape(eps), printed, 1e-12 * (1 + printed));
      EXPECT_EQ(law.shape(-eps), -law.shape(eps));
    }
  }
}

TEST(SpringLaw, TangentIsTheDerivativeOfForceAndForceThatOfEnergy) {
  for (const SpringLaw& law : kLaws) {
    for (double eps = -2; eps <= 2; eps += 0.0371) {
      const double h = 1e-6;
      const double slope = (law.shape(eps + h) - law.shape(eps - h)) / (2 * h);
      const double force = (law.energy(eps + h) - law.energy(eps - h)) / (2 * h);
      if (std::fabs(std::fabs(eps) - law.cap) > 2 * h) {
        EXPECT_NEAR(law.slope(eps), slope, 1e-6 * (1 + law.slope(eps)));
      }
      EXPECT_NEAR(law.shape(eps), force, 1e-6 * (1 + std::fabs(force)));
    }
  }
}

// ---- in double and in float

template <class Real>
SpringLawT<Real> rounded(const SpringLaw& law) {
  return {Real(law.p1), Real(law.p2), Real(law.cap)};
}

/// Largest relative distances of stress, tangent and energy from the printed polynomial, its derivative and its
/// integral, up to the cap.
struct LawErrors {
  double stress = 0, tangent = 0, energy = 0;
};
template <class Real>
LawErrors law_errors(const SpringLaw& law) {
  LawErrors worst;
  const SpringLawT<Real> own = rounded<Real>(law);
  for (int i = 1; i <= 1000; ++i) {
    const Real eps = own.cap * Real(i) / 1000;
    const long double e = eps, p1 = own.p1, p2 = own.p2;
    const long double stress = e * (1 + p1 * e + p2 * e * e), tangent = 1 + 2 * p1 * e + 3 * p2 * e * e,
                      energy = e * e * (0.5l + p1 * e / 3 + p2 * e * e / 4);
    const auto off = [](Real a, long double b) { return double(std::fabs(a / b - 1)); };
    worst.stress = std::max(worst.stress, off(own.shape(eps), stress));
    worst.tangent = std::max(worst.tangent, off(own.slope(eps), tangent));
    worst.energy = std::max(worst.energy, off(own.energy(eps), energy));
  }
  return worst;
}

template <class Real>
void expect_law(double tolerance) {
  LawErrors worst;
  for (const SpringLaw& law : kLaws) {
    const LawErrors e = law_errors<Real>(law);
    worst = {std::max(worst.stress, e.stress), std::max(worst.tangent, e.tangent), std::max(worst.energy, e.energy)};
  }
  expect_within("row 6, stress over the printed polynomial, six laws", precision<Real>(), worst.stress, tolerance);
  expect_within("row 6, tangent over its derivative", precision<Real>(), worst.tangent, tolerance);
  expect_within("row 6, energy over its integral", precision<Real>(), worst.energy, tolerance);
}

TEST(SpringLaw, StressTangentAndEnergyAreExactToRounding) {  // [KCM99 eq.5]
  expect_law<double>(1e-6);
  expect_law<float>(1e-6);
}

TEST(SpringLaw, DifferencesOfStressConvergeToItsTangent) {
  // Central differences of a cubic are off by P2 h^2, exactly: order 2 says that slope() is the derivative.
  const SpringLaw law{5, 105, 0.43};
  std::vector<double> stress, energy;
  for (const double h : {4e-3, 2e-3, 1e-3}) {
    stress.push_back((law.shape(0.2 + h) - law.shape(0.2 - h)) / (2 * h) - law.slope(0.2));
    energy.push_back((law.energy(0.2 + h) - law.energy(0.2 - h)) / (2 * h) - law.shape(0.2));
  }
  expect_order("row 6, differences of stress, h = 0.004, 0.002, 0.001", "f64", stress, 2, 0.01);
  expect_order("row 6, differences of energy, h = 0.004, 0.002, 0.001", "f64", energy, 2, 0.01);
}

/// Largest distance of a network's spring force, over k l, from the law at the strain that its drawn and its present
/// length have; divided by the tangent there: what strain would explain it.
template <class Real>
double force_error(const SpringLaw& law) {
  NetworkDescription d = test::oscillator(0.01, 40, 0);
  SpringDescription& spring = d.springs[0];
  spring.p1 = law.p1, spring.p2 = law.p2, spring.cap = law.cap;
  const double l = spring.rest_length;
  ReferenceNetwork<Real> network(d, build(d, 1e-3));
  const Vec3d along = normalised(Vec3d{1, 2, -2});
  double worst = 0;
  for (double eps = -0.45; eps < 1; eps += 0.0173) {
    network.node(1).x = network.node(0).x + vec_cast<Real>((l * (1 + eps)) * along);
    const double pull = double(length(network.force(network.row_of(0)))) / (spring.k * l);
    worst = std::max(worst, std::fabs(pull - std::fabs(law.shape(eps))) / law.slope(eps));
  }
  return worst;
}

TEST(SpringLaw, ANetworksSpringPullsByIt) {  // [KCM99 eq.5] in [KCM99 eq.2]
  for (const bool wide : {true, false}) {
    double worst = 0;
    for (const SpringLaw& law : kLaws)
      worst = std::max(worst, wide ? force_error<double>(law) : force_error<float>(law));
    expect_within("row 6, force of a spring in space, as strain", wide ? "f64" : "f32", worst, 1e-6);
  }
}

// ---- beyond the cap, and back

TEST(SpringLaw, GoesOnStraightBeyondTheCap) {
  for (const SpringLaw& law : kLaws) {
    EXPECT_NEAR(law.shape(law.cap + 1e-9), law.shape(law.cap), 1e-6);
    EXPECT_NEAR(law.shape(law.cap + 2) - law.shape(law.cap + 1), law.cap_slope(), 1e-9 * law.cap_slope());
    EXPECT_EQ(law.slope(law.cap + 3), law.cap_slope());
  }
}

TEST(SpringLaw, MonotoneMeansThatForceGrowsWithStrain) {
  int monotone = 0;
  for (double p1 = -12; p1 <= 12; p1 += 0.5) {
    for (double p2 = -5; p2 <= 60; p2 += 2.5) {
      const SpringLaw law{p1, p2, 1};
      double least = 1;
      for (double eps = 0; eps <= 1; eps += 1e-3) least = std::min(least, law.slope(eps));
      if (law.monotone()) {
        ++monotone;
        EXPECT_GT(least, 0) << p1 << " " << p2;
      }
      if (p1 * p1 > 3 * p2 * 1.05 && p1 < 0 && p2 > 0 && -p1 / (3 * p2) < 1) {
        EXPECT_FALSE(law.monotone());
        EXPECT_LT(least, 0) << p1 << " " << p2;
      }
    }
  }
  EXPECT_GT(monotone, 100);
}

TEST(SpringLaw, InverseFindsTheStrain) {
  for (const SpringLaw& law : kLaws)
    for (double eps : {-1.5, -0.3, -1e-4, 0.0, 1e-5, 0.2, 0.9, 3.0})
      EXPECT_NEAR(inverse_shape(law, law.shape(eps)), eps, 1e-12 * (1 + std::fabs(eps)));
}

TEST(SpringLaw, RestLengthCarriesTheTensionAsked) {
  for (const SpringLaw& law : kLaws) {
    for (double f : {-0.5, -1e-3, 0.0, 1e-3, 0.2}) {
      const double k = 60, r = 0.005, l = rest_length_for_tension(law, k, r, f);
      ASSERT_GT(l, 0);
      EXPECT_NEAR(k * l * law.shape(r / l - 1), f, 1e-10);
    }
    EXPECT_TRUE(std::isnan(rest_length_for_tension(law, 1, 0.005, 1e9)));
  }
}

}  // namespace
}  // namespace trocar::tissue
