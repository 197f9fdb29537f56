// Surfaces and centre lines of labels, on balls and tubes of known size, and on voxels at random.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/organ/centre_line.hpp>
#include <trocar/volumes/organ/label_surface.hpp>
#include <trocar/volumes/organ/label_voxels.hpp>
#include <trocar/volumes/organ/well_composed.hpp>

#include "made_volumes.hpp"

namespace trocar::volumes {
namespace {

Labels empty_labels(Index3 size, Vec3d spacing) {
  return on_grid_of(made_volume(size, spacing, [](Vec3d) { return 0; }));
}

double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
  const double share = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return length(p - (a + share * (b - a)));
}

/// A Y: a trunk along z that forks into two branches [mm].
const Vec3d kFoot{0, 0, -30}, kFork{0, 0, 0}, kLeft{16, 0, 26}, kRight{-14, 0, 28};
Labels fork() {
  Labels labels = empty_labels({60, 32, 80}, {1, 1, 1});
  put_label(labels, 1, [](Vec3d p) {
    return distance_to_segment(p, kFoot, kFork) < 5 || distance_to_segment(p, kFork, kLeft) < 3 ||
           distance_to_segment(p, kFork, kRight) < 3;
  });
  return labels;
}

}  // namespace

TEST(LabelSurface, ABallIsABodyOfItsVolumeAtItsPlace) {
  for (const int smoothing : {0, 12}) {
    Labels labels = empty_labels({50, 50, 30}, {1, 1, 2});
    put_label(labels, 4, ball({5, -3, 6}, 15));
    const LabelSurface s = label_surface(labels, 4, {.smoothing = smoothing});
    EXPECT_TRUE(s.is_body);
    EXPECT_EQ(s.held_back, 0);
    EXPECT_NEAR(s.ml, s.ml_of_label, 1e-4 * s.ml_of_label);
    EXPECT_NEAR(s.ml_of_label, ball_ml(15), 0.02 * ball_ml(15));
    EXPECT_LT(length(geometry::centre_of_volume(s.mesh) - scene_from_patient({5, -3, 6})), 2e-4);
    if (smoothing == 0) continue;
    for (const Vec3d& p : s.mesh.positions) EXPECT_NEAR(length(p - scene_from_patient({5, -3, 6})), 0.015, 1.1e-3);
  }
}

