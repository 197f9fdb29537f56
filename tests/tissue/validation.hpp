// How a validation test speaks: every figure it measures is printed and recorded beside the tolerance it is held to, in
// double and in float, and so is the order in which errors fall as steps or cells shrink. docs/science/validation.md is
// the collection of these lines.
//
//   expect_within("row 1, discrete law", precision<double>(), worst / x0, 1e-9);
//   expect_order("row 1, period", precision<double>(), {0.0037, 0.00094, 0.00023}, 2, 0.1);
#pragma once

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace trocar::tissue::test {

inline constexpr double kPi = std::numbers::pi;

template <class Real>
const char* precision() {
  return std::is_same_v<Real, double> ? "f64" : "f32";
}

inline void record(const std::string& what, const char* format, double a, double b) {
  char text[80];
  std::snprintf(text, sizeof text, format, a, b);
  testing::Test::RecordProperty(what, text);
  std::printf("    %-66s %s\n", what.c_str(), text);
}

/// Prints and records how far a result is off, and holds it to the tolerance.
inline void expect_within(const std::string& what, const std::string& real, double off, double tolerance) {
  record(what + ", " + real, "%.2e (allowed %.2g)", std::fabs(off), tolerance);
  EXPECT_LE(std::fabs(off), tolerance) << what << ", " << real;
}

/// For errors each of which belongs to half the step or cell of the one before: prints and records them, and holds the
/// order between the last two to `order`, give or take `slack`.
inline void expect_order(const std::string& what, const std::string& real, const std::vector<double>& errors,
                         double order, double slack) {
  const std::size_t n = errors.size();
  ASSERT_GE(n, 2u);
  std::string all;
  for (const double e : errors) {
    char text[24];
    std::snprintf(text, sizeof text, "%.2e ", std::fabs(e));
    all += text;
  }
  const double measured = std::log2(std::fabs(errors[n - 2] / errors[n - 1]));
  record(what + ", " + real + ": " + all, "order %.2f (expected %.1f)", measured, order);
  EXPECT_NEAR(measured, order, slack) << what << ", " << real << ": " << all;
}

}  // namespace trocar::tissue::test
