// Where a loop comes to lie on the box trainer's appendage, wanted at several places of it and drawn closed as the
// demonstration draws it.
#include <cstdio>

#include <gtest/gtest.h>

#include "shipped.hpp"
#include "sling_driver.hpp"

namespace trocar {
namespace {

constexpr double kFreeEnd = 0.045, kHandle = 0.44;  // [m] along the appendage

class SlingPlaces : public testing::TestWithParam<int> {};

TEST_P(SlingPlaces, ClosesTheLumenWithinOneAndAHalfMillimetresOfWhereItsKnotIsHeld) {
  const sim::Model& box = shipped("box_loop");
  const double wanted = 1e-3 * GetParam();
  SlingDriver d(box, box.hand_index("right"));
  d.put_over(0, kFreeEnd, wanted);
  d.draw_closed(0, wanted, kHandle, 6);
  ASSERT_EQ(d.sling().around_count, 1);
  const double lies = arc_of(box, d.sling().around[0].at);
  double cover = 0;
  sim::visit_loops(box, d.state, [&](const sim::LoopClosure& loop) { cover = std::max(cover, loop.cover); });
  double tension = 0;
  for (int i = 0; i < 200; ++i) d.step(), tension += d.sling().tension / 200;
  std::printf("wanted at %d mm: lies at %.1f mm, lumen closed by %.2f, tension %.2f N\n", GetParam(), 1e3 * lies, cover,
              tension);
  EXPECT_NEAR(lies, wanted, 0.0015);
  EXPECT_GE(cover, 0.98);
  EXPECT_NEAR(tension, 12 * kHandle - 1, 0.4);
}
INSTANTIATE_TEST_SUITE_P(Millimetres, SlingPlaces, testing::Values(12, 18, 22, 26, 32));

}  // namespace
}  // namespace trocar
