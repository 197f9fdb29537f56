// Robots as URDF describes them: links and joints, inertias, cylinders, spheres and boxes; joints that mimic others
// become couplings. Meshes are left out (they are files beside it), and so is what says nothing of kinematics
// (materials, transmissions, extensions). Joints of type "floating" and "planar" are reported as faults.
//
//   std::vector<core::Fault> faults;
//   const kinematics::MechanismDescription d = read_urdf(text, "arm.urdf", faults);
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/kinematics/chains/description.hpp>
#include <trocar/scene/mechanisms/xml.hpp>

namespace trocar::scene {

inline constexpr std::size_t kMaxUrdfBytes = kMaxXmlBytes;

/// Any text. Without faults the description can be built: every coordinate that mimics none is an actuator, between its
/// limits (one turn where it has none). @param file  as faults show it
kinematics::MechanismDescription read_urdf(std::string_view text, const std::string& file,
                                           std::vector<core::Fault>& faults);

}  // namespace trocar::scene
