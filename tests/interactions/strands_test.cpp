// Strands that touch each other: neither passes the other, and what was dragged to the wrong side goes home.
#include <gtest/gtest.h>

#include <trocar/interactions/contact/body_contact.hpp>

#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

constexpr double kApart = 0.008;  // [m] as drawn, along z

/// Two parallel tubes; `upper` is drawn above `lower`.
struct Tubes {
  test::StraightTube lower, upper{0.0016, {0, 0, kApart}};
  StrandPair pair;
  std::vector<std::int32_t> nearest;
  std::vector<Vec3f> side;
  StrandLoads lower_loads, upper_loads;
  std::uint64_t ticks = 0;
  tissue::StrandWork lower_work = tissue::make_work(lower.body.model), upper_work = lower_work;

  Tubes() {
    const size_t n = size_t(upper.body.nodes() - 1);
    pair.overlap.assign(n, 0.0f);
    for (size_t i = 0; i < n; ++i) nearest.push_back(std::int32_t(i));
    side.resize(n);
    lower_loads.reserve(200);
    upper_loads.reserve(200);
  }

  /// @param press  force on every node of the upper tube, along z [N]
  void tick(double press) {
    lower_loads.clear();
    upper_loads.clear();
    for (int e = 4; e + 1 < upper.body.nodes(); ++e) {
      tissue::StrandLoad load;
      load.element = e;
      load.w = 0.5;
      load.f0 = {0, 0, press};
      upper_loads.add(load, {});
    }
    strand_on_strand(pair, upper.body, upper.state, lower.body, lower.state, ticks++, nearest, side, upper_loads,
                     lower_loads);
    EXPECT_TRUE(tissue::advance(lower.body.model, {}, lower_loads.list, {}, {}, lower.state, lower_work).fine());
    EXPECT_TRUE(tissue::advance(upper.body.model, {}, upper_loads.list, {}, {}, upper.state, upper_work).fine());
  }

  double height(size_t node) const { return upper.state.x[node].z - lower.state.x[node].z; }
};

TEST(Strands, OneThatIsPressedOnItsNeighbourStaysAboveIt) {
  Tubes tubes;
  for (int t = 0; t < 2000; ++t) tubes.tick(-0.03);
  EXPECT_LT(tubes.height(12), 0.0034) << "they touch";
  EXPECT_GT(tubes.height(12), 0.0026);
}

/// Dragged below its neighbour, it lies against it from there, or has passed it and is remembered as below.
TEST(Strands, OneOnTheWrongSideOfItsNeighbourGoesHome) {
  for (double wrong : {-0.003, 0.004}) {
    Tubes tubes;
    for (size_t n = 4; n < tubes.upper.state.x.size(); ++n) tubes.upper.state.x[n].z = wrong;
    for (Vec3f& side : tubes.side) side = {0, 0, -1};
    for (int t = 0; t < 3000; ++t) tubes.tick(0);
    for (size_t n = 0; n < tubes.upper.state.x.size(); ++n) EXPECT_NEAR(tubes.height(n), kApart, 1e-5) << n;
  }
}

}  // namespace
