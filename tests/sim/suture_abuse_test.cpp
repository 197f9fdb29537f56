// Six seconds of hands that take, drag, drive, drop and cut needle and thread at random.
#include "suture_abuse.hpp"

#include <gtest/gtest.h>

#include "shipped.hpp"

namespace trocar {
namespace {

TEST(SutureAbuse, SixSecondsLeaveNumbersFiniteAndThreadOutOfSteelAndOrgans) {
  SutureAbuse abuse(shipped("box_suture"), 3);
  while (abuse.ticks() < 6000) abuse.tick();
  EXPECT_EQ(abuse.bad_tick, 0u) << "flags " << abuse.flags;
  EXPECT_EQ(abuse.lost, "");
  EXPECT_LE(abuse.most_in_steel, SutureAbuse::kLong);
  EXPECT_LE(abuse.most_in_organ, SutureAbuse::kLong);
  EXPECT_GT(abuse.takes, 0) << "hands that never hold anything prove nothing";
}

}  // namespace
}  // namespace trocar
