// Where drives stand: a handle a drive, 0 to 1. What a study of dimensions holds is the handle, not the coordinate, as
// the ends of a drive's way are dimensions, too.
#pragma once

#include <span>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::studies {

/// (drives) of the start that the file describes.
std::vector<double> start_handles(const kinematics::Mechanism& m);

/// Sets the driven coordinates. @param handles (drives)  @param u (u_count)
void set_handles(const kinematics::Mechanism& m, std::span<const double> handles, std::span<double> u) noexcept;

/// Holds what is driven; of a mechanism without loops everything, as nothing else says where the rest stands.
void hold_for_study(const kinematics::Mechanism& m, kinematics::LoopWork& work) noexcept;

/// From the closed pose u along the branch to these handles, everything driven being held.
kinematics::MoveReport move_handles(const kinematics::Mechanism& m, std::span<const double> handles,
                                    std::span<double> u, const kinematics::Branch& branch, kinematics::LoopWork& work);

}  // namespace trocar::studies
