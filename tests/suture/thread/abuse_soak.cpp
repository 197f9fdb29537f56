// K14, the long one.
#include <gtest/gtest.h>

#include "abuse.hpp"

using namespace trocar::suture::test;

TEST(ThreadAbuseSoak, HundredThousandJerksPullNoThreadThroughThread) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    expect_no_crossing("PDS", 10000, seed);
    expect_no_crossing("silk", 10000, 100 + seed);
  }
}
