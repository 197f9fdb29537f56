// What scissors go through where they close. The verb (cut.hpp) asks in the tick in which they do; who leads them may
// ask beforehand, with the shape that they have or will have. Nothing is changed here.
//
//   const geometry::Blade blade = closed_blades(model, shape);
//   if (crosses(geometry::BladePlane(blade), network, state)) ...
#pragma once

#include <trocar/geometry/tets/blade.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::interactions {

inline constexpr double kBesideBlades = 0.0015;  ///< [m] beside the gap between the blades that their edges still reach

/// A flat strip along the jaws, from their hinge to `length` before it. @param at_hinge, at_tips  half its width there
geometry::Blade strip_of_blades(const ToolShape& shape, double at_hinge, double at_tips, double length) noexcept;

/// The strip that the blades have closed on: from the hinge to the tips, as wide as they are open and a little more.
/// @param beyond  how far it continues before the tips, to leave room [m]
geometry::Blade closed_blades(const ToolModel& model, const ToolShape& shape, double beyond = 0) noexcept;

/// How a strand lies between blades.
struct BetweenBlades {
  int element = -1;     ///< that they part; -1: none, it does not lie between them
  BetweenJaws where;    ///< of this element
  double fraction = 0;  ///< of the cross-section that they reach over
};
/// Of the elements between the blades the one nearest to where they meet. Strands that are not cuttable are never cut.
BetweenBlades between_blades(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                             const tissue::StrandState& state) noexcept;

/// Does a whole spring cross the blade? One that is severed does not.
bool crosses(const geometry::BladePlane& plane, const tissue::NetworkModel& network, const tissue::NetworkState& state,
             int spring) noexcept;
/// Does any?
bool crosses(const geometry::BladePlane& plane, const tissue::NetworkModel& network,
             const tissue::NetworkState& state) noexcept;

}  // namespace trocar::interactions
