#include <clocale>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/decimal.hpp>

namespace trocar::core {

TEST(Decimal, OnlyPlainNumbersAreNumbers) {
  for (const char* good : {"0", "-1", "+2.5", ".5", "5.", "1e9", "1E-9", "-0.0e+00", "007"})
    EXPECT_TRUE(is_decimal(good)) << good;
  for (const char* bad : {"", "-", ".", "e5", "1e", "1e+", "nan", "inf", "0x10", "1,5", " 1", "1 ", "1d3", "--1"})
    EXPECT_FALSE(is_decimal(bad)) << bad;
}

TEST(Decimal, IsTheNearestDoubleWhateverTheLocale) {
  if (!std::setlocale(LC_NUMERIC, "de_DE.UTF-8")) std::setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(to_double("0.1"), 0.1);
  EXPECT_EQ(to_double("-6.04122664795493e-16"), -6.04122664795493e-16);
  EXPECT_EQ(to_double("1" + std::string(100, '0') + "e-100"), 1.0);
  EXPECT_TRUE(std::isinf(to_double("1e999")));
  std::setlocale(LC_NUMERIC, "C");
}

TEST(Decimal, WholeNumbersReachBothEndsAndNoFarther) {
  EXPECT_EQ(to_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(to_integer("-9223372036854775808"), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(to_integer("+12"), 12);
  for (const char* bad :
       {"9223372036854775808", "-9223372036854775809", "99999999999999999999", "", "+", "1.0", "1e3", "a"})
    EXPECT_FALSE(to_integer(bad)) << bad;
}

}  // namespace trocar::core
