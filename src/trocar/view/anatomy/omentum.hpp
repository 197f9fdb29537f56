// Fat of the omentum, an apron in lobes on what the lowest part of a wall is. Drawing only: instruments go through it.
#pragma once

#include <trocar/tissue/network/skin.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// On the part of a wall that lies lowest, as gravity [m/s^2] says; empty where none does. Its border is ragged and
/// runs out under the wall.
MeshBuffer omentum_on(const tissue::Skin& wall, Vec3d gravity);
/// The same on what continues from the wall's border.
MeshBuffer omentum_beyond(const tissue::Skin& wall, Vec3d gravity, const MeshBuffer& beyond);

}  // namespace trocar::view
