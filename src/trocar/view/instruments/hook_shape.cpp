#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

constexpr double kCollarFrom = -0.0072;  // [m] where the white collar begins

/// A hook's bare wire, bent at its end: the foot looks to where jaws would open. Its end is flattened, and what it is
/// used with is brown and black.
MeshBuffer hook_wire(const ToolModel& tool) {
  constexpr double turn = 0.0011, thin = 0.72;
  const double r = 0.5 * thin * tool.jaw_width, tip = tool.jaw_length - r, drawn = 1.03 * tool.shaft_radius,
               foot = tool.foot > 0 ? tool.foot : drawn;
  const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const auto used = [](double share) { return Paint{to_byte(1 - 0.1 * share), 0, to_byte(0.75 * share), 0}; };
  std::vector<BarSection> sections{{-0.003 * z, r * x, r * y, kShaded}};
  for (const double u : {0.2, 0.6, 1.0}) sections.push_back({(u * (tip - turn)) * z, r * x, r * y, used(0.6 * u)});
  for (int i = 1; i <= 6; ++i) {
    const double a = 0.5 * portable::pi * i / 6, c = std::cos(a), s = std::sin(a);
    const Vec3d across = c * x - s * z;
    sections.push_back({(turn * (1 - c)) * x + (tip - turn + turn * s) * z, (r * (1 - 0.12 * s)) * across,
                        (r * (1 + 0.1 * s)) * y, used(0.65 + 0.2 * s)});
  }
  sections.push_back({(foot - 0.5 * r) * x + tip * z, -0.8 * r * z, 1.12 * r * y, used(1)});
  sections.push_back({(foot - 0.12 * r) * x + tip * z, -0.66 * r * z, 0.98 * r * y, used(1)});
  sections.push_back({foot * x + tip * z, -0.4 * r * z, 0.7 * r * y, used(1)});
  return bar(sections, 0.8);
}

}  // namespace

std::vector<InstrumentPart> hook_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "insulated", shaft(tool, kCollarFrom)});
  parts.push_back({PartJoint::body, "ceramic", insulator(tool, kCollarFrom, 0, 0.55 * tool.shaft_radius)});
  parts.push_back({PartJoint::body, "steel", hook_wire(tool)});
  return parts;
}

}  // namespace trocar::view
