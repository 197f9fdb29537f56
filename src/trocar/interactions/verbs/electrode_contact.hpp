// Where an electrode is at tissue, in the frame in which heat and scars stay with that tissue (tissue/heat/heat.hpp):
//   organs, folds  places in the drawn shape [m]; the nearest point of the touched skin or of the sheet, by its corners
//   strands        (arc length in the drawn shape, across, across) [m] in the frame that goes along the strand without
//                  twist
// Walls conduct nothing: they have no place that heat could have.
//
//   ElectrodeTouch t = electrode_touch(model, shape, tool_state, view);
//   if (t.contact.body.exists()) energise(..., t.contact, ...);
#pragma once

#include <trocar/interactions/verbs/grasp.hpp>
#include <trocar/tissue/heat/electrosurgery.hpp>

namespace trocar::interactions {

struct ElectrodeTouch {
  tissue::ElectrodeContact contact;  ///< body: none where none is near
  Vec3d place;                       ///< the tissue's point [m]
  Vec3d normal{0, 0, 1};             ///< there, out of the tissue; between jaws: their opening
  MaterialPoint point;               ///< the tissue's point that is nearest to that and can be held
  Vec3d inwards{0, 0, 0};            ///< from there into the tissue, in the contact's frame; zero between jaws
};

/// The last millimetres of a hook's wire that are bare at its tip; all of its foot is.               [m]  Our choice
inline constexpr double kBareWire = 0.004;
/// Between skin and wire this counts as touching: skins' triangles are flat, tissue is not.          [m]  Our choice
inline constexpr double kTouches = 0.0003;

/// How far a place is off a hook's metal [m], as thick as tissue meets that (tool_contact.hpp): closed jaws are one
/// rod.
double off_wire(const ToolShape& shape, Vec3d place) noexcept;

/// A hook: what is nearest to its bare end. Bipolar jaws: what they hold, from pad to pad.
ElectrodeTouch electrode_touch(const ToolModel& model, const ToolShape& shape, const ToolState& tool,
                               const Bodies& bodies) noexcept;

}  // namespace trocar::interactions
