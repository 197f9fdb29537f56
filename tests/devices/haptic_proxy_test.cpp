#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/haptics/local_model.hpp>

using namespace trocar;
using devices::ContactPlane;
using devices::nearest_allowed;

namespace {

double uniform(core::Random& random) { return random.uniform(-1, 1); }
Vec3d anywhere(core::Random& random) {
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

double least_above(Vec3d x, std::span<const ContactPlane> planes) {
  double least = 1e9;
  for (const ContactPlane& p : planes) least = std::min(least, dot(p.normal, x - p.point));
  return least;
}

/// Dykstra's alternating projections: another way to the same place.
Vec3d by_projections(Vec3d p, std::span<const ContactPlane> planes) {
  std::array<Vec3d, 3> carried{};
  Vec3d x = p;
  for (int round = 0; round < 20000; ++round)
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const Vec3d y = x + carried[i];
      const double above = dot(planes[i].normal, y - planes[i].point);
      x = above < 0 ? y - above * planes[i].normal : y;
      carried[i] = y - x;
    }
  return x;
}

}  // namespace

TEST(GodObject, IsThePointItselfWhereNothingIsTouched) {
  const ContactPlane floor{{0, 0, 0}, {0, 0, 1}};
  const Vec3d p{0.01, 0.02, 0.001};
  EXPECT_EQ(nearest_allowed(p, {&floor, 1}), p);
  EXPECT_EQ(nearest_allowed(p, {}), p);
}

TEST(GodObject, IsTheFootOnOnePlaneTheLineOfTwoAndTheCornerOfThree) {
  const ContactPlane box[3] = {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 0, 1}}};
  EXPECT_EQ(nearest_allowed({1, 2, -3}, box), (Vec3d{1, 2, 0}));
  EXPECT_EQ(nearest_allowed({1, -2, -3}, box), (Vec3d{1, 0, 0}));
  EXPECT_LT(length(nearest_allowed({-1, -2, -3}, box)), 1e-15);
}

TEST(GodObject, IsWhereAlternatingProjectionsArriveForAnyThreePlanes) {
  core::Random random(5);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    ContactPlane planes[3];
    for (ContactPlane& plane : planes) plane = {0.3 * anywhere(random), normalised(anywhere(random))};
    const Vec3d p = anywhere(random), x = nearest_allowed(p, planes);
    const double det = dot(planes[0].normal, cross(planes[1].normal, planes[2].normal));
    if (std::fabs(det) < 0.2) continue;  // projections need too many rounds
    EXPECT_GE(least_above(x, planes), -1e-9);
    EXPECT_LT(length(x - by_projections(p, planes)), 1e-6) << trial;
    ++compared;
  }
  EXPECT_GT(compared, 25);
}

TEST(GodObject, StaysFiniteWhereItsPlanesAreParallelOrLeaveNoRoom) {
  const ContactPlane twice[3] = {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1e-3}, {0, 0, 1}}};
  EXPECT_LT(length(nearest_allowed({0, 0, -1}, twice) - Vec3d{0, 0, 1e-3}), 1e-12);
  const ContactPlane gap[2] = {{{0, 0, 0.1}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}};
  EXPECT_TRUE(finite(nearest_allowed({0, 0, 0.05}, gap)));
}

TEST(HandFrame, ForcesDoTheSameWorkAtTheDeviceAsInSpace) {
  core::Random random(3);
  devices::HandFrame frame;
  frame.axes = to_mat3(normalised(Quatd{uniform(random), uniform(random), uniform(random), uniform(random)}));
  frame.centre = anywhere(random);
  frame.middle = anywhere(random);
  frame.scale = 1.7;
  const Vec3d at = anywhere(random), way = 1e-3 * anywhere(random), force = anywhere(random);
  const double in_space = dot(force, frame.to_space(at + way) - frame.to_space(at));
  EXPECT_NEAR(dot(frame.force_on_device(force), way), in_space, 1e-15);
  EXPECT_LT(length(frame.to_device(frame.to_space(at)) - at), 1e-14);
}
