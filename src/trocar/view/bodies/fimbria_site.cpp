#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/bodies/fimbria_site.hpp>

namespace trocar::view {
namespace {

constexpr double kFimbriaReach = 0.019;  // [m] from the tube's end to the ovary, no further
constexpr double kSlide = 0.0035;        // [m] of the frond lie on it
constexpr double kUpwards = 0.9;
constexpr float kAboveOvary = 0.0004f;

struct Touch {
  const tissue::Skin* skin = nullptr;
  std::size_t vertex = 0;
  double distance = kFimbriaReach;
};

/// The organ nearest to the end of what the strand does not itself grow from.
Touch nearest_organ(const sim::Model& model, const sim::StrandAnatomy& strand, Vec3d at) {
  Touch best;
  sim::visit_solids(model, [&](auto r) {
    if (strand.start.kind == sim::StrandEndModel::hosted && std::size_t(strand.start.organ()) == r.organ()) return;
    const tissue::Skin& skin = model_of(model, r).fine;
    for (std::size_t v = 0; v < skin.rest.size(); ++v)
      if (const double d = length(vec_cast<double>(skin.rest[v]) - at); d < best.distance) best = {&skin, v, d};
  });
  return best;
}

std::size_t nearest_vertex(const tissue::Skin& skin, Vec3d p) {
  std::size_t best = 0;
  for (std::size_t v = 1; v < skin.rest.size(); ++v)
    if (length(vec_cast<double>(skin.rest[v]) - p) < length(vec_cast<double>(skin.rest[best]) - p)) best = v;
  return best;
}

}  // namespace

FimbriaSite fimbria_site(const sim::Model& model, int strand, const CurveFrame& end) {
  const sim::StrandAnatomy& tube = model.strands[std::size_t(strand)];
  const auto local = [&end](Vec3d v) { return Vec3d{dot(v, end.tangent), dot(v, end.normal), dot(v, end.binormal)}; };
  FimbriaSite site;
  site.radius = kBellFlare * tube.outer.back();
  site.seed = strand + 1;
  site.down = local(normalised(model.gravity, Vec3d{0, 0, -1}));
  const Touch touch = nearest_organ(model, tube, end.point + 1.5 * site.radius * end.tangent);
  if (!touch.skin) return site;
  const Vec3d first = vec_cast<double>(touch.skin->rest[touch.vertex]),
              normal = vec_cast<double>(touch.skin->rest_normal[touch.vertex]);
  // Onwards, and on the ovary's upper side.
  const Vec3d way = normalised(first - end.point) + kUpwards * normalised(model.scope.port - first);
  const Vec3d slide = normalised(way - dot(way, normal) * normal, any_perpendicular(normal));
  const std::size_t on = nearest_vertex(*touch.skin, first + kSlide * slide);
  const Vec3f out = touch.skin->rest_normal[on];
  site.ovary = true;
  site.land = local(vec_cast<double>(touch.skin->rest[on] + kAboveOvary * out) - end.point);
  site.normal = local(vec_cast<double>(out));
  site.slide = normalised(local(slide) - dot(local(slide), site.normal) * site.normal, local(slide));
  return site;
}

}  // namespace trocar::view
