// Where a wall is taken between jaws: near the place, facing the hand, out of the fat.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/observe/bare_wall.hpp>

namespace trocar::training {
namespace {

/// The gallbladder before its dissection, with the fat of the triangle.
struct InFat {
  sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json"));
  sim::State state = sim::initial_state(model);
  int wall = model.membrane_index("gallbladder");
  Approach approach{{-0.057, 0.102, -0.096}, {-0.080, 0.062, -0.010}, 0.01};

  int take(std::span<const int> missed = {}) const { return wall_to_take(model, state, wall, approach, missed); }
  Vec3d at(int node) const {
    return tissue::position(model.membranes[std::size_t(wall)].sheet.network,
                            state.membranes[std::size_t(wall)].network, node);
  }
  int lobules_within(Vec3d p, double reach) const {
    int count = 0;
    const interactions::FatBody& fat = model.fat[0];
    const tissue::FatState& s = state.fat[0];
    for (int n = 0; n < fat.fat.lobules(); ++n) count += length(position(fat.fat, s, n) - p) < reach;
    return count;
  }
  /// The node with the most of them about.
  int most_covered() const {
    int best = 0;
    for (int n = 1; n < int(model.membranes[std::size_t(wall)].sheet.network.rest.size()); ++n)
      if (lobules_within(at(n), 0.005) > lobules_within(at(best), 0.005)) best = n;
    return best;
  }
};

TEST(BareWall, IsTakenNearThePlaceWhereLessFatIsAbout) {
  InFat w;
  const int covered = w.most_covered();
  ASSERT_GT(w.lobules_within(w.at(covered), 0.005), 2);
  w.approach.place = w.at(covered);
  const int taken = w.take();
  ASSERT_GE(taken, 0);
  EXPECT_LT(length(w.at(taken) - w.approach.place), 0.018);
  EXPECT_LT(w.lobules_within(w.at(taken), 0.005), w.lobules_within(w.at(covered), 0.005));
}

TEST(BareWall, WhatWasMissedIsNotTriedAgain) {
  const InFat w;
  std::vector<int> missed;
  for (int k = 0; k < 4; ++k) {
    const int taken = w.take(missed);
    ASSERT_GE(taken, 0);
    for (const int other : missed) EXPECT_GT(length(w.at(taken) - w.at(other)), 0.003);
    missed.push_back(taken);
  }
}

TEST(BareWall, ThereIsNoneFarFromTheWall) {
  InFat w;
  w.approach.place = {0.3, 0, 0};
  EXPECT_EQ(w.take(), -1);
}

}  // namespace
}  // namespace trocar::training
