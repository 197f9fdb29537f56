// Another instrument through the same trocar: let go, draw back, change, go in again.
#include <gtest/gtest.h>

#include "small_scene.hpp"

namespace trocar::sim {
namespace {

using small::kApplier;
using small::kGrasper;
using small::kScissors;
using small::Table;

int rack_number(const Table& t, int hand, const char* instrument) {
  return t.model.hands[size_t(hand)].find(instrument);
}

void want(Table& t, int hand, const char* instrument) {
  t.input.tools[size_t(hand)].instrument = rack_number(t, hand, instrument);
}

TEST(Exchange, ARackHoldsWhatFitsTheTrocarThePlacedInstrumentFirst) {
  const Model& m = small::model();
  ASSERT_EQ(m.hands[kGrasper].rack.size(), 2u) << "the applier is too thick for 5 mm";
  EXPECT_EQ(m.hands[kGrasper].rack[0].name, "grasper");
  EXPECT_EQ(m.hands[kGrasper].rack[1].name, "scissors");
  ASSERT_EQ(m.hands[kApplier].rack.size(), 3u);
  EXPECT_EQ(m.hands[kApplier].rack[0].name, "clip_applier");
  EXPECT_EQ(m.hands[kGrasper].find("clip_applier"), -1);
}

TEST(Exchange, TheInstrumentIsChangedAtTheTrocarAndGoesInAgain) {
  Table t(small::model());
  t.steps(10);
  const double depth = t.tool(kGrasper).depth;
  want(t, kGrasper, "scissors");
  int changed_at = -1;
  for (int i = 0; i < 1000; ++i) {
    const double before = t.tool(kGrasper).depth;
    t.step();
    if (changed_at < 0 && t.tool(kGrasper).instrument == 1) {
      changed_at = i;
      EXPECT_LE(before, 0.0121) << "only in the sleeve";
    }
  }
  EXPECT_GT(changed_at, 50) << "drawing back takes time";
  EXPECT_EQ(t.count(Event::exchanged), 1);
  EXPECT_EQ(t.model.tool(t.state, kGrasper).name, "scissors");
  EXPECT_NEAR(t.tool(kGrasper).depth, depth, 1e-6) << "the hand's command holds again";
  EXPECT_EQ(t.flags & StepReport::kBadInput, 0u);
}

TEST(Exchange, HeldTissueIsLetGoBeforeTheInstrumentIsDrawnBack) {
  Table t(small::model());
  const interactions::StrandBody& tube = t.model.strand_bodies[small::kTube];
  const interactions::ToolModel& grasper = t.model.placed(kGrasper);
  const Vec3d at = interactions::point_at(tube, t.state.strands[small::kTube], interactions::place_at(tube, 0.056));
  t.carry(kGrasper, {0.055, 0, 0.04}, at + (grasper.jaw_length - 0.012) * normalised(at - grasper.port), 0.2);
  t.close_slowly(kGrasper, 0.95, 400);
  ASSERT_GT(t.tool(kGrasper).holds, 0);
  const double depth = t.tool(kGrasper).depth;
  want(t, kGrasper, "scissors");
  for (int i = 0; i < 1000 && t.tool(kGrasper).holds > 0; ++i) {
    EXPECT_NEAR(t.tool(kGrasper).depth, depth, 1e-9);
    t.step();
  }
  ASSERT_EQ(t.tool(kGrasper).holds, 0);
  t.steps(600);
  EXPECT_EQ(t.count(Event::released), 1);
  EXPECT_EQ(t.count(Event::exchanged), 1);
}

TEST(Exchange, AMagazineKeepsItsClipsWhileItIsPutDown) {
  Table t(small::model());
  t.state.tools[kApplier].clips_left = 7;
  want(t, kApplier, "grasper");
  t.steps(800);
  EXPECT_EQ(t.tool(kApplier).clips_left, 0);
  want(t, kApplier, "clip_applier");
  t.steps(800);
  EXPECT_EQ(t.tool(kApplier).clips_left, 7);
  EXPECT_EQ(t.tool(kApplier).changes, 2);
}

TEST(Exchange, AnInstrumentThatIsNotInTheRackIsFlaggedAndChangesNothing) {
  Table t(small::model());
  for (std::int32_t wanted : {-1, 2, 1 << 30}) {
    t.flags = 0;
    t.input.tools[kScissors].instrument = wanted;
    t.steps(5);
    EXPECT_EQ(t.flags & StepReport::kBadInput, std::uint32_t(StepReport::kBadInput)) << wanted;
    EXPECT_EQ(t.tool(kScissors).instrument, 0);
  }
}

}  // namespace
}  // namespace trocar::sim