TEST(LabelSurface, MirroredGridsFaceOutwardsToo) {
  Labels labels = empty_labels({40, 40, 40}, {1, 1, 1});
  labels.grid.direction = Mat3d{{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
  labels.grid.origin.y = -labels.grid.origin.y;
  put_label(labels, 1, ball({0, 5, 0}, 12));
  const LabelSurface s = label_surface(labels, 1);
  EXPECT_TRUE(s.is_body);
  EXPECT_GT(geometry::volume(s.mesh), 0);
}

TEST(LabelSurface, VoxelsAtRandomBecomeBodies) {
  core::Random random(3);
  for (int round = 0; round < 20; ++round) {
    Labels labels = empty_labels({9, 8, 7}, {1, 1.3, 0.8});
    for (std::uint16_t& l : labels.at) l = random.uniform() < 0.1 + 0.04 * round ? 1 : 0;
    labels.at[100] = 1;
    const LabelSurface s = label_surface(labels, 1, {.smoothing = 6});
    EXPECT_TRUE(geometry::check_edges(s.mesh).closed()) << round;
    EXPECT_TRUE(s.is_body) << round;
    EXPECT_GE(s.ml, 0.99 * s.ml_of_label);
    EXPECT_LE(s.ml, 1.01 * s.ml_of_label + double(s.added_voxels) * labels.grid.voxel_ml());
  }
}

TEST(LabelSurface, VoxelsThatTouchByEdgesOrCornersAreJoined) {
  PaddedVoxels v{{5, 5, 5}, std::vector<std::uint8_t>(125)};
  v.in[v.index(1, 1, 1)] = v.in[v.index(2, 2, 2)] = 1;
  EXPECT_EQ(make_well_composed(v), 2u);
  PaddedVoxels w{{5, 5, 5}, std::vector<std::uint8_t>(125)};
  w.in[w.index(1, 1, 1)] = w.in[w.index(2, 2, 1)] = 1;
  EXPECT_EQ(make_well_composed(w), 1u);
  EXPECT_EQ(make_well_composed(w), 0u);
}

TEST(LabelSurface, WhatTheGridCutsIsClosedAndFewerTrianglesAreABodyToo) {
  Labels labels = empty_labels({30, 30, 30}, {1, 1, 1});
  put_label(labels, 1, ball({0, 0, 15}, 12));
  const LabelSurface s = label_surface(labels, 1, {.most_triangles = 800});
  EXPECT_TRUE(s.is_body);
  EXPECT_LE(s.mesh.triangles.size(), 800u);
  EXPECT_NEAR(s.ml, s.ml_of_label, 0.02 * s.ml_of_label);
  EXPECT_THROW(label_surface(labels, 2), std::invalid_argument);
}

TEST(LabelVoxels, CellsOfALabelLieWhereItsSurfaceDoes) {
  Labels labels = empty_labels({50, 50, 30}, {1, 1, 2});
  put_label(labels, 4, ball({5, -3, 6}, 15));
  const geometry::TetMesh cells = geometry::stuffed(label_voxels(labels, 4), 1, 0.004);
  const geometry::TriMesh skin = geometry::surface_of(cells).mesh;
  EXPECT_LT(length(geometry::centre_of_volume(skin) - scene_from_patient({5, -3, 6})), 3e-4);
  EXPECT_NEAR(1e6 * geometry::volume(skin), millilitres(labels, 4), 0.05 * millilitres(labels, 4));
  EXPECT_THROW(label_voxels(labels, 5), std::invalid_argument);
}

TEST(CentreLine, RunsInTheMiddleOfATubeWithItsRadius) {
  Labels labels = empty_labels({70, 40, 40}, {1, 1, 1.5});
  const auto middle = [](double x) { return Vec3d{x, 8 * std::sin(x / 12), 5 * std::cos(x / 15)}; };
  put_label(labels, 2, [&](Vec3d p) {
    double least = 1e9;
    for (double x = -32; x <= 32; x += 0.5) least = std::min(least, length(p - middle(x)));
    return least < 4;
  });
  const auto line = centre_line(labels, 2, middle(-34), middle(34));
  ASSERT_GT(line.size(), 40u);
  for (std::size_t i = 5; i + 5 < line.size(); ++i) {
    const Vec3d p = patient_from_scene(line[i].at);
    double least = 1e9;
    for (double x = -32; x <= 32; x += 0.1) least = std::min(least, length(p - middle(x)));
    EXPECT_LT(least, 0.9) << i;
    EXPECT_NEAR(line[i].radius, 4e-3, 0.8e-3) << i;
  }
  EXPECT_LT(length(patient_from_scene(line.front().at) - middle(-32)), 5);
  EXPECT_THROW(centre_line(labels, 3, {}, {}), std::invalid_argument);
  put_label(labels, 2, [](Vec3d p) { return length(p - Vec3d{0, -18, -25}) < 1.5; });
  EXPECT_THROW(centre_line(labels, 2, middle(0), {0, -18, -25}), std::invalid_argument);
}

TEST(CentreLine, AForkHasTwoEndsThreeWaysAndItsRadii) {
  const CentreTree tree = centre_tree(fork(), 1);
  ASSERT_EQ(tree.ends.size(), 2u);
  EXPECT_EQ(tree.parent[0], -1);
  EXPECT_LT(length(patient_from_scene(tree.points[0].at) - kFoot), 7);  // the thicker end is the root
  std::vector<int> children(tree.points.size());
  for (std::size_t p = 1; p < tree.points.size(); ++p) {
    EXPECT_LT(tree.parent[p], int(p));
    ++children[std::size_t(tree.parent[p])];
  }
  EXPECT_EQ(std::count(children.begin(), children.end(), 2), 1);
  double near_left = 1e9, near_right = 1e9;
  for (const int end : tree.ends) {
    near_left = std::min(near_left, length(patient_from_scene(tree.points[std::size_t(end)].at) - kLeft));
    near_right = std::min(near_right, length(patient_from_scene(tree.points[std::size_t(end)].at) - kRight));
  }
  EXPECT_LT(near_left, 5);
  EXPECT_LT(near_right, 5);
  for (const CentrePoint& p : tree.points) {
    const Vec3d at = patient_from_scene(p.at);
    if (at.z < -5 && at.z > -26) {
      EXPECT_NEAR(p.radius, 5e-3, 0.8e-3);
    }
    if (at.z > 12 && at.z < 22) {
      EXPECT_NEAR(p.radius, 3e-3, 0.8e-3);
    }
  }
}

/// A scan cuts vessels off flat: the rims of such ends are no branches.
TEST(CentreLine, AShortWideTubeWithFlatEndsIsOneVesselOfItsRadius) {
  for (const bool at_border : {false, true})
    for (const double half : {19.0, 30.0}) {
      Labels labels = empty_labels({50, 50, at_border ? int(half) : 40}, {0.8, 0.8, 2});
      put_label(labels, 1, [&](Vec3d p) {
        return std::hypot(p.x - 0.05 * p.z, p.y) < 13.3 && std::fabs(p.z) < (at_border ? 1e9 : half);
      });
      const CentreTree tree = centre_tree(labels, 1);
      ASSERT_EQ(tree.ends.size(), 1u) << at_border << half;
      std::vector<int> children(tree.points.size());
      for (std::size_t p = 1; p < tree.points.size(); ++p) ++children[std::size_t(tree.parent[p])];
      EXPECT_EQ(std::count(children.begin(), children.end(), 2), 0);
      const double length_mm = 1e3 * length(tree.points[std::size_t(tree.ends[0])].at - tree.points[0].at);
      const double whole = at_border ? 2 * (half - 1) : 2 * half;
      EXPECT_NEAR(length_mm, whole, 6) << "from one end to the other";
      for (const CentrePoint& p : tree.points) {
        EXPECT_NEAR(p.radius, 13.3e-3, 1.6e-3);
        const Vec3d at = patient_from_scene(p.at);
        EXPECT_LT(std::hypot(at.x - 0.05 * at.z, at.y), 2.5);
      }
    }
}

TEST(CentreLine, TheRootMayBeChosenAndABallIsATreeOfOnePoint) {
  const CentreTree tree = centre_tree(fork(), 1, {.root_mm = kLeft});
  EXPECT_LT(length(patient_from_scene(tree.points[0].at) - kLeft), 4);
  EXPECT_EQ(tree.ends.size(), 2u);
  Labels labels = empty_labels({30, 30, 30}, {1, 1, 1});
  put_label(labels, 1, ball({0, 0, 0}, 6));
  EXPECT_LE(centre_tree(labels, 1, {.least_branch_mm = 20}).ends.size(), 1u);
}

}  // namespace trocar::volumes
