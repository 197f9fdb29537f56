// "This is what was to be shown": heard once for as long as the key is held, and part of the State only while it is.
#include <gtest/gtest.h>

#include "small_scene.hpp"

namespace trocar::sim {
namespace {

TEST(Declaration, IsToldOnceForAsLongAsTheKeyIsHeld) {
  small::Table t(small::model());
  t.steps(5);
  EXPECT_EQ(t.count(Event::declared), 0);
  for (int told = 1; told <= 2; ++told) {
    t.input.pedals = kDeclare;
    t.steps(50);
    EXPECT_EQ(t.count(Event::declared), told);
    t.input.pedals = 0;
    t.steps(5);
  }
}

TEST(Declaration, LeavesNoTraceInTheState) {
  small::Table declares(small::model()), is_silent(small::model());
  declares.input.pedals = kDeclare;
  declares.steps(3);
  is_silent.steps(3);
  EXPECT_NE(hash_of(declares.state), hash_of(is_silent.state)) << "that the key is down is State";
  declares.input.pedals = 0;
  declares.steps(1);
  is_silent.steps(1);
  EXPECT_EQ(hash_of(declares.state), hash_of(is_silent.state));
}

}  // namespace
}  // namespace trocar::sim
