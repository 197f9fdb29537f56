// The bed of the pool goes with the organs that it lies on.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/sim/model/pool_floor.hpp>
#include <trocar/sim/stages/step.hpp>

#include "shipped.hpp"

namespace trocar::sim {
namespace {

constexpr double kLifted = 0.006;  // [m]

const Model& pelvis() { return shipped("bleeding"); }

void lift(const Model& model, int organ, double by, State& s) {
  const tissue::NetworkModel& network = model.solids[size_t(organ)].network;
  const Vec3d up = by * model.wet.model.pool.up;
  for (int n = 0; n < network.nodes; ++n)
    set_position(network, s.solids[size_t(organ)], n, position(network, s.solids[size_t(organ)], n) + up);
}

double highest_change(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, double(std::fabs(a[i] - b[i])));
  return most;
}

TEST(PoolFloor, RisesWithTheBowelThatItLiesOn) {
  const Model& model = pelvis();
  State s = initial_state(model);
  ASSERT_EQ(model.wet.floor_organs.size(), 1u);
  const std::vector<float> drawn = s.pool_floor;
  lift(model, model.wet.floor_organs[0], kLifted, s);
  lay_floor(model, s);
  size_t of_the_bowel = 0;
  for (size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i] == model.wet.floor[i]) continue;  // wall
    EXPECT_NEAR(s.pool_floor[i] - drawn[i], kLifted, 1e-5) << i;
    ++of_the_bowel;
  }
  EXPECT_GT(of_the_bowel, 500u) << "of 16384 cells";
}

TEST(PoolFloor, FollowsEveryRowWithinThirtyTwoTicksAndKeepsThePoolsContent) {
  const Model& model = pelvis();
  State s = initial_state(model);
  Work work = make_work(model);
  const fluids::PoolModel& pool = model.wet.model.pool;
  constexpr std::int64_t kCell = fluids::kMillilitre / 100;
  for (int j = 40; j < 80; ++j)
    for (int i = 40; i < 80; ++i) {
      pour(pool, i, j, {.blood = kCell}, s.fluids.pool);
      receive(s.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, {.blood = kCell});
    }
  ASSERT_TRUE(balanced(s.fluids.ledger));
  lift(model, model.wet.floor_organs[0], kLifted, s);
  const std::vector<float> before = s.pool_floor;
  for (int t = 0; t < 32; ++t) ASSERT_TRUE(step(model, model.start, s, work).fine());
  State laid = s;
  lay_floor(model, laid);
  EXPECT_GT(highest_change(s.pool_floor, before), 0.5 * kLifted) << "the lifted bowel was noticed";
  EXPECT_LT(highest_change(s.pool_floor, laid.pool_floor), 0.5 * kLifted) << "what it moved since a row was laid";
  for (int t = 0; t < 1000; ++t) ASSERT_TRUE(step(model, model.start, s, work).fine());
  laid = s;
  lay_floor(model, laid);
  EXPECT_LT(highest_change(s.pool_floor, laid.pool_floor), 1e-4) << "[m] the bowel is home again";
  EXPECT_TRUE(balanced(s.fluids.ledger));
}

}  // namespace
}  // namespace trocar::sim
