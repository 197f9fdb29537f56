// An organ where its two solvers are farthest apart, as pictures: as it looks, and in colours of the distance with the
// other solver's outline as wires. From outside, at an angle to the surface, from where least hides it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/attempt/solver_comparison.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::pictures {

struct SolverPicture {
  std::string file;  ///< in the folder
  std::string text;  ///< for people
};

/// Writes them into an existing folder.
/// @throws core::EnvironmentLacks without OpenGL
std::vector<SolverPicture> draw_solvers(const attempt::SolverPair& pair, const attempt::SolverComparison& comparison,
                                        const std::filesystem::path& folder, PictureSize size = {960, 720});

}  // namespace trocar::pictures
