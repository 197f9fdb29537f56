// Mechanisms in instruments: the table of a linkage, the chain of a wrist, and what is wrong with either.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/instrument/linkage_works.hpp>
#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/mechanisms/instrument_mechanism.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

using interactions::kLinkageSteps;

Instrument with_linkage(const std::string& mechanism) {
  Instrument i;
  i.linkage.file = mechanism + ".json";
  i.linkage.description = std::make_shared<const kinematics::MechanismDescription>(
      read_mechanism(TROCAR_SOURCE_DIR "/scenes/mechanisms/" + i.linkage.file));
  i.linkage.at = {"grasper.json", 7, 3};
  return i;
}

interactions::ToolModel taken(const Instrument& i) {
  interactions::ToolModel tool;
  std::vector<core::Fault> faults;
  take_linkage(i, tool, faults);
  EXPECT_TRUE(faults.empty()) << faults.front().message;
  return tool;
}

/// Of the claw grasper: where its rod stands with a jaw at an angle, by its triangle of tang, bar and rod, and how fast
/// it goes there.
constexpr double kTang = 2.5, kBar = 4.5, kTangAngle = 25 * portable::pi / 180;
double rod_at(double jaw) {
  const double turn = jaw + kTangAngle, across = kTang * std::sin(turn);
  return kTang * std::cos(turn) + std::sqrt(kBar * kBar - across * across);
}
double rod_slope(double jaw) {
  const double turn = jaw + kTangAngle, across = kTang * std::sin(turn);
  return -across - across * kTang * std::cos(turn) / std::sqrt(kBar * kBar - across * across);
}

TEST(InstrumentMechanism, ALinkagesTableIsTheWayOfItsTriangleAndItsLeverageThatOfVirtualWork) {
  const interactions::ToolModel tool = taken(with_linkage("claw_grasper"));
  ASSERT_TRUE(tool.linkage.there);
  EXPECT_NEAR(tool.opening, 60 * portable::pi / 180, 1e-5);
  for (int k = 0; k <= kLinkageSteps; ++k) {
    const double rod = 5.440958 + double(k) / kLinkageSteps * (6.639979 - 5.440958);
    const double jaw = 0.5 * tool.opening * tool.linkage.aperture[k];
    EXPECT_NEAR(rod_at(jaw), rod, 1e-5) << k << " [mm]";
    // Force of the rod times its way is force between the jaws times theirs.
    EXPECT_NEAR(tool.linkage.leverage[k], rod_slope(jaw) / rod_slope(0), 1e-6) << k;
  }
  EXPECT_EQ(tool.linkage.aperture[0], 1);
  EXPECT_EQ(tool.linkage.aperture[kLinkageSteps], 0);
}

TEST(InstrumentMechanism, EveryShippedLinkageClosesItsJawsOneWayAndItsTableInverts) {
  for (const char* name :
       {"grasper", "claw_grasper", "maryland", "scissors", "curved_scissors", "bipolar", "needle_holder"}) {
    const interactions::LinkageModel l = taken(with_linkage(name)).linkage;
    for (int k = 0; k < kLinkageSteps; ++k) EXPECT_GT(l.aperture[k], l.aperture[k + 1]) << name;
    for (int i = 0; i <= 1000; ++i) {
      const double handle = i / 1000.0;
      EXPECT_NEAR(handle_of(l, aperture_of(l, handle)), handle, 1e-12) << name;
    }
    EXPECT_GT(*std::min_element(std::begin(l.leverage), std::end(l.leverage)), 0) << name;
    EXPECT_NEAR(leverage_at(l, 0), 1, 1e-12) << name;
  }
}

TEST(InstrumentMechanism, ParallelJawsOpenByTheirGap) {
  Instrument i = with_linkage("clip_applier");
  i.parallel_gap = 0.006;
  i.opening = 0;
  const interactions::ToolModel tool = taken(i);
  EXPECT_TRUE(tool.linkage.there);
  for (int k = 0; k < kLinkageSteps; ++k) EXPECT_GT(tool.linkage.aperture[k], tool.linkage.aperture[k + 1]);
}

TEST(InstrumentMechanism, ACamOfTheHandleLikeTheJawsOwnMakesTheirWayTheHandlesToTheBit) {
  struct Case {
    const char* name;
    double opening_deg, gap;
  };
  for (const Case& c : {Case{"cam_grasper", 60, 0}, Case{"cam_maryland", 50, 0}, Case{"cam_scissors", 45, 0},
                        Case{"cam_bipolar", 50, 0}, Case{"cam_clip_applier", 0, 0.006}}) {
    Instrument i = with_linkage(c.name);
    i.parallel_gap = c.gap;
    if (c.gap > 0) i.opening = 0;
    const interactions::ToolModel tool = taken(i);
    EXPECT_FALSE(tool.linkage.there) << c.name << ": nothing is to be computed";
    if (!(c.gap > 0)) {
      EXPECT_EQ(tool.opening, c.opening_deg * portable::pi / 180) << c.name << ": as opening_deg would be read";
    }
    ASSERT_TRUE(tool.works) << c.name;
    EXPECT_GE(tool.works->parts.size(), 1u) << c.name;
    EXPECT_EQ(tool.works->tails.size() % 2, 0u) << c.name;
  }
}

