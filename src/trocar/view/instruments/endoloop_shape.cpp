#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {
namespace {

using namespace metal;

constexpr double kNose = 0.0011, kThreadBore = 0.0005;  // [m] radii of its end, and of the bore there
constexpr double kThreadRod = 0.00035;                  // [m] radius of the rod that draws the thread

/// The tube comes to a blunt nose, which pushes the knot; thread comes out of its bore
/// (view/objects/suture_drawing.hpp).
MeshBuffer nose(const ToolModel& tool) {
  const double end = tool.jaw_length, r = tool.shaft_radius;
  return turned({{-0.1 * end, r, kClean},
                 {0.35 * end, 0.9 * r, kClean},
                 {0.8 * end, 1.2 * kNose, kClean},
                 {0.96 * end, kNose, kClean},
                 {end, 0.8 * kNose, kClean},
                 {end, kThreadBore, kShaded},
                 {0.8 * end, 0.9 * kThreadBore, kHollow},
                 {0.8 * end, 0, kHollow}},
                kAround);
}

}  // namespace

std::vector<InstrumentPart> endoloop_parts(const ToolModel& tool) {
  const double end = tool.jaw_length;
  std::vector<InstrumentPart> parts;
  parts.push_back({PartJoint::body, "plastic_sleeve", shaft(tool, 0)});
  parts.push_back({PartJoint::body, "plastic_sleeve", nose(tool)});
  parts.push_back(
      {PartJoint::body, "matte_steel",
       turned({{0.75 * end, kThreadRod, kShaded}, {0.97 * end, kThreadRod, kShaded}, {0.97 * end, 0, kShaded}}, 12)});
  return parts;
}

}  // namespace trocar::view
