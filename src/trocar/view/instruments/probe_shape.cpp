#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

MeshBuffer blunt_rod(const ToolModel& tool) {
  const double r = tool.shaft_radius, tip = tool.jaw_length;
  std::vector<TurnPoint> outline{
      {-tool.shaft_length, 0, kClean}, {-tool.shaft_length, r, kClean}, {-tool.shaft_length, r, kClean}};
  for (int i = 0; i <= 8; ++i) {
    const double a = 0.5 * portable::pi * i / 8;
    outline.push_back({tip - r + r * std::sin(a), i == 8 ? 0 : r * std::cos(a), kClean});
  }
  return turned(outline, kAround);
}

}  // namespace

std::vector<InstrumentPart> probe_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "steel", blunt_rod(tool)});
  return parts;
}

}  // namespace trocar::view
