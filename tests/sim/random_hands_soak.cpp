// Hands at random in every shipped scene, twice five simulated minutes. Numbers stay finite, the fluids' account is
// exact, no organ or membrane is deeper than 2 mm in itself, and none than 1 mm in another one for longer than 50 ms.
// A test that was stopped resumes from its last keyframe. TROCAR_HANDS_SECONDS does less of it.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "random_hands.hpp"
#include "shipped.hpp"

using namespace trocar;

namespace {

constexpr std::uint64_t kKept = 20'000;  // [ticks] between two keyframes

std::uint64_t ticks() {
  const char* seconds = std::getenv("TROCAR_HANDS_SECONDS");
  return seconds ? std::uint64_t(1000 * std::atof(seconds)) : 300'000;
}

class RandomHandsSoak : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(RandomHandsSoak, LeaveBodiesOutsideOfEachOtherAndOfThemselves) {
  const auto& [scene, seed] = GetParam();
  RandomHands hands(shipped(scene), std::uint64_t(seed));
  const std::string file = TROCAR_BINARY_DIR "/random_hands/" + scene + "_" + std::to_string(seed) + ".keyframe";
  // Another program may do another thing with the same State.
  const bool fits = std::filesystem::exists(file) &&
                    std::filesystem::last_write_time(file) > std::filesystem::last_write_time("/proc/self/exe");
  if (fits && hands.resume(file)) std::printf("    resumed at tick %llu\n", (unsigned long long)hands.ticks());
  while (hands.ticks() < ticks()) {
    const std::uint64_t before = hands.ticks();
    hands.run(int(std::min(kKept, ticks() - before)));
    if (hands.ticks() == before) break;
    hands.keep(file);
  }
  std::printf("    %s, %d: %llu s, %d grasps, at most %.3f J, flags %x\n", scene.c_str(), seed,
              (unsigned long long)hands.ticks() / 1000, hands.grasps(), hands.most_energy(), hands.flags());
  for (const auto& [pair, worst] : hands.worst())
    std::printf("    %s - %s: deeper by %.2f mm at most, in %d looks\n", pair.first.c_str(), pair.second.c_str(),
                1e3 * worst.depth, worst.looks);
  EXPECT_EQ(hands.findings(), "");
  std::filesystem::remove(file);
}
INSTANTIATE_TEST_SUITE_P(Scenes, RandomHandsSoak,
                         testing::Combine(testing::ValuesIn(shipped_scenes()), testing::Values(1, 2)),
                         [](const auto& p) {
                           return std::get<0>(p.param) + "_" + std::to_string(std::get<1>(p.param));
                         });

}  // namespace
