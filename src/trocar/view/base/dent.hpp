// Drawn organs beside instruments: finer than the mechanics resolve, the skin gives way to each of them, and dips
// around one that touches it.
#pragma once

#include <span>
#include <vector>

#include <trocar/collision/rods.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::view {

/// Might one of the instruments dent what is in the box?
bool near(const tissue::Box& box, std::span<const collision::Capsule> rods);

/// Moves the vertices; true where any was close enough. Normals are those before.
bool dent(std::span<const collision::Capsule> rods, std::span<Vec3f> positions, std::span<const Vec3f> normals);

}  // namespace trocar::view
