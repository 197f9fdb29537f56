#include <algorithm>
#include <cmath>

#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

/// The bevel that is ground along a blade's edge: it slants from the outer face to the middle plane.
MeshBuffer ground_edge(const std::vector<BarSection>& blade) {
  constexpr double kBevel = 0.0007;  // [m]
  std::vector<BarSection> sections;
  for (std::size_t i = 4; i < blade.size(); ++i) {
    const BarSection& of = blade[i];
    const double edge = of.centre.x - of.wide.x, inner = of.centre.y - of.deep.y, outer = of.centre.y + of.deep.y;
    const double wide = std::min(kBevel, of.wide.x);
    const Vec3d low{edge - 0.00012, inner + 0.00003, of.centre.z}, high{edge + wide, outer - 0.00004, of.centre.z};
    const Vec3d half = 0.5 * (high - low), out = normalised(Vec3d{-half.y, half.x, 0}, Vec3d{0, 1, 0});
    sections.push_back({0.5 * (low + high), half, 0.00003 * out, kClean});
  }
  return bar(sections, 0.1);
}

/// Blade of curved scissors: a wedge beside the middle plane, both blades bent the same way. @param bend along y [m]
MeshBuffer blade(const ToolModel& tool, double bend) {
  const double length = tool.jaw_length, high = 0.95 * tool.jaw_width, thick = 0.62 * tool.jaw_thickness;
  std::vector<BarSection> sections;
  for (int i = 0; i <= 14; ++i) {
    const double u = i / 14.0, z = -0.0016 + (length + 0.0016) * u;
    const double w = std::max(0.0, z) / length;
    const double back = high * (0.45 + 0.55 * smooth(-0.002, 0.003, z)) * (1 - 0.78 * std::pow(w, 1.6));
    const double edge = -0.00035 * smooth(0, 0.004, z) * (1 - 0.5 * w);
    const double narrow = 1 - 0.45 * w;
    const double shift = bend * w * w;
    const Vec3d centre{0.5 * (back + edge), 0.02e-3 + 0.5 * thick * narrow + shift, z};
    sections.push_back({centre, {0.5 * (back - edge), 0, 0}, {0, 0.5 * thick * narrow, 0}, kUsed});
    sections.back().paint.blood = to_byte(0.32 * std::max(smooth(0.1, 0.6, w), smooth(0.3, 0, w)));
  }
  MeshBuffer b = bar(sections, 0.22);
  merge(b, ground_edge(sections));
  merge(b, jaw_root(tool.shaft_radius));
  return b;
}

}  // namespace

std::vector<InstrumentPart> scissors_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  add_hinge(parts, tool);
  parts.push_back({PartJoint::jaw_a, "polished_steel", blade(tool, 0.0016)});
  parts.push_back({PartJoint::jaw_b, "polished_steel", blade(tool, -0.0016)});
  return parts;
}

}  // namespace trocar::view
