// The short form of a thousand cuts.
#include "cut_campaign.hpp"

namespace trocar::tissue::campaign {
namespace {

class ManyCuts : public testing::TestWithParam<Campaign> {};

TEST_P(ManyCuts, LeaveAClosedSurfaceBookedVolumeAndMassAndABodyThatLives) { run(GetParam(), 200); }

INSTANTIATE_TEST_SUITE_P(Bodies, ManyCuts, testing::ValuesIn(kCampaigns),
                         [](const auto& body) { return body.param.name; });

}  // namespace
}  // namespace trocar::tissue::campaign
