// Files of mechanisms: scenes/mechanisms/*.json. Every fault of a file is reported with its place, in one pass.
//
//   const kinematics::MechanismDescription d = read_mechanism("scenes/mechanisms/four_bar.json");   // or *.urdf
//   const kinematics::Mechanism m = kinematics::build(d);
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/kinematics/chains/description.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

/// Is it a robot's file, which is no JSON: by its ending (.urdf, .xacro), or XML of a robot, SDFormat or MuJoCo?
bool is_robot_file(const std::filesystem::path& path);

/// A file, JSON or URDF. What is wrong is appended to `faults`; without faults the description can be
/// built. With `memory` files are looked up there instead of on the disk.
kinematics::MechanismDescription read_mechanism(const std::filesystem::path& path, std::vector<core::Fault>& faults,
                                                const MemoryFiles* memory = nullptr);
/// The same. @throws core::BadInput with all faults
kinematics::MechanismDescription read_mechanism(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);
/// What is suspicious in a robot's file (URDF) that can be read: other units than its own, joints without a range.
std::vector<core::Fault> mechanism_warnings(const std::filesystem::path& path);
/// JSON text.
kinematics::MechanismDescription parse_mechanism(std::string_view text, const std::string& file,
                                                 std::vector<core::Fault>& faults);

/// JSON text of a mechanism with other values of its named parameters; whatever else its author wrote stays, and so do
/// values that it says already. @param values (named parameters, more are not looked at) [m, rad, 1]
/// @throws std::invalid_argument for a text that has faults
std::string mechanism_text_with(std::string_view text, std::span<const double> values);

/// The table of keys, from which scenes/schema/mechanism.schema.json is written.
const Shape& mechanism_shape();

/// Kinds of closures, as files call them.
std::vector<std::string> closure_words();

}  // namespace trocar::scene
