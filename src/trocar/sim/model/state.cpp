#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <trocar/core/hash.hpp>
#include <trocar/fluids/shown_fluids.hpp>
#include <trocar/sim/model/pool_floor.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/tissue/heat/heat_scars.hpp>

namespace trocar::sim {

namespace {

/// Room for the counters of bodies that may tear.
void make_counters(const Model& model, State& s) {
  const auto counters = [](double failure, size_t size) { return std::vector<std::uint8_t>(failure > 0 ? size : 0); };
  for (const SolidModel& m : model.solids)
    s.overstretched_organs.push_back(counters(m.failure_strain, size_t(m.network.rows)));
  for (const CuttableOrgan& m : model.cuttables)
    s.overstretched_organs.push_back(counters(m.failure_strain, size_t(m.body.rows)));
  for (const MembraneModel& m : model.membranes)
    s.overstretched_membranes.push_back(counters(m.failure_strain, size_t(m.sheet.network.rows)));
  for (size_t i = 0; i < model.strands.size(); ++i)
    s.overstretched_strands.push_back(counters(model.strands[i].failure_strain, size_t(model.bodies[i].nodes())));
}

}  // namespace

State drawn_bodies(const Model& model) {
  State s;
  for (const SolidModel& solid : model.solids) {
    s.solids.push_back(tissue::rest_state(solid.network));
    s.parted.emplace_back(solid.fine.triangles.size(), std::uint8_t(0));
  }
  for (const CuttableOrgan& c : model.cuttables) s.cuttables.push_back(tissue::rest_state(c.body));
  for (const interactions::StrandBody& body : model.bodies) s.strands.push_back(tissue::rest_state(body.model));
  for (const MembraneModel& m : model.membranes) {
    s.membranes.push_back(tissue::rest_state(m.sheet));
    s.torn.emplace_back(m.sheet.triangles.size(), std::uint8_t(0));
  }
  return s;
}

State initial_state(const Model& model) {
  State s = drawn_bodies(model);
  for (size_t t = 0; t < model.hands.size(); ++t) {
    interactions::ToolState& tool = s.tools[t];
    const ToolInput& in = model.start.tools[t];
    tool.yaw = in.yaw;
    tool.pitch = in.pitch;
    tool.roll = in.roll;
    tool.depth = in.depth;
    tool.handle = in.handle;
    tool.aperture = 1.0 - double(in.handle);
    tool.clips_left = model.placed(t).clips;
    for (size_t i = 0; i < model.hands[t].rack.size(); ++i)
      s.magazine[t * size_t(kMaxRack) + i] = model.hands[t].rack[i].clips;
  }
  s.scope = model.start.scope;
  s.nearest = model.nearest_at_start;
  size_t sides = 0;
  for (const interactions::StrandPair& p : model.strand_pairs) sides += p.overlap.size();
  s.strand_side.resize(sides);
  size_t elements = 0;
  for (const interactions::StrandBody& body : model.bodies) elements += size_t(body.nodes() - 1);
  s.tool_side.resize(model.hands.size() * elements * size_t(interactions::kToolParts));
  size_t triangles = 0;
  for (const MembraneModel& m : model.membranes) triangles += m.sheet.triangles.size();
  s.sheet_side.resize(model.hands.size() * triangles * size_t(interactions::kSheetParts));
  s.sheet_bond.resize(model.hands.size() * model.membranes.size());
  s.touches.resize(model.hands.size());
  for (size_t t = 0; t < model.hands.size(); ++t) interactions::start_here(s.tools[t], s.touches[t]);
  s.seen.resize(model.samples.size());
  if (model.vessels.there()) {
    s.flow = model.vessels.start;
    s.openings.resize(interactions::kMaxOpenings);
    s.vessel_clips.resize(interactions::kMaxVesselClips);
  }
  if (model.energy.there) {
    s.heat = tissue::cold(model.energy.heat);
    s.panel = model.energy.panel;
    s.electrodes.resize(model.hands.size());
    s.seals.resize(interactions::kMaxSeals);
    s.scarred.resize(size_t(kMaxScarred));
    for (tissue::StrandState& strand : s.strands) strand.shrunk.assign(strand.alive.size(), 1.0);
  }
  if (model.wet.there) {
    s.fluids = fluids::initial_state(model.wet.model);
    lay_floor(model, s);
  }
  if (model.irrigates()) s.impacts.resize(size_t(model.wet.model.droplets.capacity));
  make_counters(model, s);
  return s;
}

tissue::NodeView nodes_of(const Model& model, const State& s, int organ) noexcept {
  const size_t i = size_t(organ), n = model.solids.size();
  return i < n ? view_of(model.solids[i].network, s.solids[i])
               : view_of(model.cuttables[i - n].body, s.cuttables[i - n]);
}

std::uint64_t hash_of(const State& s) noexcept {
  core::Hasher h;
  h.add(s.tick);
  for (const auto& solid : s.solids) add_to_hash(h, solid);
  for (const auto& body : s.cuttables) add_to_hash(h, body);
  for (const auto& strand : s.strands) add_to_hash(h, strand);
  h.add(s.tools);
  h.add(s.magazine);
  h.add(s.scope);
  h.add(s.clips);
  h.add(s.cuts);
  h.add(s.clip_count);
  h.add(s.cut_count);
  h.add(s.nearest);
  h.add(s.strand_side);
  h.add(s.tool_side);
  for (const interactions::TouchBook& book : s.touches) add_to_hash(h, book);
  h.add(s.seen);
  for (const auto& membrane : s.membranes) add_to_hash(h, membrane);
  h.add(s.sheet_side);
  h.add(s.sheet_bond);
  for (const auto* bodies : {&s.overstretched_organs, &s.overstretched_membranes, &s.overstretched_strands})
    for (const std::vector<std::uint8_t>& counters : *bodies) h.add(counters);
  for (const std::vector<std::uint8_t>& torn : s.torn) h.add(torn);
  for (const std::vector<std::uint8_t>& parted : s.parted) h.add(parted);
  if (!s.openings.empty()) {
    vessels::add_to_hash(h, s.flow);
    h.add(s.openings);
    h.add(s.vessel_clips);
    h.add(s.opening_count);
    h.add(s.vessel_clip_count);
  }
  if (!s.electrodes.empty()) {
    tissue::add_to_hash(h, s.heat);
    h.add(s.panel);
    h.add(s.electrodes);
    h.add(s.seals);
    h.add(s.seal_count);
    h.add(s.scarred_count);
    h.add(core::hash_bytes(s.scarred.data(), size_t(s.scarred_count) * sizeof s.scarred[0]));
  }
  if (!s.fluids.droplets.x.empty()) {
    fluids::add_to_hash(h, s.fluids);
    h.add(s.pool_floor);
  }
  if (!s.impacts.empty()) {
    h.add(s.valves);
    h.add(s.impact_count);
    h.add(core::hash_bytes(s.impacts.data(), size_t(s.impact_count) * sizeof s.impacts[0]));
  }
  return h.value();
}

namespace {

template <class T>
void put(std::vector<std::uint8_t>& out, const T* data, size_t count) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(data);
  out.insert(out.end(), bytes, bytes + count * sizeof(T));
}

constexpr double kStep = 1e-5;  // [m] a picture needs no finer places than 0.01 mm

/// Places as whole steps from where they were drawn, in as few bytes as each takes: most of a scene hardly moves.
void put_place(std::vector<std::uint8_t>& out, Vec3d place, Vec3d drawn) {
  for (int k = 0; k < 3; ++k) {
    double steps = (place[k] - drawn[k]) / kStep;
    if (!(std::fabs(steps) < 2e9)) steps = 0;  // not a place: the step has flagged it
    const auto q = std::int64_t(std::floor(steps + 0.5));
    auto bits = std::uint64_t(q < 0 ? -2 * q - 1 : 2 * q);
    for (; bits >= 128; bits >>= 7) out.push_back(std::uint8_t(bits | 128u));
    out.push_back(std::uint8_t(bits));
  }
}

/// Reads from a keyframe; remembers whether there was always enough.
struct Source {
  const std::vector<std::uint8_t>& bytes;
  size_t at = 0;
  bool good = true;

