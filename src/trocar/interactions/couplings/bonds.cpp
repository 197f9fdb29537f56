#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/interactions/couplings/coupled.hpp>

namespace trocar::interactions {
namespace {

constexpr double kBondDamping = 2e-4;  // [s] times stiffness, ours: loose tissue swings out at once

void damage_by(const BondSet& set, double opening, double dt, BondState::Cause cause, BondState& state) noexcept {
  const double damage = tissue::damage_after(set.law, double(state.damage), opening, dt);
  if (damage <= double(state.damage)) return;
  state.damage = float(damage);
  if (state.cause == BondState::whole || cause == BondState::burnt) state.cause = cause;
}

}  // namespace

double BondSet::area() const noexcept {
  double sum = 0;
  for (const Bond& bond : bonds) sum += bond.area;
  return sum;
}

Vec3d root_of(const Bodies& bodies, const Bond& bond) noexcept {
  if (bond.vertex < 0) return foot_of(bodies, bond.far);
  const std::size_t organ = bond.far.body.index();
  return skin_point(organ_nodes(bodies, organ), skin_of(bodies, organ), bond.vertex);
}

Vec3d opening_of(const Bodies& bodies, const Bond& bond) noexcept {
  return place_of(bodies, bond.near) - place_of(bodies, bond.far);
}

void bond_loads(const Bodies& bodies, const BondSet& set, std::span<BondState> states, double dt) noexcept {
  for (std::size_t i = 0; i < set.bonds.size(); ++i) {
    const Bond& bond = set.bonds[i];
    BondState& state = states[i];
    if (!state.holds()) {
      put_load(bodies, bond.far, {.f0 = -bond.drawn_pull}, {Owner::anchor, 0, 0});
      continue;
    }
    const Coupled ends(bodies, bond.near, bond.far);
    damage_by(set, length(ends.apart), dt, BondState::pulled, state);
    const double whole = 1 - double(state.damage), k = whole * set.law.stiffness() * bond.area;
    couple(bodies, ends, {k, kBondDamping * k, bond.drawn_pull, whole}, dt, {Owner::anchor, 0, 0});
  }
}

void weaken(const BondSet& set, double opening, double times, double dt, BondState& state) noexcept {
  damage_by(set, times * opening, dt, BondState::burnt, state);
}

bool breached(const BondSet& set, const BondState& state) noexcept {
  return state.cause == BondState::staunched || (set.breaches && !state.holds() && state.cause == BondState::pulled);
}

double breached_area(const BondSet& set, std::span<const BondState> states) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < set.bonds.size(); ++i) sum += breached(set, states[i]) ? set.bonds[i].area : 0;
  return sum;
}

void staunch(const BondSet& set, BondState& state) noexcept {
  state.cause = breached(set, state) ? BondState::staunched : BondState::burnt;
}

double energy_spent(const BondSet& set, std::span<const BondState> states) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < set.bonds.size(); ++i)
    sum += set.bonds[i].area * tissue::spent(set.law, double(states[i].damage));
  return sum;
}

double holding_share(const BondSet& set, std::span<const BondState> states) noexcept {
  double left = 0;
  for (std::size_t i = 0; i < set.bonds.size(); ++i) left += (1 - double(states[i].damage)) * set.bonds[i].area;
  const double all = set.area();
  return all > 0 ? left / all : 0;
}

}  // namespace trocar::interactions
