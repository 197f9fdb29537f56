// What is suspicious in a robot's file that can be read: lengths that are no metres, angles that are no radians, joints
// without limits or without a range.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/mechanisms/xml.hpp>

namespace trocar::scene {

/// @param root  of a URDF without faults
std::vector<core::Fault> urdf_warnings(const XmlElement& root, const std::string& file);

}  // namespace trocar::scene
