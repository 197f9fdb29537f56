// Splines to test with: random ones of every kind, and how to compare two of them.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry::nurbs {

inline Vec3d random_place(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

/// Clamped on 1 .. 4, with knots of every multiplicity up to the degree, or periodic with some doubled.
inline Knots random_knots(core::Random& random, int degree, bool periodic_) {
  std::vector<double> inside;
  double t = 1.0;
  for (int k = 0; k < 5; ++k) {
    t += random.uniform(0.1, 0.6);
    const int times = 1 + k % (periodic_ ? std::min(degree, 2) : degree);
    inside.insert(inside.end(), static_cast<std::size_t>(times), t);
  }
  if (!periodic_) return clamped(degree, 1.0, inside, 4.0);
  inside.insert(inside.begin(), 1.0);
  while (static_cast<int>(inside.size()) < degree + 1) inside.push_back(t += 0.1);
  return periodic(degree, inside, 3.5);
}

inline Curve random_curve(core::Random& random, int degree, bool periodic_, bool rational) {
  Curve curve{random_knots(random, degree, periodic_), {}, {}};
  for (int i = 0; i < curve.knots.points(); ++i) {
    curve.points.push_back(random_place(random) + Vec3d{0.5 * i, 0, 0});
    if (rational) curve.weights.push_back(random.uniform(0.4, 2.5));
  }
  require_valid(curve, "random_curve");
  return curve;
}

inline Surface random_surface(core::Random& random, int degree_u, int degree_v, bool periodic_u, bool periodic_v,
                              bool rational) {
  Surface s{random_knots(random, degree_u, periodic_u), random_knots(random, degree_v, periodic_v), {}, {}};
  for (int j = 0; j < s.v.points(); ++j)
    for (int i = 0; i < s.u.points(); ++i) {
      s.points.push_back(0.4 * random_place(random) + Vec3d{0.5 * i, 0.5 * j, 0});
      if (rational) s.weights.push_back(random.uniform(0.4, 2.5));
    }
  require_valid(s, "random_surface");
  return s;
}

/// `count` parameters over the domain, both ends among them.
inline std::vector<double> over(const Knots& knots, int count) {
  std::vector<double> result;
  for (int k = 0; k < count; ++k) result.push_back(knots.start() + knots.extent() * k / (count - 1));
  return result;
}

/// The farthest that two curves are apart at equal parameters.
inline double apart(const Curve& a, const Curve& b, int samples = 101) {
  double worst = 0.0;
  for (double u : over(a.knots, samples)) worst = std::max(worst, length(point(a, u) - point(b, u)));
  return worst;
}
inline double apart(const Surface& a, const Surface& b, int samples = 31) {
  double worst = 0.0;
  for (double v : over(a.v, samples))
    for (double u : over(a.u, samples)) worst = std::max(worst, length(point(a, u, v) - point(b, u, v)));
  return worst;
}

/// Every kind of curve once: calls act(curve) with a trace of which it is.
template <class Act>
void each_curve(std::uint64_t seed, int lowest_degree, int highest_degree, const Act& act) {
  core::Random random(seed);
  for (int degree = lowest_degree; degree <= highest_degree; ++degree)
    for (bool periodic_ : {false, true})
      for (bool rational : {false, true}) {
        SCOPED_TRACE(::testing::Message() << "degree " << degree << (periodic_ ? ", periodic" : ", clamped")
                                          << (rational ? ", rational" : ""));
        act(random_curve(random, degree, periodic_, rational));
      }
}

/// What an std::invalid_argument that `act` throws says; empty if it throws none.
template <class Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

}  // namespace trocar::geometry::nurbs

#define EXPECT_REFUSED(statement, words)                                                              \
  {                                                                                                   \
    const std::string told = trocar::geometry::nurbs::refusal([&] { (void)(statement); });            \
    EXPECT_NE(told.find(words), std::string::npos) << "got: '" << told << "', expected: " << (words); \
  }
