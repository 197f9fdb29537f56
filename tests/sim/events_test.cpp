// What an event holds, and what becomes of events that find no room.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/model/step_context.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr BodyId kTube = BodyId::strand(small::kTube);

// A kind whose content is another does not compile.
template <Event::Kind kind, Event::Content content>
concept Makes = requires {
  typename std::bool_constant<(Event::KindWith<content>(kind), true)>;
};
static_assert(Makes<Event::torn, Event::Content::body> && !Makes<Event::clipped, Event::Content::body>);
static_assert(Makes<Event::clipped, Event::Content::record> && !Makes<Event::torn, Event::Content::record>);
static_assert(Makes<Event::slipped, Event::Content::hand_only> && !Makes<Event::exchanged, Event::Content::hand_only>);
static_assert(!Makes<Event::none, Event::Content::hand_only>);

struct Tick {
  State state = initial_state(small::model());
  Work work = make_work(small::model());
  Input input = small::model().start;
  StepReport report;
  StepContext context() { return {small::model(), input, state, work, report}; }
  bool full(StepReport::Flag flag) const { return (report.flags & flag) != 0; }
};

}  // namespace

TEST(Event, HoldsWhatItsKindHasAndNothingElse) {
  const Event slipped = Event::of_hand(Event::slipped, small::kGrasper);
  EXPECT_EQ(slipped.hand, small::kGrasper);
  EXPECT_FALSE(slipped.body.exists());
  EXPECT_EQ(slipped.record, -1);
  EXPECT_EQ(slipped.instrument, -1);
  const Event clipped = Event::recorded(Event::clipped, small::kApplier, 3, kTube);
  EXPECT_EQ(clipped.record, 3);
  EXPECT_EQ(clipped.body, kTube);
  EXPECT_EQ(clipped.instrument, -1);
  const Event exchanged = Event::exchange(small::kApplier, 2);
  EXPECT_EQ(exchanged.instrument, 2);
  EXPECT_EQ(exchanged.record, -1);
  EXPECT_FALSE(exchanged.body.exists());
}

TEST(Event, BeyondTheRoomOfATickSetsAFlagAndLeavesRoomForTears) {
  Tick t;
  StepContext c = t.context();
  for (int i = 0; i < kMaxEvents - kRoomForTears; ++i) emit_event(c, Event::of_hand(Event::slipped, 0));
  EXPECT_FALSE(t.full(StepReport::kEventsFull));
  emit_event(c, Event::of_hand(Event::slipped, 0));
  EXPECT_TRUE(t.full(StepReport::kEventsFull));
  t.report.flags = 0;
  for (int i = 0; i < kRoomForTears; ++i) emit_event(c, Event::on_body(Event::torn, 0, kTube));
  EXPECT_FALSE(t.full(StepReport::kEventsFull));
  EXPECT_EQ(t.report.event_count, kMaxEvents);
  emit_event(c, Event::on_body(Event::torn, 0, kTube));
  EXPECT_TRUE(t.full(StepReport::kEventsFull));
  EXPECT_EQ(t.report.event_count, kMaxEvents);
}

TEST(Event, OfSeveralStitchesThatAreTornOutInATickEachIsKept) {
  interactions::SewnReport report;
  for (int i = 0; i < interactions::kMostSewn; ++i) {
    report.add(interactions::TornStitch{BodyId::organ(0), BodyId(BodyKind::suture, std::size_t(i)), {}, 1});
    report.add(interactions::BrokenThread{BodyId(BodyKind::suture, std::size_t(i)), -1});
  }
  EXPECT_EQ(report.torn_count, interactions::kMostSewn);
  EXPECT_EQ(report.broken_count, interactions::kMostSewn);
  EXPECT_FALSE(report.events_lost);
  report.add(interactions::BrokenThread{});
  EXPECT_TRUE(report.events_lost);
}

TEST(Records, AVesselThatOpensByItselfWithoutRoomForItsOpeningIsReported) {
  Model bleeds = small::model();
  bleeds.vessels.bleeder.vessel = small::kTubeArtery;
  bleeds.vessels.bleeder.s = 0.5;
  bleeds.vessels.bleeder.area = 1e-7;
  Tick t;
  bleeds.vessels.bleeder.tick = t.state.tick;
  StepContext c{bleeds, t.input, t.state, t.work, t.report};
  open_bleeder(c);
  EXPECT_EQ(t.state.opening_count, 1);
  EXPECT_FALSE(t.full(StepReport::kRecordsFull));
  t.state.opening_count = interactions::kMaxOpenings;
  for (auto& o : t.state.openings) o = {.s = 0.5, .area = 0, .tick = 0, .vessel = small::kBarArtery};
  open_bleeder(c);
  EXPECT_TRUE(t.full(StepReport::kRecordsFull));
}
