#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/mechanisms/quantity_text.hpp>
#include <trocar/scene/mechanisms/urdf.hpp>
#include <trocar/scene/mechanisms/xml.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

using kinematics::Measure;
using kinematics::Parameter;

std::vector<std::string> faults_of_mechanism(const std::string& text) {
  std::vector<core::Fault> faults;
  parse_mechanism(text, "m.json", faults);
  return told(faults);
}
bool some_fault_has(const std::vector<std::string>& faults, const std::string& part) {
  return std::any_of(faults.begin(), faults.end(), [&](const std::string& f) { return f.find(part) != f.npos; });
}

TEST(QuantityText, SumsMultiplesOfParameters) {
  const std::vector<Parameter> p{
      {"rod", Measure::length, 0.05}, {"crank", Measure::length, 0.02}, {"tilt", Measure::angle, 1}};
  const auto value = [&](const char* text) {
    const QuantityReading r = read_quantity(text, p, Measure::length, 1e-3);
    EXPECT_EQ(r.fault, "") << text;
    return value_of(r.quantity, p);
  };
  EXPECT_DOUBLE_EQ(value("rod"), 0.05);
  EXPECT_DOUBLE_EQ(value("-rod"), -0.05);
  EXPECT_DOUBLE_EQ(value("2 * rod - 3"), 0.097);
  EXPECT_DOUBLE_EQ(value("rod * 0.5 - crank + 1e-1"), 0.025 - 0.02 + 1e-4);
  EXPECT_DOUBLE_EQ(value("7.5"), 0.0075);
}

TEST(QuantityText, SaysWhatIsWrong) {
  const std::vector<Parameter> p{{"rod", Measure::length, 0.05}, {"tilt", Measure::angle, 1}};
  const auto fault = [&](const std::string& text) { return read_quantity(text, p, Measure::length, 1e-3).fault; };
  EXPECT_EQ(fault("rood"), "expected a known parameter, got \"rood\" (did you mean \"rod\"?); known: rod, tilt");
  EXPECT_EQ(fault("tilt"), "expected a length, got \"tilt\", which is an angle");
  EXPECT_EQ(fault("rod * rod"), "expected one parameter in a product, got \"rod\" as well");
  EXPECT_EQ(fault("rod rod"), "expected '+' or '-' between terms, got 'r'");
  EXPECT_EQ(fault("rod +"), "expected a number or a parameter, got the end of the text");
  EXPECT_EQ(fault(""), "expected a number or a parameter, got the end of the text");
  EXPECT_EQ(fault("1.2.3"), "expected a number, got \"1.2.3\"");
  EXPECT_NE(fault(std::string(500, '1')), "");
}

const char* const kGood = R"({"format": 1, "name": "two",
 "parameters": [{"name": "upper", "length_mm": 300, "between": [200, 400], "plus_minus": 0.1}],
 "links": [
  {"name": "a", "joint": {"kind": "revolute", "limits_deg": [-90, 90], "start_deg": [30]}},
  {"name": "b", "parent": "a", "at_mm": ["upper", 0, 0], "joint": {"kind": "revolute", "name": "elbow"}}],
 "frames": [{"name": "tip", "link": "b", "at_mm": ["0.5 * upper", 0, 0]}]})";

TEST(MechanismFile, IsReadWithUnitsAndParameters) {
  std::vector<core::Fault> faults;
  const kinematics::Mechanism m = kinematics::build(parse_mechanism(kGood, "m.json", faults));
  EXPECT_TRUE(faults.empty());
  EXPECT_NEAR(m.high[0], portable::pi / 2, 1e-15);
  EXPECT_NEAR(m.start_u()[0], portable::pi / 6, 1e-15);
  kinematics::Pose pose(m);
  forward(m, std::vector<double>{0, 0}, pose);
  EXPECT_NEAR(place(m.frames[0], pose).p.x, 0.45, 1e-15);
  std::vector<double> p = m.parameter_values;
  p[0] = 0.2;
  forward(m.with(p), std::vector<double>{0, 0}, pose);
  EXPECT_NEAR(place(m.with(p).frames[0], pose).p.x, 0.3, 1e-15);
}

