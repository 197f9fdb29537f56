#include <trocar/fluids/shown_fluids.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/keyframe_bytes.hpp>
#include <trocar/sim/verbs/verbs.hpp>
#include <trocar/tissue/heat/heat_scars.hpp>

namespace trocar::sim {
namespace {

using namespace keyframe;

/// The few triangles that are cut open, by number.
std::vector<std::uint32_t> open_triangles(const std::vector<std::uint8_t>& parted) {
  std::vector<std::uint32_t> open;
  for (size_t t = 0; t < parted.size(); ++t)
    if (parted[t]) open.push_back(std::uint32_t(t));
  return open;
}

/// What a cut has made of a body, and where its nodes are.
void put_body(std::vector<std::uint8_t>& out, const tissue::CuttableModel& m, const tissue::CuttableState& s) {
  const size_t nodes = size_t(s.tets.nodes);
  put(out, &s.tets.nodes, 1);
  put_changes(out, s.tets.source, m.drawn.source, nodes);
  put_changes(out, s.tets.rest, m.drawn.rest, nodes);
  put_changes(out, s.tets.cells, m.drawn.cells, s.tets.cells.size());
  put_changes(out, s.tets.across, m.drawn.across, s.tets.across.size());
  for (int n = 0; n < s.tets.nodes; ++n) put_place(out, tissue::position(m, s, n), s.tets.rest[size_t(n)]);
}

void put_vessels(std::vector<std::uint8_t>& out, const State& s) {
  for_flow([&out](const auto& values) { put(out, values.data(), values.size()); }, s);
  put(out, &s.flow.bled, 1);
  put(out, &s.opening_count, 1);
  put(out, s.openings.data(), size_t(s.opening_count));
  put(out, &s.vessel_clip_count, 1);
  put(out, s.vessel_clips.data(), size_t(s.vessel_clip_count));
}

/// What is seen of it: where a drug is and since when. Numbers of what lies there are small beside that.
void put_injection(std::vector<std::uint8_t>& out, const InjectionState& s) {
  put(out, s.hands.data(), s.hands.size());
  put(out, &s.account, 1);
  for (const tissue::InfusionState& organ : s.organs) {
    std::uint32_t n = 0;
    for (const float dose : organ.dose) n += dose > 0 ? 1 : 0;
    put(out, &n, 1);
    for (size_t r = 0; r < organ.dose.size(); ++r) {
      if (!(organ.dose[r] > 0)) continue;
      const auto row = std::uint32_t(r);
      put(out, &row, 1);
      put(out, &organ.dose[r], 1);
      put(out, &organ.since[r], 1);
    }
  }
}

}  // namespace

std::vector<std::uint8_t> display_bytes(const Model& model, const State& s) {
  std::vector<std::uint8_t> out;
  put(out, &s.tick, 1);
  const auto put_network = [&](auto r) {
    const tissue::NetworkModel& network = network_of(model, r);
    for (int n = 0; n < network.nodes; ++n)
      put_place(out, tissue::position(network, network_state_of(s, r), n), network.rest[size_t(n)]);
  };
  visit_bodies(model, Overloaded{[&](SolidRef r) { put_network(r); }, [&](MembraneRef r) { put_network(r); },
                                 [&](CuttableRef r) { put_body(out, model_of(model, r).body, state_of(s, r)); },
                                 [&](StrandRef r) {
                                   const tissue::StrandState& rod = state_of(s, r);
                                   for (size_t n = 0; n < rod.x.size(); ++n)
                                     put_place(out, rod.x[n], rod_of(model, r).model.rest[n]);
                                   put(out, rod.alive.data(), rod.alive.size());
                                 }});
  put(out, &s.tools, 1);
  put(out, &s.scope, 1);
  visit_record_buffers(model, s, [&out](auto, auto buffer) {
    put(out, &buffer.count, 1);
    put(out, buffer.used().data(), buffer.used().size());
  });
  for (const auto* bodies : {&s.parted, &s.torn})
    for (const std::vector<std::uint8_t>& parted : *bodies) {
      const std::vector<std::uint32_t> open = open_triangles(parted);
      const auto n = std::uint32_t(open.size());
      put(out, &n, 1);
      put(out, open.data(), open.size());
    }
  if (model.vessels.there()) put_vessels(out, s);
  if (model.energy.there) {
    put(out, s.electrodes.data(), s.electrodes.size());
    tissue::put_scars(s.heat, out);
  }
  if (model.wet.there) fluids::put_shown(model.wet.model, s.fluids, out);
  interactions::ObjectKinds::for_each([&](auto kind) {
    kind.serialize_display(interactions::part_of<decltype(kind)>(model), interactions::part_of<decltype(kind)>(s),
                           [&out](const auto* values, size_t n) { put(out, values, n); });
  });
  for (const auto& bonds : s.bonds) put(out, bonds.data(), bonds.size());
  put(out, s.joints.data(), s.joints.size());
  put(out, s.ports.data(), s.ports.size());
  if (s.injection.there()) put_injection(out, s.injection);
  return out;
}

}  // namespace trocar::sim
