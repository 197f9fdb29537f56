#include <trocar/geometry/nearest.hpp>
#include <trocar/interactions/nearest_skin.hpp>

namespace trocar::interactions {

int nearest_vertex_near(const Surface& surface, Vec3d p, double reach) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  int best = -1;
  double least = reach * reach;
  for (size_t b = 0; b < pose.block.size(); ++b) {
    if (!pose.block[b].reaches(p, reach)) continue;
    const int end = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
    for (int first = int(b) * tissue::kSkinBlock; first < end; first += tissue::kSkinPatch) {
      if (pose.patch[size_t(first / tissue::kSkinPatch)].distance2(p) >= least) continue;
      const int last = std::min(first + tissue::kSkinPatch, end);
      for (int v = first; v < last; ++v) {
        const double d = geometry::distance2(surface.position(v), p);
        if (d >= least || !surface.skin->at_surface(v)) continue;
        least = d;
        best = v;
      }
    }
  }
  return best;
}

SkinPoint nearest_on_faces(const Surface& surface, int vertex, Vec3d p) noexcept {
  const tissue::Skin& skin = *surface.skin;
  SkinPoint best;
  double least = 1e9;
  for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k) {
    const auto& t = skin.triangles[size_t(skin.face[size_t(k)])];
    const auto on =
        geometry::closest_on_triangle(p, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
    if (on.distance2 >= least) continue;
    least = on.distance2;
    best.vertex = t;
    best.weights = on.weights;
    best.point = on.point;
  }
  return best;
}

SkinPoint nearest_skin_point(const Surface& surface, int vertex, Vec3d p) noexcept {
  SkinPoint best = nearest_on_faces(surface, vertex, p);
  for (size_t k = 0; k < 3; ++k) best.normal += best.weights[int(k)] * surface.normal(best.vertex[k]);
  best.normal = normalised(best.normal, surface.normal(vertex));
  return best;
}

}  // namespace trocar::interactions