TEST(InstrumentMechanism, ASlingsRodIsTheHandlesWayWhateverItsPulleysRatio) {
  for (const double ratio : {0.5, 1.5, 3.0}) {
    Instrument i = with_linkage("endoloop");
    i.kind = interactions::ToolKind::endoloop;
    kinematics::MechanismDescription changed = *i.linkage.description;
    ASSERT_EQ(changed.parameters.at(0).name, "ratio");
    changed.parameters[0].value = ratio;
    i.linkage.description = std::make_shared<const kinematics::MechanismDescription>(changed);
    EXPECT_FALSE(taken(i).linkage.there) << ratio << ": nothing is to be computed";
  }
}

TEST(InstrumentMechanism, WhatIsDrawnOfALinkageStandsWhereItsMechanismHasIt) {
  const interactions::ToolModel tool = taken([] {
    Instrument i = with_linkage("claw_grasper");
    i.jaw_length = 0.020;
    return i;
  }());
  ASSERT_TRUE(tool.works);
  const interactions::LinkageWorks& works = *tool.works;
  ASSERT_EQ(works.parts.size(), 3u) << "the rod and two bars";
  ASSERT_EQ(works.tails.size(), 2u);
  EXPECT_NEAR(works.shaft_end, 0.014, 1e-12);
  for (const double handle : {0.0, 0.3, 0.5, 1.0}) {
    const double jaw = 0.5 * tool.opening * aperture_of(tool.linkage, handle);
    const kinematics::Frame rod = at_handle(works.parts[0], handle);
    EXPECT_NEAR(rod.p.z, -1e-3 * (5.440958 + handle * (6.639979 - 5.440958)), 1e-8) << "z goes ahead";
    for (int bar = 0; bar < 2; ++bar) {  // from the rod's pin to the jaw's tang
      const kinematics::Frame at = at_handle(works.parts[std::size_t(1 + bar)], handle);
      const interactions::WorksRod& r = works.parts[std::size_t(1 + bar)].rods.at(0);
      const Vec3d from = at * r.a, to = at * r.b;
      EXPECT_NEAR(from.z, rod.p.z, 1e-9);
      EXPECT_NEAR(from.x, 0, 1e-9);
      const Vec3d tang = works.tails[std::size_t(bar)].closed;
      const double side = works.tails[std::size_t(bar)].jaw == 0 ? 1 : -1, turn = side * jaw;
      // jaws turn about y; a tang behind the hinge goes to the other side than the tip
      const Vec3d turned{std::cos(turn) * tang.x + std::sin(turn) * tang.z, 0,
                         std::cos(turn) * tang.z - std::sin(turn) * tang.x};
      EXPECT_NEAR(to.x, turned.x, 2e-6) << handle << ' ' << bar;
      EXPECT_NEAR(to.z, turned.z, 2e-6) << handle << ' ' << bar;
    }
  }
}

TEST(InstrumentMechanism, WithoutOneTheHandleOpensAsItDid) {
  const interactions::LinkageModel none;
  for (int i = 0; i <= 100; ++i) EXPECT_EQ(aperture_of(none, i / 100.0), 1.0 - i / 100.0);
  EXPECT_EQ(leverage_at(none, 0.4), 1);
}

std::string fault_of(const Instrument& i) {
  interactions::ToolModel tool;
  std::vector<core::Fault> faults;
  take_linkage(i, tool, faults);
  EXPECT_FALSE(tool.linkage.there);
  if (faults.size() != 1) return "not one";
  EXPECT_EQ(faults[0].at.line, 7);
  return faults[0].message;
}

TEST(InstrumentMechanism, WhatDoesNotCloseIsALocatedFault) {
  Instrument i = with_linkage("claw_grasper");
  kinematics::MechanismDescription d = *i.linkage.description;
  d.actuators[0].at_1.constant = 0.0080;  // farther than tang and bar are long together
  i.linkage.description = std::make_shared<const kinematics::MechanismDescription>(d);
  EXPECT_NE(fault_of(i).find("closes the jaws over the handle's whole range"), std::string::npos) << fault_of(i);
  d.actuators[0].at_1.constant = 0.0062;
  i.linkage.description = std::make_shared<const kinematics::MechanismDescription>(d);
  EXPECT_NE(fault_of(i).find("jaws that meet"), std::string::npos) << fault_of(i);
  i = with_linkage("claw_grasper");
  i.handle = "trigger";
  EXPECT_NE(fault_of(i).find("actuator 'trigger', got handle"), std::string::npos) << fault_of(i);
  EXPECT_NE(fault_of(with_linkage("flexible_instrument")).find("tip_upper"), std::string::npos);
}

