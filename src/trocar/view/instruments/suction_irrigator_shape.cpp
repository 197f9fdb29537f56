#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

/// A round hole in a tube's side: a dark disc that is bent around it.
MeshBuffer side_hole(double tube_radius, double angle, double z, double radius) {
  MeshBuffer b = turned({{0, radius, kShaded}, {0, 0.8 * radius, kHollow}, {0, 0, kHollow}}, 16);
  const double out = tube_radius + 2e-5;
  for (Vec3f& p : b.positions) {
    const double at = angle + double(p.x) / tube_radius;
    p = {float(out * std::cos(at)), float(out * std::sin(at)), float(z) + p.y};
  }
  return b;
}

/// A tube whose end is the bore, with eight holes of 1 mm around it.
MeshBuffer irrigator_tube(const ToolModel& tool) {
  const double r = tool.shaft_radius, bore = std::max(0.0015, 0.74 * tool.shaft_radius),
               end = tool.jaw_length + 0.5 * tool.jaw_thickness;
  MeshBuffer b = open_shaft(tool, end, std::max(r - bore, 0.2 * r));
  for (int i = 0; i < 8; ++i)
    merge(b, side_hole(r, (i + 0.5 * (i % 2)) * 0.5 * portable::pi, end - (i < 4 ? 0.004 : 0.0075), 0.0005));
  return b;
}

}  // namespace

std::vector<InstrumentPart> suction_irrigator_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "matte_steel", irrigator_tube(tool)});
  return parts;
}

}  // namespace trocar::view
