#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

constexpr double kTooth = 0.0011;  // [m] from one cross tooth of a grasper to the next

/// Straight sides and round ends between z = from and to.
Outline stadium(double from, double to, double half_width) {
  return [=](double u) {
    const double r = std::min(half_width, 0.45 * (to - from)), low = from + r, high = to - r;
    if (u < 0.4) return Vec3d{0, half_width, low + (high - low) * u / 0.4};
    if (u < 0.5) {
      const double a = portable::pi * (u - 0.4) / 0.1;
      return Vec3d{0, half_width * std::cos(a), high + r * std::sin(a)};
    }
    if (u < 0.9) return Vec3d{0, -half_width, high + (low - high) * (u - 0.5) / 0.4};
    const double a = portable::pi * (1 + (u - 0.9) / 0.1);
    return Vec3d{0, half_width * std::cos(a), low + r * std::sin(a)};
  };
}

/// Jaw of a fenestrated grasper: a frame around a window that one sees through, cross teeth inside, narrow at the hinge
/// and thinner to the tip.
MeshBuffer grasper_jaw(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, thick = tool.jaw_thickness;
  const auto neck = [=](double z) { return 0.46 + 0.54 * smooth(0.003, 0.0075, z); };
  const Outline plain = stadium(-0.001, length, half);
  const Outline outer = [=](double u) {
    Vec3d p = plain(u);
    p.y *= neck(p.z);
    return p;
  };
  const Outline window = stadium(0.37 * length, 0.87 * length, 0.52 * half);
  const Height inside = [=](double y, double z) {
    if (z < 0.006) return 0.00006;
    const double phase = z / kTooth - std::floor(z / kTooth);
    const double teeth = 0.00034 * (phase < 0.5 ? 2 * phase : 2 - 2 * phase);
    // They end before the window; at the edge they are lower, and their tops meet when the jaws are closed.
    const double across = std::fabs(y) / (half * neck(z)), edge = smooth(0.8, 0.96, across);
    const double side = 1 - 0.35 * edge - 0.65 * smooth(0.9, 1, z / length);
    return teeth * smooth(0.5, 0.66, across) * side + 0.00012 * (1 - edge) + 0.00001;
  };
  const Height outside = [=](double y, double z) {
    const double across = std::min(1.0, std::fabs(y) / (half * neck(z)));
    const double body = thick * (1.2 - 0.38 * smooth(0.002, 0.3 * length, z) - 0.24 * smooth(0.3 * length, length, z));
    // Milled: a back that is nearly flat, and slants to its edges.
    return body * (1 - 0.06 * across * across - 0.44 * smooth(0.6, 0.98, across));
  };
  MeshBuffer b = plate(outer, window, inside, outside, 208, 6, [=](bool face, double y, double z) {
    const double phase = z / kTooth - std::floor(z / kTooth), deep = phase < 0.5 ? 1 - phase : phase;
    const double works = smooth(0.004, 0.012, z), across = std::fabs(y) / (half * neck(z));
    if (face) return Paint{std::uint8_t(90 + deep * 130), to_byte(works * (1.2 - 0.55 * deep)), 0, 0};
    // Outside it stays in the window's corners, at the teeth and on the tip.
    const bool rim = across < 0.56 && z > 0.36 * length && z < 0.88 * length;
    const double edge = smooth(0.9, 1, across) * (1 - 0.5 * deep), tip = 0.4 * smooth(0.7, 1, z / length);
    const double blood = rim ? 0.42 : std::max({0.62 * works * edge, tip, stained(z, 0.33).blood / 255.0});
    return Paint{to_byte(rim ? 0.6 : 1 - 0.25 * edge), to_byte(blood), 0, 0};
  });
  merge(b, jaw_root(tool.shaft_radius));
  return b;
}

}  // namespace

std::vector<InstrumentPart> grasper_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  add_hinge(parts, tool);
  parts.push_back({PartJoint::jaw_a, "steel", grasper_jaw(tool)});
  parts.push_back({PartJoint::jaw_b, "steel", grasper_jaw(tool)});
  return parts;
}

}  // namespace trocar::view
