#include <trocar/view/base/listing.hpp>

namespace trocar::view {

RigidMesh rigid(MeshBuffer shape, const Detail& detail, render::Backend& backend) {
  coarsen(shape, detail, kRigid);
  return {{backend, shape.data()}, std::move(shape.positions)};
}

render::DrawItem item(render::MeshHandle mesh, const Look& look, std::size_t part) {
  render::DrawItem i;
  i.mesh = mesh;
  i.part = std::uint16_t(part);
  i.material = look.material;
  i.translucent = look.translucent;
  return i;
}

render::DrawItem& Listing::add(render::DrawItem item, Detail& detail, std::span<const Vec3f> points, bool whole) const {
  item.level = detail.level_at(eye.distance(points, item.transform), eye.index);
  item.detail = detail.surface(item.level);
  if (whole) item.level = 0;
  frame.items.push_back(item);
  return frame.items.back();
}

render::DrawItem& Listing::add(const RigidMesh& mesh, render::DrawItem item, Detail& detail) const {
  item.mesh = mesh.mesh.handle();
  return add(item, detail, mesh.points);
}

}  // namespace trocar::view
