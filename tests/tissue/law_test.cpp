#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/law.hpp>

namespace trocar::tissue {
namespace {

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
