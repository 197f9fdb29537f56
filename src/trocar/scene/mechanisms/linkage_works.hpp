// Rods and bars of a linkage as they are drawn (interactions/instrument/linkage_works.hpp).
#pragma once

#include <memory>
#include <span>

#include <trocar/interactions/instrument/linkage_works.hpp>
#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::scene {

/// @param poses       (kLinkageSteps + 1) the mechanism along its handle's way
/// @param upper, lower  frames of the jaws' tips
/// @param jaw_length  of the instrument: its jaws' hinge is that far behind the closed tips
std::shared_ptr<const interactions::LinkageWorks> works_of(const kinematics::Mechanism& m,
                                                           std::span<const kinematics::Pose> poses, int upper,
                                                           int lower, double jaw_length);

}  // namespace trocar::scene
