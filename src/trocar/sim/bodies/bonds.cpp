#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {
namespace {

interactions::BondedSheet sheet_of(StepContext& c, const interactions::BondSet& set) noexcept {
  const size_t m = size_t(set.membrane);
  return {c.model.membranes[m].sheet, c.state.membranes[m], c.work.membrane_loads[m]};
}

}  // namespace

void pull_on_bonds(StepContext& c) noexcept {
  const interactions::Holders holders = holders_of(c);
  for (size_t i = 0; i < c.model.bonds.size(); ++i)
    interactions::bond_loads(c.model.bonds[i], c.state.bonds[i], sheet_of(c, c.model.bonds[i]), holders, kTick,
                             c.work.strand_loads, c.work.organ_loads);
}

int sever_bonds(StepContext& c, const geometry::Blade& blade) noexcept {
  const geometry::BladePlane plane(blade);
  if (!plane.flat) return 0;
  const interactions::Holders holders = holders_of(c);
  int severed = 0;
  for (size_t i = 0; i < c.model.bonds.size(); ++i) {
    const interactions::BondSet& set = c.model.bonds[i];
    const interactions::BondedSheet sheet = sheet_of(c, set);
    for (size_t b = 0; b < set.bonds.size(); ++b) {
      const interactions::Bond& bond = set.bonds[b];
      interactions::BondState& state = c.state.bonds[i][b];
      if (!state.holds()) continue;
      const Vec3d foot = held_place(bond.hold, holders) - bond.hold.offset;
      const Vec3d node = tissue::position(sheet.model.network, sheet.state.network, bond.node);
      if (!plane.crosses(foot, node)) continue;
      state = {1, interactions::BondState::cut};
      ++severed;
    }
  }
  return severed;
}

}  // namespace trocar::sim
