// The ray caster and slices, against what balls and boxes must look like.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/core/instruction_set.hpp>
#include <trocar/core/random.hpp>
#include <trocar/volumes/show/caster.hpp>
#include <trocar/volumes/show/caster_kernel.hpp>
#include <trocar/volumes/show/cells.hpp>
#include <trocar/volumes/show/slice_image.hpp>

#include "made_volumes.hpp"

namespace trocar::volumes {
namespace {

/// A ball of 1000 with a soft edge of a voxel in air of -1000.
Volume ball_volume(double radius, Vec3d centre = {}) {
  return made_volume({64, 64, 40}, {1, 1, 1.6},
                     [=](Vec3d p) { return std::clamp(1000 * (radius - length(p - centre)), -1000.0, 1000.0); });
}
const TransferFunction kSolid{{{-1, {1, 1, 1}, 0}, {0, {1, 1, 1}, 0}, {1, {1, 0.5, 0.25}, 0.99999}}};

struct Scene {
  Volume volume = ball_volume(20);
  core::ThreadPool pool{2};
  VolumeCaster caster{volume, pool};
  View view{{0, 0, 0.3}, {}, {0, 1, 0}, 0, 0.064, 64, 64};  // a pixel is a millimetre

  Scene() { caster.set_transfer(kSolid); }
  int opaque_pixels(const Quality& quality = {}) {
    const Picture p = caster.render(view, quality).picture;
    int count = 0;
    for (std::size_t i = 3; i < p.rgba.size(); i += 4) count += p.rgba[i] > 127;
    return count;
  }
};

}  // namespace

TEST(VolumeCaster, ABallHasItsSilhouetteAndItsDistance) {
  Scene s;
  EXPECT_NEAR(s.opaque_pixels(), 3.14159 * 400, 0.03 * 3.14159 * 400);
  const Picture p = s.caster.render(s.view, {}).picture;
  EXPECT_NEAR(p.depth[32 * 64 + 32], 300 - 20, 1.1);
  EXPECT_TRUE(std::isinf(p.depth[0]));
  EXPECT_EQ(p.at(0, 0)[3], 0);
  EXPECT_EQ(p.at(32, 32)[3], 255);
  EXPECT_GT(p.at(32, 32)[0], p.at(32, 32)[2]);
}

TEST(VolumeCaster, PerspectiveShowsTheBallAtItsAngle) {
  Scene s;
  s.view.fov_deg = 30;
  const double silhouette = std::tan(std::asin(20.0 / 300)) / std::tan(15 * 3.14159265 / 180) * 32;  // pixels
  EXPECT_NEAR(s.opaque_pixels(), 3.14159 * silhouette * silhouette, 0.04 * 3.14159 * silhouette * silhouette);
}

TEST(VolumeCaster, WhatIsToThePatientsLeftHeadAndFrontIsThere) {
  // In millimetres L P S: the ball is left, in front, and towards the head.
  const Volume volume = ball_volume(8, {15, -12, 18});
  core::ThreadPool pool(1);
  VolumeCaster caster(volume, pool);
  caster.set_transfer(kSolid);
  const auto middle = [&](const View& view) {
    const Picture p = caster.render(view, {}).picture;
    Vec3d sum;
    double count = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (p.at(x, y)[3] > 127) sum += {double(x), double(y), p.depth[std::size_t(64 * y + x)]}, ++count;
    return sum / count;
  };
  // From the front: the patient's left is on the right side; the head is up.
  const Vec3d front = middle({{0, 0, 0.3}, {}, {0, 1, 0}, 0, 0.064, 64, 64});
  EXPECT_NEAR(front.x - 31.5, 15, 1);
  EXPECT_NEAR(front.y - 31.5, -18, 1);
  EXPECT_NEAR(front.z, 300 - 12 - 5.3, 1);  // the near half of a ball is 2/3 of its radius in front of its middle
  // From the head, the front upwards.
  const Vec3d head = middle({{0, 0.3, 0}, {}, {0, 0, 1}, 0, 0.064, 64, 64});
  EXPECT_NEAR(std::fabs(head.x - 31.5), 15, 1);
  EXPECT_NEAR(head.y - 31.5, -12, 1);
}

TEST(VolumeCaster, SkippingEmptyCellsLeavesNothingOut) {
  core::Random random(7);
  Volume volume = made_volume({70, 45, 33}, {1, 1, 1}, [&](Vec3d) { return -1000.0; });
  for (int n = 0; n < 60; ++n) {
    Index3 v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = int(random.uniform() * volume.grid.size[k]);
    volume.stored[volume.grid.index(v)] = 800;
  }
  core::ThreadPool pool(2);
  VolumeCaster caster(volume, pool);
  TransferFunction faint{{{-500, {1, 1, 1}, 0}, {500, {1, 1, 1}, 0.3}}}, everywhere = faint;
  // With a veil of 0.2 % a millimetre no cell is empty; what it adds is bounded by its thickness.
  everywhere.points.insert(everywhere.points.begin(), {-1000, {0, 0, 0}, 0.002});
  everywhere.points[1].opacity = 0.002;
  for (const Vec3d eye : {Vec3d{0, 0, 0.2}, Vec3d{0.15, 0.1, 0.05}, Vec3d{-0.02, -0.2, 0.1}}) {
    const View view{eye, {}, {0, 0.3, 1}, 25, 0, 96, 64};
    caster.set_transfer(faint);
    const Picture skipped = caster.render(view, {}).picture;
    caster.set_transfer(everywhere);
    const Picture all = caster.render(view, {}).picture;
    double most = 0, seen = 0;
    for (std::size_t i = 3; i < all.rgba.size(); i += 4) {
      most = std::max(most, double(all.rgba[i]) - double(skipped.rgba[i]));
      seen = std::max(seen, double(skipped.rgba[i]));
    }
    EXPECT_LT(most, 255 * (1 - std::pow(0.998, 100)));
    EXPECT_GT(seen, 20);
  }
}

TEST(VolumeCaster, InstructionSetsAgreeButForTheLastBits) {
  const CasterKernel* wide = caster_avx2();
  if (!core::can_run(wide)) GTEST_SKIP() << "no AVX2 here";
  Scene s;
  const Picture usual = s.caster.render(s.view, {}).picture;
  // The caster asks once: another process would be needed to change its mind, so its kernels are compared by
  // themselves.
  EXPECT_STREQ(wide->name, "avx2");
  EXPECT_STREQ(caster_plain()->name, "plain");
  std::vector<std::uint8_t> skip(std::size_t(8 * 8 * 5) + 3, 0);
  std::vector<float> table(4 * kTableSize);
  for (int e = 0; e < kTableSize; ++e) {
    const float share = float(e) / kTableSize;
    for (std::size_t c = 0; c < 4; ++c) table[4 * std::size_t(e) + c] = c == 3 ? 0.4f * share : share;
  }
  CastJob job;
  job.voxels = s.volume.stored.data();
  job.skip = skip.data();
  job.table = table.data();
  job.table_from = -1000, job.table_scale = (kTableSize - 1) / 2000.0f, job.shade_full = 20, job.fine_gradient = true;
  for (int k = 0; k < 3; ++k) {
    job.size[k] = s.volume.grid.size[std::size_t(k)];
    job.cells[k] = (job.size[k] + 7) / 8;
    job.inverse_spacing[k] = 1;
    job.high[k] = float(job.size[k] - 1);
  }
  job.perspective = false;
  job.origin[0] = 31.5f, job.origin[1] = 31.5f, job.origin[2] = -50;
  job.forward[2] = job.metric_forward[2] = 1;
  job.right[0] = job.down[1] = 1;
  job.width = 61, job.height = 45;  // not a whole number of packets
  std::vector<std::uint32_t> a(std::size_t(61 * 45)), b = a;
  std::vector<float> depth(a.size());
  job.depth = depth.data();
  job.pixels = a.data();
  wide->cast(job, 0, 0, 61, 45);
  job.pixels = b.data();
  caster_plain()->cast(job, 0, 0, 61, 45);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int shift = 0; shift < 32; shift += 8) EXPECT_NEAR(int(a[i] >> shift & 255), int(b[i] >> shift & 255), 1);
}

