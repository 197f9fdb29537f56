// The step's law: no allocation.
#include <cmath>

#include <gtest/gtest.h>

#include "../count_allocations.hpp"
#include "plates.hpp"

namespace trocar::fluids {
namespace {

TEST(NoAllocation, InATickOfAllFluids) {
  test::Scene b(test::small_scene());
  b.plates = {{.centre = {0, 0, 0.04f}, .normal = {0.6f, 0, 0.8f}, .radius = 0.02f, .first_film = 0, .film_cells = 5}};
  b.openings = {test::bleeding({0, 0, 0.07f}, {0.6f, 0, 0.8f}, 3e-5, 2e-6)};
  b.tools = {{.tip = {0.02f, 0, 0.01f}, .irrigation = 1, .suction = 1}};
  b.capsules = {{.a = {0, 0, 0}, .b = {0.05f, 0, 0.1f}, .radius = 0.004f, .body = 9}};
  b.boiled = {{{0, 0, 0.03}, 1e-8}};
  const long before = g_allocations;
  for (int t = 0; t < 600; ++t) b.tick();
  EXPECT_EQ(g_allocations, before);
  EXPECT_GT(b.s.droplets.count, 50);
  EXPECT_GT(b.millilitres(Place::kPool), 1);
}

}  // namespace
}  // namespace trocar::fluids
