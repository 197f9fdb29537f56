#include <algorithm>

#include <trocar/attempt/organ_solver.hpp>
#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::attempt {

std::vector<std::string> organ_names(const scene::Description& scene) {
  std::vector<std::string> names;
  for (const scene::Solid& s : scene.solids) names.push_back(s.name);
  return names;
}

void set_solver(scene::Description& scene, const std::string& organ, scene::Solver solver, const std::string& asked) {
  const auto named = [&organ](const scene::Solid& s) { return s.name == organ; };
  const auto found = std::find_if(scene.solids.begin(), scene.solids.end(), named);
  if (found == scene.solids.end())
    throw core::BadInput({{{asked, 0, 0}, scene::unknown_name("organ", organ, organ_names(scene))}});
  found->solver = solver;
  if (found->solver_at.file.empty()) found->solver_at = found->at;  // its file says nothing of a solver: faults, here
}

const char* name_of(scene::Solver solver) { return solver == scene::Solver::elastostatic ? "static" : "dynamic"; }

}  // namespace trocar::attempt
