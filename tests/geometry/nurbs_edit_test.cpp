#include <limits>

#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Curve;

namespace {

constexpr double kSame = 1e-12;

// How far two curves' control points and weights are apart; infinite where there is not the same number of them.
double control_apart(const Curve& a, const Curve& b) {
  if (a.points.size() != b.points.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (int i = 0; i < static_cast<int>(a.points.size()); ++i)
    worst = std::max({worst, length(a.points[i] - b.points[i]), std::fabs(a.weight(i) - b.weight(i))});
  return worst;
}

}  // namespace

TEST(NurbsInsertion, LeavesTheShapeWhereverAndHoweverOftenTheKnotIs) {  // [PT97 A5.1]
  nurbs::each_curve(21, 1, 6, [](const Curve& curve) {
    const int degree = curve.knots.degree;
    for (double u : {1.0, 1.03, 1.5, 2.2, 3.1, 3.9, 4.0, 4.4}) {
      if (!curve.knots.periodic && u > 4.0) continue;
      for (int times = 1; times <= degree; ++times) {
        const Curve finer = nurbs::inserted(curve, u, times);
        ASSERT_EQ(nurbs::fault_in(finer), "");
        ASSERT_LT(nurbs::apart(curve, finer), kSame) << u << " x " << times;
        const bool end = !curve.knots.periodic && (u == 1.0 || u == 4.0);
        const int before = nurbs::multiplicity(curve.knots, u), grown = std::min(times, degree - before);
        ASSERT_EQ(finer.knots.points(), curve.knots.points() + (end ? 0 : grown)) << u << " x " << times;
      }
    }
    for (const nurbs::Knot& knot : nurbs::distinct(curve.knots)) {
      const Curve full = nurbs::inserted(curve, knot.value, degree);
      ASSERT_LT(nurbs::apart(curve, full), kSame) << knot.value;
    }
  });
}

TEST(NurbsInsertion, OfTheBooksExampleGivesItsControlPoints) {  // [PT97 A5.1] example 5.1: a cubic, u = 5/2
  Curve curve{{3, false, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}}, {}, {}};
  for (int i = 0; i < 8; ++i) curve.points.push_back({double(i * i), double(i), 0});
  const Curve finer = nurbs::inserted(curve, 2.5);
  const auto mix = [&](int i, double a) { return a * curve.points[i] + (1 - a) * curve.points[i - 1]; };
  EXPECT_LT(length(finer.points[3] - mix(3, 5.0 / 6)), 1e-14);
  EXPECT_LT(length(finer.points[4] - mix(4, 1.0 / 2)), 1e-14);
  EXPECT_LT(length(finer.points[5] - mix(5, 1.0 / 6)), 1e-14);
  for (int i = 0; i <= 2; ++i) EXPECT_EQ(finer.points[i], curve.points[i]);
  for (int i = 6; i <= 8; ++i) EXPECT_EQ(finer.points[i], curve.points[i - 1]);
}

TEST(NurbsInsertion, ParametersThatAreAKnotButForRoundingAreThatKnot) {
  core::Random random(22);
  const Curve curve = nurbs::random_curve(random, 3, false, false);
  const double knot = nurbs::distinct(curve.knots)[1].value;
  const Curve finer = nurbs::inserted(curve, knot * (1 + 1e-15));
  EXPECT_EQ(nurbs::multiplicity(finer.knots, knot), 2);
}

TEST(NurbsRefinement, LeavesTheShape) {  // [PT97 A5.4]
  nurbs::each_curve(23, 1, 5, [](const Curve& curve) {
    const Curve finer = nurbs::refined(curve, {1.1, 1.9, 1.9, 2.345, 3.3, 3.3, 3.3});
    ASSERT_EQ(nurbs::fault_in(finer), "");
    ASSERT_LT(nurbs::apart(curve, finer), kSame);
  });
}

TEST(NurbsRefinement, BringsTheControlPolygonToTheCurve) {
  core::Random random(24);
  Curve curve = nurbs::random_curve(random, 3, true, false);
  double last = 0.0;
  for (int round = 0; round < 5; ++round) {
    std::vector<double> middles;
    const auto ends = nurbs::breaks(curve.knots);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) middles.push_back(0.5 * (ends[i] + ends[i + 1]));
    curve = nurbs::refined(curve, middles);
    double worst = 0.0;
    const auto greville = nurbs::greville(curve.knots);
    for (std::size_t i = 0; i < greville.size(); ++i)
      worst = std::max(worst, length(curve.points[i] - nurbs::point(curve, greville[i])));
    if (round == 4) {
      EXPECT_NEAR(last / worst, 4, 0.3) << "with the square of the spans";
    }
    last = worst;
  }
}

