#include <cmath>

#include <gtest/gtest.h>

#include <trocar/view/operating_room/room_drawing.hpp>

namespace trocar::view {
namespace {

kinematics::Mechanism one_link() {
  kinematics::MechanismDescription d;
  d.name = "one";
  kinematics::Link link;
  link.name = "rod";
  link.joint.kind = kinematics::JointKind::revolute;
  kinematics::Shape shape;
  shape.to[0].constant = 0.3;
  shape.radius.constant = 0.02;
  link.shapes.push_back(shape);
  d.links.push_back(link);
  return kinematics::build(d);
}

TEST(RoomDrawing, IsOfSoundMeshesAndFollowsTheTable) {
  const kinematics::Mechanism m = one_link();
  kinematics::Pose pose(m);
  kinematics::forward(m, m.start_u(), pose);
  Scenery s;
  s.ports.push_back({{0, 0, 0}, {0, 0, 1}, 0.005});
  s.instruments.push_back({{0, 0.05, -0.1}, {0, -0.1, 0.2}, 0.005, true});
  s.monitors.push_back({{-1, 0.5, 0.5}, {0.3, 0.02, 0.2}, Mat3d::identity()});
  Scenery::Person someone;
  someone.facing = {-1, 0, 0};
  someone.foot = {0.5, 0, -1};
  for (int side = 0; side < 2; ++side) {
    someone.shoulder[side] = {0.5, side ? 0.2 : -0.2, 0.4};
    someone.elbow[side] = {0.4, side ? 0.2 : -0.2, 0.2};
    someone.hand[side] = {0.2, 0, 0.2};
  }
  s.people.push_back(someone);
  s.arms.push_back({&m, &pose, {}, {0.5, 0.5, -1}, {0.5, 0.5, 0.2}, {0.3, 0.3, 0.2}, false});
  s.cones.push_back({{0, 0, 0}, {0, 0, 1}, 1.0, 0.2, {80, 80, 200, 90}});
  const auto backend = render::make_null_backend();
  RoomDrawing drawing(*backend, s);
  const render::Frame level = drawing.frame({});
  render::draw_frame(*backend, level, render::Target::off_screen(320, 200));  // refuses what is not finite
  EXPECT_GT(backend->stats().triangles, 50'000u);
  const std::uint32_t alive = backend->stats().meshes_alive;
  s.table.r = kinematics::turn_about({1, 0, 0}, -0.3);
  drawing.move(s);
  const render::Frame tilted = drawing.frame({});
  render::draw_frame(*backend, tilted, render::Target::off_screen(320, 200));
  EXPECT_EQ(backend->stats().meshes_alive, alive) << "nothing is left behind";
  int moved = 0;
  for (std::size_t k = 0; k < level.items.size(); ++k)
    moved += !(level.items[k].transform == tilted.items[k].transform);
  EXPECT_GT(moved, 4);
  EXPECT_LT(moved, int(level.items.size())) << "floor and people stay";
}

TEST(RoomDrawing, HeatIsPaintedOnTheSkinOnly) {
  Scenery s;
  const auto triangles = [&] {
    const auto backend = render::make_null_backend();
    RoomDrawing drawing(*backend, s);
    render::draw_frame(*backend, drawing.frame({}), render::Target::off_screen(64, 64));
    return backend->stats().triangles;
  };
  const auto bare = triangles();
  s.heat = {{0, 0.05, 1}, {0.04, 0.05, 0.2}};
  EXPECT_EQ(triangles(), bare);
}

TEST(UprightOrbit, KeepsItsDistanceWhileItTurnsAndStaysAboveTheFloor) {
  UprightOrbit o;
  for (int k = 0; k < 50; ++k) o.turn(0.3, -0.1);
  EXPECT_NEAR(length(o.eye() - o.target), o.distance, 1e-12);
  EXPECT_GE(o.pitch, -0.15);
  o.zoom(1e6);
  EXPECT_LE(o.distance, 6);
}

}  // namespace
}  // namespace trocar::view
