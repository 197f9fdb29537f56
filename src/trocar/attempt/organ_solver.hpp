// Which solver an organ of a scene gets, when somebody asks for another one than its file says.
//
//   load_adapted(exercise, 0, [](scene::Description& d) { set_solver(d, "bladder", scene::Solver::elastostatic); });
#pragma once

#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>

namespace trocar::attempt {

/// @param asked  what named the organ, for faults: an option
/// @throws core::BadInput with what there is, where there is no such organ
void set_solver(scene::Description& scene, const std::string& organ, scene::Solver solver,
                const std::string& asked = "--organ");

std::vector<std::string> organ_names(const scene::Description& scene);

/// "static", "dynamic": as an organ's file has it.
const char* name_of(scene::Solver solver);

}  // namespace trocar::attempt
