#include <gtest/gtest.h>

#include <trocar/geometry/figure/figure.hpp>

namespace trocar::geometry {
namespace {

TEST(Figure, UmbilicusIsTheOriginWhateverTheSizesAre) {
  for (const FigureSizes& sizes :
       {FigureSizes{}, FigureSizes{.stature = 1.9, .breadth = 0.42, .depth = 0.28, .rise = 0.05},
        FigureSizes{.stature = 1.5, .breadth = 0.28, .depth = 0.17, .rise = 0}}) {
    const Figure f(sizes);
    EXPECT_NEAR(f.front(0, 0), 0, 1e-12);
    EXPECT_NEAR(2 * f.section(0).half, sizes.breadth, 1e-12);
    EXPECT_NEAR(f.section(0).back, -sizes.depth, 1e-12);
    EXPECT_NEAR(f.crown() - f.soles(), sizes.stature, 0.06 * sizes.stature);  // heels and toes are not where soles are
  }
}

TEST(Figure, GasLiftsTheAbdomenAndNotTheChest) {
  const Figure flat({.depth = 0.175, .rise = 0}), full({.depth = 0.205, .rise = 0.03});
  const auto over_back = [](const Figure& f, double y) { return f.front(0, y) - f.section(y).back; };
  EXPECT_NEAR(over_back(full, 0) - over_back(flat, 0), 0.03, 1e-9);
  EXPECT_NEAR(over_back(full, 0.32), over_back(flat, 0.32), 1e-9);
}

TEST(Figure, PortsOfTheShippedScenesAreInItsSkin) {
  const Figure f;
  for (const Vec3d p : {Vec3d{0, -0.01, 0}, Vec3d{-0.015, 0.125, 0}, Vec3d{-0.08, 0.075, -0.01},
                        Vec3d{-0.135, 0.015, -0.045}, Vec3d{0.105, -0.075, -0.015}, Vec3d{0, -0.13, -0.005}})
    EXPECT_NEAR(f.front(p.x, p.y), p.z, 0.012) << p.x << " " << p.y;
}

TEST(Figure, DistanceIsNoughtOnTheSkinAndGrowsAlongItsNormal) {
  const Figure f;
  for (double x = -0.12; x <= 0.121; x += 0.04)
    for (double y = -0.12; y <= 0.241; y += 0.06) {
      const Vec3d p{x, y, f.front(x, y)}, n = f.normal(x, y);
      EXPECT_NEAR(f.trunk_distance(p), 0, 1e-9);
      EXPECT_NEAR(f.trunk_distance(p + 0.02 * n), 0.02, 0.004) << x << " " << y;
      EXPECT_NEAR(f.trunk_distance(p - 0.01 * n), -0.01, 0.003) << x << " " << y;
    }
}

TEST(Figure, ALimbIsAsFarAsItsTaperedRodSays) {
  const Limb limb{{0, 0, 0}, {0, 0, 1}, 0.1, 0.2};
  EXPECT_NEAR(distance(limb, {0.5, 0, 0.5}), 0.5 - 0.15, 1e-12);
  EXPECT_NEAR(distance(limb, {0, 0, -0.3}), 0.2, 1e-12);
  EXPECT_NEAR(distance(limb, {0, 0, 1.1}), -0.1, 1e-12);
}

}  // namespace
}  // namespace trocar::geometry
