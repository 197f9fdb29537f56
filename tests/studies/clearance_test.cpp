#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/studies/clearance.hpp>
#include <trocar/studies/end_of_way.hpp>
#include <trocar/studies/halton.hpp>
#include <trocar/studies/link_pairs.hpp>
#include <trocar/studies/optimise.hpp>
#include <trocar/studies/shape_distance.hpp>

#include "shipped.hpp"

namespace trocar::studies {
namespace {

using namespace kinematics;

PlacedShape rod(Vec3d a, Vec3d b, double radius) { return {false, a, b, radius, Mat3d::identity()}; }
PlacedShape box(Vec3d middle, Vec3d edges, Mat3d axes = Mat3d::identity()) {
  return {true, middle, 0.5 * edges, 0, axes};
}

TEST(ShapeDistance, OfSegmentsIsTheLeastOfAllTheirPoints) {
  core::Random random(3);
  const auto point = [&] { return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3d a = point(), b = trial % 9 ? point() : a, c = point();
    const Vec3d d = trial % 7 ? point() : c + 0.7 * (b - a);  // parallel ones, too
    double least = 1e9;
    for (int i = 0; i <= 60; ++i)
      for (int k = 0; k <= 60; ++k) least = std::min(least, length(a + i / 60.0 * (b - a) - (c + k / 60.0 * (d - c))));
    const double found = segment_distance(a, b, c, d);
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - 0.03);
  }
}

TEST(ShapeDistance, OfBoxesAndRodsIsWhatOneMeasures) {
  EXPECT_NEAR(clearance(box({0, 0, 0}, {2, 2, 2}), rod({3, 0, -5}, {3, 0, 5}, 0.5)), 1.5, 1e-9);
  EXPECT_NEAR(clearance(rod({0.8, 0, -5}, {0.8, 0, 5}, 0.1), box({0, 0, 0}, {2, 2, 2})), -0.3, 1e-7);
  EXPECT_NEAR(clearance(box({0, 0, 0}, {2, 2, 2}), box({3, 0, 0}, {2, 2, 2})), 1, 1e-9);
  const double turned = portable::pi / 4;
  EXPECT_NEAR(clearance(box({0, 0, 0}, {2, 2, 2}), box({4, 0, 0}, {2, 2, 2}, turn_about({0, 0, 1}, turned))),
              3 - std::sqrt(2.0), 1e-7);
  EXPECT_LT(clearance(box({0, 0, 0}, {10, 0.2, 0.2}), box({0, 0, 0}, {0.2, 10, 0.2})), 0);  // a cross
  EXPECT_NEAR(clearance(box({0, 0, 0}, {2, 2, 2}), box({1.9, 0, 0}, {2, 2, 2})), -0.1, 1e-12);
  EXPECT_LT(clearance(box({0, 0, 0}, {10, 10, 10}), box({0, 0, 0}, {1, 1, 1})), 0);  // one in the other
}

TEST(Clearance, OfTheCollidingGraspersBarIsThatOfItsElbowAndTheWall) {
  const Mechanism m = shipped("colliding_grasper");
  const ClearanceReport r = clearance_over_motion(m, {});
  EXPECT_EQ(r.reached, r.poses);
  ASSERT_FALSE(r.pairs.empty());
  const PairClearance& p = r.pairs.front();
  EXPECT_EQ(m.links[std::size_t(p.first)], "shaft");
  EXPECT_EQ(m.links[std::size_t(p.second)], "bar_upper");
  // by hand: the elbow lies tang * sin(jaw + tang_angle) off the axis, the wall at 2 mm, the bar is 0.4 mm thick
  std::vector<double> u = m.start_u();
  LoopWork work(m);
  hold_drives(m, work);
  u[std::size_t(m.drives[0].independent)] = m.drives[0].value(p.handles[0]);
  ASSERT_TRUE(close(m, u, work).closed());
  const double jaw = work.pose.q[std::size_t(m.coordinate("jaw_upper"))];
  const double elbow = 2.6e-3 * std::sin(jaw + 20 * portable::pi / 180);
  EXPECT_NEAR(p.least, 2.0e-3 - 0.4e-3 - elbow, 1e-8);
  EXPECT_LT(p.least, -0.3e-3);
}

TEST(Clearance, NeighboursAreNotLookedAtAndWhatIsIgnoredIsNot) {
  const Mechanism m = shipped("grasper");
  const auto names = [&](const ClearanceReport& r) {
    std::vector<std::string> all;
    for (const auto* list : {&r.pairs, &r.joined})
      for (const PairClearance& p : *list)
        all.push_back(m.links[std::size_t(p.first)] + " " + m.links[std::size_t(p.second)]);
    return all;
  };
  EXPECT_EQ(names(clearance_over_motion(m, {})), std::vector<std::string>{"jaw_upper jaw_lower"});
  EXPECT_TRUE(clearance_over_motion(m, {}).pairs.empty());  // hinged on one pin: in each other in every pose
  ClearanceOptions strict;
  strict.strict = true;
  EXPECT_LT(clearance_over_motion(m, strict).least, 0);
  ClearanceOptions options;
  options.ignored = {{m.link("jaw_lower"), m.link("jaw_upper")}};
  EXPECT_TRUE(names(clearance_over_motion(m, options)).empty());
}

TEST(Clearance, OfAnArmIsTheSameEveryTimeAndNeverAboveThatOfAnyPose) {
  const Mechanism m = shipped("dvrk_arm");
  ClearanceOptions coarse;
  coarse.samples = 300;
  coarse.refine = false;
  ClearanceOptions fine = coarse;
  fine.refine = true;
  const ClearanceReport a = clearance_over_motion(m, coarse), b = clearance_over_motion(m, coarse);
  EXPECT_EQ(a.least, b.least);
  EXPECT_LE(clearance_over_motion(m, fine).least, a.least);
}

/// Two rods, the second of which turns about the end of the first, as far as the limits say.
Mechanism folding(double limit_deg) {
  std::vector<core::Fault> faults;
  const std::string limits = "[" + std::to_string(-limit_deg) + ", " + std::to_string(limit_deg) + "]";
  const MechanismDescription d = scene::parse_mechanism(
      R"({"format": 1, "name": "folding", "links": [
      {"name": "base", "joint": {"kind": "fixed"},
       "shapes": [{"kind": "capsule", "from_mm": [0, 0, 0], "to_mm": [0, 0, 100], "radius_mm": 10}]},
      {"name": "arm", "parent": "base", "at_mm": [0, 0, 100],
       "joint": {"kind": "revolute", "axis": [0, 1, 0], "limits_deg": )" +
          limits + R"(},
       "shapes": [{"kind": "capsule", "from_mm": [0, 0, 0], "to_mm": [0, 0, 100], "radius_mm": 10}]}]})",
      "folding.json", faults);
  EXPECT_TRUE(faults.empty());
  return build(d);
}

