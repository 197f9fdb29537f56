// What a scene can be built with and hardly means: meshes that had to be mended, instruments that begin inside an
// organ. `trocar check` says so, and so does every attempt's beginning.
#pragma once

#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// A tip deeper than this below an organ's drawn surface is inside it; less is a touch [m].
inline constexpr double kTouchDepth = 0.001;

/// @param warnings  out: with the places in the files, in the order of the scene
void find_warnings(const Description& description, const sim::Model& model, std::vector<core::Fault>& warnings);

}  // namespace trocar::scene
