// A stitch as it is shown: on seeds on which the needle once was thrown off the pad, or the thread parted at its swage.
#include "basics.hpp"

namespace trocar::training::basics {
namespace {

constexpr const char* kStitch = "../suturing/needle-through";

TEST(NeedleThrough, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 2, 3, 6, 7}) expect_passes(kStitch, seed, {});
}

TEST(NeedleThrough, TheDemonstrationPassesWithATremor) {
  for (const std::uint64_t seed : {0, 3}) expect_passes(kStitch, seed);
}

}  // namespace
}  // namespace trocar::training::basics
