// Ten minutes of hands that take, drag, drive, drop and cut needle and thread at random: twenty times half a minute, as
// a thread that is cut to pieces is no trial any more.
#include <cstdio>

#include <gtest/gtest.h>

#include "shipped.hpp"
#include "suture_abuse.hpp"

namespace trocar {
namespace {

class SutureAbuseSoak : public testing::TestWithParam<int> {};
TEST_P(SutureAbuseSoak, HalfAMinuteLeavesNumbersFiniteAndThreadOutOfSteelAndOrgans) {
  SutureAbuse abuse(shipped("box_suture"), std::uint64_t(GetParam()));
  while (abuse.ticks() < 30'000) abuse.tick();
  std::printf(
      "seed %2d: %2d takes, %d of needles (at the trocar %d times), %d cuts, %d bites; %.1f N; in steel %d ms, in "
      "organs %d ms\n",
      GetParam(), abuse.takes, abuse.needle_takes, abuse.drawn_out, abuse.cuts, abuse.bites, abuse.most_force,
      abuse.most_in_steel, abuse.most_in_organ);
  ASSERT_EQ(abuse.bad_tick, 0u) << "flags " << abuse.flags;
  EXPECT_EQ(abuse.lost, "");
  EXPECT_GT(abuse.takes, 0) << "hands that never hold anything prove nothing";
  EXPECT_LE(abuse.most_in_steel, SutureAbuse::kLong);
  EXPECT_LE(abuse.most_in_organ, SutureAbuse::kLong);
}
INSTANTIATE_TEST_SUITE_P(Seeds, SutureAbuseSoak, testing::Range(1, 21));

}  // namespace
}  // namespace trocar
