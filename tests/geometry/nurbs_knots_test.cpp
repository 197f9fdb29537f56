#include <limits>

#include <trocar/geometry/nurbs/basis.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Knots;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Knots cubic(std::vector<double> values, bool periodic = false) { return {3, periodic, std::move(values)}; }

// Example 2.3 and 2.4 of the book: degree 2, u = 5/2 in span 4.
const Knots kBook{2, false, {0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5}};

}  // namespace

TEST(NurbsKnots, FaultsAreNamedWithTheirPlace) {
  const auto fault = [](const Knots& k) { return nurbs::fault_in(k); };
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 1, 1, 1, 1})), "");
  EXPECT_EQ(fault({0, false, {0, 1}}), "a degree from 1 to 9 expected, got 0");
  EXPECT_EQ(fault({10, false, std::vector<double>(30)}), "a degree from 1 to 9 expected, got 10");
  EXPECT_EQ(fault(cubic({0, 0, 0, 1, 1, 1})), "at least 8 knots expected for degree 3, got 6");
  EXPECT_EQ(fault(cubic({})), "at least 8 knots expected for degree 3, got 0");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, kNan, 1, 1, 1, 1})), "knot 4 is not a number");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 0.7, 0.5, 1, 1, 1, 1})), "knot 5 = 0.5 lies below knot 4 = 0.7");
  EXPECT_EQ(fault(cubic({2, 2, 2, 2, 2, 2, 2, 2})), "the knots span no domain");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0.1, 0.5, 1, 1, 1, 1})),
            "the first 4 knots of a clamped spline are equal; knot 3 is 0.1, not 0");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 0.5, 0.9, 1, 1, 1})),
            "the last 4 knots of a clamped spline are equal; knot 5 is 0.9, not 1");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5, 1, 1, 1, 1})),
            "knot 0.5 is repeated more than 3 times, the degree");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 0, 1, 1, 1, 1})), "the first knot is repeated more than 4 times");
  EXPECT_EQ(fault(cubic({0, 0, 0, 0, 1, 1, 1, 1, 1})), "the last knot is repeated more than 4 times");
  const Knots ring = nurbs::periodic_uniform(3, 4);
  Knots off = ring;
  off.values[8] += 0.01;
  EXPECT_EQ(fault(off), "knot 8 = 1.26 is not one period of 1 behind knot 4 = 0.25");
  EXPECT_EQ(fault(cubic({-1, -1, 0, 0, 1, 2, 3, 3, 4, 4, 4}, true)),
            "the repeats of a periodic spline's first knot stand inside of its domain; knot 2 is 0, too");
  EXPECT_REFUSED(nurbs::require_valid(off, "here"), "here: knot 8 = 1.26");
}

TEST(NurbsKnots, MakersMakeValidOnesAndRefuseTooFewPoints) {
  for (int degree = 1; degree <= nurbs::kHighestDegree; ++degree)
    for (int points = degree + 1; points < degree + 6; ++points) {
      const Knots open = nurbs::clamped_uniform(degree, points), round = nurbs::periodic_uniform(degree, points);
      EXPECT_EQ(nurbs::fault_in(open), "");
      EXPECT_EQ(nurbs::fault_in(round), "");
      EXPECT_EQ(open.points(), points);
      EXPECT_EQ(round.points(), points);
      EXPECT_EQ(round.functions(), points + degree);
      EXPECT_EQ(round.extent(), 1.0);
    }
  EXPECT_REFUSED(nurbs::clamped_uniform(3, 3), "at least 4 control points expected for degree 3, got 3");
  EXPECT_REFUSED(nurbs::periodic_uniform(3, 3), "at least 4 control points expected for degree 3, got 3");
  EXPECT_REFUSED(nurbs::clamped(2, 0, {0.6, 0.4}, 1), "lies below");
}

TEST(NurbsKnots, SpansHoldTheirParameterAndHaveALength) {  // [PT97 A2.1]
  EXPECT_EQ(nurbs::span_of(kBook, 2.5), 4);
  EXPECT_EQ(nurbs::span_of(kBook, -1.0), 2) << "outside: the nearest";
  EXPECT_EQ(nurbs::span_of(kBook, 9.0), 7);
  core::Random random(1);
  for (int degree = 1; degree <= 5; ++degree)
    for (bool periodic : {false, true}) {
      const Knots k = nurbs::random_knots(random, degree, periodic);
      for (double u : nurbs::over(k, 997)) {
        const int s = nurbs::span_of(k, u);
        ASSERT_LT(k.values[s], k.values[s + 1]);
        ASSERT_LE(k.values[s], u);
        ASSERT_TRUE(u < k.values[s + 1] || u == k.end()) << u;
        ASSERT_GE(s, degree);
        ASSERT_LT(s, k.functions());
      }
      for (double u : k.values)  // on knots: the span that begins there
        if (u >= k.start() && u < k.end()) {
          ASSERT_EQ(k.values[nurbs::span_of(k, u)], u);
        }
    }
}

