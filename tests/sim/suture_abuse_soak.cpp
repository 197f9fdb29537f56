// Ten minutes of hands that take, drag, drive, drop and cut needle and thread at random.
#include <cstdio>

#include <gtest/gtest.h>

#include "shipped.hpp"
#include "suture_abuse.hpp"

namespace trocar {
namespace {

TEST(SutureAbuseSoak, TenMinutesLeaveNumbersFiniteAndThreadOutOfSteelAndOrgans) {
  int takes = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {  // a thread that is cut to pieces is no trial any more
    SutureAbuse abuse(shipped("box_suture"), seed);
    while (abuse.ticks() < 30'000) abuse.tick();
    std::printf(
        "seed %2d: %2d takes, %d of needles (at the trocar %d times), %d cuts, %d bites; %.1f N; in steel %d ms, in "
        "organs %d ms\n",
        int(seed), abuse.takes, abuse.needle_takes, abuse.drawn_out, abuse.cuts, abuse.bites, abuse.most_force,
        abuse.most_in_steel, abuse.most_in_organ);
    std::fflush(stdout);
    SCOPED_TRACE(seed);
    ASSERT_EQ(abuse.bad_tick, 0u) << "flags " << abuse.flags;
    EXPECT_EQ(abuse.lost, "");
    EXPECT_LE(abuse.most_in_steel, SutureAbuse::kLong);
    EXPECT_LE(abuse.most_in_organ, SutureAbuse::kLong);
    takes += abuse.takes;
  }
  EXPECT_GT(takes, 60) << "hands that never hold anything prove nothing";
}

}  // namespace
}  // namespace trocar
