// What instruments look like, built from the same numbers that the simulation moves and grips with: shaft, hinge, and
// jaws that turn about the pivot or shift apart. Fine features (teeth, windows, rivets) are drawing only.
//
// The body's frame: z along the axis (forward), x along the jaws' opening, origin at the pivot. A jaw's frame: inner
// face at x = 0, z from the pivot to its tip; jaw b is jaw a turned by half a turn about the axis. Of an instrument
// that bends the body is what the jaws hinge in, and shaft and links have frames of their own, from their ends on.
#pragma once

#include <string>
#include <vector>

#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

struct InstrumentPart {
  enum class Joint { body, jaw_a, jaw_b, shaft, link, works, needle } joint = Joint::body;
  std::string look;
  MeshBuffer mesh;
  int link = 0;  ///< which of an instrument that bends, or of its linkage's parts
};

std::vector<InstrumentPart> instrument_parts(const interactions::ToolModel& tool);
/// A trocar's sleeve: z forward along whatever lies in it, origin at its fulcrum in the abdominal wall; its end is cut
/// at a slant. @param radius inside [m] @param reach how far the longer side of the slant reaches in [m]
/// @param from where it comes through the wall; below 0 behind the fulcrum [m]
std::vector<InstrumentPart> sleeve_parts(double radius, double reach, double from = 0);
inline constexpr double kSleeveWall = 0.0009;  ///< of a trocar's sleeve [m]
/// The endoscope's shaft: z forward, origin at its tip.
std::vector<InstrumentPart> scope_parts(double radius);

/// Where a part stands. Columns of the rotation are unit and right-handed.
struct Placement {
  Mat3f rotation = Mat3f::identity();
  Vec3f translation;
};
Placement placement_of(InstrumentPart::Joint joint, const interactions::ToolShape& shape, int link = 0);
/// The same of a part of the linkage between handle and jaws, which stands as jaws that are so far open have it.
Placement placement_of_works(const interactions::ToolModel& tool, const interactions::ToolShape& shape, int part,
                             double aperture);
/// How far jaws can be open while they are still in their trocar's sleeve: the mechanics do not know the sleeve.
/// @param beyond how far the sleeve reaches past the pivot [m] @param radius inside the sleeve [m]
double aperture_in_sleeve(const interactions::ToolModel& tool, double beyond, double radius);
/// From the pivot to the bend of a clip that lies in the jaws [m].
double clip_seat(const interactions::ToolModel& tool);

}  // namespace trocar::view
