#include <algorithm>

#include <trocar/view/instruments/kind_shapes.hpp>
#include <trocar/view/instruments/metal_parts.hpp>

namespace trocar::view {

/// A sleeve of plastic, open at its end: hoop and cloth of the bag come out of it (view/objects/bag_drawing.hpp).
std::vector<InstrumentPart> bag_parts(const metal::ToolModel& tool) {
  const double end = tool.jaw_length, wall = 0.16 * tool.shaft_radius;
  std::vector<InstrumentPart> parts;
  parts.push_back({InstrumentPart::Joint::body, "plastic_sleeve", metal::open_shaft(tool, end, wall)});
  return parts;
}

}  // namespace trocar::view