TEST(NurbsKnots, ParametersOutsideAreClampedOrWrapped) {
  const Knots open = nurbs::clamped_uniform(2, 5), round = nurbs::periodic(2, {0.5, 1, 2, 2.5}, 3);
  EXPECT_EQ(nurbs::into_domain(open, -1), 0);
  EXPECT_EQ(nurbs::into_domain(open, 7), 1);
  EXPECT_EQ(nurbs::into_domain(round, 3.5), 0.5);
  EXPECT_EQ(nurbs::into_domain(round, 0.25), 3.25);
  EXPECT_EQ(nurbs::into_domain(round, -6.0), 3.0);
  const double below = std::nextafter(0.5, 0.0);  // a whole turn more would be rounded to the end
  EXPECT_GE(nurbs::into_domain(round, below), round.start());
  EXPECT_LT(nurbs::into_domain(round, below), round.end());
}

TEST(NurbsKnots, MultiplicityDistinctAndGrevilleAreThoseOfTheBook) {
  EXPECT_EQ(nurbs::multiplicity(kBook, 4.0), 2);
  EXPECT_EQ(nurbs::multiplicity(kBook, 0.0), 3);
  EXPECT_EQ(nurbs::multiplicity(kBook, 2.5), 0);
  const auto different = nurbs::distinct(kBook);
  ASSERT_EQ(different.size(), 6u);
  EXPECT_EQ(different[4].value, 4.0);
  EXPECT_EQ(different[4].multiplicity, 2);
  EXPECT_EQ(nurbs::greville(kBook), (std::vector<double>{0, 0.5, 1.5, 2.5, 3.5, 4, 4.5, 5}));
  const Knots round = nurbs::periodic(2, {0, 0, 1, 2}, 3);
  EXPECT_EQ(nurbs::multiplicity(round, 0.0), 2);
  EXPECT_EQ(nurbs::multiplicity(round, 3.0), 2) << "its end is its start";
  EXPECT_EQ(nurbs::distinct(round).size(), 3u);
  EXPECT_EQ(nurbs::breaks(round), (std::vector<double>{0, 1, 2, 3}));
}

TEST(NurbsKnots, LineWithGrevillePointsRunsAtEvenSpeed) {  // what Greville abscissae are
  core::Random random(2);
  for (int degree = 1; degree <= 5; ++degree) {
    nurbs::Curve curve{nurbs::random_knots(random, degree, false), {}, {}};
    for (double g : nurbs::greville(curve.knots)) curve.points.push_back({g, 0, 0});
    for (double u : nurbs::over(curve.knots, 50)) ASSERT_NEAR(nurbs::point(curve, u).x, u, 1e-13);
  }
}

TEST(NurbsKnots, OtherDomainKeepsTheSpansProportions) {
  core::Random random(3);
  for (bool periodic : {false, true}) {
    const Knots k = nurbs::random_knots(random, 3, periodic), moved = nurbs::on_domain(k, -2, 8);
    EXPECT_EQ(moved.start(), -2);
    EXPECT_EQ(moved.end(), 8);
    for (std::size_t i = 0; i < k.values.size(); ++i)
      EXPECT_NEAR((moved.values[i] + 2) / 10, (k.values[i] - k.start()) / k.extent(), 1e-14);
  }
  EXPECT_REFUSED(nurbs::on_domain(kBook, 1, 1), "domain");
}

TEST(NurbsBasis, ValuesAreThoseOfTheBooksExample) {  // [PT97 A2.2] example 2.3
  nurbs::BasisRow n{};
  nurbs::basis_values(kBook, 4, 2.5, n);
  EXPECT_DOUBLE_EQ(n[0], 1.0 / 8);
  EXPECT_DOUBLE_EQ(n[1], 6.0 / 8);
  EXPECT_DOUBLE_EQ(n[2], 1.0 / 8);
}

