// A figure against what it should be: printed, recorded in the test's XML, and held to a tolerance.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace trocar::fluids::test {

inline void expect_within(const std::string& what, double value, double wanted, double tolerance) {
  const double off = value / wanted - 1;
  std::printf("  %s: %+.3g %% (allowed %.3g %%)\n", what.c_str(), 100 * off, 100 * tolerance);
  ::testing::Test::RecordProperty(what, std::to_string(off));
  EXPECT_LE(std::fabs(off), tolerance) << what << ": " << value << ", wanted " << wanted;
}

}  // namespace trocar::fluids::test
