#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/tissue/fat/fat.hpp>

namespace trocar::tissue {
namespace {

constexpr double kNeighbour = 1.25;     // lobules tie to those within so many spacings
constexpr double kStepShare = 1.0 / 7;  // of the undamped limit that damping may take, as of organs

/// Of a septum: a face-centred lattice of central springs has about this stiffness for a given modulus.
double septum_stiffness(double young, double spacing) { return young * spacing / std::sqrt(2.0); }
/// Of serosa: the same of a plane lattice of triangles.
double serosa_stiffness(double modulus) { return 0.5 * std::sqrt(3.0) * modulus; }

/// Openings as a law has them; its traction that of one septum of stiffness k, spread over a spacing squared.
CohesiveLaw law_of(double k, double yields, double opens, double spacing) {
  CohesiveLaw law;
  law.yields = yields * spacing;
  law.opens = opens * spacing;
  law.peak = k * law.yields / (spacing * spacing);
  law.pace = law.opens / CohesiveLaw::kQuickest;
  return law;
}

void add_septa(const FatDescription& d, NetworkDescription& net, std::vector<std::uint8_t>& serosal) {
  const double reach = kNeighbour * d.spacing;
  for (std::size_t i = 0; i < d.lobules.size(); ++i)
    for (std::size_t j = i + 1; j < d.lobules.size(); ++j) {
      const double apart = length(d.lobules[j] - d.lobules[i]);
      if (apart > reach) continue;
      const bool leaf = d.material.serosa > 0 && d.free[i] && d.free[j];
      SpringDescription s;
      s.a = int(i), s.b = int(j);
      s.rest_length = apart;
      s.k = septum_stiffness(d.material.young, d.spacing);
      if (leaf) s.k += serosa_stiffness(d.material.serosa);
      net.springs.push_back(s);
      serosal.push_back(leaf);
    }
}

}  // namespace

FatModel build(const FatDescription& d, double tick) {
  if (d.lobules.empty()) throw std::invalid_argument("fat needs at least one lobule");
  FatModel m;
  m.material = d.material;
  m.spacing = d.spacing;
  m.volume = d.spacing * d.spacing * d.spacing / std::sqrt(2.0);
  m.mass = d.material.density * m.volume;
  m.radius = 0.5 * d.spacing;
  NetworkDescription net;
  net.positions = d.lobules;
  net.mass.assign(d.lobules.size(), m.mass);
  net.fixed.assign(d.lobules.size(), kFree);
  for (std::size_t i = 0; i < d.held.size(); ++i)
    if (d.held[i]) net.fixed[i] = kHeld;
  net.gravity = d.gravity;
  net.global_damping = 1;
  add_septa(d, net, m.serosal);
  const double damping = std::min(d.material.damping, kStepShare * build(net, tick).dt_limit);
  for (SpringDescription& s : net.springs) s.damping = damping * s.k;
  m.network = build(net, tick);
  m.septum = law_of(septum_stiffness(d.material.young, d.spacing), d.material.yields, d.material.opens, d.spacing);
  m.serosa =
      law_of(serosa_stiffness(d.material.serosa), 0.7 * d.material.serosa_opens, d.material.serosa_opens, d.spacing);
  return m;
}

FatState rest_state(const FatModel& m) {
  FatState s;
  s.network = rest_state(m.network);
  s.lobules.resize(std::size_t(m.lobules()));
  return s;
}

FatWork make_work(const FatModel& m) { return {make_work(m.network)}; }

}  // namespace trocar::tissue
