// Tools that change labels, on balls, boxes and tubes of known size.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/volumes/segment/brush.hpp>
#include <trocar/volumes/segment/distance.hpp>
#include <trocar/volumes/segment/islands.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>
#include <trocar/volumes/segment/threshold.hpp>

#include "made_volumes.hpp"

namespace trocar::volumes {
namespace {

/// Two balls of 100 and 200 in air of -1000, 1 x 1 x 2 mm.
struct TwoBalls {
  Vec3d left{12, 0, 0}, right{-12, 0, 0};
  Volume volume = made_volume({64, 40, 20}, {1, 1, 2}, [&](Vec3d p) {
    return length(p - left) <= 10 ? 100.0 : length(p - right) <= 8 ? 200.0 : -1000.0;
  });
  Labels labels = on_grid_of(volume);

  void make(const LabelChange& change) { apply(labels, change); }
  double ml(int label) const { return millilitres(labels, label); }
  Index3 at(Vec3d p) const { return labels.grid.nearest(p); }
};

}  // namespace

TEST(Segment, AChangeIsUndoneBitByBitAndIsSmall) {
  TwoBalls s;
  put_label(s.labels, 7, ball(s.left, 5));
  const Labels before = s.labels;
  const LabelChange change = thresholded(s.volume, s.labels, {50, 300}, 1);
  s.make(change);
  EXPECT_NE(s.labels.at, before.at);
  EXPECT_LT(change.bytes(), before.at.size() * 2 / 5);
  undo(s.labels, change);
  EXPECT_EQ(s.labels.at, before.at);
  EXPECT_THROW(undo(s.labels, change), std::invalid_argument);
  EXPECT_EQ(s.labels.at, before.at);
}

TEST(Segment, ThresholdsTakeWhatTheRulesAllow) {
  TwoBalls s;
  s.make(thresholded(s.volume, s.labels, {50, 150}, 1));
  EXPECT_NEAR(s.ml(1), ball_ml(10), 0.05 * ball_ml(10));
  s.make(thresholded(s.volume, s.labels, {50, 300}, 2, {.overwrite = false}));
  EXPECT_NEAR(s.ml(2), ball_ml(8), 0.05 * ball_ml(8));
  s.make(thresholded(s.volume, s.labels, {-2000, 2000}, 3, {.inside = 2}));
  EXPECT_EQ(s.ml(2), 0);
  EXPECT_NEAR(s.ml(3), ball_ml(8), 0.05 * ball_ml(8));
}

TEST(Segment, ABallIsPaintedWithItsVolumeAndADiscInOneSlice) {
  TwoBalls s;
  const Vec3d there[] = {{0, 0, 0}};
  const LabelChange dab = painted(s.volume, s.labels, there, {.radius_mm = 9}, 1);
  EXPECT_NEAR(gained_ml(dab, 1, s.labels.grid), ball_ml(9), 0.04 * ball_ml(9));
  const Vec3d along[] = {{-15, 0, 1}, {15, 0, 1}};
  s.make(painted(s.volume, s.labels, along, {.radius_mm = 5, .normal = Vec3d{0, 0, 1}}, 2));
  const Box box = box_of(s.labels, 2);
  EXPECT_EQ(box.size(), (Index3{40, 10, 1}));
  s.make(painted(s.volume, s.labels, along, {.radius_mm = 50}, 0, {.inside = 2}));
  EXPECT_EQ(s.ml(2), 0);
}

TEST(Segment, ThePaintbrushMayKeepToValues) {
  TwoBalls s;
  const Vec3d there[] = {s.left};
  s.make(painted(s.volume, s.labels, there, {.radius_mm = 14}, 1, {.values = {{50.0, 150.0}}}));
  EXPECT_NEAR(s.ml(1), ball_ml(10), 0.05 * ball_ml(10));
}

TEST(Segment, GrowingFromAClickStopsAtTheEdge) {
  TwoBalls s;
  const Index3 seeds[] = {s.at(s.right), {-5, 0, 0}};
  s.make(grown(s.volume, s.labels, seeds, {50, 300}, 4));
  EXPECT_NEAR(s.ml(4), ball_ml(8), 0.05 * ball_ml(8));
  EXPECT_EQ(s.labels.at[s.labels.grid.index(s.at(s.left))], 0);
}

TEST(Segment, CompetingSeedsMeetAtTheEdgesOfTheScan) {
  TwoBalls s;
  const Vec3d left[] = {s.left}, right[] = {s.right}, air[] = {{0, 18, 0}};
  s.make(painted(s.volume, s.labels, left, {.radius_mm = 2.5}, 1));
  s.make(painted(s.volume, s.labels, right, {.radius_mm = 2.5}, 2));
  s.make(painted(s.volume, s.labels, air, {.radius_mm = 2.5}, 3));
  s.make(grown_from_labels(s.volume, s.labels));
  EXPECT_NEAR(s.ml(1), ball_ml(10), 0.05 * ball_ml(10));
  EXPECT_NEAR(s.ml(2), ball_ml(8), 0.05 * ball_ml(8));
  EXPECT_EQ(s.ml(0), 0);
  EXPECT_THROW(
      grown_from_labels(made_volume({200, 200, 60}, {1, 1, 1}, [](Vec3d) { return 0; }),
                        [] {
                          Labels l = on_grid_of(made_volume({200, 200, 60}, {1, 1, 1}, [](Vec3d) { return 0; }));
                          l.at[0] = 1;
                          return l;
                        }(),
                        {.margin_mm = 500, .progress = [](double) { return false; }}),
      Cancelled);
}

TEST(Segment, IslandsAreKeptRemovedAndToldApart) {
  TwoBalls s;
  put_label(s.labels, 1, ball(s.left, 8));
  put_label(s.labels, 1, ball(s.right, 5));
  put_label(s.labels, 1, ball({0, 15, 0}, 1));
  const Labels before = s.labels;
  const double big = ball_ml(8), small = ball_ml(5);
  s.make(small_removed(s.volume, s.labels, 1, 20));
  EXPECT_NEAR(s.ml(1), big + small, 0.06 * big);
  s.make(split(s.volume, s.labels, 1, 10));
  EXPECT_NEAR(s.ml(10), small, 0.1 * small);
  s.labels = before;
  s.make(largest_kept(s.volume, s.labels, 1));
  EXPECT_NEAR(s.ml(1), big, 0.06 * big);
  s.labels = before;
  s.make(chosen_kept(s.volume, s.labels, 1, s.at(s.right)));
  EXPECT_NEAR(s.ml(1), small, 0.1 * small);
}

TEST(Segment, HolesAreFilledInSpaceOrInSlices) {
  TwoBalls s;
  put_label(s.labels, 1, ball(s.left, 10));
  const double full = s.ml(1);
  put_label(s.labels, 0, ball(s.left, 4));
  const Labels hollow = s.labels;
  s.make(holes_filled(s.volume, s.labels, 1));
  EXPECT_EQ(s.ml(1), full);
  // A channel to the outside along z: open in space, closed in the slices across z.
  s.labels = hollow;
  put_label(s.labels, 0, [&](Vec3d p) { return std::hypot(p.x - 12, p.y) < 2; });
  const double open = s.ml(1);
  s.make(holes_filled(s.volume, s.labels, 1));
  EXPECT_EQ(s.ml(1), open);
  s.make(holes_filled(s.volume, s.labels, 1, 2));
  EXPECT_NEAR(s.ml(1), full, 0.01 * full);
}

TEST(Segment, MarginsAreInMillimetresAlongAllAxes) {
  TwoBalls s;
  put_label(s.labels, 1, ball({0, 0, 0}, 8));
  s.make(margin_moved(s.volume, s.labels, 1, 5));
  EXPECT_NEAR(s.ml(1), ball_ml(13), 0.06 * ball_ml(13));
  s.make(margin_moved(s.volume, s.labels, 1, -5));
  EXPECT_NEAR(s.ml(1), ball_ml(8), 0.12 * ball_ml(8));
  s.make(hollowed(s.volume, s.labels, 1, 3));
  EXPECT_EQ(s.labels.at[s.labels.grid.index(s.at({0, 0, 0}))], 0);
  EXPECT_GT(s.ml(1), 0.3 * ball_ml(8));
}

TEST(Segment, SmoothingKeepsTheVolumeWhereItIsAskedToAndSaysHowMuchItIs) {
  TwoBalls s;
  put_label(s.labels, 1, ball({0, 0, 0}, 9));
  put_label(s.labels, 1, [](Vec3d p) { return std::fabs(p.y) < 1 && std::fabs(p.z) < 1 && std::fabs(p.x) < 20; });
  const double before = s.ml(1);
  const SmoothLabel median = smoothed(s.volume, s.labels, 1, 3, Smoothing::median);
  const SmoothLabel keeps = smoothed(s.volume, s.labels, 1, 3, Smoothing::keeps_volume);
  EXPECT_EQ(median.ml_before, before);
  EXPECT_LT(median.ml, 0.99 * before);
  EXPECT_NEAR(keeps.ml, before, 0.01 * before);
  s.make(keeps.change);
  EXPECT_NEAR(s.ml(1), keeps.ml, 1e-9);
  EXPECT_EQ(s.labels.at[s.labels.grid.index(s.at({18, 0, 0}))], 0);  // the spike is gone
}

TEST(Segment, NeighboursThatAreSmoothedTogetherLeaveNoGap) {
  TwoBalls s;
  put_label(s.labels, 1, [](Vec3d p) { return length(p) < 15 && p.x + std::sin(p.y) * 2 < 0; });
  put_label(s.labels, 2, [](Vec3d p) { return length(p) < 15 && p.x + std::sin(p.y) * 2 >= 0; });
  const std::uint16_t both[] = {1, 2};
  s.make(smoothed_together(s.volume, s.labels, both, 4));
  for (double y = -8; y <= 8; ++y)
    for (double x = -8; x <= 8; ++x) EXPECT_NE(s.labels.at[s.labels.grid.index(s.at({x, y, 0}))], 0);
  EXPECT_NEAR(s.ml(1) + s.ml(2), ball_ml(15), 0.1 * ball_ml(15));
}

TEST(Segment, ShapesBetweenDrawnSlicesAreInBetween) {
  TwoBalls s;
  put_label(s.labels, 1, [](Vec3d p) { return std::fabs(p.z - 9) < 0.5 && std::hypot(p.x, p.y) < 12; });
  put_label(s.labels, 1, [](Vec3d p) { return std::fabs(p.z + 7) < 0.5 && std::hypot(p.x, p.y) < 4; });
  s.make(filled_between_slices(s.volume, s.labels, 1, 2));
  const auto area = [&](double z) {
    const Box box{{0, 0, s.at({0, 0, z})[2]}, {64, 40, s.at({0, 0, z})[2] + 1}};
    return double(voxels_of(s.labels, 1, box).count());
  };
  EXPECT_NEAR(area(1), 3.14159 * 64, 0.1 * 3.14159 * 64);  // half way: radius 8
  EXPECT_EQ(area(-9), 0);
}

TEST(Segment, LogicCombinesLabels) {
  TwoBalls s;
  const Labels empty = s.labels;
  const auto fresh = [&] {
    s.labels = empty;
    put_label(s.labels, 1, [](Vec3d p) { return p.x < 5; });
    VoxelSet other(whole(s.labels.grid));
    for (std::size_t i = 0; i < other.in.size(); ++i) other.in[i] = s.labels.grid.place(i)[0] >= 20;
    return other;
  };
  const auto width = [&] { return double(voxels_of(s.labels, 1).count()) / (40 * 20); };
  const auto result = [&](Logic how) {
    const VoxelSet other = fresh();
    s.make(combined(s.volume, s.labels, 1, how, other));
    return width();
  };
  fresh();
  const double own = width();
  EXPECT_EQ(result(Logic::add), 64);
  EXPECT_EQ(result(Logic::copy), 44);
  EXPECT_EQ(result(Logic::subtract), 20);
  EXPECT_EQ(result(Logic::intersect), own - 20);
  EXPECT_EQ(result(Logic::invert), 64 - own);
  EXPECT_EQ(result(Logic::clear), 0);
}

TEST(Segment, DistancesAreThoseOfTheNearestVoxelByTryingAll) {
  const Volume volume = made_volume({13, 9, 7}, {0.7, 1.1, 2.3}, [](Vec3d) { return 0; });
  VoxelSet set(whole(volume.grid));
  for (std::size_t i = 0; i < set.in.size(); ++i) set.in[i] = i * 2654435761u % 97 < 3;
  const std::vector<float> squared = squared_distance(set, volume.grid.spacing, false);
  for (std::size_t i = 0; i < set.in.size(); ++i) {
    double nearest = 1e20;
    const auto p = [&](std::size_t n) {
      const Index3 v = volume.grid.place(n);
      return volume.grid.to_patient({double(v[0]), double(v[1]), double(v[2])});
    };
    for (std::size_t j = 0; j < set.in.size(); ++j)
      if (set.in[j] != 0) nearest = std::min(nearest, dot(p(i) - p(j), p(i) - p(j)));
    EXPECT_NEAR(squared[i], nearest, 1e-4 * (1 + nearest));
  }
}

}  // namespace trocar::volumes
