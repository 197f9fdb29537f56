// Vessels of a scene become one graph of blood flow, and lines that ride on the scene's bodies.
#pragma once

#include <vector>

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

inline constexpr double kMostVesselPoints = 50'000;  ///< of all lines of a scene
inline constexpr double kVesselSpacing = 0.0025;     ///< of these [m]

/// Fills Model::vessels. All bodies must be compiled before.
void compile_vessels(const Description& description, sim::Model& model, std::vector<core::Fault>& faults,
                     CompileReport* report);

}  // namespace trocar::scene
