// A thousand cuts in a row.
#include "cut_campaign.hpp"

namespace trocar::tissue::campaign {
namespace {

class ThousandCuts : public testing::TestWithParam<Campaign> {};

TEST_P(ThousandCuts, LeaveAClosedSurfaceBookedVolumeAndMassAndABodyThatLives) { run(GetParam(), 1000); }

INSTANTIATE_TEST_SUITE_P(Bodies, ThousandCuts, testing::ValuesIn(kCampaigns),
                         [](const auto& body) { return body.param.name; });

}  // namespace
}  // namespace trocar::tissue::campaign
