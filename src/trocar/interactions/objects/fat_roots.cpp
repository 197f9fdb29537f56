// What lobules hold on: strands and organs by roots, walls of pouches by ties.
#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/couplings/border_loads.hpp>
#include <trocar/interactions/objects/fat.hpp>

namespace trocar::interactions {
namespace {

constexpr double kTieDamping = 2e-4;  // [s] times stiffness, as of bonds
constexpr double kWarms = 1.2;        // spacings: lobules so near to where current enters share its heat.  Our estimate

bool coagulated(const FatBodyState& s, int lobule) noexcept { return s.fat.lobules[size_t(lobule)].coagulated(); }

/// What holds a coagulated lobule parts at a fifth of its opening.
void weaken(const tissue::CohesiveLaw& law, double opening, double dt, BondState& state) noexcept {
  const double weak = opening / tissue::kCoagulatedStrength;
  const double damage = tissue::damage_after(law, double(state.damage), weak, dt);
  if (damage <= double(state.damage)) return;
  state.damage = float(damage);
  state.cause = BondState::burnt;
}

void weaken_roots(const FatBody& body, const BondedNodes& nodes, const Bodies& bodies, double dt,
                  FatBodyState& s) noexcept {
  for (size_t i = 0; i < body.roots.bonds.size(); ++i) {
    const Bond& bond = body.roots.bonds[i];
    if (coagulated(s, bond.node) && s.roots[i].holds())
      weaken(body.roots.law, length(opening_of(bond, nodes, bodies)), dt, s.roots[i]);
  }
}

/// Both ends are light and both bear the tie implicitly, each from where the other is about to be.
void tie_loads(const FatBody& body, const FatTie& tie, const Bodies& bodies, double dt, FatBodyState& s,
               BondState& state, NetworkLoads& loads) noexcept {
  const tissue::CohesiveLaw& law = body.roots.law;
  const size_t wall = size_t(tie.membrane);
  const tissue::NetworkModel& net = bodies.models.membranes[wall].sheet.network;
  const tissue::NetworkState& now = bodies.states.membranes[wall].network;
  const Vec3d x = tissue::position(body.fat, s.fat, tie.lobule);
  const Vec3d v = counted_on(tissue::velocity(body.fat, s.fat, tie.lobule));
  const Vec3d at = tissue::position(net, now, tie.node) + tie.offset;
  const Vec3d moves = counted_on(tissue::velocity(net, now, tie.node));
  const double opening = length(x - at);
  if (coagulated(s, tie.lobule)) weaken(law, opening, dt, state);
  const double damage = tissue::damage_after(law, double(state.damage), opening, dt);
  if (damage > double(state.damage) && state.cause == BondState::whole) state.cause = BondState::pulled;
  state.damage = float(damage);
  if (!state.holds()) return;
  const double k = (1 - double(state.damage)) * law.stiffness() * tie.area, d = kTieDamping * k;

  tissue::NodeLoad on_fat;
  on_fat.node = tie.lobule;
  on_fat.k = float(k);
  on_fat.d = float(d);
  on_fat.x0 = vec_cast<float>(at + 0.5 * dt * moves);
  on_fat.f0 = vec_cast<float>(d * moves);
  loads.add(on_fat, {Owner::anchor, 0, 0});

  const double resists = k * dt + 2 * d;  // as a holder of bonds
  tissue::NodeLoad on_wall;
  on_wall.node = tie.node;
  on_wall.d = float(resists);
  on_wall.f0 = vec_cast<float>(k * (x - at) + d * (v - moves) + resists * moves);
  bodies.work->membranes[wall].loads.add(on_wall, {Owner::anchor, 0, 0});
}

Vec3d foot_of(const FatTie& tie, const Bodies& bodies) noexcept {
  const size_t wall = size_t(tie.membrane);
  return tissue::position(bodies.models.membranes[wall].sheet.network, bodies.states.membranes[wall].network, tie.node);
}

int sever(BondState& state) noexcept {
  state = {1, BondState::cut};
  return 1;
}

}  // namespace

void apply_fat_loads(const FatBody& body, FatBodyState& s, const Bodies& bodies, double dt, FatBodyWork& w) noexcept {
  const BondedNodes nodes{body.fat.network, s.fat.network, w.loads};
  weaken_roots(body, nodes, bodies, dt, s);
  bond_loads(body.roots, s.roots, nodes, bodies, dt);
  for (size_t i = 0; i < body.ties.size(); ++i)
    if (s.ties[i].holds()) tie_loads(body, body.ties[i], bodies, dt, s, s.ties[i], w.loads);
}

int sever_fat(const FatBody& body, const geometry::Blade& blade, const Bodies& bodies, FatBodyState& s) noexcept {
  const geometry::BladePlane plane(blade);
  if (!plane.flat) return 0;
  int severed = tissue::sever(body.fat, plane, s.fat);
  for (size_t i = 0; i < body.roots.bonds.size(); ++i) {
    const Bond& bond = body.roots.bonds[i];
    const Vec3d foot = foot_of(bond.hold, bodies);
    if (s.roots[i].holds() && plane.crosses(foot, tissue::position(body.fat, s.fat, bond.node)))
      severed += sever(s.roots[i]);
  }
  for (size_t i = 0; i < body.ties.size(); ++i)
    if (s.ties[i].holds() &&
        plane.crosses(foot_of(body.ties[i], bodies), tissue::position(body.fat, s.fat, body.ties[i].lobule)))
      severed += sever(s.ties[i]);
  return severed;
}

int lobule_at(const FatBody& body, const FatBodyState& s, const Capsule& wire) noexcept {
  int best = -1;
  double nearest = body.fat.radius + wire.radius;
  for (int n = 0; n < body.fat.lobules(); ++n) {
    if (s.fat.lobules[size_t(n)].gone()) continue;
    const Vec3d p = tissue::position(body.fat, s.fat, n);
    const double apart = length(p - collision::nearest_on_axis(wire, p));
    if (apart < nearest) nearest = apart, best = n;
  }
  return best;
}

double warm_fat(const FatBody& body, int lobule, double joules, FatBodyState& s) noexcept {
  const Vec3d middle = tissue::position(body.fat, s.fat, lobule);
  const double reach = kWarms * body.fat.spacing;
  const auto share = [&](int n) {
    const double near = std::max(0.0, 1 - length(tissue::position(body.fat, s.fat, n) - middle) / reach);
    return near * near;
  };
  double all = 0, boiled = 0;
  for (int n = 0; n < body.fat.lobules(); ++n)
    if (!s.fat.lobules[size_t(n)].gone()) all += share(n);
  if (!(all > 0)) return 0;
  for (int n = 0; n < body.fat.lobules(); ++n)
    if (!s.fat.lobules[size_t(n)].gone()) boiled += tissue::warm(body.fat, n, share(n) / all * joules, s.fat);
  for (size_t i = 0; i < body.roots.bonds.size(); ++i)
    if (s.fat.lobules[size_t(body.roots.bonds[i].node)].gone()) s.roots[i] = {1, BondState::burnt};
  for (size_t i = 0; i < body.ties.size(); ++i)
    if (s.fat.lobules[size_t(body.ties[i].lobule)].gone()) s.ties[i] = {1, BondState::burnt};
  return boiled;
}

}  // namespace trocar::interactions