TEST(MechanismFile, TellsEveryFaultWithItsPlaceInOnePass) {
  const std::vector<std::string> faults = faults_of_mechanism(R"({"format": 1, "name": "bad",
 "parameters": [{"name": "upper", "length_mm": 300, "angle_deg": 3}],
 "links": [
  {"name": "a", "joint": {"kind": "revolute", "limits_deg": [-90]}},
  {"name": "b", "parent": "a", "at_mm": ["uper", 0], "joint": {"kind": "helical"}},
  {"name": "c", "at_mm": ["uper", 0, 1e9], "joint": {"kind": "hinge"}}],
 "closures": [{"name": "loop", "a": {}, "b": {"link": "c"}}],
 "actuators": [{"name": "drive", "coordinate": "a", "at_0_deg": 0}]})");
  for (const char* part :
       {"2:17 expected one of \"length_mm\"", "4:61 expected at least 2 items", "5:41 expected three numbers",
        "5:72 expected \"pitch_mm\"", "6:27 expected a known parameter", "6:38 expected at most 5000",
        "6:62 expected one of fixed", "7:15 expected either \"kind\" or \"directions\"", "8:16 expected \"at_1_deg\""})
    EXPECT_TRUE(some_fault_has(faults, part)) << part << "\n" << testing::PrintToString(faults);
  EXPECT_TRUE(std::is_sorted(faults.begin(), faults.end()))
      << "as they stand in the file: " << testing::PrintToString(faults);
}

TEST(MechanismFile, TellsWhatOnlyTheWholeShows) {
  const std::vector<std::string> faults = faults_of_mechanism(R"({"format": 1, "name": "bad",
 "links": [
  {"name": "a", "parent": "b", "joint": {"kind": "revolute"}},
  {"name": "b", "parent": "a", "joint": {"kind": "revolute"}},
  {"name": "b", "parent": "nobody", "joint": {"kind": "prismatic"}}],
 "couplings": [{"coordinate": "nothing", "terms": [{"of": "a", "ratio": 1}]}],
 "frames": [{"name": "tip", "link": "d"}]})");
  for (const char* part : {"5:12 expected every name of a link once", "5:27 expected a link",
                           "6:31 expected a coordinate", "7:37 expected a link"})
    EXPECT_TRUE(some_fault_has(faults, part)) << part << "\n" << testing::PrintToString(faults);
}

TEST(MechanismFile, AnAngleIsNotDrivenInMillimetresNorByASlideInRatios) {
  const std::vector<std::string> faults = faults_of_mechanism(R"({"format": 1, "name": "bad",
 "links": [
  {"name": "a", "joint": {"kind": "revolute"}},
  {"name": "b", "joint": {"kind": "prismatic"}}],
 "couplings": [{"coordinate": "b", "terms": [{"of": "a", "ratio": 1}]}],
 "actuators": [{"name": "drive", "coordinate": "a", "at_0_mm": 0, "at_1_mm": 5}]})");
  EXPECT_TRUE(some_fault_has(faults, "5:46 expected \"ratio_mm_deg\"")) << testing::PrintToString(faults);
  EXPECT_TRUE(some_fault_has(faults, "6:64 expected no \"at_0_mm\"")) << testing::PrintToString(faults);
}

const char* const kUrdf = R"(<?xml version="1.0"?>
<!-- a turning post, a sliding arm, a finger that mimics -->
<robot name="post">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base"/>
  <link name="post">
    <inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value="2"/>
      <inertia ixx="0.02" iyy="0.03" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="post.dae"/></geometry></visual>
    <collision><origin xyz="0 0 0.1"/><geometry><cylinder length="0.2" radius="0.03"/></geometry></collision>
  </link>
  <link name="arm"><visual><geometry><box size="0.3 0.02 0.02"/></geometry></visual></link>
  <link name="finger"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="post"/><origin xyz="0.1 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="post"/><child link="arm"/><origin xyz="0 0 0.2"/><limit lower="0" upper="0.5" effort="1" velocity="1"/>
  </joint>
  <joint name="bend" type="continuous">
    <parent link="arm"/><child link="finger"/><origin xyz="0.3 0 0" rpy="0 0 0"/><axis xyz="0 0 2"/>
    <mimic joint="turn" multiplier="-0.5" offset="0.1"/>
  </joint>