Instrument with_chain(const std::string& mechanism, double jaw) {
  Instrument i;
  i.jaw_length = jaw;
  i.wrist.there = true;
  i.wrist.mechanism.file = mechanism + ".json";
  i.wrist.mechanism.description = std::make_shared<const kinematics::MechanismDescription>(
      read_mechanism(TROCAR_SOURCE_DIR "/scenes/mechanisms/" + i.wrist.mechanism.file));
  return i;
}

TEST(InstrumentMechanism, AFlexibleInstrumentsChainStandsWhereItsMechanismDoes) {
  const Instrument i = with_chain("flexible_instrument", 0.012);
  interactions::ToolModel tool;
  std::vector<core::Fault> faults;
  take_wrist(i, tool, faults);
  ASSERT_TRUE(faults.empty()) << faults.front().message;
  ASSERT_EQ(tool.bends.joints, 4);
  EXPECT_TRUE(tool.bends.redundant());
  EXPECT_NEAR(tool.bends.length(), 0.029, 1e-12);
  const kinematics::Mechanism m = kinematics::build(*i.wrist.mechanism.description);
  kinematics::Pose pose(m);
  std::vector<double> u = m.start_u();
  const auto set = [&](const char* coordinate, double value) {
    ASSERT_GE(m.independent_of(coordinate), 0) << coordinate;
    u[std::size_t(m.independent_of(coordinate))] = value;
  };
  // Joints are numbered as hinges come: bend_x, bend_y, wrist_pitch, wrist_yaw.
  const kinematics::Joints joints{{0.7, -0.4, 0.5, -0.6}};
  set("bend_x", joints.angle[0]), set("bend_y", joints.angle[1]);
  set("wrist_pitch", joints.angle[2]), set("wrist_yaw", joints.angle[3]);
  forward(m, u, pose);
  const kinematics::Frame tip = place(m.frames[std::size_t(m.frame("tip"))], pose);
  // The mechanism's depth is to the shaft's end, the instrument's to the straight tip.
  const kinematics::TipFrame here =
      kinematics::forward(tool.bends, {0, 0, 0}, {0, 0, 0, 0.1 + tool.bends.length() + 0.012}, joints, 0.012);
  EXPECT_LT(length(here.tip - tip.p), 1e-12);
  EXPECT_LT(length(kinematics::turn_between(here.rotation, tip.r)), 1e-10);
}

TEST(InstrumentMechanism, AnArmsWristInDenavitHartenbergNumbersStandsWhereItsMechanismDoes) {
  const Instrument i = with_chain("dvrk_arm", 0.0102);
  interactions::ToolModel tool;
  std::vector<core::Fault> faults;
  take_wrist(i, tool, faults);
  ASSERT_TRUE(faults.empty()) << faults.front().message;
  ASSERT_EQ(tool.bends.joints, 2) << "with yaw, pitch, depth and roll about its trocar six";
  EXPECT_FALSE(tool.bends.redundant());
  EXPECT_NEAR(tool.bends.length(), 0.0091, 1e-12);
  EXPECT_NEAR(tool.bends.high[0], 78 * 1.0186 * portable::pi / 180, 1e-12) << "as far as its motor turns it";
  EXPECT_NEAR(tool.bends.high[1], 80 * portable::pi / 180, 1e-12) << "several turn it: its own";
  const kinematics::Mechanism m = kinematics::build(*i.wrist.mechanism.description);
  kinematics::Pose pose(m);
  for (const auto& [pitch, yaw] : {std::pair{0.0, 0.0}, {0.6, 0.0}, {0.0, -0.7}, {0.5, 0.9}, {-1.2, 0.4}}) {
    std::vector<double> u = m.start_u();  // motors that bring the joints there, the jaws closed
    const auto motor = [&](const char* name) -> double& { return u[std::size_t(m.independent_of(name))]; };
    motor("motor_pitch") = pitch / 1.0186;
    const double both = (yaw + 0.8306 * motor("motor_pitch")) / 0.6089;
    motor("motor_left") = motor("motor_right") = 0.5 * both;
    forward(m, u, pose);
    const kinematics::Frame shaft = place(m.frames[std::size_t(m.frame("shaft"))], pose);
    const kinematics::Frame tip = kinematics::inverse(shaft) * place(m.frames[std::size_t(m.frame("tip"))], pose);
    const kinematics::Joints joints{{pitch, yaw}};
    const kinematics::Chain here =
        kinematics::chain(tool.bends, {0, 0, 0}, {0, 0, 0, 0.1 + tool.bends.length() + 0.0102}, joints, 0.0102);
    // In the shaft's own terms: how far ahead the tip is, how far aside, and how much the jaws are turned away.
    const Vec3d way = here.tip.tip - here.shaft.tip;
    EXPECT_NEAR(dot(way, here.shaft.axis()), tip.p.z, 1e-12) << pitch << ' ' << yaw;
    EXPECT_NEAR(length(way), length(tip.p), 1e-12);
    EXPECT_NEAR(dot(here.tip.axis(), here.shaft.axis()), tip.r.column(2).z, 1e-12);
    EXPECT_NEAR(dot(here.tip.opening(), here.shaft.axis()), tip.r.column(0).z, 1e-12);
    EXPECT_NEAR(dot(here.tip.opening(), way), dot(tip.r.column(0), tip.p), 1e-12) << "and to which side";
  }
}

