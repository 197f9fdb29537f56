#include <trocar/modeller/drive/places.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::modeller {

std::vector<BodyPlace> places_of(const sim::Model& model, const sim::State& state) {
  std::vector<BodyPlace> out;
  for (int i = 0; i < model.organs(); ++i) {
    const tissue::NodeView nodes = nodes_of(model, state, i);
    const tissue::Skin& skin = model.skin(i);
    for (int v = 0; v < skin.size(); ++v)
      if (skin.at_surface(v)) out.push_back({BodyId::organ(std::size_t(i)), skin_point(nodes, skin, v)});
  }
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    const tissue::NodeView nodes = membrane_nodes(bodies_of(model, state), i);
    for (std::size_t n = 0; n < nodes.row_of_node.size(); ++n)
      out.push_back({BodyId::membrane(i), nodes.position(int(n))});
  }
  for (std::size_t i = 0; i < model.strand_bodies.size(); ++i) {
    const interactions::StrandBody& body = model.strand_bodies[i];
    constexpr int kSteps = 60;
    for (int k = 0; k <= kSteps; ++k)
      out.push_back({BodyId::strand(i), point_at(body, state.strands[i], place_at(body, body.length() * k / kSteps))});
  }
  return out;
}

std::optional<BodyPlace> nearest(const std::vector<BodyPlace>& places, Vec3d point) {
  std::optional<BodyPlace> best;
  for (const BodyPlace& p : places)
    if (!best || length(p.at - point) < length(best->at - point)) best = p;
  return best;
}

std::optional<BodyPlace> met_by(const std::vector<BodyPlace>& places, Vec3d from, Vec3d direction, double reach) {
  std::optional<BodyPlace> best;
  double first = 0;
  for (const BodyPlace& p : places) {
    const double along = dot(p.at - from, direction);
    if (along <= 0 || length(p.at - from - direction * along) > reach) continue;
    // in front of others by more than what the ray's width makes uncertain
    const double rank = along + 2 * length(p.at - from - direction * along);
    if (!best || rank < first) best = p, first = rank;
  }
  return best;
}

}  // namespace trocar::modeller
