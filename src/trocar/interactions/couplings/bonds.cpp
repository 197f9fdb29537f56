#include <trocar/core/field_hash.hpp>
#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/interactions/couplings/border_loads.hpp>

namespace trocar::interactions {
namespace {

constexpr double kBondDamping = 2e-4;  // [s] times stiffness, ours: loose tissue swings out at once

}  // namespace

double BondSet::area() const noexcept {
  double sum = 0;
  for (const Bond& bond : bonds) sum += bond.area;
  return sum;
}

Vec3d opening_of(const Bond& bond, const BondedNodes& nodes, const Bodies& bodies) noexcept {
  return tissue::position(nodes.model, nodes.state, bond.node) - held_place(bond.hold, bodies);
}

void bond_loads(const BondSet& set, std::span<BondState> states, const BondedNodes& nodes, const Bodies& bodies,
                double dt) noexcept {
  for (std::size_t i = 0; i < set.bonds.size(); ++i) {
    const Bond& bond = set.bonds[i];
    BondState& state = states[i];
    if (!state.holds()) {
      bear(bond.hold, -bond.hold.drawn_pull, 0, bodies);
      continue;
    }
    const Vec3d x = tissue::position(nodes.model, nodes.state, bond.node);
    const Vec3d v = counted_on(tissue::velocity(nodes.model, nodes.state, bond.node));
    const Vec3d at = held_place(bond.hold, bodies), moves = counted_on(held_velocity(bond.hold, bodies));
    const double damage = tissue::damage_after(set.law, double(state.damage), length(x - at), dt);
    if (damage > double(state.damage) && state.cause == BondState::whole) state.cause = BondState::pulled;
    state.damage = float(damage);
    const double whole = 1 - double(state.damage), k = whole * set.law.stiffness() * bond.area, d = kBondDamping * k;

    tissue::NodeLoad load;
    load.node = bond.node;
    load.k = float(k);
    load.d = float(d);
    load.x0 = vec_cast<float>(at + 0.5 * dt * moves);  // where the holder is on the average: else they drive each other
    load.f0 = vec_cast<float>(d * moves - whole * bond.hold.drawn_pull);
    nodes.loads.add(load, {Owner::anchor, 0, 0});

    const Vec3d pull = k * (x - at) + d * (v - moves) - (1 - whole) * bond.hold.drawn_pull;
    bear(bond.hold, pull, k * dt + 2 * d, bodies);
  }
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

void add_to_hash(core::Hasher& hasher, const BondSet& set) noexcept { core::add_fields(hasher, set); }

}  // namespace trocar::interactions
