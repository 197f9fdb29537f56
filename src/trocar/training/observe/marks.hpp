// Marks: whatever of a scene its visibility targets name (a drawn mark, an organ, a strand's landmark, a jaw, the
// bleeding place), as a point in space, and how it lies in the picture.
#pragma once

#include <optional>

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// The middle of a mark's samples [m]. @param mark  a target that is there
Vec3d place_of_mark(const sim::Model& model, const sim::State& state, int mark);
/// Where a disc faces, or out of an organ's surface; nothing for strands, stripes and instruments, which face every
/// way, and for closed surfaces whose sides cancel.
std::optional<Vec3d> normal_of_mark(const sim::Model& model, const sim::State& state, int mark);

}  // namespace trocar::training
