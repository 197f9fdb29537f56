// How a drawing becomes items of a frame: with its look, its part's number and the triangles that its distance asks
// for.
#pragma once

#include <span>
#include <vector>

#include <trocar/render/frame/frame.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// A mesh that does not bend.
struct RigidMesh {
  OwnedMesh mesh;
  std::vector<Vec3f> points;  ///< of it
};
RigidMesh rigid(MeshBuffer shape, const Detail& detail, render::Backend& backend);

render::DrawItem item(render::MeshHandle mesh, const Look& look, std::size_t part);

/// Where this frame's items go to.
struct Listing {
  render::Frame& frame;
  const DetailEye& eye;

  void add(const render::DrawItem& item) const { frame.items.push_back(item); }
  /// As fine as its distance asks for. @param points  of it @param whole  with all its triangles, which burns, dents
  /// and what jaws do to it need
  render::DrawItem& add(render::DrawItem item, Detail& detail, std::span<const Vec3f> points, bool whole = false) const;
  render::DrawItem& add(const RigidMesh& mesh, render::DrawItem item, Detail& detail) const;
};

}  // namespace trocar::view
