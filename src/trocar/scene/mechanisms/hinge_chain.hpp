// What of a mechanism an instrument can have beyond its trocar: the hinges between its link "shaft" and its frame
// "tip", as the step computes with them.
#pragma once

#include <string>

#include <trocar/kinematics/articulation.hpp>
#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::scene {

/// However its frames lie, also by Denavit-Hartenberg numbers: with all hinges at 0 the chain is straight, along the
/// z axis of the link "shaft" (either way), which all hinges cross squarely, and which the tip is on; they turn about
/// the tip frame's x or y. What turns all hinges alike (vertebrae that share cables) is one joint; hinges that are
/// coupled otherwise are a joint each, as an instrument is controlled by its joints, and motors follow: they must be
/// able to. A joint's angle is that of its hinge; of several hinges that of the coordinate which turns them. Limits are
/// those of both.
/// @returns empty, or what is wrong: what is there in place of that
std::string take_hinges(const kinematics::Mechanism& m, double jaw_length, kinematics::Articulation& out);

}  // namespace trocar::scene
