#include <trocar/core/field_hash.hpp>
#include <trocar/interactions/couplings/border.hpp>

namespace trocar::interactions {
namespace {

/// The node of a cut element on whose stump the place lies: 0 lower, 1 upper; within a whole element the place itself.
double bearing(const StrandPlace& place, const tissue::StrandState& state) noexcept {
  return state.alive[std::size_t(place.element)] ? place.w : (place.w <= 0.5 ? 0.0 : 1.0);
}

/// Share of a border node's springs that are whole; where all of them go to other held nodes, it is whole.
double whole_share(const tissue::MembraneModel& sheet, const tissue::MembraneState& state, std::size_t h) noexcept {
  const int first = sheet.border_first[h], last = sheet.border_first[h + 1];
  double sum = 0;
  for (int k = first; k < last; ++k)
    sum += double(spring_scale(sheet.network, state.network, sheet.border_spring[std::size_t(k)].spring));
  return last > first ? sum / (last - first) : 1;
}

}  // namespace

double added_damping(const tissue::BorderPull& pull, double dt) noexcept { return 0.35 * pull.k * dt + 0.6 * pull.d; }

Vec3d held_place(const BorderHold& hold, const Holders& holders) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::strand)
    return point_at(holders.strands[i], holders.strand_states[i], hold.place) + hold.offset;
  if (hold.kind == BorderHold::organ) return skin_point(holders.nodes[i], *holders.skins[i], hold.vertex) + hold.offset;
  return hold.offset;
}

Vec3d held_velocity(const BorderHold& hold, const Holders& holders) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::organ) return skin_velocity(holders.nodes[i], *holders.skins[i], hold.vertex);
  if (hold.kind != BorderHold::strand) return {};
  const tissue::StrandState& s = holders.strand_states[i];
  const std::size_t e = std::size_t(hold.place.element);
  return s.v[e] + bearing(hold.place, s) * (s.v[e + 1] - s.v[e]);
}

void bear(const BorderHold& hold, Vec3d force, double d, const Holders& holders, std::span<StrandLoads> strand_loads,
          std::span<NetworkLoads> organ_loads) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::strand) {
    tissue::StrandLoad load;
    load.element = hold.place.element;
    load.w = bearing(hold.place, holders.strand_states[i]);
    load.d = d;
    load.f0 = force + d * held_velocity(hold, holders);
    strand_loads[i].add(load, {Owner::body, 0, 0});
  } else if (hold.kind == BorderHold::organ) {
    SkinLoad load;
    load.d = d;
    load.f0 = force + d * counted_on(held_velocity(hold, holders));
    add_skin_load(holders.nodes[i], *holders.skins[i], hold.vertex, load, {Owner::strand_end, 0, 0}, organ_loads[i]);
  }
}

void border_loads(std::span<const BorderHold> holds, std::span<const tissue::BorderPull> pulls,
                  const tissue::MembraneModel& sheet, const tissue::MembraneState& state, const Holders& holders,
                  double dt, std::span<StrandLoads> strand_loads, std::span<NetworkLoads> organ_loads) noexcept {
  for (std::size_t h = 0; h < holds.size(); ++h) {
    if (holds[h].kind == BorderHold::space) continue;
    const Vec3d force = pulls[h].force - whole_share(sheet, state, h) * holds[h].drawn_pull;
    bear(holds[h], force, added_damping(pulls[h], dt), holders, strand_loads, organ_loads);
  }
}

void add_to_hash(core::Hasher& hasher, const BorderHold& hold) noexcept { core::add_fields(hasher, hold); }

}  // namespace trocar::interactions
