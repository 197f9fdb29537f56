#include <trocar/sim/host_views.hpp>

namespace trocar::sim {

HostViews make_host_views(const Model& model) {
  HostViews v;
  v.organs.resize(size_t(model.organs()));
  v.membranes.resize(model.membranes.size());
  for (int i = 0; i < model.organs(); ++i) v.skins.push_back(&model.skin(i));
  return v;
}

interactions::VesselHosts look_at_hosts(const Model& model, const State& state, HostViews& v) noexcept {
  for (size_t i = 0; i < v.organs.size(); ++i) v.organs[i] = nodes_of(model, state, int(i));
  for (size_t i = 0; i < v.membranes.size(); ++i)
    v.membranes[i] = view_of(model.membranes[i].sheet.network, state.membranes[i].network);
  return {model.bodies, state.strands, v.organs, v.skins, state.cuttables, v.membranes, state.torn};
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
