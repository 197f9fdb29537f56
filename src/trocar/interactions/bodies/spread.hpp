// A material point that many nodes carry: where a rod grows out of an organ, so that its pull is spread.
#pragma once

#include <trocar/interactions/bodies/models.hpp>

namespace trocar::interactions {

/// Smooth weights about `place` over the nodes of an organ within `radius`, corrected to be exact for affine motions,
/// as a long row of the models.
/// @param mass  (nodes) of the organ [kg]
/// Throws std::invalid_argument when fewer than four nodes are there.
MaterialPoint spread(BodyModels& models, std::size_t organ, std::span<const double> mass, Vec3d place, double radius);

}  // namespace trocar::interactions
