// The step's law: a tick of a thread allocates nothing, whatever it is given.
#include <gtest/gtest.h>

#include "../../count_allocations.hpp"
#include "tying.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

TEST(NoAllocation, InAThreadsTickKnottedHeldPiercedAndCut) {
  Tying rig({.stuff = find_thread("3-0", "PDS")->stuff, .speed = 0.2});
  rig.begin({1, 1});
  std::vector<SkinContact> skins(8);
  for (int i = 0; i < 8; ++i) skins[std::size_t(i)] = {.node = 40 + i, .point = {0, 0, -1}};
  Passage passages[1] = {{.x = point_at(rig.m, rig.s, 0.02)}};
  PassageReaction through[1];
  std::vector<Vec3d> lie(8);
  const long before = g_allocations;
  open_passage(rig.m, rig.s, 0, 0.02);
  tie(rig.m, rig.s, 0, 0.03, 0.09);
  std::uint32_t flags = 0;
  for (int k = 0; k < 60; ++k) {
    rig.holds[0].x.x += 2e-4;
    if (k == 40) cut(rig.m, rig.s, 0.1), untie(rig.s, 0);
    flags |= advance(rig.m, {.holds = rig.holds, .obstacles = rig.posts, .skins = skins, .passages = passages},
                     {.holds = rig.pulls, .obstacles = rig.presses, .skins = lie, .passages = through}, rig.s, rig.w)
                 .flags;
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_EQ(flags & (ThreadReport::kIndefinite | ThreadReport::kNonFinite), 0u);
}