TEST(NurbsBasis, DerivativesAreThoseOfTheBooksExample) {  // [PT97 A2.3] [PT97 eq.2.10] example 2.4
  nurbs::BasisRow n[3];
  nurbs::basis_derivatives(kBook, 4, 2.5, 2, n);
  EXPECT_DOUBLE_EQ(n[1][0], -0.5);
  EXPECT_DOUBLE_EQ(n[1][1], 0.0);
  EXPECT_DOUBLE_EQ(n[1][2], 0.5);
  EXPECT_DOUBLE_EQ(n[2][0], 1.0);
  EXPECT_DOUBLE_EQ(n[2][1], -2.0);
  EXPECT_DOUBLE_EQ(n[2][2], 1.0);
}

TEST(NurbsBasis, FunctionsSumToOneAreNowhereNegativeAndDerivativesSumToNothing) {
  core::Random random(4);
  for (int degree = 1; degree <= nurbs::kHighestDegree; ++degree)
    for (bool periodic : {false, true}) {
      const Knots k = nurbs::random_knots(random, degree, periodic);
      for (double u : nurbs::over(k, 101)) {
        const double inside = nurbs::into_domain(k, u);
        nurbs::BasisRow n[4];
        nurbs::basis_derivatives(k, nurbs::span_of(k, inside), inside, 3, n);
        double sum[4] = {}, size[4] = {};
        for (int d = 0; d < 4; ++d)
          for (int i = 0; i <= degree; ++i) sum[d] += n[d][i], size[d] += std::fabs(n[d][i]);
        for (int i = 0; i <= degree; ++i) ASSERT_GE(n[0][i], 0.0);
        ASSERT_NEAR(sum[0], 1.0, 1e-13) << degree << ' ' << u;
        for (int d = 1; d < 4; ++d)
          ASSERT_LE(std::fabs(sum[d]), 1e-12 * (1 + size[d])) << degree << ' ' << u << ' ' << d;
      }
    }
}

// Two routes to one number: all functions of a span at once, and each function alone.
TEST(NurbsBasis, EachFunctionAloneIsTheSameAndVanishesOutsideItsSupport) {  // [PT97 A2.4]
  core::Random random(5);
  for (int degree = 1; degree <= 6; ++degree) {
    const Knots k = nurbs::random_knots(random, degree, false);
    for (double u : nurbs::over(k, 211)) {
      const nurbs::Basis2 all = nurbs::basis_at(k, u, 0);
      for (int i = 0; i < k.functions(); ++i) {
        const bool alive = i >= all.first && i <= all.first + degree;
        const double alone = nurbs::basis_function(k, i, u);
        ASSERT_NEAR(alone, alive ? all.value[0][i - all.first] : 0.0, 1e-14) << degree << ' ' << u << ' ' << i;
      }
    }
  }
}

TEST(NurbsBasis, DerivativesOfEveryOrderMatchDifferencesOfTheOneBelow) {
  core::Random random(6);
  const double h = 1e-5;
  for (int degree = 1; degree <= 6; ++degree)
    for (bool periodic : {false, true}) {
      const Knots k = nurbs::random_knots(random, degree, periodic);
      for (double u = k.start() + 0.0123; u < k.end() - 0.01; u += 0.0517) {
        const int span = nurbs::span_of(k, u);
        if (u - h < k.values[span] || u + h > k.values[span + 1]) continue;
        nurbs::BasisRow at[8], before[8], after[8];
        nurbs::basis_derivatives(k, span, u, 7, at);
        nurbs::basis_derivatives(k, span, u - h, 7, before);
        nurbs::basis_derivatives(k, span, u + h, 7, after);
        for (int d = 1; d <= 7; ++d)
          for (int i = 0; i <= degree; ++i) {
            const double difference = (after[d - 1][i] - before[d - 1][i]) / (2 * h);
            double size = 1.0;
            for (int j = 0; j <= degree; ++j) size = std::max({size, std::fabs(at[d][j]), std::fabs(at[d - 1][j])});
            ASSERT_NEAR(at[d][i], difference, 1e-6 * size) << degree << ' ' << d << ' ' << u;
          }
        for (int d = degree + 1; d <= 7; ++d)
          for (int i = 0; i <= degree; ++i) ASSERT_EQ(at[d][i], 0.0);
      }
    }
}

TEST(NurbsBasis, ANumberThatIsNoneGoesThroughWithoutHarm) {
  for (bool periodic : {false, true}) {
    const Knots k = periodic ? nurbs::periodic_uniform(3, 6) : nurbs::clamped_uniform(3, 6);
    for (double u : {kNan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
      const nurbs::Basis2 basis = nurbs::basis_at(k, u);
      EXPECT_GE(basis.first, 0);
      EXPECT_LE(basis.first + 3, k.functions() - 1);
    }
  }
}
