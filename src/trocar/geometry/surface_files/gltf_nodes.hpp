// Where the meshes of a glTF file stand: its nodes' transforms, one after the other. Used by gltf_reader.cpp only.
#pragma once

#include <vector>

#include <trocar/geometry/surface_files/gltf_document.hpp>

namespace trocar::geometry {

/// p -> linear p + shift
struct Affine {
  Mat3d linear = Mat3d::identity();
  Vec3d shift{};
  Vec3d operator()(Vec3d p) const { return linear * p + shift; }
};

struct GltfPlaced {
  GltfItem node, mesh;
  Affine place;
};
/// Every node of the scene that is shown which has a mesh, parents before children; without a scene, of all nodes.
/// Nodes that are reached twice are a fault: there are no circles.
std::vector<GltfPlaced> gltf_placed(GltfDocument& gltf);

}  // namespace trocar::geometry
