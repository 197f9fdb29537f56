// Instruments that strike each other with a link.
#include <gtest/gtest.h>

#include <trocar/training/observe/watches.hpp>

#include "../sim/bent_scene.hpp"

namespace trocar::training {
namespace {

using small::Bent;
using small::kScissors;

/// Does the watch tell a collision while the scissors come onto the grasper's link?
bool struck(bool bent) {
  Handling limits;
  limits.collision_speed = 0.02;
  CollisionWatch watch;
  Bent b;
  constexpr double kSample = 0.01, kSpeed = 0.1;  // [s], [m/s]
  int told = 0;
  for (double gap = 0.006; gap > -0.0015; gap -= kSpeed * kSample) {
    Bent now(gap);
    if (!bent) now.straighten();
    Incidents incidents;
    watch.update(limits, now.model, now.state, kSample, incidents);
    for (int i = 0; i < incidents.count; ++i) told += incidents.list[size_t(i)].kind == Incident::collided;
  }
  EXPECT_LE(told, 1) << "once a meeting";
  return told > 0;
}

TEST(CollisionWatch, AShaftThatStrikesABentLinkIsToldAndOfAStraightInstrumentItStrikesNothing) {
  EXPECT_TRUE(struck(true));
  EXPECT_FALSE(struck(false));
}

}  // namespace
}  // namespace trocar::training