TEST(Clearance, NeighboursCountWhereTheyAreInEachOtherOffTheirJoint) {
  EXPECT_TRUE(clearance_over_motion(folding(90), {}).pairs.empty()) << "at the joint they are meant to be";
  const ClearanceReport folded = clearance_over_motion(folding(180), {});
  ASSERT_EQ(folded.pairs.size(), 1u);
  EXPECT_TRUE(folded.pairs[0].beside_joint);
  EXPECT_NEAR(folded.pairs[0].least, -0.02, 1e-6) << "one on the other";
}

TEST(Clearance, NeighboursThatAreDrawnInEachOtherCountFromThatDepthOn) {
  const Mechanism m = folding(90);
  const LinkPairs links(m, {});
  ASSERT_EQ(links.all().size(), 1u);
  Pose pose(m);
  forward(m, std::vector<double>{0.0}, pose);
  const LinkPair& pair = links.all()[0];
  EXPECT_NEAR(links.drawn(m, pose)[0], 0.02, 1e-9)
      << "20 mm of each rod are the joint, 20 mm are left between surfaces";
  const std::vector<double> drawn{-0.005};
  EXPECT_NEAR(links.gap(pair, m, pose, drawn), 0.025, 1e-9);
}

TEST(Clearance, OfJawsThatGoOnThroughEachOtherIsFoundThoughTheyShareTheirHinge) {
  const Mechanism m = shipped("colliding_grasper");
  std::vector<double> values = m.parameter_values;
  const auto set = [&](const char* name, double value) { values[std::size_t(m.parameter(name))] = value; };
  set("tang", 1.857e-3), set("bar", 5.5e-3), set("rod_open", 6.5575e-3), set("rod_shut", 7.2727e-3);
  const ClearanceReport r = clearance_over_motion(m.with(values), {});
  ASSERT_FALSE(r.pairs.empty());
  EXPECT_TRUE(r.pairs[0].beside_joint);
  EXPECT_EQ(m.links[std::size_t(r.pairs[0].first)], "jaw_upper");
  EXPECT_EQ(m.links[std::size_t(r.pairs[0].second)], "jaw_lower");
  EXPECT_LT(r.least, -0.5e-3);
  EXPECT_NEAR(r.pairs[0].handles[0], 1, 1e-3);
}

TEST(Clearance, OfArmsWithLoopsAndWithoutDrivesIsLookedForInManyPoses) {
  for (const char* name : {"artemis_arm", "redundant_arm"}) {
    const Mechanism m = shipped(name);
    ClearanceOptions options;
    options.samples = 50;
    options.refine = false;
    const ClearanceReport a = clearance_over_motion(m, options), b = clearance_over_motion(m, options);
    EXPECT_EQ(a.reached, 50) << name << ": poses within limits";
    EXPECT_GT(a.drives.size(), 5u) << name;
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    for (std::size_t k = 0; k < a.pairs.size(); ++k) EXPECT_EQ(a.pairs[k].least, b.pairs[k].least);
  }
}

