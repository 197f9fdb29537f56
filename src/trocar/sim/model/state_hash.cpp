#include <trocar/core/hash.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

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

}  // namespace trocar::sim
