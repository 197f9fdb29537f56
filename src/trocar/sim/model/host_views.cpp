#include <algorithm>
#include <utility>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/host_views.hpp>

namespace trocar::sim {

HostViews make_host_views(const Model& model) {
  HostViews v;
  v.organs.resize(size_t(model.organs()));
  v.cuttable_of.assign(size_t(model.organs()), -1);
  visit_cuttables(model, [&](CuttableRef organ) { v.cuttable_of[organ.organ()] = std::int32_t(organ.index); });
  v.membranes.resize(model.membranes.size());
  for (int i = 0; i < model.organs(); ++i) v.skins.push_back(&model.skin(i));
  for (const Vessel& vessel : model.vessels.list) {
    if (!vessel.pulses()) continue;
    for (const interactions::VesselPoint& p : vessel.path.points)
      for (size_t k = 0; k < 3 && p.hold.kind == interactions::VesselHold::organ; ++k)
        v.ridden.push_back({p.hold.index, p.hold.vertex[k]});
  }
  const auto key = [](HostViews::Corner c) { return std::pair(c.organ, c.vertex); };
  std::sort(v.ridden.begin(), v.ridden.end(), [&](auto a, auto b) { return key(a) < key(b); });
  v.ridden.erase(std::unique(v.ridden.begin(), v.ridden.end(), [&](auto a, auto b) { return key(a) == key(b); }),
                 v.ridden.end());
  for (const tissue::Skin* skin : v.skins) v.corners.emplace_back(size_t(skin->size()));
  return v;
}

interactions::VesselHosts look_at_hosts(const Model& model, const State& state, HostViews& v) noexcept {
  for (size_t i = 0; i < v.organs.size(); ++i) v.organs[i] = nodes_of(model, state, int(i));
  for (size_t i = 0; i < v.membranes.size(); ++i)
    v.membranes[i] = view_of(model.membranes[i].sheet.network, state.membranes[i].network);
  return {model.strand_bodies, state.strands, v.organs,    v.skins,
          state.cuttables,     v.cuttable_of, v.membranes, state.torn};
}

interactions::VesselHosts look_at_hosts_of_all(const Model& model, const State& state, HostViews& v) noexcept {
  interactions::VesselHosts hosts = look_at_hosts(model, state, v);
  for (const HostViews::Corner c : v.ridden)
    v.corners[size_t(c.organ)][size_t(c.vertex)] =
        skin_point(v.organs[size_t(c.organ)], *v.skins[size_t(c.organ)], c.vertex);
  hosts.corners = v.corners;
  return hosts;
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
