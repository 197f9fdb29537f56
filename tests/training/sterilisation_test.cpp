// How the sterilisation begins: outside the pelvis, with an oblique endoscope, and what it takes to see into it.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/surgeon/camera_hand.hpp>

namespace trocar::training {
namespace {

const Exercise& exercise() {
  static const Exercise read = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  return read;
}
const sim::Model& model() {
  static const sim::Model made = scene::compile(scene::read_scene(exercise().scene));
  return made;
}

TEST(Sterilisation, WhoDoesNotMoveTheEndoscopeMakesNoSurvey) {
  const sim::Model& m = model();
  Monitor monitor(exercise(), m);
  sim::State s = sim::initial_state(m);
  sim::Work w = sim::make_work(m);
  for (int t = 0; t < 2500; ++t) {
    const sim::StepReport report = step(m, m.start, s, w);
    ASSERT_TRUE(report.fine());
    monitor.update(m, s, report);
  }
  EXPECT_FALSE(monitor.steps().front().done);
  EXPECT_TRUE(monitor.errors().empty());
  const double organ = exercise().limit("organ_share", 0);
  for (const char* mark : {"uterus", "ovary_left", "ovary_right"})
    EXPECT_LT(visible_share(m, s, m.target_index(mark)), 0.5 * organ) << mark;
  for (const char* mark : {"tube_left.trace", "tube_right.trace"})
    EXPECT_LT(visible_share(m, s, m.target_index(mark)), 0.25) << mark;
}

TEST(Sterilisation, WhatIsNeededForBleedingIsInTheRacks) {
  for (const char* name : {"suction_irrigator", "hook", "bipolar"}) {
    int racks = 0;
    for (const sim::HandModel& hand : model().hands) racks += hand.find(name) >= 0;
    EXPECT_GE(racks, 2) << name;
  }
  EXPECT_TRUE(model().vessels.there() && model().wet.there && model().energy.there);
}

/// Where the lens is and where it looks, after so long [s] of showing these points.
kinematics::ScopeFrame shown(std::initializer_list<Vec3d> points, double seconds) {
  CameraHand camera(model());
  sim::Input input = model().start;
  for (int t = 0; t < int(1000 * seconds); ++t) camera.show({points.begin(), points.size()}, 0.06);
  camera.fill(input);
  EXPECT_TRUE(camera.settled());
  const sim::ScopeInput& s = input.scope;
  return kinematics::scope_frame(model().scope.port, {s.yaw, s.pitch, s.roll, s.depth}, model().scope.angle, s.post);
}

TEST(ObliqueCamera, BringsAPlaceIntoThePicturesMiddle) {
  for (const Vec3d at : {Vec3d{0.022, -0.157, -0.092}, Vec3d{-0.033, -0.149, -0.107}, Vec3d{0, -0.17, -0.11}}) {
    const kinematics::ScopeFrame frame = shown({at}, 8);
    const Vec3d way = at - frame.eye;
    EXPECT_GT(dot(normalised(way), frame.forward), 0.999) << at.x;
    EXPECT_LT(length(way), 0.08) << at.x << ", as near as it can go";
    EXPECT_GT(frame.up.z, 0) << "the right way up";
  }
}

TEST(ObliqueCamera, StandsBackUntilAllIsInThePicture) {
  const std::initializer_list<Vec3d> all{{0, -0.17, -0.11}, {0.045, -0.14, -0.11}, {-0.045, -0.14, -0.11}};
  const kinematics::ScopeFrame frame = shown(all, 8);
  for (const Vec3d& p : all)
    EXPECT_GT(dot(normalised(p - frame.eye), frame.forward), std::cos(0.5 * model().scope.field_of_view)) << p.x;
}

}  // namespace
}  // namespace trocar::training
