#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {
namespace {

// Loose tissue is a few threads and much water: what current does to it is not computed but said.
constexpr double kBurns = 0.0022;   // [m] from the electrode.                   Our choice
constexpr double kLoosens = 5e-6;   // [m^3] that loosens a bond where it comes in.  Our choice
constexpr float kLoosest = 0.85f;   // of a bond: threads remain.                    Our choice
constexpr double kBurnTime = 0.15;  // [s] until such a bond has parted.         Our choice

}  // namespace

void apply_bond_loads(StepContext& c) noexcept {
  weaken_coagulated(c);
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t i = 0; i < c.model.bonds.size(); ++i)
    interactions::bond_loads(bodies, c.model.bonds[i], c.state.bonds[i], kTick);
}

namespace {

/// f(set, state, foot, node) of all bonds, parted ones among them: where they are rooted, and the wall's node.
template <class F>
void for_bonds(StepContext& c, F&& f) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t i = 0; i < c.model.bonds.size(); ++i) {
    const interactions::BondSet& set = c.model.bonds[i];
    for (size_t b = 0; b < set.bonds.size(); ++b) {
      const interactions::Bond& bond = set.bonds[b];
      f(set, c.state.bonds[i][b], root_of(bodies, bond), place_of(bodies, bond.near));
    }
  }
}

}  // namespace

int sever_bonds(StepContext& c, const geometry::Blade& blade) noexcept {
  const geometry::BladePlane plane(blade);
  if (!plane.flat) return 0;
  int severed = 0;
  for_bonds(c, [&](const interactions::BondSet&, interactions::BondState& state, Vec3d foot, Vec3d node) {
    if (!state.holds() || !plane.crosses(foot, node)) return;
    state = {1, interactions::BondState::cut};
    ++severed;
  });
  return severed;
}

void burn_bonds(StepContext& c, Vec3d electrode, double dt) noexcept {
  for_bonds(c, [&](const interactions::BondSet& set, interactions::BondState& state, Vec3d foot, Vec3d node) {
    if (!set.of_membrane()) return;  // fat has a warmth of its own
    if (!state.holds()) {            // what is left of it on the holder
      if (length(electrode - foot) <= kBurns) staunch(set, state);
      return;
    }
    const double w = geometry::closest_on_segment(electrode, foot, node);
    if (length(electrode - (foot + w * (node - foot))) > kBurns) return;
    state.damage = std::min(1.0f, state.damage + float(dt / kBurnTime));
    state.cause = interactions::BondState::burnt;
  });
}

void loosen_bonds(StepContext& c, Vec3d at, double volume, double spread) noexcept {
  if (c.model.bonds.empty()) return;
  const double most2 = 9 * spread * spread, per = 1 / (2 * spread * spread);
  for_bonds(c, [&](const interactions::BondSet& set, interactions::BondState& state, Vec3d foot, Vec3d node) {
    if (!state.holds() || !set.of_membrane()) return;
    const double w = geometry::closest_on_segment(at, foot, node);
    const double far2 = geometry::distance2(at, foot + w * (node - foot));
    if (far2 > most2) return;
    const auto more = float(volume / kLoosens * portable::exp(-far2 * per));
    state.damage = std::max(state.damage, std::min(kLoosest, state.damage + more));
  });
}

Ooze ooze_from_bonds(StepContext& c, size_t i) noexcept {
  const interactions::BondSet& set = c.model.bonds[i];
  const std::size_t turn = std::size_t(c.state.tick % set.bonds.size());
  const interactions::Bond& bond = set.bonds[turn];
  const interactions::BondState& state = c.state.bonds[i][turn];
  if (!state.raw() || bond.vertex < 0) return {};
  const double flow =
      (breached(set, state) ? set.bleeds : set.oozes) * bond.area * kTick * double(set.bonds.size());  // [m^3]
  return {root_of(bodies_of(c), bond), c.model.wet.film[bond.far.body.index()] + bond.vertex,
          std::int64_t(flow / fluids::kM3PerPicolitre)};
}

}  // namespace trocar::sim
