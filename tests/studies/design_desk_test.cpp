// A mechanism whose dimensions are turned by hand.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/files.hpp>
#include <trocar/studies/design_desk.hpp>
#include <trocar/studies/optimise.hpp>

#include "shipped.hpp"

namespace trocar::studies {
namespace {

std::filesystem::path shipped_file(const std::string& name) {
  return scene::found_scenes_folder().value() / "mechanisms" / (name + ".json");
}
kinematics::MechanismDescription described(const std::string& name) {
  return scene::read_mechanism(shipped_file(name));
}

const DesignDesk::Dial& dial(const DesignDesk& desk, const std::string& name) {
  for (const DesignDesk::Dial& d : desk.dials())
    if (desk.mechanism().parameters[std::size_t(d.parameter)].name == name) return d;
  throw std::invalid_argument(name);
}

TEST(DesignDesk, EveryShippedMechanismStandsOnItAndIsLedFromEndToEnd) {
  for (const auto& entry : std::filesystem::directory_iterator(shipped_file("").parent_path())) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().stem().string());
    DesignDesk desk(scene::read_mechanism(entry.path()));
    EXPECT_TRUE(desk.closed()) << desk.words();
    for (std::size_t l = 0; l < desk.leads().size(); ++l)
      for (const double to : {0.25, 0.5, 0.75}) {
        desk.lead(l, to);
        EXPECT_NEAR(desk.handle(l), to, 1e-12);
      }
  }
}

TEST(DesignDesk, TheCollidingGraspersGapFollowsItsDialsAsTheStudySays) {
  DesignDesk desk(described("colliding_grasper"));
  ASSERT_TRUE(desk.clearance().has_value());
  const double before = desk.clearance()->least;
  EXPECT_LT(before, 0) << "it is drawn with a fault";
  desk.turn(dial(desk, "tang"), 0.0018);
  const double after = desk.clearance()->least;
  EXPECT_NE(before, after);
  const ClearanceReport study =
      clearance_over_motion(desk.mechanism(), {DesignDesk::kPathSteps, 200, false, false, {}});
  EXPECT_EQ(study.least, after);
}

TEST(DesignDesk, ADialGoesAsFarAsItsFileSaysAndAboutItsValueWhereItSaysNothing) {
  DesignDesk desk(described("colliding_grasper"));
  desk.turn(dial(desk, "tang"), 1);
  EXPECT_DOUBLE_EQ(desk.value(dial(desk, "tang")), 0.0032);
  EXPECT_FALSE(dial(desk, "jaw").bounded);
  desk.turn(dial(desk, "jaw"), 1);
  EXPECT_DOUBLE_EQ(desk.value(dial(desk, "jaw")), 0.024);
}

TEST(DesignDesk, WhatIsTurnedIsTakenBackStepByStepAndBroughtBack) {
  DesignDesk desk(described("colliding_grasper"));
  const std::vector<double> start = desk.values();
  const std::vector<Vec3d> places = [&] {
    std::vector<Vec3d> all;
    for (const kinematics::Frame& f : desk.pose().frames) all.push_back(f.p);
    return all;
  }();
  for (const double value : {0.0024, 0.0022, 0.0020}) desk.turn(dial(desk, "tang"), value);
  desk.keep();  // one drag
  desk.turn(dial(desk, "bar"), 0.0065);
  desk.keep();
  const std::vector<double> end = desk.values();
  desk.undo();
  EXPECT_DOUBLE_EQ(desk.value(dial(desk, "tang")), 0.0020);
  desk.undo();
  EXPECT_EQ(desk.values(), start);
  EXPECT_FALSE(desk.can_undo());
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(length(desk.pose().frames[i].p - places[i]), 0, 1e-10);
  desk.redo(), desk.redo();
  EXPECT_EQ(desk.values(), end);
  desk.reset();
  EXPECT_FALSE(desk.changed());
  desk.undo();
  EXPECT_EQ(desk.values(), end);
}

TEST(DesignDesk, WhatCannotCloseIsToldAndComesBackWhenItCan) {
  DesignDesk desk(described("four_bar"));
  bool opened = false;
  for (const DesignDesk::Dial& d : desk.dials()) {
    desk.turn(d, d.low);
    opened |= !desk.closed();
    desk.turn(d, desk.value_in_file(d));
    EXPECT_TRUE(desk.closed()) << desk.words();
  }
  for (const DesignDesk::Dial& d : desk.dials()) desk.turn(d, d.low);
  for (const DesignDesk::Dial& d : desk.dials()) desk.turn(d, desk.value_in_file(d));
  EXPECT_TRUE(desk.closed()) << desk.words();
}

TEST(DesignDesk, AFramesPathIsWhereTheDriveBringsIt) {
  DesignDesk desk(described("slider_crank"));
  ASSERT_FALSE(desk.mechanism().frames.empty());
  desk.lead(0, 0.4);
  const std::vector<Vec3d> path = desk.path(0);
  ASSERT_GT(path.size(), 10u);
  const Vec3d now = kinematics::place(desk.mechanism().frames[0], desk.pose()).p;
  double nearest = 1;
  for (const Vec3d& p : path) nearest = std::min(nearest, length(p - now));
  EXPECT_LT(nearest, 1e-9) << "0.4 is one of its steps";
}

TEST(MechanismText, AnOptimisedMechanismIsWrittenAndReadAgainAsTheSame) {
  const std::string text = core::read_file(shipped_file("colliding_grasper"), 1 << 20);
  const kinematics::Mechanism m = shipped("colliding_grasper");
  EXPECT_EQ(scene::mechanism_text_with(text, m.parameter_values), text) << "nothing is changed, nothing is written";
  const OptimiseResult r = optimise(m, {.clearance = 1e-4});
  const std::string written = scene::mechanism_text_with(text, r.values);
  std::vector<core::Fault> faults;
  const kinematics::Mechanism again = kinematics::build(scene::parse_mechanism(written, "written.json", faults));
  ASSERT_TRUE(faults.empty());
  for (int i = 0; i < m.named_parameters; ++i)
    EXPECT_NEAR(again.parameter_values[std::size_t(i)], r.values[std::size_t(i)], 1e-8) << i;
  EXPECT_GT(clearance_over_motion(again, {}).least, 0) << "as written it is free of its fault";
  EXPECT_NE(written.find("elbow collides with the shaft"), std::string::npos)
      << "the rest stays as its author wrote it";
}

}  // namespace
}  // namespace trocar::studies
