// What several kinds of instruments are made of: shafts, the fork that two jaws turn in, insulation. Frames as in
// instrument_shapes.hpp.
#pragma once

#include <trocar/view/instruments/instrument_shapes.hpp>
#include <trocar/view/instruments/shapes.hpp>

namespace trocar::view::metal {

using interactions::ToolModel;
using PartJoint = InstrumentPart::Joint;

inline constexpr int kAround = 40;
// Blood is what clings there after work, burn what chars there: SceneView says how much of it is on an instrument.
inline constexpr Paint kClean{255, 0, 0, 0}, kShaded{110, 0, 0, 0}, kHollow{40, 0, 0, 90}, kUsed{235, 190, 0, 0},
    kSmeared{235, 80, 0, 0};
inline constexpr Paint kJoint{110, 150, 0, 60};

void merge(MeshBuffer& to, const MeshBuffer& part);

/// Blood that stays in a joint: most at the pivot, none a few millimetres off it. @param z from the pivot [m]
Paint stained(double z, double most);

/// Fork with a rivet that carries two turning jaws; between its cheeks the rod that drives them.
MeshBuffer hinge(double radius);
inline constexpr double kHingeFrom = -0.0098;  ///< the shaft's end before it [m]

/// Shaft and fork of an instrument whose jaws turn; where a linkage drives them (ToolModel::works), a longer fork with
/// its rods and bars in it, and the tails of the jaws.
void add_hinge(std::vector<InstrumentPart>& parts, const ToolModel& tool);

/// Root of a jaw, between the fork's cheeks beside its fellow's: an eye around the rivet.
MeshBuffer jaw_root(double radius);

/// Tube of the shaft, from the handle's side to `end`.
MeshBuffer shaft(const ToolModel& tool, double end);

/// A tube, open at its end: the applier's mouth, the bore of a suction-irrigator.
MeshBuffer open_shaft(const ToolModel& tool, double end, double wall);

/// A white end on an insulated shaft: ceramic or PTFE from `from` to `end` [m], narrower at its end, which heat has
/// browned.
MeshBuffer insulator(const ToolModel& tool, double from, double end, double end_radius);

}  // namespace trocar::view::metal