TEST(VolumeCaster, PlanesAndBoxesOpenTheVolume) {
  Scene s;
  const int whole_ball = s.opaque_pixels();
  const ClipPlane left_half[] = {{{-1, 0, 0}, 0}};  // shown: x <= 0
  s.caster.set_planes(left_half);
  EXPECT_NEAR(s.opaque_pixels(), whole_ball / 2.0, 25);
  const ClipPlane back_half[] = {{{0, 0, -1}, 0}};
  s.caster.set_planes(back_half);
  EXPECT_NEAR(s.caster.render(s.view, {}).picture.depth[32 * 64 + 32], 300, 1.1);
  s.caster.set_planes({});
  s.caster.set_box({{0, 0, 0}, {64, 64, 20}});  // the lower half
  EXPECT_NEAR(s.opaque_pixels(), whole_ball / 2.0, 45);
  s.caster.set_box({});
  EXPECT_EQ(s.opaque_pixels(), whole_ball);
}

TEST(VolumeCaster, LabelsTintAndHide) {
  Scene s;
  Labels labels = on_grid_of(s.volume);
  put_label(labels, 3, [](Vec3d p) { return p.x > 0; });
  labels.segments = {{3, "half", {0, 0, 1}, true}};
  s.caster.set_labels(&labels, 1);
  const Picture tinted = s.caster.render(s.view, {}).picture;
  EXPECT_GT(tinted.at(40, 32)[2], tinted.at(40, 32)[0]);
  EXPECT_LT(tinted.at(24, 32)[2], tinted.at(24, 32)[0]);
  const int all = s.opaque_pixels();
  labels.segments[0].visible = false;
  s.caster.set_labels(&labels);
  EXPECT_NEAR(s.opaque_pixels(), all / 2.0, 30);
  s.caster.set_labels(nullptr);
  EXPECT_EQ(s.opaque_pixels(), all);
}

