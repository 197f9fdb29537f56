// What instruments look like, built from the same numbers that the simulation moves and grips with: shaft, hinge, and
// jaws that turn about the pivot or shift apart. Fine features (teeth, windows, rivets) are drawing only.
//
// The body's frame: z along the axis (forward), x along the jaws' opening, origin at the pivot. A jaw's frame: inner
// face at x = 0, z from the pivot to its tip; jaw b is jaw a turned by half a turn about the axis.
#pragma once

#include <string>
#include <vector>

#include <trocar/interactions/tool.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

struct InstrumentPart {
  enum class Joint { body, jaw_a, jaw_b } joint = Joint::body;
  std::string look;
  MeshBuffer mesh;
};

std::vector<InstrumentPart> instrument_parts(const interactions::ToolModel& tool);
/// A trocar's sleeve: z forward along whatever lies in it, origin at its fulcrum in the abdominal wall; its end is cut
/// at a slant. @param radius inside [m] @param reach how far the longer side of the slant reaches in [m]
std::vector<InstrumentPart> sleeve_parts(double radius, double reach);
/// The endoscope's shaft: z forward, origin at its tip.
std::vector<InstrumentPart> scope_parts(double radius);

/// Where a part stands. Columns of the rotation are unit and right-handed.
struct Placement {
  Mat3f rotation = Mat3f::identity();
  Vec3f translation;
};
Placement placement_of(InstrumentPart::Joint joint, const interactions::ToolShape& shape);
/// From the pivot to the bend of a clip that lies in the jaws [m].
double clip_seat(const interactions::ToolModel& tool);

}  // namespace trocar::view
