#include <algorithm>
#include <array>

#include <trocar/sim/bodies/static_organ.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/verbs/current_cut.hpp>
#include <trocar/sim/verbs/scarring.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

namespace trocar::sim {
namespace {

using interactions::ElectrodeTouch;

constexpr double kScarReach = 0.008;  // [m] from an electrode to the middle of springs that it may change
constexpr float kTold = 0.005f;       // a spring that shrinks less stays as it is
constexpr int kTurns = 8;             // steps of the heat in which all of a body is looked at
constexpr std::array kAlong{0.1, 0.3, 0.5, 0.7, 0.9};

// ---- what heat leaves

struct Change {
  float share = 0;  ///< of a length that is left
  float stiff = 0;  ///< factor on a stiffness
};
Change change_at(const StepContext& c, BodyId body, Vec3d at) noexcept {
  const tissue::HeatReading reading = tissue::reading(c.model.energy.heat, c.state.heat, body, at);
  return {tissue::shrinkage(reading), tissue::stiffness(reading)};
}
/// The mean of `count` places; place(i) says where they were drawn.
template <class Place>
Change mean_change(const StepContext& c, BodyId body, int count, Place&& place) noexcept {
  Change mean;
  for (int i = 0; i < count; ++i) {
    const Change one = change_at(c, body, place(i));
    mean.share += one.share / float(count);
    mean.stiff += one.stiff / float(count);
  }
  return mean;
}

/// The entry of that spring, or a new one; null where there is no room.
Scar* entry_of(StepContext& c, BodyId body, std::int32_t spring) noexcept {
  const auto end = c.state.scarred.begin() + c.state.scarred_count;
  const auto found = std::find_if(c.state.scarred.begin(), end,
                                  [body, spring](const Scar& s) { return s.body == body && s.spring == spring; });
  if (found != end) return &*found;
  if (c.state.scarred_count == kMaxScarred) {
    c.report.flags |= StepReport::kHeatFull;
    return nullptr;
  }
  c.state.scarred[size_t(c.state.scarred_count++)] = {body, spring, 1, 1};
  return &*end;
}

void note(StepContext& c, BodyId body, std::int32_t spring, const Change& change) noexcept {
  if (change.share > 1 - kTold) return;
  Scar* entry = entry_of(c, body, spring);
  if (!entry) return;
  entry->share = std::min(entry->share, change.share);
  entry->stiff = std::max(entry->stiff, change.stiff);
}

bool near(Vec3d a, Vec3d b) noexcept { return dot(a - b, a - b) <= kScarReach * kScarReach; }

/// The part of `count` whose turn it is.
struct Turn {
  int first, last;
  Turn(const StepContext& c, int count) noexcept {
    const int turn = int(c.state.heat.tick / std::uint64_t(c.model.energy.heat.period) % std::uint64_t(kTurns));
    first = int(std::int64_t(count) * turn / kTurns), last = int(std::int64_t(count) * (turn + 1) / kTurns);
  }
};

void scar_springs(StepContext& c, const tissue::NetworkModel& m, BodyId body, Vec3d electrode) noexcept {
  const Turn turn(c, m.springs);
  for (int s = turn.first; s < turn.last; ++s) {
    const Vec3d a = m.rest[size_t(m.spring_nodes[size_t(2 * s)])],
                b = m.rest[size_t(m.spring_nodes[size_t(2 * s + 1)])];
    if (!near(0.5 * (a + b), electrode)) continue;
    note(c, body, s, mean_change(c, body, int(kAlong.size()), [&](int i) { return a + kAlong[size_t(i)] * (b - a); }));
  }
}

Vec3d middle_of(const ElectrodeTouch& touch) noexcept { return 0.5 * (touch.contact.a + touch.contact.b); }

/// Springs that heat has changed are no longer those of a precomputed compliance.
template <class Ref>
void hand_over_if_scarred(StepContext& c, Ref organ) noexcept {
  for (int i = 0; i < c.state.scarred_count; ++i)
    if (c.state.scarred[size_t(i)].body == organ.id()) return switch_to_dynamic(c, organ);
}

void scar(StepContext& c, const ElectrodeTouch& touch, SolidRef solid) noexcept {
  scar_springs(c, model_of(c.model, solid).network, solid.id(), middle_of(touch));
  hand_over_if_scarred(c, solid);
}
void scar(StepContext& c, const ElectrodeTouch& touch, MembraneRef membrane) noexcept {
  scar_springs(c, model_of(c.model, membrane).sheet.network, membrane.id(), middle_of(touch));
}

/// At the cell's middle and half way from there to its corners, in the drawn shape: heat does not move with what snaps
/// to a blade.
void scar(StepContext& c, const ElectrodeTouch& touch, CuttableRef organ) noexcept {
  const BodyId body = organ.id();
  const Vec3d electrode = middle_of(touch);
  const geometry::CuttableTets& drawn = model_of(c.model, organ).body.drawn;
  const Turn turn(c, int(drawn.cells.size()));
  for (size_t t = size_t(turn.first); t < size_t(turn.last); ++t) {
    Vec3d middle;
    for (const std::int32_t node : drawn.cells[t]) middle += 0.25 * drawn.rest[size_t(node)];
    if (!near(middle, electrode)) continue;
    note(c, body, std::int32_t(t), mean_change(c, body, 5, [&](int i) {
           return i == 0 ? middle : 0.5 * (middle + drawn.rest[size_t(drawn.cells[t][size_t(i - 1)])]);
         }));
  }
  hand_over_if_scarred(c, organ);
}

/// Coagulated strands: their step is implicit, so that any stiffness is stable. What was cut in part stays weak.
void scar(StepContext& c, const ElectrodeTouch& touch, StrandRef r) noexcept {
  const BodyId strand = r.id();
  const Section section = section_of(c, strand, touch.point.element, touch.contact.a.x);
  const Change change =
      mean_change(c, strand, 5, [&](int i) { return i == 0 ? section.middle : section.around[size_t(i - 1)]; });
  tissue::StrandState& s = state_of(c.state, r);
  double &share = s.shrunk[size_t(touch.point.element)], &scale = s.scale[size_t(touch.point.element)];
  share = std::min(share, double(change.share));
  if (scale >= 1) scale = std::max(scale, double(change.stiff));
}

// ---- what it does

using Springs = std::vector<tissue::ScarredSpring>;

Springs& springs_of(StepContext& c, SolidRef r) noexcept { return c.work.organs[r.organ()].scars; }
Springs& springs_of(StepContext& c, CuttableRef r) noexcept { return c.work.organs[r.organ()].scars; }
Springs& springs_of(StepContext& c, MembraneRef r) noexcept { return c.work.membranes[r.index].scars; }

void add_spring(const tissue::NetworkModel& m, const tissue::NetworkState& state, const Scar& scar,
                Springs& to) noexcept {
  const double k = double(tissue::spring_scale(m, state, scar.spring)) * tissue::spring_stiffness(m, scar.spring);
  to.push_back({m.spring_nodes[size_t(2 * scar.spring)], m.spring_nodes[size_t(2 * scar.spring + 1)], k,
                double(m.spring_rest[size_t(scar.spring)]), double(scar.share), double(scar.stiff)});
}

/// A cell's share of the springs along its edges and across its faces.
void add_cell(const tissue::CuttableModel& m, const geometry::CuttableTets& tets, const Scar& scar,
              Springs& to) noexcept {
  const tissue::CellSprings& brings = m.brings[size_t(scar.spring)];
  const geometry::Tet& cell = tets.cells[size_t(scar.spring)];
  const auto add_between = [&](int a, int b, float k_l2, float ratio) {
    const double drawn = length(tets.rest[size_t(b)] - tets.rest[size_t(a)]);
    to.push_back({a, b, double(k_l2) / (drawn * drawn), double(ratio) * drawn, double(scar.share), double(scar.stiff)});
  };
  for (size_t e = 0; e < 6; ++e)
    add_between(cell[size_t(tissue::kCellEdges[e][0])], cell[size_t(tissue::kCellEdges[e][1])], brings.edge[e],
                brings.edge_ratio[e]);
  for (size_t f = 0; f < 4; ++f) {
    const std::int32_t beyond = tets.across[size_t(scar.spring)][f];
    if (beyond < 0) continue;
    const geometry::Tet& faces = tets.across[size_t(beyond)];
    const auto face = std::find(faces.begin(), faces.end(), scar.spring) - faces.begin();
    add_between(cell[f], tets.cells[size_t(beyond)][size_t(face)], brings.cross[f], brings.cross_ratio[f]);
  }
}

void add(StepContext& c, const Scar& scar, SolidRef r) noexcept {
  add_spring(network_of(c.model, r), state_of(c.state, r), scar, springs_of(c, r));
}
void add(StepContext& c, const Scar& scar, CuttableRef r) noexcept {
  add_cell(model_of(c.model, r).body, state_of(c.state, r).tets, scar, springs_of(c, r));
}
void add(StepContext& c, const Scar& scar, MembraneRef r) noexcept {
  add_spring(network_of(c.model, r), network_state_of(c.state, r), scar, springs_of(c, r));
}
void add(StepContext&, const Scar&, StrandRef) noexcept {}  // those have changed themselves

}  // namespace

void scar_tissue(StepContext& c, const ElectrodeTouch& touch) noexcept {
  visit(c.model, touch.contact.body, [&](auto body) { scar(c, touch, body); });
}

void apply_scars(StepContext& c) noexcept {
  for (interactions::OrganWork& of : c.work.organs) of.scars.clear();
  for (interactions::MembraneBodyWork& of : c.work.membranes) of.scars.clear();
  for (int i = 0; i < c.state.scarred_count; ++i) {
    const Scar& scar = c.state.scarred[size_t(i)];
    visit(c.model, scar.body, [&](auto body) { add(c, scar, body); });
  }
}

}  // namespace trocar::sim