TEST(VolumeCaster, CoarserPicturesShowTheSameAndStopWhenTold) {
  Scene s;
  const Rendered coarse = s.caster.render(s.view, moving_quality());
  EXPECT_EQ(coarse.picture.width, 32);
  int count = 0;
  for (std::size_t i = 3; i < coarse.picture.rgba.size(); i += 4) count += coarse.picture.rgba[i] > 127;
  EXPECT_NEAR(4.0 * count, s.opaque_pixels(), 0.06 * 4 * count);
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(s.caster.render(s.view, {.stop = &stop}).finished);
}

TEST(VolumeCaster, WhatCannotBeShownIsRefused) {
  core::ThreadPool pool(1);
  const Volume flat = made_volume({5, 5, 1}, {1, 1, 1}, [](Vec3d) { return 0; });
  EXPECT_THROW(VolumeCaster(flat, pool), std::invalid_argument);
  Scene s;
  const std::vector<ClipPlane> many(9, ClipPlane{{1, 0, 0}, 0});
  EXPECT_THROW(s.caster.set_planes(many), std::invalid_argument);
}

TEST(VolumeCaster, CellsKnowHowFarTheNextVisibleOneIs) {
  Volume volume = made_volume({80, 80, 80}, {1, 1, 1}, [](Vec3d) { return 0.0; });
  volume.stored[volume.grid.index(40, 40, 40)] = 9;
  core::ThreadPool pool(1);
  const CellRanges ranges = cell_ranges(volume, pool);
  std::vector<std::uint32_t> visible(65537, 0);
  for (std::size_t n = 32769 + 5; n < visible.size(); ++n) visible[n] = std::uint32_t(n - 32769 - 4);
  const auto around = empty_around(ranges, visible);
  const auto at = [&](int i, int j, int k) { return int(around[std::size_t(i + 10 * (j + 10 * k))]); };
  EXPECT_EQ(at(5, 5, 5), 0);
  EXPECT_EQ(at(4, 5, 5), 0);  // between voxels 39 and 40
  EXPECT_EQ(at(7, 5, 5), 2);
  EXPECT_EQ(at(9, 9, 0), 4);
  EXPECT_EQ(at(0, 0, 0), 4);
}

TEST(QualityGovernorTest, PicturesComeWithinTheirTime) {
  QualityGovernor governor(50);
  double cost = 400;  // [ms] at full quality
  const auto took = [&] {
    const Quality q = governor.quality();
    return cost / (q.shrink * q.shrink * q.step) * (q.fine_gradient ? 1 : 0.7);
  };
  for (int i = 0; i < 30; ++i) governor.took(took());
  EXPECT_LT(took(), 50);
  cost = 18;
  for (int i = 0; i < 40; ++i) governor.took(took());
  EXPECT_EQ(governor.quality().shrink, 1);
  EXPECT_TRUE(governor.quality().fine_gradient);
}

