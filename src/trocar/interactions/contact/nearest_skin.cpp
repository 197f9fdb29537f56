#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>

namespace trocar::interactions {

namespace {

/// The nearest vertex so far.
struct Nearest {
  int vertex = -1;
  double least = 0;  ///< square of its distance [m^2]
};

/// Box::distance2 to the last bit, without a branch.
double square_beyond(const tissue::Box& box, Vec3d p) noexcept {
  const auto beyond = [](double q, double low, double high) {
    const double below = low - q, above = q - high, off = below > above ? below : above;
    return off > 0 ? off : 0.0;
  };
  const double x = beyond(p.x, double(box.low.x), double(box.high.x));
  const double y = beyond(p.y, double(box.low.y), double(box.high.y));
  const double z = beyond(p.z, double(box.low.z), double(box.high.z));
  return x * x + y * y + z * z;
}

void look_into_block(const Surface& surface, Vec3d p, int b, Nearest& best) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  if (!(square_beyond(pose.block[size_t(b)], p) < best.least)) return;
  const int end = std::min((b + 1) * tissue::kSkinBlock, surface.skin->size());
  for (int first = b * tissue::kSkinBlock; first < end; first += tissue::kSkinPatch) {
    if (!(square_beyond(pose.patch[size_t(first / tissue::kSkinPatch)], p) < best.least)) continue;
    const int last = std::min(first + tissue::kSkinPatch, end);
    for (int v = first; v < last; ++v) {
      const double d = geometry::distance2(surface.position(v), p);
      if (d >= best.least || !surface.skin->at_surface(v)) continue;
      best = {v, d};
    }
  }
}

}  // namespace

int nearest_vertex_near(const Surface& surface, Vec3d p, double reach) noexcept {
  Nearest best{-1, reach * reach};
  for (size_t b = 0; b < surface.pose->block.size(); ++b) look_into_block(surface, p, int(b), best);
  return best.vertex;
}

int nearest_vertex_near(const Surface& surface, Vec3d p, double reach, std::span<const std::int32_t> blocks) noexcept {
  Nearest best{-1, reach * reach};
  for (const std::int32_t b : blocks) look_into_block(surface, p, b, best);
  return best.vertex;
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

bool encloses(const Surface& surface, Vec3d p) noexcept {
  constexpr double kLeansX = 0.0137, kLeansY = 0.0071;  // of a ray that rises, so that it meets no upright wall flatly
  const tissue::Skin& skin = *surface.skin;
  bool inside = false;
  const auto seen_along = [&](int v) {
    const Vec3d off = surface.position(v) - p;
    return Vec3d{off.x - kLeansX * off.z, off.y - kLeansY * off.z, off.z};
  };
  for (const auto& t : skin.triangles) {
    const Vec3d u = seen_along(t[0]), v = seen_along(t[1]), w = seen_along(t[2]);
    const double uv = u.x * v.y - u.y * v.x, vw = v.x * w.y - v.y * w.x, wu = w.x * u.y - w.y * u.x;
    if ((uv > 0) != (vw > 0) || (uv > 0) != (wu > 0)) continue;
    if (!((vw * u.z + wu * v.z + uv * w.z) / (uv + vw + wu) > 0)) continue;
    if (surface.torn(t[0]) || surface.torn(t[1]) || surface.torn(t[2])) return true;
    inside = !inside;
  }
  return inside;
}

}  // namespace trocar::interactions
