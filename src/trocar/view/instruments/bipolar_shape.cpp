#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

/// White insulation of a bipolar jaw: a tine that leaves the shaft's end beside its fellow, bows away from it, and runs
/// out as the back of the paddle.
MeshBuffer bipolar_tine(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, deep = 0.45 * tool.jaw_thickness;
  std::vector<BarSection> sections;
  for (int i = 0; i <= 20; ++i) {
    const double u = i / 20.0, z = -0.0045 + (0.84 * length + 0.0045) * u;
    const double flat = smooth(0.42, 0.62, u), out = 1 - 0.55 * smooth(0.75, 1, u);
    const double thick = (1 - flat) * 0.0008 + flat * 0.00045 * out;
    const double at =
        (1 - flat) * (0.0010 + 0.0005 * std::sin(0.9 * portable::pi * u / 0.5)) + flat * (deep + 0.3 * thick);
    const double wide = (1 - flat) * 0.00085 + flat * 0.74 * half * (1 - 0.3 * smooth(0.85, 1, u));
    sections.push_back({{at, 0, z}, {thick, 0, 0}, {0, wide, 0}, kClean});
  }
  return bar(sections, 0.75);
}

/// The paddle of bipolar forceps: narrow, flat and smooth inside, blunt; its back is insulated nearly to the tip.
MeshBuffer bipolar_paddle(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, deep = 0.45 * tool.jaw_thickness;
  const auto works = [](double u) { return Paint{240, to_byte(0.3 * u), to_byte(0.2 + 0.5 * smooth(0.3, 1, u)), 0}; };
  std::vector<BarSection> sections;
  for (int i = 0; i <= 12; ++i) {
    const double u = i / 12.0, z = (0.44 + 0.56 * u) * length;
    const double blunt = std::sqrt(std::max(0.04, 1 - std::pow(std::max(0.0, (u - 0.8) / 0.2), 2)));
    const double wide = (0.5 + 0.18 * smooth(0, 0.4, u)) * half * blunt, thick = deep * (0.8 + 0.2 * blunt);
    sections.push_back({{0.5 * thick + 0.00004, 0, z}, {0.5 * thick, 0, 0}, {0, wide, 0}, works(u)});
  }
  return bar(sections, 0.3);
}

}  // namespace

std::vector<InstrumentPart> bipolar_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "insulated", shaft(tool, -0.0105)});
  parts.push_back({PartJoint::body, "ceramic", insulator(tool, -0.0105, -0.003, 0.92 * tool.shaft_radius)});
  for (const PartJoint jaw : {PartJoint::jaw_a, PartJoint::jaw_b}) {
    parts.push_back({jaw, "ceramic", bipolar_tine(tool)});
    parts.push_back({jaw, "steel", bipolar_paddle(tool)});
  }
  return parts;
}

}  // namespace trocar::view