TEST(InstrumentMechanism, AChainThatIsNoneIsALocatedFaultThatSaysWhy) {
  const auto fault_of_chain = [](const char* name, double jaw) {
    interactions::ToolModel tool;
    std::vector<core::Fault> faults;
    take_wrist(with_chain(name, jaw), tool, faults);
    EXPECT_EQ(faults.size(), 1u) << name;
    EXPECT_FALSE(tool.bends.bends()) << name;
    return faults.empty() ? std::string() : faults.front().message;
  };
  EXPECT_NE(fault_of_chain("four_bar", 0.01).find("without a 'shaft'"), std::string::npos);
  EXPECT_NE(fault_of_chain("four_bar", 0.01).find("'arms' of a room"), std::string::npos) << "and what to do";
  EXPECT_NE(fault_of_chain("flexible_instrument", 0.02).find("nearer than jaws of 20 mm"), std::string::npos);
  EXPECT_NE(fault_of_chain("dvrk_arm", 0.02).find("nearer than jaws"), std::string::npos);
  EXPECT_FALSE(fault_of_chain("grasper", 0.01).empty());
}

TEST(InstrumentMechanism, AHingeBesideTheShaftsAxisIsToldByItsNameAndHowFar) {
  Instrument i = with_chain("dvrk_arm", 0.0102);
  kinematics::MechanismDescription d = *i.wrist.mechanism.description;
  for (kinematics::Link& l : d.links)
    if (l.name == "wrist") l.joint.place.at[0].constant += 0.004;
  i.wrist.mechanism.description = std::make_shared<const kinematics::MechanismDescription>(d);
  interactions::ToolModel tool;
  std::vector<core::Fault> faults;
  take_wrist(i, tool, faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find("4 mm beside the shaft's axis"), std::string::npos) << faults[0].message;
}

TEST(InstrumentMechanism, AFileThatNamesWhatIsNotThereOrContradictsItIsToldInOnePass) {
  const Folder folder;
  const std::string mechanism = text_of(TROCAR_SOURCE_DIR "/scenes/mechanisms/claw_grasper.json");
  folder.write("claw.json", mechanism);
  const auto path = folder.write("tool.json", R"({"format": 1, "name": "a", "kind": "grasper",
 "opening_deg": 30,
 "mechanism": "claw.json",
 "wrist": {"pitch_deg": 40, "mechanism": "missing.json"}})");
  const std::vector<core::Fault> faults = check_file(path);
  const std::vector<std::string> all = told(faults);
  ASSERT_EQ(all.size(), 3u);
  std::string joined;
  for (const std::string& line : all) joined += line + "\n";
  EXPECT_NE(joined.find("2:"), std::string::npos) << joined;
  EXPECT_NE(joined.find("expected no other key beside mechanism"), std::string::npos) << joined;
  EXPECT_NE(joined.find("missing.json"), std::string::npos) << joined;
}

TEST(InstrumentMechanism, CalledByItsNameIsTheTreesOwnOrALibrarysAndElseTold) {
  const Folder folder;
  const auto tool = [&](const std::string& mechanism) {
    return folder.write("tool.json",
                        R"({"format": 1, "name": "a", "kind": "grasper", "mechanism": ")" + mechanism + "\"}");
  };
  EXPECT_TRUE(check_file(tool("cam_grasper")).empty()) << "the program's";
  folder.write("mechanisms/mine.json", text_of(TROCAR_SOURCE_DIR "/scenes/mechanisms/claw_grasper.json"));
  EXPECT_TRUE(check_file(tool("mine")).empty());
  folder.write("mechanisms/cam_grasper.json", "{}");
  EXPECT_FALSE(check_file(tool("cam_grasper")).empty()) << "the tree's own comes first";
  const std::vector<core::Fault> faults = check_file(tool("mane"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].message.find("mine"), std::string::npos) << faults[0].message;
}

}  // namespace
}  // namespace trocar::scene
