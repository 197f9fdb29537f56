#include <algorithm>
#include <utility>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/vessel_carriers.hpp>

namespace trocar::sim {

RiddenCorners make_ridden_corners(const Model& model) {
  RiddenCorners c;
  for (const Vessel& vessel : model.vessels.list) {
    if (!vessel.pulses()) continue;
    for (const interactions::VesselPoint& p : vessel.path.points)
      for (size_t k = 0; k < 3 && p.hold.kind == interactions::VesselHold::organ; ++k)
        c.list.push_back({p.hold.index, p.hold.vertex[k]});
  }
  const auto key = [](RiddenCorners::Corner at) { return std::pair(at.organ, at.vertex); };
  std::sort(c.list.begin(), c.list.end(), [&](auto a, auto b) { return key(a) < key(b); });
  c.list.erase(std::unique(c.list.begin(), c.list.end(), [&](auto a, auto b) { return key(a) == key(b); }),
               c.list.end());
  for (int i = 0; i < model.organs(); ++i) c.place.emplace_back(size_t(model.skin(i).size()));
  return c;
}

void pose(const interactions::Bodies& bodies, RiddenCorners& corners) noexcept {
  for (const RiddenCorners::Corner c : corners.list)
    corners.place[size_t(c.organ)][size_t(c.vertex)] =
        skin_point(organ_nodes(bodies, size_t(c.organ)), bodies.models.skin(c.organ), c.vertex);
}

std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept {
  size_t n = 0;
  for (int i = 0; i < state.opening_count; ++i) {
    const interactions::VesselOpening& o = state.openings[size_t(i)];
    if (o.vessel == vessel && o.through) out[n++] = o.s;
  }
  return {out.data(), n};
}

}  // namespace trocar::sim
