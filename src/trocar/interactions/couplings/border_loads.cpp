#include <trocar/core/field_hash.hpp>
#include <trocar/interactions/couplings/border_loads.hpp>

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

Vec3d held_place(const BorderHold& hold, const Bodies& bodies) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::strand)
    return point_at(bodies.strand(i), bodies.strand_state(i), hold.place) + hold.offset;
  if (hold.kind == BorderHold::organ)
    return skin_point(organ_nodes(bodies, i), skin_of(bodies, i), hold.vertex) + hold.offset;
  return hold.offset;
}

Vec3d foot_of(const BorderHold& hold, const Bodies& bodies) noexcept { return held_place(hold, bodies) - hold.offset; }

Vec3d held_velocity(const BorderHold& hold, const Bodies& bodies) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::organ) return skin_velocity(organ_nodes(bodies, i), skin_of(bodies, i), hold.vertex);
  if (hold.kind != BorderHold::strand) return {};
  const tissue::StrandState& s = bodies.strand_state(i);
  const std::size_t e = std::size_t(hold.place.element);
  return s.v[e] + bearing(hold.place, s) * (s.v[e + 1] - s.v[e]);
}

void bear(const BorderHold& hold, Vec3d force, double d, const Bodies& bodies) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == BorderHold::strand) {
    tissue::StrandLoad load;
    load.element = hold.place.element;
    load.w = bearing(hold.place, bodies.strand_state(i));
    load.d = d;
    load.f0 = force + d * held_velocity(hold, bodies);
    bodies.work->strands[i].loads.add(load, {Owner::body, 0, 0});
  } else if (hold.kind == BorderHold::organ) {
    SkinLoad load;
    load.d = d;
    load.f0 = force + d * counted_on(held_velocity(hold, bodies));
    add_skin_load(organ_nodes(bodies, i), skin_of(bodies, i), hold.vertex, load, {Owner::strand_end, 0, 0},
                  bodies.work->organs[i].loads);
  }
}

void border_loads(std::span<const BorderHold> holds, std::span<const tissue::BorderPull> pulls,
                  const tissue::MembraneModel& sheet, const tissue::MembraneState& state, const Bodies& bodies,
                  double dt) noexcept {
  for (std::size_t h = 0; h < holds.size(); ++h) {
    if (holds[h].kind == BorderHold::space) continue;
    const Vec3d force = pulls[h].force - whole_share(sheet, state, h) * holds[h].drawn_pull;
    bear(holds[h], force, added_damping(pulls[h], dt), bodies);
  }
}

void add_to_hash(core::Hasher& hasher, const BorderHold& hold) noexcept { core::add_fields(hasher, hold); }

}  // namespace trocar::interactions
