#include <algorithm>

#include <trocar/interactions/couplings/border.hpp>

namespace trocar::interactions {
namespace {

/// Share of a border node's springs that are whole; where all of them go to other held nodes, it is whole.
double whole_share(const tissue::MembraneModel& sheet, const tissue::MembraneState& state, std::size_t h) noexcept {
  const int first = sheet.border_first[h], last = sheet.border_first[h + 1];
  double sum = 0;
  for (int k = first; k < last; ++k)
    sum += double(spring_scale(sheet.network, state.network, sheet.border_spring[std::size_t(k)].spring));
  return last > first ? sum / (last - first) : 1;
}

/// What loads a held node loads what holds it: the node is exactly there.
void pass_on(const Bodies& bodies, const MembraneBody& m, const tissue::NodeLoad& load) noexcept {
  if (m.sheet.network.fixed[std::size_t(load.node)] != tissue::kHeld) return;
  const std::vector<int>& held = m.sheet.held_nodes;
  const std::size_t h = std::size_t(std::lower_bound(held.begin(), held.end(), load.node) - held.begin());
  const auto wide = [](Vec3f a) { return vec_cast<double>(a); };
  const PointLoad same{.f0 = wide(load.f0),
                       .k = double(load.k),
                       .target = wide(load.x0),
                       .d = double(load.d),
                       .u = wide(load.u),
                       .dir = wide(load.dir)};
  put_load(bodies, m.holds[h].point, same, {Owner::anchor, 0, 0});
}

}  // namespace

double added_damping(const tissue::BorderPull& pull, double dt) noexcept {
  return kBorderShare * resistance_of(pull.k, pull.d, dt);
}

void border_loads(const Bodies& bodies, std::size_t membrane, std::span<const tissue::BorderPull> pulls,
                  double dt) noexcept {
  const MembraneBody& m = bodies.models.membranes[membrane];
  const tissue::MembraneState& state = bodies.states.membranes[membrane];
  for (std::size_t h = 0; h < m.holds.size(); ++h) {
    const Vec3d pull = pulls[h].force - whole_share(m.sheet, state, h) * m.holds[h].drawn_pull;
    bear(bodies, m.holds[h].point, pull, added_damping(pulls[h], dt), {Owner::anchor, 0, 0});
  }
  for (const tissue::NodeLoad& load : bodies.work->membranes[membrane].loads.gathered) pass_on(bodies, m, load);
}

}  // namespace trocar::interactions
