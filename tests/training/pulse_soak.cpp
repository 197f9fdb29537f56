// Pulse palpation performed: what beats, and how fast, is another in each of these patients.
#include "basics.hpp"

namespace trocar::training::basics {
namespace {

TEST(PulsePalpation, TheDemonstrationFindsAndCountsThePulseWhereverItIs) {
  for (const std::uint64_t seed : {0, 1, 3, 12}) expect_passes("pulse-palpation", seed);
}

}  // namespace
}  // namespace trocar::training::basics
