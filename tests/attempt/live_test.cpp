// The simulation on its own thread: what the drawing thread gets to see of it, and when.
#include <gtest/gtest.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/live.hpp>
#include <trocar/attempt/sources.hpp>

namespace trocar::attempt {
namespace {

using namespace std::chrono_literals;

const attempt::Lesson& scene() {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("gynaecology");
  return *lesson;
}

/// Asks until something newer has come.
bool newer(attempt::Live& live) {
  for (int i = 0; i < 2000; ++i) {
    if (live.refresh()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

TEST(Live, EveryPictureThatAsksGetsALaterStateThanTheOneBefore) {
  attempt::Session session(scene(), 1);
  attempt::HandsSource hands(scene().model);
  attempt::Live live(session, hands, 0);
  std::uint64_t before = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(newer(live));
    EXPECT_GT(live.snapshot().state.tick, before);
    before = live.snapshot().state.tick;
  }
}

TEST(Live, WhileTimeStandsStillThePictureShowsTheTickItStandsAt) {
  attempt::Session session(scene(), 1);
  attempt::HandsSource hands(scene().model);
  attempt::Live live(session, hands, 0);
  ASSERT_TRUE(newer(live));
  live.pause(true);
  ASSERT_TRUE(newer(live));  // this may have been asked for before
  ASSERT_TRUE(newer(live));
  const std::uint64_t shown = live.snapshot().state.tick;
  live.stop();
  EXPECT_EQ(shown, session.state().tick);
}

TEST(Live, NobodyWaitsForASimulationThatHasEnded) {
  attempt::Session session(scene(), 1);
  attempt::HandsSource hands(scene().model);
  attempt::Live live(session, hands, 10);
  while (!live.snapshot().finished) ASSERT_TRUE(newer(live));
  EXPECT_EQ(live.snapshot().state.tick, 10u);
  live.stop();
  EXPECT_TRUE(live.refresh()) << "the last copy, made as it ends";
  EXPECT_FALSE(live.refresh());
}

}  // namespace
}  // namespace trocar::attempt
