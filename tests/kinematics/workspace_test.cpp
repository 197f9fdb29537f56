#include <cmath>

#include <gtest/gtest.h>

#include <trocar/kinematics/inverse/workspace.hpp>

#include "linkages.hpp"

namespace trocar::kinematics {
namespace {

TEST(Workspace, OfASphericalArmIsItsShellOfAHemisphere) {
  // pan all round, tilt from the horizontal to the top, a slide from 0.2 to 0.3 m
  MechanismDescription d;
  d.links = {link_of("pan", "ground", JointKind::revolute, {}),
             link_of("tilt", "pan", JointKind::revolute, {}, {0, -1, 0}),
             link_of("slide", "tilt", JointKind::prismatic, {}, {1, 0, 0}, 0.25)};
  d.links[0].joint.limits = {-portable::pi, portable::pi};
  d.links[1].joint.limits = {0, portable::pi / 2};
  d.links[2].joint.limits = {0.2, 0.3};
  d.frames = {{"tip", "slide", {}}};
  const Mechanism m = build(d);
  const WorkspaceOptions options{400'000, 0.01, 1};
  const Workspace w = workspace(m, m.frames[0], options);
  const double shell = 2 * portable::pi / 3 * (0.027 - 0.008);
  EXPECT_EQ(w.within, w.samples);
  EXPECT_GT(w.volume, shell) << "cells at the border count whole";
  EXPECT_LT(w.volume, 1.25 * shell);
  EXPECT_GT(w.volume_of_half, 0.95 * w.volume) << "settled";
  EXPECT_NEAR(w.high.z, 0.3, 1e-3);
  EXPECT_NEAR(w.low.z, 0, 1e-3);
}

TEST(Workspace, OfALinkageWithOneDriveIsTheWayOfItsTip) {
  MechanismDescription d = four_bar(0.020, 0.050, 0.045, 0.055, 0.3, 0.5, 1.5);
  d.frames = {{"crank_pin", "coupler", {}}};
  const Mechanism m = build(d);
  const Workspace w = workspace(m, m.frames[0], {1000, 0, 1});
  EXPECT_NEAR(w.path, portable::two_pi * 0.02, 1e-6) << "a circle";
  EXPECT_EQ(w.closed, w.samples);
}

TEST(Workspace, LeavesOutWhatDoesNotCloseOrIsBeyondLimits) {
  MechanismDescription d = four_bar(0.020, 0.050, 0.045, 0.055, 0.3, 0.5, 1.5);
  d.links[2].joint.limits = {0, 1.7};
  d.frames = {{"knee", "rocker", at(0.045)}};
  const Mechanism m = build(d);
  const Workspace w = workspace(m, m.frames[0], {1000, 0, 1});
  EXPECT_EQ(w.closed, w.samples);
  EXPECT_LT(w.within, w.closed);
  EXPECT_GT(w.within, 0);
}

}  // namespace
}  // namespace trocar::kinematics