  template <class T>
  void take(T* data, size_t count) {
    const size_t n = count * sizeof(T);
    good = good && bytes.size() - at >= n;
    if (!good) return;
    std::memcpy(data, bytes.data() + at, n);
    at += n;
  }

  Vec3d take_place(Vec3d drawn) {
    for (int k = 0; k < 3; ++k) {
      std::uint64_t bits = 0;
      for (int shift = 0;; shift += 7) {
        std::uint8_t byte = 0;
        take(&byte, 1);
        good = good && shift < 35;
        if (!good) return drawn;
        bits |= std::uint64_t(byte & 127u) << shift;
        if (byte < 128) break;
      }
      const auto half = std::int64_t(bits >> 1);
      drawn[k] += kStep * double(bits & 1u ? -half - 1 : half);
    }
    return drawn;
  }
};

}  // namespace

namespace {

/// The few triangles that are cut open, by number.
std::vector<std::uint32_t> open_triangles(const std::vector<std::uint8_t>& parted) {
  std::vector<std::uint32_t> open;
  for (size_t t = 0; t < parted.size(); ++t)
    if (parted[t]) open.push_back(std::uint32_t(t));
  return open;
}

/// Numbers that differ from what they were when uncut, each with its place; first how many there are.
template <class T>
void put_changes(std::vector<std::uint8_t>& out, const std::vector<T>& now, const std::vector<T>& uncut, size_t count) {
  std::vector<std::uint32_t> changed;
  for (size_t i = 0; i < count; ++i)
    if (!(now[i] == uncut[i])) changed.push_back(std::uint32_t(i));
  const auto n = std::uint32_t(changed.size());
  put(out, &n, 1);
  for (const std::uint32_t i : changed) {
    put(out, &i, 1);
    put(out, &now[i], 1);
  }
}
template <class T>
void take_changes(Source& in, std::vector<T>& now, size_t count) {
  std::uint32_t n = 0, i = 0;
  in.take(&n, 1);
  in.good = in.good && n <= count;
  for (std::uint32_t k = 0; in.good && k < n; ++k) {
    in.take(&i, 1);
    in.good = in.good && i < count;
    if (in.good) in.take(&now[i], 1);
  }
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

/// Does every number in it name something that is there, have all cells a volume, and know neighbours each other?
bool sound(const geometry::CuttableTets& b) {
  constexpr double least6 = 1e-16;  // [m^3]
  const auto cells = std::int32_t(b.cells.size());
  for (std::int32_t n = 0; n < b.nodes; ++n) {
    if (b.source[size_t(n)] < 0 || b.source[size_t(n)] > n) return false;
    for (int k = 0; k < 3; ++k)
      if (!(std::fabs(b.rest[size_t(n)][k]) < 1e3)) return false;
  }
  for (size_t c = 0; c < b.cells.size(); ++c)
    for (size_t k = 0; k < 4; ++k)
      if (b.cells[c][k] < 0 || b.cells[c][k] >= b.nodes || b.across[c][k] < -1 || b.across[c][k] >= cells) return false;
  for (size_t c = 0; c < b.cells.size(); ++c) {
    const auto x = [&](size_t k) { return b.rest[size_t(b.cells[c][k])]; };
    if (!(dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) > least6)) return false;
    for (const std::int32_t u : b.across[c]) {
      if (u < 0) continue;
      const geometry::Tet& back = b.across[size_t(u)];
      if (std::find(back.begin(), back.end(), std::int32_t(c)) == back.end()) return false;
    }
  }
  return true;
}

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

/// Pulse, bleeding, clips: small beside the tissue.
template <class F>
void for_flow(F&& each, auto& s) {
  each(s.flow.p), each(s.flow.q), each(s.flow.openings);
}
void put_vessels(std::vector<std::uint8_t>& out, const State& s) {
  for_flow([&out](const auto& values) { put(out, values.data(), values.size()); }, s);
  put(out, &s.flow.bled, 1);
  put(out, &s.opening_count, 1);
  put(out, s.openings.data(), size_t(s.opening_count));
  put(out, &s.vessel_clip_count, 1);
  put(out, s.vessel_clips.data(), size_t(s.vessel_clip_count));
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

/// Keyframes that were written before fluids were in them end here, and show none.
void take_fluids(Source& in, const Model& model, fluids::FluidsState& s) {
  if (!in.good || in.at == in.bytes.size()) return fluids::show_none(s);
  const std::ptrdiff_t read = fluids::take_shown(model.wet.model, std::span(in.bytes).subspan(in.at), s);
  in.good = read >= 0;
  if (in.good) in.at += size_t(read);
}

}  // namespace

std::vector<std::uint8_t> display_bytes(const Model& model, const State& s) {
  std::vector<std::uint8_t> out;
  put(out, &s.tick, 1);
  for (size_t i = 0; i < s.solids.size(); ++i) {
    const tissue::NetworkModel& network = model.solids[i].network;
    for (int n = 0; n < network.nodes; ++n)
      put_place(out, tissue::position(network, s.solids[i], n), network.rest[size_t(n)]);
  }
  for (size_t i = 0; i < s.cuttables.size(); ++i) put_body(out, model.cuttables[i].body, s.cuttables[i]);
  for (size_t i = 0; i < s.strands.size(); ++i) {
    const tissue::StrandState& strand = s.strands[i];
    for (size_t n = 0; n < strand.x.size(); ++n) put_place(out, strand.x[n], model.bodies[i].model.rest[n]);
    put(out, strand.alive.data(), strand.alive.size());
  }
  for (size_t i = 0; i < s.membranes.size(); ++i) {
    const tissue::NetworkModel& network = model.membranes[i].sheet.network;
    for (int n = 0; n < network.nodes; ++n)
      put_place(out, tissue::position(network, s.membranes[i].network, n), network.rest[size_t(n)]);
  }
  put(out, &s.tools, 1);
  put(out, &s.scope, 1);
  put(out, &s.clip_count, 1);
  put(out, s.clips.data(), size_t(s.clip_count));
  put(out, &s.cut_count, 1);
  put(out, s.cuts.data(), size_t(s.cut_count));
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
  return out;
}

namespace {

bool names_tissue(const Model& model, const interactions::Hold& hold) {
  const std::int32_t b = hold.body, solid = b - interactions::kSolidBase, fold = b - interactions::kMembraneBase;
  int elements = 0;
  if (b >= 0 && size_t(b) < model.bodies.size()) elements = model.bodies[size_t(b)].nodes() - 1;
  if (solid >= 0 && solid < model.organs()) elements = model.skin(solid).size();
  if (fold >= 0 && size_t(fold) < model.membranes.size()) elements = model.membranes[size_t(fold)].sheet.nodes();
  return hold.element >= 0 && hold.element < elements;
}

bool sound(const Model& model, int rack, const interactions::ToolState& t) {
  for (double v : {t.yaw, t.pitch, t.roll, t.depth, t.aperture, t.handle})
    if (!(std::fabs(v) < 1e3)) return false;
  if (t.instrument < 0 || t.instrument >= rack) return false;
  if (t.holds < 0 || t.holds > interactions::kMaxHolds) return false;
  for (int i = 0; i < t.holds; ++i)
    if (!names_tissue(model, t.hold[i])) return false;
  return true;
}

bool sound(const Model& model, const State& s) {
  for (size_t t = 0; t < s.tools.size(); ++t)
    if (!sound(model, t < model.hands.size() ? int(model.hands[t].rack.size()) : 1, s.tools[t])) return false;
  for (float v : {s.scope.yaw, s.scope.pitch, s.scope.roll, s.scope.depth, s.scope.post})
    if (!(std::fabs(v) < 1e3f)) return false;
  const auto names_strand = [&model](std::int32_t i, double place) {
    return i >= -1 && i < std::int32_t(model.strands.size()) && std::isfinite(place);
  };
  for (int i = 0; i < s.clip_count; ++i)
    if (!names_strand(s.clips[size_t(i)].strand, s.clips[size_t(i)].s) || s.clips[size_t(i)].vessel < 0 ||
        s.clips[size_t(i)].vessel > std::int32_t(model.vessels.list.size()))
      return false;
  for (int i = 0; i < s.cut_count; ++i)
    if (!names_strand(s.cuts[size_t(i)].strand, s.cuts[size_t(i)].s) || s.cuts[size_t(i)].solid < -1 ||
        s.cuts[size_t(i)].solid >= model.organs() || s.cuts[size_t(i)].membrane < -1 ||
        s.cuts[size_t(i)].membrane >= std::int32_t(model.membranes.size()) || !std::isfinite(s.cuts[size_t(i)].fold))
      return false;
  return true;
}

}  // namespace

bool restore_display(const Model& model, const std::vector<std::uint8_t>& bytes, State& state) {
  State s = state;
  Source in{bytes};
  in.take(&s.tick, 1);
  for (size_t i = 0; i < s.solids.size(); ++i) {
    const tissue::NetworkModel& network = model.solids[i].network;
    for (int n = 0; in.good && n < network.nodes; ++n)
      tissue::set_position(network, s.solids[i], n, in.take_place(network.rest[size_t(n)]));
  }
  for (size_t i = 0; i < s.cuttables.size(); ++i) take_body(in, model.cuttables[i].body, s.cuttables[i]);
  for (size_t i = 0; i < s.strands.size(); ++i) {
    tissue::StrandState& strand = s.strands[i];
    for (size_t n = 0; in.good && n < strand.x.size(); ++n) strand.x[n] = in.take_place(model.bodies[i].model.rest[n]);
    in.take(strand.alive.data(), strand.alive.size());
  }
  for (size_t i = 0; i < s.membranes.size(); ++i) {
    const tissue::NetworkModel& network = model.membranes[i].sheet.network;
    for (int n = 0; in.good && n < network.nodes; ++n)
      tissue::set_position(network, s.membranes[i].network, n, in.take_place(network.rest[size_t(n)]));
  }
  in.take(&s.tools, 1);
  in.take(&s.scope, 1);
  in.take(&s.clip_count, 1);
  in.good = in.good && s.clip_count >= 0 && s.clip_count <= interactions::kMaxClips;
  if (in.good) in.take(s.clips.data(), size_t(s.clip_count));
  in.take(&s.cut_count, 1);
  in.good = in.good && s.cut_count >= 0 && s.cut_count <= interactions::kMaxCuts;
  if (in.good) in.take(s.cuts.data(), size_t(s.cut_count));
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
  if (!in.good || in.at != bytes.size() || !sound(model, s)) return false;
  if (model.wet.there) lay_floor(model, s);
  state = std::move(s);
  return true;
}

}  // namespace trocar::sim
