// Mechanisms that tests of studies share.
#pragma once

#include <string>

#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::studies {

inline kinematics::Mechanism shipped(const std::string& name) {
  return kinematics::build(
      scene::read_mechanism(scene::found_scenes_folder().value() / "mechanisms" / (name + ".json")));
}

}  // namespace trocar::studies
