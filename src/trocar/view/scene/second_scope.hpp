// A second endoscope, through a second trocar: nobody needs it for the exercise, it only looks. It stands at a free
// place of the abdominal wall, is aimed by hand, and has a lamp of its own; the simulation does not know it.
//
//   SecondScope second = second_scope_of(model);
//   aim(second, 0.1, 0);                                     // a little to the picture's right
//   const ViewOptions options = view_through(second);
#pragma once

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {

/// Between the first endoscope's trocar and a hand's, whichever leaves the most room around it; deep enough to look
/// out of its trocar, towards the middle of the scene.
SecondScope second_scope_of(const sim::Model& model);

/// Swings about the trocar, to look further to the picture's right and up [rad].
void aim(SecondScope& scope, double right, double up);
/// In (> 0) or out [m].
void advance(SecondScope& scope, double by);

/// Its picture: the endoscope's optics, its own place.
ViewOptions view_through(const SecondScope& scope);

}  // namespace trocar::view