TEST(Halton, ItsAxesDifferAndFillTheirRange) {
  for (int axis = 0; axis < kHaltonAxes; ++axis) {
    double low = 1, high = 0, sum = 0;
    for (int k = 1; k <= 2000; ++k) {
      const double value = halton(std::int64_t(1009) * k, axis);
      low = std::min(low, value), high = std::max(high, value), sum += value;
      if (axis > 0 && k < 4) {
        EXPECT_NE(value, halton(std::int64_t(1009) * k, axis - 1)) << axis;
      }
    }
    EXPECT_LT(low, 0.01) << axis;
    EXPECT_GT(high, 0.99) << axis;
    EXPECT_NEAR(sum / 2000, 0.5, 0.02) << axis;
  }
}

TEST(Optimise, ItsGrasperClosesAndNotThroughItsOtherJaw) {
  const Mechanism m = shipped("colliding_grasper");
  OptimiseOptions options;
  options.clearance = 1e-4;
  options.follow = m.frame("tip_upper");
  const OptimiseResult r = optimise(m, options);
  ASSERT_TRUE(r.free);
  const Mechanism best = m.with(r.values);
  const auto before = end_of_way(m, options.follow), after = end_of_way(best, options.follow);
  ASSERT_TRUE(before && after);
  EXPECT_LT(length(*after->followed - *before->followed), 0.005 * r.range_before);
  EXPECT_LT(length(turn_between(before->jaws->r, after->jaws->r)), 0.3 * portable::pi / 180);
  for (const PairClearance& p : r.after.pairs) EXPECT_FALSE(p.beside_joint);
  for (const int i : r.parameters) {
    const double unit = m.parameters[std::size_t(i)].measure == Measure::length ? 1e6 : 180e3 / portable::pi;
    const double value = unit * r.values[std::size_t(i)];
    EXPECT_NEAR(value, std::round(value), 1e-6) << "as a drawing has it: " << m.parameters[std::size_t(i)].name;
  }
}

TEST(Optimise, TheEndOfTheWayFollowsFromTheOtherDimensions) {
  const Mechanism m = shipped("colliding_grasper");
  const int tip = m.frame("tip_upper"), end = end_parameter(m);
  ASSERT_EQ(end, m.parameter("rod_shut"));
  std::vector<double> values = m.parameter_values;
  values[std::size_t(m.parameter("bar"))] = 5.9e-3;
  const EndOfWay drawn = *end_of_way(m, tip);
  const auto shorter = end_of_way(m.with(values), tip);
  ASSERT_TRUE(shorter.has_value());
  EXPECT_GT(shorter->off(drawn, m.length), 1e-3) << "a shorter bar alone turns the jaw too far";
  values[std::size_t(end)] = fitted_end(m.with(values), end, tip, drawn);
  EXPECT_LT(end_of_way(m.with(values), tip)->off(drawn, m.length), 1e-6);
  EXPECT_EQ(end_parameter(shipped("dvrk_arm")), -1) << "several drives have no one way";
}

TEST(Optimise, FreesTheCollidingGrasperAndKeepsItsJawsWay) {
  const Mechanism m = shipped("colliding_grasper");
  OptimiseOptions options;
  options.clearance = 1e-4;
  options.follow = m.frame("tip_upper");
  const OptimiseResult r = optimise(m, options);
  EXPECT_LT(r.before.least, 0);
  EXPECT_TRUE(r.free);
  EXPECT_GE(r.after.least, 1e-4);
  EXPECT_EQ(r.after.reached, r.after.poses);
  EXPECT_GE(r.range_after, 0.95 * r.range_before);
  for (const int p : r.parameters) {
    const auto i = std::size_t(p);
    EXPECT_GE(r.values[i], m.parameters[i].low);
    EXPECT_LE(r.values[i], m.parameters[i].high);
  }
  const ClearanceReport again = clearance_over_motion(m.with(r.values), {}, options.follow);  // judged once more
  EXPECT_EQ(again.least, r.after.least);
  EXPECT_EQ(optimise(m, options).values, r.values);
}

TEST(Optimise, SaysWhereAWishCannotBeMetAndRefusesWhatHasNoBounds) {
  const Mechanism m = shipped("colliding_grasper");
  OptimiseOptions options;
  options.clearance = 1e-2;  // more than the shaft has room for
  options.follow = m.frame("tip_upper");
  options.starts = 1;
  options.evaluations = 150;
  EXPECT_FALSE(optimise(m, options).free);
  Mechanism unbounded = m;
  for (Parameter& p : unbounded.parameters) p.low = p.high = 0;
  EXPECT_THROW(optimise(unbounded, options), std::invalid_argument);
}

}  // namespace
}  // namespace trocar::studies
