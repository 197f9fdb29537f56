#include <algorithm>
#include <cmath>

#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

constexpr double kBow = 0.0012;          // [m] the jaws' bow off the straight rods that the mechanics have for them
constexpr double kDissectorTip = 0.002;  // [m] across the closed tips
constexpr double kTeeth = 0.0009;        // [m] from one tooth to the next
constexpr double kGroove = 0.0002;       // [m] between the teeth

/// Both jaws bend the same way, beside the plane that they open in; joint and tips are where straight jaws have them.
Vec3d bowed(double u, double length) { return {0, 4 * kBow * u * (1 - u), u * length}; }

double half_width(const ToolModel& tool, double u) {
  return 0.5 * (tool.jaw_width + (kDissectorTip - tool.jaw_width) * smooth(0.15, 0.95, u));
}

/// The jaw's back, half round: thick at the joint, slender and blunt at its tip.
MeshBuffer back(const ToolModel& tool) {
  std::vector<BarSection> sections;
  for (int i = -1; i <= 20; ++i) {
    const double u = i / 20.0;
    const double blunt = std::sqrt(std::max(0.05, 1 - std::pow(std::max(0.0, (u - 0.94) / 0.06), 2)));
    const double thick = tool.jaw_thickness * (1.1 - 0.45 * smooth(0.1, 0.9, u)) * blunt;
    const double wide = half_width(tool, u) * blunt * (0.55 + 0.45 * smooth(0, 0.12, u));
    const Vec3d inner = bowed(u, tool.jaw_length) + Vec3d{kGroove, 0, 0};
    sections.push_back({inner + Vec3d{0.5 * thick, 0, 0}, {0.5 * thick, 0, 0}, {0, wide, 0}, kUsed});
    sections.back().paint.blood = to_byte(0.35 * std::max(smooth(0.3, 0.9, u), smooth(0.2, 0, u)));
  }
  return bar(sections, 0.65);
}

/// Fine teeth across the whole inner face.
MeshBuffer teeth(const ToolModel& tool) {
  MeshBuffer b;
  const double length = tool.jaw_length;
  for (double z = 0.22 * length; z < 0.96 * length; z += kTeeth) {
    const double u = z / length, wide = 0.86 * half_width(tool, u);
    const Vec3d middle = bowed(u, length) + Vec3d{0.55 * kGroove, 0, 0}, across{0, wide, 0};
    const Vec3d along{0, 0, 0.3 * kTeeth}, high{0.5 * kGroove, 0, 0};
    merge(b, bar({{middle - across, along, high, kSmeared}, {middle + across, along, high, kSmeared}}, 0.6));
  }
  return b;
}

/// @param side  1: jaw a; -1: jaw b, whose frame is turned by half a turn about the axis, and which bends the same way
MeshBuffer jaw(const ToolModel& tool, float side) {
  MeshBuffer bent = back(tool), b;
  merge(bent, teeth(tool));
  append(b, bent, Mat3f::from_columns({1, 0, 0}, {0, side, 0}, {0, 0, 1}), {});
  merge(b, jaw_root(tool.shaft_radius));
  return b;
}

}  // namespace

std::vector<InstrumentPart> dissector_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  add_hinge(parts, tool);
  parts.push_back({PartJoint::jaw_a, "steel", jaw(tool, 1)});
  parts.push_back({PartJoint::jaw_b, "steel", jaw(tool, -1)});
  return parts;
}

}  // namespace trocar::view
