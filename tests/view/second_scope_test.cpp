// A second endoscope: through a place of the abdominal wall that nobody uses, aimed by hand, with its own picture.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/view/scene/second_scope.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

TEST(SecondScope, StandsWhereNoOtherTrocarIsAndLooksAtTheScene) {
  const SecondScope second = second_scope_of(pelvis());
  EXPECT_GT(length(second.port - pelvis().scope.port), 0.03);
  for (const sim::HandModel& h : pelvis().hands) EXPECT_GT(length(second.port - h.port), 0.03) << h.name;
  const kinematics::ScopeFrame frame = scope_frame(second.port, second.pose, 0, 0);
  const Vec3d to_middle = normalised(orbit_around(pelvis()).target - frame.eye);
  EXPECT_GT(dot(frame.forward, to_middle), 0.98);
}

TEST(SecondScope, LooksToWhereItIsAimedAndStaysInItsTrocar) {
  SecondScope second = second_scope_of(pelvis());
  const kinematics::ScopeFrame before = scope_frame(second.port, second.pose, 0, 0);
  const Vec3d port = second.port;
  aim(second, 0.1, 0);
  EXPECT_NEAR(dot(scope_frame(second.port, second.pose, 0, 0).forward, before.right), 0.1, 0.01);
  aim(second, 0, 0.1);
  EXPECT_GT(dot(scope_frame(second.port, second.pose, 0, 0).forward, before.up), 0.09);
  advance(second, 10);
  EXPECT_LE(second.pose.depth, 0.2) << "not out at the back";
  advance(second, -10);
  EXPECT_GE(second.pose.depth, 0.02) << "nor out of its trocar";
  for (int i = 0; i < 100; ++i) aim(second, 0.3, 0.2);
  EXPECT_TRUE(std::isfinite(second.pose.yaw) && std::isfinite(second.pose.pitch));
  EXPECT_EQ(length(second.port - port), 0);
}

TEST(SecondScope, SeesTheFirstOneAndIsSeenFromOutside) {
  const auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  const sim::State state = sim::initial_state(pelvis());
  const SecondScope second = second_scope_of(pelvis());
  const auto scopes_in = [&](const ViewOptions& options) {
    std::size_t scopes = 0;
    const auto& parts = view.parts();
    for (const render::DrawItem& i : view.frame(state, options).items)
      scopes += i.part > 0 && parts[i.part - std::size_t(1)].name == "endoscope";
    return scopes;
  };
  ViewOptions outside;
  outside.camera = ViewOptions::Camera::outside;
  const std::size_t one = scopes_in(outside);
  EXPECT_GT(one, 0u);
  EXPECT_EQ(scopes_in({}), 0u) << "nobody sees what he looks through";
  EXPECT_EQ(scopes_in(view_through(second)), one);
  outside.second_scope = second;
  EXPECT_EQ(scopes_in(outside), 2 * one);
}

TEST(SecondScope, HasALampOfItsOwnBesideItsEye) {
  const auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  const SecondScope second = second_scope_of(pelvis());
  const render::Frame frame = view.frame(sim::initial_state(pelvis()), view_through(second));
  EXPECT_TRUE(frame.light.inverse_square);
  EXPECT_LT(length(frame.light.position), 0.01f);
  EXPECT_NEAR(length(vec_cast<double>(frame.camera.position) - scope_frame(second.port, second.pose, 0, 0).eye), 0,
              1e-6);
}

}  // namespace
}  // namespace trocar::view
