// Every figure that a test measures is printed and recorded beside what it is held to.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace trocar::suture::test {

inline void say(const std::string& what, double value, const std::string& beside) {
  char text[120];
  std::snprintf(text, sizeof text, "%.4g (%s)", value, beside.c_str());
  testing::Test::RecordProperty(what, text);
  std::printf("    %-66s %s\n", what.c_str(), text);
}
/// Measured over expected, held to 1 give or take `tolerance`.
inline void expect_ratio(const std::string& what, double measured, double expected, double tolerance) {
  char beside[80];
  std::snprintf(beside, sizeof beside, "%.5g of %.5g, allowed off 1 by %.2g", measured, expected, tolerance);
  say(what, measured / expected, beside);
  EXPECT_NEAR(measured / expected, 1, tolerance) << what;
}
inline void expect_between(const std::string& what, double value, double low, double high) {
  char beside[80];
  std::snprintf(beside, sizeof beside, "allowed %.3g to %.3g", low, high);
  say(what, value, beside);
  EXPECT_GE(value, low) << what;
  EXPECT_LE(value, high) << what;
}

}  // namespace trocar::suture::test
