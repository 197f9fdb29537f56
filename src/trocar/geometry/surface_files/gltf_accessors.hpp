// Arrays of a glTF file: what accessors make of buffers. Used by gltf_*.cpp only.
#pragma once

#include <optional>
#include <vector>

#include <trocar/geometry/surface_files/gltf_document.hpp>

namespace trocar::geometry {

/// Positions of an accessor of type VEC3: float, or whole numbers as KHR_mesh_quantization has them; sparse ones with
/// their values put in. Nothing after a fault.
std::optional<std::vector<Vec3d>> gltf_points(GltfDocument& gltf, GltfItem accessor);
/// Whole numbers of an accessor of type SCALAR, each below `vertices`. Nothing after a fault.
std::optional<std::vector<int>> gltf_indices(GltfDocument& gltf, GltfItem accessor, std::size_t vertices);

}  // namespace trocar::geometry
