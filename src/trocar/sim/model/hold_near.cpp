#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/sim/model/hold_near.hpp>

namespace trocar::sim {

interactions::BorderHold hold_near(const std::vector<std::string>& names, double reach, Vec3d p, const Model& model) {
  interactions::BorderHold best;
  best.offset = p;
  double nearest = reach;
  for (const std::string& name : names) {
    const int strand = model.strand_index(name);
    if (strand >= 0) {
      const interactions::StrandBody& body = model.strand_bodies[size_t(strand)];
      for (int e = 0; e + 1 < body.nodes(); ++e) {
        const Vec3d a = body.model.rest[size_t(e)], b = body.model.rest[size_t(e) + 1];
        const double w = geometry::closest_on_segment(p, a, b);
        const Vec3d at = a + w * (b - a);
        const double distance = length(p - at) - body.model.radius[size_t(e)];
        if (distance >= nearest) continue;
        nearest = distance;
        best.kind = interactions::BorderHold::strand;
        best.index = strand;
        best.place = {e, w};
        best.vertex = -1;
        best.offset = p - at;
      }
    }
    if (const int i = model.organ_index(name); i >= 0) {
      const tissue::Skin& skin = model.skin(i);
      for (int v = 0; v < skin.size(); ++v) {
        const Vec3d at = vec_cast<double>(skin.rest[size_t(v)]);
        const double distance = length(p - at);
        if (distance >= nearest || !skin.at_surface(v)) continue;
        nearest = distance;
        best.kind = interactions::BorderHold::organ;
        best.index = std::int32_t(i);
        best.place = {};
        best.vertex = v;
        best.offset = p - at;
      }
    }
  }
  return best;
}

}  // namespace trocar::sim
