#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

/// Jaw of a clip applier: a back with two rails, between which a leg of the clip slides.
MeshBuffer applier_jaw(const ToolModel& tool) {
  const double length = tool.jaw_length, half = 0.5 * tool.jaw_width, thick = tool.jaw_thickness;
  MeshBuffer b;
  const Vec3d x{1, 0, 0}, y{0, 1, 0};
  const auto back = [&](double z, double low, double high, double wide) {
    return BarSection{{0.5 * (low + high), 0, z}, 0.5 * (high - low) * x, wide * y, kClean};
  };
  merge(b, bar({back(-0.009, 0.0002, thick, 0.7 * half), back(-0.003, 0.2 * thick, 1.3 * thick, 0.75 * half),
                back(0.1 * length, 0.3 * thick, 1.45 * thick, 0.72 * half),
                back(0.35 * length, 0.42 * thick, 1.35 * thick, 0.85 * half),
                back(0.8 * length, 0.42 * thick, 1.05 * thick, 0.93 * half),
                back(0.9 * length, 0.42 * thick, 0.95 * thick, 0.93 * half),
                back(0.98 * length, 0.42 * thick, 0.8 * thick, 0.85 * half),
                back(length, 0.42 * thick, 0.62 * thick, 0.6 * half)},
               0.3));
  for (const double side : {-1.0, 1.0}) {
    const double rail = 0.5 * (half - 0.5 * 0.0013), at = side * (half - rail);
    // They are as high as the back nearly everywhere: a seam in the jaw's side would look dotted from afar.
    const auto section = [&](double z, double low, double high) {
      return BarSection{{0.5 * (low + high), at, z}, 0.5 * (high - low) * x, rail * y, kSmeared};
    };
    merge(b, bar({section(0.1 * length, 0.3 * thick, 1.3 * thick), section(0.25 * length, 0.0001, 1.28 * thick),
                  section(0.8 * length, 0.0001, 0.97 * thick), section(0.95 * length, 0.0001, 0.78 * thick),
                  section(0.995 * length, 0.0003, 0.56 * thick)},
                 0.3));
  }
  return b;
}

}  // namespace

std::vector<InstrumentPart> clip_applier_parts(const ToolModel& tool) {
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "steel", open_shaft(tool, -0.002, 0.0008)});
  parts.push_back({PartJoint::jaw_a, "matte_steel", applier_jaw(tool)});
  parts.push_back({PartJoint::jaw_b, "matte_steel", applier_jaw(tool)});
  return parts;
}

}  // namespace trocar::view
