// A stitch and a throw on it as they are shown: the stitch on seeds on which the needle once was thrown off the pad, or
// the thread parted at its swage.
#include <trocar/training/observe/stitches.hpp>

#include "basics.hpp"

namespace trocar::training::basics {
namespace {

constexpr const char* kStitch = "../suturing/needle-through";
constexpr const char* kKnot = "../suturing/double-throw";
constexpr std::uint64_t kTied = 0;

TEST(NeedleThrough, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 2, 3, 6, 7}) expect_passes(kStitch, seed, {});
}

TEST(NeedleThrough, TheDemonstrationPassesWithATremor) {
  for (const std::uint64_t seed : {0, 3}) expect_passes(kStitch, seed);
}

TEST(DoubleThrow, TheDemonstrationLaysItOnTheSlit) {
  Lesson lesson(kKnot, kTied);
  const Performed tied(lesson, "", {}, {});
  EXPECT_FALSE(tied.gave_up) << tied.difficulties;
  EXPECT_TRUE(tied.monitor.score().passed) << tied.monitor.score().total;
  const suture::KnotReading knot = knot_of(lesson.model, tied.state);
  ASSERT_EQ(knot.count, 1);
  EXPECT_EQ(knot.throws[0].turns, 2);
  EXPECT_LT(knot_above_tissue(lesson.model, tied.state, knot), 0.005);
}

}  // namespace
}  // namespace trocar::training::basics
