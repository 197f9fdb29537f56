// The readers of mechanisms, JSON and URDF, and what is made of what they accept: it builds, stands somewhere, closes
// or says that it does not, and ends.
#include <cmath>
#include <filesystem>

#include <trocar/core/files.hpp>
#include <trocar/kinematics/chains/excluded_range.hpp>
#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/mechanisms/urdf.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace kinematics;

void check_told(const std::vector<core::Fault>& faults) {
  require(faults.size() <= scene::kMaxFaults + 1, "faults are bounded");
  for (const core::Fault& f : faults) require(!f.message.empty(), "a fault says what was expected");
}

void check_mechanism(const MechanismDescription& description) {
  require(check(description).empty(), "what is read without faults can be built");
  const Mechanism m = build(description);
  require(m.u_count() <= m.q_count() && m.q_count() <= kMostCoordinates, "coordinates are bounded");
  for (const double x : m.dimensions) require(std::isfinite(x), "dimensions are finite");
  for (const ExcludedRange& range : excluded_ranges(m)) {
    require(range.low <= range.high && std::isfinite(range.high - range.low), "a range that is led to has two ends");
    require(!words(m, range).empty(), "and is told of in words");
  }
  if (m.q_count() > 12 || m.rows > 24 || m.bodies.size() > 40) return;  // quick only
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  LoopOptions options;
  options.iterations = 8;
  const LoopReport report = close(m, u, work, options);
  require(!words(m, report).empty(), "a closure is told of in words");
  require(report.rank <= report.unknowns && report.rank <= report.conditions, "a rank is one");
  for (const double x : u) require(!std::isinf(x), "coordinates do not run away");
}

}  // namespace

void mechanism_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const MechanismDescription d = scene::parse_mechanism(text_of(bytes), "memory.json", faults);
  check_told(faults);
  if (faults.empty()) check_mechanism(d);
}

std::vector<Seed> mechanism_seeds() {
  std::vector<Seed> seeds;
  for (const char* name : {"four_bar", "needle_holder", "bricard", "slider_crank"})
    seeds.push_back({name, bytes_of(core::read_file(std::filesystem::path(TROCAR_SOURCE_DIR) / "scenes/mechanisms" /
                                                        (std::string(name) + ".json"),
                                                    1u << 20))});
  return seeds;
}

void urdf_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const MechanismDescription d = scene::read_urdf(text_of(bytes), "memory.urdf", faults);
  check_told(faults);
  if (faults.empty()) check_mechanism(d);
}

std::vector<Seed> urdf_seeds() {
  return {{"arm", bytes_of(R"(<?xml version="1.0"?>
<robot name="arm"><link name="base"/><link name="a"><inertial><origin xyz="0 0 .1"/><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual></link><link name="b"><collision><geometry>
<cylinder radius=".1" length="1"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><origin xyz="1 0 0" rpy="0 1 0"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1"/></joint>
<joint name="k" type="continuous"><parent link="a"/><child link="b"/><mimic joint="j" multiplier="2" offset="1"/></joint>
</robot>)")},
          {"slide",
           bytes_of("<robot name='s'><link name='x'/><link name='y'><visual><geometry><sphere radius='1'/></geometry>"
                    "</visual></link><joint name='p' type='prismatic'><parent link='x'/><child link='y'/><limit "
                    "lower='0' upper='1'/></joint></robot>")},
          {"xacro", bytes_of("<robot xmlns:xacro=\"http://ros.org/wiki/xacro\" name=\"${n}\"><xacro:hand a='1'/>"
                             "<link name='l'/><property/></robot>")},
          {"entities", bytes_of("<!-- c --><robot name=\"&lt;&#65;&amp;\"><link name='l'/><![CDATA[<x>]]></robot>")}};
}

std::vector<std::string> urdf_words() {
  return {"<robot name=\"r\">",
          "</robot>",
          "<link name=\"a\"/>",
          "<joint name=\"j\" type=\"revolute\">",
          "</joint>",
          "<parent link=\"a\"/>",
          "<child link=\"b\"/>",
          "<origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>",
          "<axis xyz=\"0 0 1\"/>",
          "<limit lower=\"0\" upper=\"1\"/>",
          "<mimic joint=\"j\"/>",
          "<xacro:a b=\"${c}\"/>",
          "xmlns:x=\"http://ros.org/wiki/xacro\"",
          "$(arg a)",
          "type=\"prismatic\"",
          "type=\"fixed\"",
          "<!--",
          "-->",
          "<![CDATA[",
          "]]>",
          "<?",
          "?>",
          "<!DOCTYPE",
          "&lt;",
          "&#x41;",
          "1e308",
          "nan"};
}

}  // namespace trocar::fuzz