TEST(SliceImage, AxialSlicesShowThePatientsLeftOnTheRightAndTheFrontAtTheTop) {
  const Volume volume = made_volume({20, 30, 10}, {1, 1, 2}, [](Vec3d p) { return 10 * p.x - 5 * p.y + 100 * p.z; });
  const SlicePlane plane = axial(volume.grid, {0, 0, 3});
  EXPECT_EQ(plane.width, 20);
  EXPECT_EQ(plane.height, 30);
  const SliceLook look{.centre = 300, .width = 510};  // a grey level is 2 units
  const Picture p = slice_image(volume, nullptr, plane, look);
  for (const auto& [x, y] : {std::pair<int, int>{0, 0}, {19, 0}, {7, 29}}) {
    const Vec3d at = plane.at(x, y);
    EXPECT_NEAR(at.z, 3, 1e-9);
    EXPECT_NEAR(p.at(x, y)[0], (10 * at.x - 5 * at.y + 300 - 45) / 2, 0.8);
  }
  EXPECT_GT(p.at(19, 5)[0], p.at(0, 5)[0]);  // left is brighter
  EXPECT_GT(p.at(5, 0)[0], p.at(5, 29)[0]);  // as the front is
  SliceLook inverted = look;
  inverted.inverted = true;
  EXPECT_NEAR(slice_image(volume, nullptr, plane, inverted).at(3, 3)[0], 255 - p.at(3, 3)[0], 1);
}

TEST(SliceImage, ObliqueSlicesAreOneWithTheAxialOneWhereTheyAreUpright) {
  const Volume volume = made_volume({20, 30, 10}, {1, 1, 2}, [](Vec3d p) { return 10 * p.x - 5 * p.y + 100 * p.z; });
  const SliceLook look{.centre = 0, .width = 1000};
  const SlicePlane a = axial(volume.grid, {1, 2, 3}), b = oblique(volume.grid, {1, 2, 3}, {0, 0, -1}, {0, -1, 0});
  EXPECT_EQ(slice_image(volume, nullptr, a, look).rgba, slice_image(volume, nullptr, b, look).rgba);
  for (const SlicePlane& plane : {coronal(volume.grid, {1, 2, 3}), sagittal(volume.grid, {1, 2, 3}),
                                  oblique(volume.grid, {0, 0, 0}, {1, 1, 1}, {0, 0, 1})}) {
    EXPECT_LT(dot(plane.down, {0, 0, 1}), 0);  // the head is up
    const Picture p = slice_image(volume, nullptr, plane, look);
    const int x = plane.width / 2, y = plane.height / 2;
    const Vec3d at = plane.at(x, y);
    EXPECT_NEAR(p.at(x, y)[0], std::clamp((10 * at.x - 5 * at.y + 100 * at.z + 500) * 0.255, 0.0, 255.0), 1);
  }
  EXPECT_EQ(across_axis(volume.grid, 2, 4).width, 20);
  EXPECT_EQ(across_axis(volume.grid, 0, 4).height, 19);
  EXPECT_THROW(oblique(volume.grid, {}, {0, 0, 1}, {0, 0, 1}), std::invalid_argument);
}

TEST(SliceImage, LabelsLieOverTheSliceWithTheirOutlines) {
  const Volume volume = made_volume({20, 20, 4}, {1, 1, 1}, [](Vec3d) { return 0.0; });
  Labels labels = on_grid_of(volume);
  put_label(labels, 2, [](Vec3d p) { return std::hypot(p.x, p.y) < 6; });
  labels.segments = {{2, "disc", {1, 0, 0}, true}};
  const SlicePlane plane = axial(volume.grid, {0, 0, 0});
  const Picture p = slice_image(volume, &labels, plane, {.centre = 0, .width = 400, .label_opacity = 0.4});
  EXPECT_NEAR(p.at(10, 10)[0], 128 + 0.4 * 127, 1);
  EXPECT_NEAR(p.at(10, 10)[1], 128 * 0.6, 1);
  EXPECT_NEAR(p.at(4, 10)[1], 128 * 0.2, 1);  // the outline
  EXPECT_NEAR(p.at(1, 1)[0], 127.5, 0.6);
  labels.segments[0].visible = false;
  EXPECT_NEAR(slice_image(volume, &labels, plane, {.centre = 0, .width = 400}).at(10, 10)[0], 127.5, 0.6);
}

}  // namespace trocar::volumes