TEST(NurbsRemoval, UndoesInsertion) {  // [PT97 A5.8]
  nurbs::each_curve(25, 1, 6, [](const Curve& curve) {
    for (double u : {1.03, 1.5, 2.2, 3.1, 3.9}) {
      for (int times = 1; times <= std::min(3, curve.knots.degree); ++times) {
        std::optional<Curve> back = nurbs::inserted(curve, u, times);
        for (int k = 0; k < times; ++k) {
          back = nurbs::without_knot(*back, u, 1e-9);
          ASSERT_TRUE(back) << u << ' ' << k;
        }
        ASSERT_TRUE(back->knots == curve.knots);
        ASSERT_LT(control_apart(*back, curve), 1e-11) << u << " x " << times;
      }
    }
  });
}

TEST(NurbsRemoval, RefusesWhatWouldMoveTheCurve) {
  nurbs::each_curve(26, 2, 4, [](const Curve& curve) {
    const double u = nurbs::distinct(curve.knots)[2].value;
    EXPECT_FALSE(nurbs::without_knot(curve, u, 1e-6));
    EXPECT_FALSE(nurbs::without_knot(curve, 2.34567, 1.0)) << "no knot there";
    EXPECT_FALSE(nurbs::without_knot(curve, curve.knots.start(), 1e9)) << "the start stays";
    EXPECT_FALSE(nurbs::without_knot(curve, curve.knots.end(), 1e9));
  });
  const Curve least{nurbs::periodic_uniform(3, 4), {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}};
  EXPECT_FALSE(nurbs::without_knot(least, 0.5, 1e9)) << "fewer control points do not close";
}

TEST(NurbsRemoval, MovesTheCurveByNoMoreThanItsTolerance) {  // [PT97 eq.5.30]
  int gone = 0;
  nurbs::each_curve(27, 3, 4, [&gone](const Curve& curve) {
    Curve finer = nurbs::inserted(curve, 2.5);
    core::Random random(28);
    for (Vec3d& p : finer.points) p += 2e-4 * nurbs::random_place(random);
    for (double tolerance : {1e-5, 1e-4, 1e-3, 1e-2}) {
      const auto fewer = nurbs::without_knot(finer, 2.5, tolerance);
      if (!fewer) continue;
      ++gone;
      EXPECT_LE(nurbs::apart(finer, *fewer, 1001), tolerance);
      EXPECT_EQ(fewer->points.size(), curve.points.size());
    }
  });
  EXPECT_GT(gone, 6);
}

TEST(NurbsRemoval, NeedlessKnotsGoAndOthersStay) {
  nurbs::each_curve(29, 2, 4, [](const Curve& curve) {
    const Curve finer = nurbs::refined(curve, {1.05, 1.6, 1.6, 2.71, 3.83});
    const Curve slim = nurbs::without_needless_knots(finer, 1e-9);
    EXPECT_EQ(slim.points.size(), curve.points.size());
    EXPECT_LT(nurbs::apart(curve, slim), 1e-9);
  });
}

TEST(NurbsElevation, LeavesTheShapeAndRaisesEveryKnotsMultiplicity) {  // [PT97 A5.9]
  nurbs::each_curve(30, 1, 6, [](const Curve& curve) {
    for (int times = 1; times <= 3; ++times) {
      const Curve higher = nurbs::elevated(curve, times);
      ASSERT_EQ(nurbs::fault_in(higher), "");
      ASSERT_EQ(higher.knots.degree, curve.knots.degree + times);
      ASSERT_LT(nurbs::apart(curve, higher), kSame) << times;
      const auto before = nurbs::distinct(curve.knots), after = nurbs::distinct(higher.knots);
      ASSERT_EQ(before.size(), after.size());
      for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(after[i].multiplicity, before[i].multiplicity + times);
    }
  });
  core::Random random(31);
  EXPECT_REFUSED(nurbs::elevated(nurbs::random_curve(random, 8, false, false), 2),
                 "degree 10 asked for, 9 is the highest");
}

TEST(NurbsElevation, OfALineIsALineWithEvenControlPoints) {
  const Curve line = nurbs::elevated(nurbs::line({0, 0, 0}, {3, 6, 9}), 2);
  ASSERT_EQ(line.points.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_LT(length(line.points[i] - double(i) * Vec3d{1, 2, 3}), 1e-14);
}

TEST(NurbsReduction, UndoesElevationAndRefusesWhatWouldMoveTheCurve) {  // [PT97 A5.11]
  nurbs::each_curve(32, 1, 4, [](const Curve& curve) {
    const auto back = nurbs::reduced(nurbs::elevated(curve), 1e-9);
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->knots == curve.knots);
    EXPECT_LT(control_apart(*back, curve), 1e-10);
    if (curve.knots.degree > 1) {
      EXPECT_FALSE(nurbs::reduced(curve, 1e-6));
    }
  });
  EXPECT_FALSE(nurbs::reduced(nurbs::line({0, 0, 0}, {1, 0, 0}), 1e9)) << "nothing is below degree 1";
}