</robot>
)";

TEST(Urdf, ARobotIsReadWithInertiasLimitsAndMimickedJoints) {
  std::vector<core::Fault> faults;
  const kinematics::MechanismDescription d = read_urdf(kUrdf, "post.urdf", faults);
  ASSERT_TRUE(faults.empty()) << testing::PrintToString(told(faults));
  const kinematics::Mechanism m = kinematics::build(d);
  EXPECT_EQ(m.u_count(), 2);
  EXPECT_NEAR(d.links[1].inertia[0], 0.03, 1e-15) << "turned by a quarter: x and y change places";
  EXPECT_EQ(d.links[1].shapes.size(), 1u);
  kinematics::Pose pose(m);
  const double turn = 0.6;
  forward(m, std::vector<double>{turn, 0.25}, pose);
  const int finger = m.link_body[std::size_t(m.link("finger"))];
  const Vec3d at = pose.frames[std::size_t(finger)].p;
  EXPECT_NEAR(at.x, 0.1 + 0.55 * portable::cos(turn), 1e-15);
  EXPECT_NEAR(at.y, 0.55 * portable::sin(turn), 1e-15);
  EXPECT_NEAR(at.z, 0.2, 1e-15);
  EXPECT_NEAR(pose.q[std::size_t(m.coordinate("bend"))], 0.1 - 0.5 * turn, 1e-15);
}

TEST(Urdf, FaultsHaveTheirPlaces) {
  const auto faults_in = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
    std::vector<core::Fault> faults;
    read_urdf(text, "post.urdf", faults);
    return told(faults);
  };
  const std::string good = kUrdf;
  EXPECT_TRUE(
      some_fault_has(faults_in(good, "child link=\"arm\"", "child link=\"am\""), "18:26 expected a known link"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "radius=\"0.03\"", "radius=\"nan\""), "10:80 expected a number"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "\"continuous\"", "\"floating\""), "20:28 expected revolute, continuous"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "joint=\"turn\"", "joint=\"trun\""), "expected a coordinate"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "</robot>", "</robbt>"), "24:1 expected \"</robot>\""));
  EXPECT_TRUE(some_fault_has(faults_in(good, "<robot", "<!DOCTYPE x [<!ENTITY a \"b\">]><robot"),
                             "3:1 expected no document type"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "xyz=\"0.1 0 0\"", "xyz=\"0.1 0\""), "15:59 expected 3 numbers, got 2"));
  EXPECT_TRUE(some_fault_has(faults_in(good, "<child link=\"arm\"/>", "<child link=\"post\"/>"), "second one"));
}

TEST(Xml, IsBoundedInEveryWay) {
  const auto refused = [](const std::string& text) {
    std::vector<core::Fault> faults;
    parse_xml(text, "x", faults);
    return faults.size() == 1;
  };
  std::string deep, wide = "<a", many = "<a>";
  for (int k = 0; k < 1000; ++k) deep += "<a>";
  for (int k = 0; k < 1000; ++k) wide += " b" + std::to_string(k) + "=''";
  for (int k = 0; k < 200'000; ++k) many += "<b/>";
  EXPECT_TRUE(refused(deep));
  EXPECT_TRUE(refused(wide + "/>"));
  EXPECT_TRUE(refused(many + "</a>"));
  EXPECT_TRUE(refused(std::string(5u << 20, ' ')));
  for (const char* text : {"", "<", "<a", "<a b", "<a b=", "<a b='", "<a b='&", "<a b='&#0;'/>", "<a b='&#xd800;'/>",
                           "<a>", "<a></b>", "<a/><b/>", "<!--", "<a><!--", "<?", "<a b='<'/>", "x"})
    EXPECT_TRUE(refused(text)) << text;
  std::vector<core::Fault> faults;
  const XmlElement e =
      parse_xml("\xef\xbb\xbf<a b='&lt;&#x41;&amp;'><c/>text<![CDATA[<d/>]]></a> <!-- end -->", "x", faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(e.attribute("b")->value, "<A&");
  EXPECT_EQ(e.children.size(), 1u);
}

}  // namespace
}  // namespace trocar::scene
