// Marks: whatever of a scene its visibility targets name (a drawn mark, an organ, a strand's landmark, a jaw, the
// bleeding place), as a point in space, and how it lies in the picture.
#pragma once

#include <optional>

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// The middle of a mark's samples [m]. @param mark  a target that is there
Vec3d place_of_mark(const sim::Model& model, const sim::State& state, int mark);
/// Has it a direction in which it faces? Strands, stripes, folds and instruments face every way.
bool can_face(const sim::Model& model, const sim::VisibilityTarget& target);
/// Where a disc faces, or out of an organ's surface; nothing for what faces every way, and for closed surfaces whose
/// sides cancel.
std::optional<Vec3d> normal_of_mark(const sim::Model& model, const sim::State& state, int mark);

}  // namespace trocar::training
