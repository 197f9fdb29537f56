// Robots are often kept as xacro: URDF with macros and arithmetic, which a program of that name expands. What was not
// expanded is missing in the robot, so it is a fault, with the command that expands it.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/mechanisms/xml.hpp>

namespace trocar::scene {

/// Appends a fault for each element and attribute that xacro should have replaced (the first ones of many), or for a
/// file that is named .xacro. @return were there any?
bool tell_of_xacro(const XmlElement& root, const std::string& file, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
