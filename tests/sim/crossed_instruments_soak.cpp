// Instruments that cross each other in every shipped scene.
#include "crossed_instruments.hpp"
#include "shipped.hpp"

using namespace trocar;

namespace {

class CrossedInstrumentsSoak : public testing::TestWithParam<std::string> {};

TEST_P(CrossedInstrumentsSoak, OfAShippedSceneAreNeverDeeperThan1mmForLongerThan50ms) {
  expect_apart(shipped(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Scenes, CrossedInstrumentsSoak, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