TEST(NurbsReduction, TakesSimpleKnotsWhereTheyAreNeedless) {
  // A parabola as a cubic, with a knot put in that nothing needs.
  const Curve parabola{nurbs::clamped_uniform(2, 3), {{0, 0, 0}, {0.5, 1, 0}, {1, 0, 0}}, {}};
  const auto back = nurbs::reduced(nurbs::inserted(nurbs::elevated(parabola), 0.3), 1e-9);
  ASSERT_TRUE(back);
  EXPECT_LT(control_apart(*back, parabola), 1e-12);
}

TEST(NurbsParts, SplitHalvesAreTheCurve) {
  core::Random random(33);
  for (int degree = 1; degree <= 5; ++degree) {
    const Curve curve = nurbs::random_curve(random, degree, false, true);
    for (double u : {1.2, nurbs::distinct(curve.knots)[3].value, 3.7}) {
      const auto [front, back] = nurbs::split(curve, u);
      EXPECT_EQ(front.knots.start(), 1.0);
      EXPECT_EQ(back.knots.end(), 4.0);
      for (double t : nurbs::over(front.knots, 40))
        ASSERT_LT(length(nurbs::point(front, t) - nurbs::point(curve, t)), kSame) << degree << ' ' << u << ' ' << t;
      for (double t : nurbs::over(back.knots, 40))
        ASSERT_LT(length(nurbs::point(back, t) - nurbs::point(curve, t)), kSame) << degree << ' ' << u << ' ' << t;
      Curve scaled = back;  // the same curve
      for (double& w : scaled.weights) w *= 3;
      EXPECT_LT(nurbs::apart(nurbs::joined(front, back), curve), kSame);
      EXPECT_LT(nurbs::apart(nurbs::joined(front, scaled), curve), kSame);
    }
  }
  const Curve ring = nurbs::circle({}, {0, 0, 1}, 1);
  EXPECT_REFUSED(nurbs::split(ring, 0.5), "open it first");
  EXPECT_REFUSED(nurbs::split(nurbs::line({}, {1, 0, 0}), 1.0), "inside of the domain");
  EXPECT_REFUSED(nurbs::joined(nurbs::line({}, {1, 0, 0}), nurbs::line({2, 0, 0}, {3, 0, 0})), "does not start where");
}

TEST(NurbsParts, OpenedAnywhereAPeriodicCurveIsTheSame) {
  nurbs::each_curve(34, 1, 5, [](const Curve& curve) {
    if (!curve.knots.periodic) return;
    for (double u : {curve.knots.start(), 1.7, 3.3, nurbs::distinct(curve.knots)[2].value}) {
      const Curve open = nurbs::opened(curve, u);
      ASSERT_EQ(nurbs::fault_in(open), "");
      EXPECT_EQ(open.knots.start(), u);
      EXPECT_LT(nurbs::apart(open, curve), kSame) << u;
      EXPECT_LT(length(open.points.front() - open.points.back()), 1e-14);
    }
    const Curve seam = nurbs::part(curve, 4.0, 5.25);  // across its end at 4.5
    for (double t : nurbs::over(seam.knots, 30))
      ASSERT_LT(length(nurbs::point(seam, t) - nurbs::point(curve, t)), kSame);
  });
}

TEST(NurbsParts, ReversedRunsThroughTheSameBackwards) {
  nurbs::each_curve(35, 1, 5, [](const Curve& curve) {
    const Curve back = nurbs::reversed(curve);
    ASSERT_EQ(nurbs::fault_in(back), "");
    for (double u : nurbs::over(curve.knots, 53)) {
      const double mirrored = curve.knots.start() + curve.knots.end() - u;
      ASSERT_LT(length(nurbs::point(back, mirrored) - nurbs::point(curve, u)), kSame) << u;
    }
    EXPECT_LT(control_apart(nurbs::reversed(back), curve), 1e-14);
  });
}

TEST(NurbsParts, OnAnotherDomainAndMovedItIsTheSameShape) {
  nurbs::each_curve(36, 3, 3, [](const Curve& curve) {
    const Curve moved = nurbs::moved(nurbs::on_domain(curve, 0, 1), {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {1, 2, 3});
    for (double t : nurbs::over(moved.knots, 20)) {
      const Vec3d p = nurbs::point(curve, curve.knots.start() + t * curve.knots.extent());
      ASSERT_LT(length(nurbs::point(moved, t) - (Vec3d{-p.y, p.x, p.z} + Vec3d{1, 2, 3})), kSame);
    }
  });
}
