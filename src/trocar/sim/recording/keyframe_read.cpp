#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/fluids/shown_fluids.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/pool_floor.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/keyframe_bytes.hpp>
#include <trocar/sim/recording/keyframe_check.hpp>
#include <trocar/sim/verbs/verbs.hpp>
#include <trocar/tissue/heat/heat_scars.hpp>

namespace trocar::sim {
namespace {

using namespace keyframe;

void take_body(Source& in, const tissue::CuttableModel& m, tissue::CuttableState& s) {
  s.tets = m.drawn;
  in.take(&s.tets.nodes, 1);
  in.good = in.good && s.tets.nodes >= m.own_nodes && size_t(s.tets.nodes) <= m.drawn.rest.size();
  if (!in.good) return;
  const size_t nodes = size_t(s.tets.nodes);
  take_changes(in, s.tets.source, nodes);
  take_changes(in, s.tets.rest, nodes);
  take_changes(in, s.tets.cells, s.tets.cells.size());
  take_changes(in, s.tets.across, s.tets.across.size());
  in.good = in.good && sound(s.tets);
  if (in.good) s.version = tissue::version_of(m, s.tets);
  for (int n = 0; in.good && n < s.tets.nodes; ++n)
    tissue::set_position(m, s, n, in.take_place(s.tets.rest[size_t(n)]));
}

void take_vessels(Source& in, const Model& model, State& s) {
  for_flow([&in](auto& values) { in.take(values.data(), values.size()); }, s);
  in.take(&s.flow.bled, 1);
  in.take(&s.opening_count, 1);
  in.good = in.good && s.opening_count >= 0 && s.opening_count <= interactions::kMaxOpenings;
  if (in.good) in.take(s.openings.data(), size_t(s.opening_count));
  in.take(&s.vessel_clip_count, 1);
  in.good = in.good && s.vessel_clip_count >= 0 && s.vessel_clip_count <= interactions::kMaxVesselClips;
  if (in.good) in.take(s.vessel_clips.data(), size_t(s.vessel_clip_count));
  const auto placed = [&model](std::int32_t vessel, double at) {
    return vessel >= 0 && size_t(vessel) < model.vessels.list.size() && at >= 0 && at <= 1;
  };
  for (int i = 0; in.good && i < s.opening_count; ++i)
    in.good = placed(s.openings[size_t(i)].vessel, s.openings[size_t(i)].s);
  for (int i = 0; in.good && i < s.vessel_clip_count; ++i)
    in.good = placed(s.vessel_clips[size_t(i)].vessel, s.vessel_clips[size_t(i)].s);
}

/// What the generator's panel shows, and scars. Tissue sticks to nothing in a picture.
void take_heat(Source& in, const Model& model, State& s) {
  in.take(s.electrodes.data(), s.electrodes.size());
  for (ElectrodeHand& hand : s.electrodes) hand.stuck = {};
  if (!in.good) return;
  const std::ptrdiff_t read = tissue::take_scars(model.energy.heat, std::span(in.bytes).subspan(in.at), s.heat);
  in.good = read >= 0;
  if (!in.good) return;
  in.at += size_t(read);
  s.heat.tick = s.tick;  // so that who draws sees that it has changed
}

void take_injection(Source& in, InjectionState& s) {
  in.take(s.hands.data(), s.hands.size());
  in.take(&s.account, 1);
  for (tissue::InfusionState& organ : s.organs) {
    std::fill(organ.dose.begin(), organ.dose.end(), 0.0f);
    std::fill(organ.since.begin(), organ.since.end(), 0u);
    std::uint32_t n = 0, row = 0;
    in.take(&n, 1);
    in.good = in.good && n <= organ.dose.size();
    for (std::uint32_t k = 0; in.good && k < n; ++k) {
      in.take(&row, 1);
      in.good = in.good && row < organ.dose.size();
      if (!in.good) return;
      in.take(&organ.dose[row], 1);
      in.take(&organ.since[row], 1);
    }
  }
}

/// Keyframes that were written before fluids were in them end here, and show none.
void take_fluids(Source& in, const Model& model, fluids::FluidsState& s) {
  if (!in.good || in.at == in.bytes.size()) return fluids::show_none(s);
  const std::ptrdiff_t read = fluids::take_shown(model.wet.model, std::span(in.bytes).subspan(in.at), s);
  in.good = read >= 0;
  if (in.good) in.at += size_t(read);
}

/// Do loops lie around strands that are there?
bool loops_are_sound(const Model& model, const State& s) {
  for (const interactions::SutureState& suture : s.objects.sutures) {
    const interactions::SlingState& g = suture.sling;
    if (g.around_count < 0 || g.around_count > interactions::kMostAround) return false;
    for (std::int32_t k = 0; k < g.around_count; ++k) {
      const interactions::SlingAround& a = g.around[size_t(k)];
      if (!a.at.body.is(BodyKind::strand) || !is_valid(model, a.at) || !std::isfinite(a.radius)) return false;
    }
  }
  return true;
}

}  // namespace

bool restore_display(const Model& model, const std::vector<std::uint8_t>& bytes, State& state) {
  State s = state;
  Source in{bytes};
  in.take(&s.tick, 1);
  const auto take_network = [&](auto r) {
    const tissue::NetworkModel& network = network_of(model, r);
    for (int n = 0; in.good && n < network.nodes; ++n)
      tissue::set_position(network, network_state_of(s, r), n, in.take_place(network.rest[size_t(n)]));
  };
  visit_bodies(model, Overloaded{[&](SolidRef r) { take_network(r); }, [&](MembraneRef r) { take_network(r); },
                                 [&](CuttableRef r) { take_body(in, model_of(model, r).body, state_of(s, r)); },
                                 [&](StrandRef r) {
                                   tissue::StrandState& rod = state_of(s, r);
                                   for (size_t n = 0; in.good && n < rod.x.size(); ++n)
                                     rod.x[n] = in.take_place(rod_of(model, r).model.rest[n]);
                                   in.take(rod.alive.data(), rod.alive.size());
                                 }});
  in.take(&s.tools, 1);
  in.take(&s.scope, 1);
  visit_record_buffers(model, s, [&in](auto, auto buffer) {
    in.take(&buffer.count, 1);
    in.good = in.good && buffer.count >= 0 && size_t(buffer.count) <= buffer.records.size();
    if (in.good) in.take(buffer.used().data(), buffer.used().size());
  });
  for (auto* bodies : {&s.parted, &s.torn})
    for (std::vector<std::uint8_t>& parted : *bodies) {
      std::uint32_t n = 0, triangle = 0;
      in.take(&n, 1);
      in.good = in.good && n <= parted.size();
      parted.assign(parted.size(), 0);
      for (std::uint32_t k = 0; in.good && k < n; ++k) {
        in.take(&triangle, 1);
        in.good = in.good && triangle < parted.size();
        if (in.good) parted[triangle] = 1;
      }
    }
  if (model.vessels.there()) take_vessels(in, model, s);
  if (model.energy.there) take_heat(in, model, s);
  if (model.wet.there) take_fluids(in, model, s.fluids);
  interactions::ObjectKinds::for_each([&](auto kind) {
    auto& states = interactions::part_of<decltype(kind)>(s);
    kind.serialize_display(interactions::part_of<decltype(kind)>(model), states,
                           [&in](auto* values, size_t n) { in.take(values, n); });
    in.good = in.good && kind.is_valid(states);
  });
  for (auto& bonds : s.bonds) in.take(bonds.data(), bonds.size());
  in.take(s.joints.data(), s.joints.size());
  in.take(s.ports.data(), s.ports.size());
  if (s.injection.there()) take_injection(in, s.injection);
  if (!in.good || in.at != bytes.size() || !sound(model, s) || !loops_are_sound(model, s)) return false;
  if (model.wet.there) lay_floor(model, s);
  state = std::move(s);
  return true;
}

}  // namespace trocar::sim
