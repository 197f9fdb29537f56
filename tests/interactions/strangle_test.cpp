// What a loop of thread does to a strand that it lies around: the laws alone.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_strangle.hpp>

using namespace trocar::interactions;

namespace {

constexpr double kYoungs = 150e3, kRadius = 0.004, kLumen = 0.002;  // [Pa], [m]

}  // namespace

TEST(Strangle, PushesBackWithTheModulusWhereItIsHardlySunkIn) {
  const StrangleLaw law = strangle_law(kYoungs, kRadius, kLumen, 1e-6);
  EXPECT_NEAR(law.force, kYoungs * 1e-6, 1e-4);
  EXPECT_NEAR(law.slope, kYoungs, 1e-3 * kYoungs);
}

TEST(Strangle, TakesOneAndAHalfNewtonsToDrawTheFoamTubeToItsWall) {
  const double inner = kRadius - kLumen;
  const double tension = strangle_law(kYoungs, kRadius, kLumen, kRadius - inner).force * inner;
  EXPECT_NEAR(tension, 1.457, 0.01);
}

TEST(Strangle, GoesOnPushingHarderWhereNothingIsLeftToGive) {
  const StrangleLaw crushed = strangle_law(kYoungs, kRadius, kLumen, 0.9 * kRadius);
  const StrangleLaw deeper = strangle_law(kYoungs, kRadius, kLumen, 1.1 * kRadius);
  EXPECT_GT(deeper.force, crushed.force);
  EXPECT_GT(crushed.force * 0.0006, 8.0);  // what cuts through, at the thinnest loop
}

TEST(Strangle, ClosesALumenAtTheThicknessOfTheWall) {
  EXPECT_EQ(cover_of_loop(kRadius, kLumen, kRadius - kLumen), 1);
  EXPECT_NEAR(cover_of_loop(kRadius, kLumen, 0.003), 0.5, 1e-12);
  EXPECT_EQ(cover_of_loop(kRadius, kLumen, kRadius), 0);
  EXPECT_EQ(cover_of_loop(kRadius, 0, 0.001), 0);
}

TEST(Strangle, SlopesMoreThanThreadRubsTwoMillimetresFromAnEndAndLessAtSix) {
  constexpr double kRubs = 0.1;  // of a monofilament on tissue
  EXPECT_GT(slope_to_end(kRadius, 0.002, 0.002), kRubs);
  EXPECT_LT(slope_to_end(kRadius, 0.002, 0.006), kRubs);
}
