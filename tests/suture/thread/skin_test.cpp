// A thread on skins: what these do to it where it lies deep in them.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/suture/thread/thread.hpp>

#include "figures.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

/// What a skin does to the node that jaws hold so deep in it [N].
double pressed(double deep) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.06, .gravity = {0, 0, 0}});
  ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}});
  ThreadWork w = make_work(m);
  const int node = m.nodes / 2;
  take_hold(m, s, 0, node * m.spacing);
  const std::vector<Hold> holds{{.x = s.x[std::size_t(node)], .friction_limit = 20}};
  std::vector<SkinContact> skins(std::size_t(m.nodes));
  skins[std::size_t(node)] = {.node = node, .point = {0, 0, deep}, .stiffness = 150, .hardens = m.stuff.diameter};
  std::vector<Vec3d> forces(std::size_t(m.nodes));
  for (int k = 0; k < 20; ++k) advance(m, {.holds = holds, .skins = skins}, {.skins = forces}, s, w);
  return length(forces[std::size_t(node)]);
}

TEST(ThreadOnSkin, WhatIsHeldDeeperThanItsDiameterIsPressedInProportionToItsDepth) {
  const double once = pressed(0.3e-3), twice = pressed(0.7e-3);
  say("skin of 150 N/m on a node 0.7 mm below it [N]", twice, "without a bound on what hardens: 28");
  EXPECT_GT(once, 1);
  EXPECT_LT(twice, 2.5 * once);
}

TEST(ThreadOnSkin, WhatIsPulledAgainstItIsKeptOutByMoreThanItsStiffness) {
  EXPECT_GT(pressed(0.05e-3), 4 * 150 * 0.05e-3);
}

}  // namespace
