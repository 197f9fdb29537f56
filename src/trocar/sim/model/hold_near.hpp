// The body of a Model that is nearest to a place, in the drawn shape: for bodies that are attached there when a scene
// is compiled.
#pragma once

#include <string>
#include <vector>

#include <trocar/sim/model/model.hpp>

namespace trocar::sim {

/// The strand or organ of those named that is nearest to p and within reach of its surface [m], and the place on it;
/// else space.
interactions::BorderHold hold_near(const std::vector<std::string>& names, double reach, Vec3d p, const Model& model);

}  // namespace trocar::sim
