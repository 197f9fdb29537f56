#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/spring_medium.hpp>

namespace trocar::tissue {
namespace {

struct Share {
  int a, b;
  double k;
};

constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr int kDiagonals[12][2] = {{0, 3}, {1, 2}, {4, 7}, {5, 6}, {0, 5}, {1, 4},
                                   {2, 7}, {3, 6}, {0, 6}, {2, 4}, {1, 7}, {3, 5}};
// Four corners cut off and the middle; its edges are face diagonals, so its cells move only with springs.
constexpr int kTets[5][4] = {{0, 1, 2, 4}, {3, 1, 7, 2}, {5, 1, 4, 7}, {6, 2, 7, 4}, {1, 2, 4, 7}};

double cell_volume(std::span<const Vec3d> x, const std::array<int, 8>& c) {
  double six = 0;
  for (const auto& t : kTets) six += geometry::volume6(x[c[t[0]]], x[c[t[1]]], x[c[t[2]]], x[c[t[3]]]);
  return six / 6;
}

/// How much stiffer than without fibres a cell's springs are, by their direction.
class FibreFactors {
 public:
  FibreFactors(const LatticeMaterial& m, std::span<const Vec3d> fibres) : m_everywhere(m.fibre), m_fibres(fibres) {
    if (m.fibre_ratio == 1 || (fibres.empty() && !(length(m.fibre) > 0))) return;
    m_any = true;
    m_medium = spring_medium(1, {1, 0, 0}, m.fibre_ratio);
    m_share = m_medium.s / spring_medium(1).s;
  }
  /// @param along  of the spring, any length
  double of(std::size_t cell, Vec3d along) const {
    const Vec3d f = m_fibres.empty() ? m_everywhere : m_fibres[cell];
    if (!m_any || !(length(f) > 0)) return 1;
    SpringMedium medium = m_medium;
    medium.f = normalised(f);
    return m_share * medium.density(normalised(along));
  }

 private:
  Vec3d m_everywhere;
  std::span<const Vec3d> m_fibres;
  SpringMedium m_medium;
  double m_share = 1;
  bool m_any = false;
};

/// k = 0.4 E V / l^2, which is 0.4 E l on a cube (l = its edge, also for the diagonals, whose square is twice l^2),
/// shared among the cells that meet at the spring; times what fibres make of it.
/// @param factor  of a spring along a vector
template <class Factor>
void add_cell_springs(std::span<const Vec3d> x, const std::array<int, 8>& c, double stiffness, double volume,
                      Factor&& factor, std::vector<Share>& shares) {
  const auto add = [&](const int(&pair)[2], double share) {
    const int a = std::min(c[pair[0]], c[pair[1]]), b = std::max(c[pair[0]], c[pair[1]]);
    const Vec3d d = x[b] - x[a];
    shares.push_back({a, b, share * 0.4 * stiffness * volume / dot(d, d) * factor(d)});
  };
  for (const auto& e : kEdges) add(e, 0.25);
  for (const auto& e : kDiagonals) add(e, 0.5 * 2);  // 2: V / (l_diagonal^2 / 2)
}

/// A collapsed cell is driven open no faster than twice a wave's time across it: one that is driven faster presses
/// neighbours together that do not follow yet, so that they collapse in turn and are driven as well. A liver of cells
/// of 9 mm that scissors had pressed worked itself up to 2.6 J so in half a second, and tore.
double opening_time(std::span<const Vec3d> x, std::span<const std::array<int, 8>> cells, const LatticeMaterial& m) {
  double sum = 0;
  for (const auto& c : cells)
    for (const auto& e : kEdges) sum += length(x[c[e[1]]] - x[c[e[0]]]);
  return cells.empty() ? 0 : 2 * sum / (12 * double(cells.size())) * std::sqrt(m.density / m.youngs_modulus);
}

}  // namespace

LatticeNetwork lattice_network(std::span<const Vec3d> corners, std::span<const std::array<int, 8>> cells,
                               std::span<const double> fill, const LatticeMaterial& material,
                               std::span<const Vec3d> fibres) {
  if (!(material.youngs_modulus > 0 && material.density > 0))
    throw std::invalid_argument("lattice: expected youngs_modulus > 0 and density > 0");
  if (!fill.empty() && fill.size() != cells.size())
    throw std::invalid_argument("lattice: expected one fill per cell, got " + std::to_string(fill.size()));
  if (!fibres.empty() && fibres.size() != cells.size())
    throw std::invalid_argument("lattice: expected one fibre per cell, got " + std::to_string(fibres.size()));
  const FibreFactors factors(material, fibres);
  LatticeNetwork out;
  NetworkDescription& d = out.network;
  d.positions.assign(corners.begin(), corners.end());
  d.mass.assign(corners.size(), 0.0);
  d.fixed.assign(corners.size(), kFree);
  std::vector<Share> shares;
  shares.reserve(cells.size() * 24);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& c = cells[i];
    const double volume = cell_volume(corners, c);
    if (!(volume > 0)) throw std::invalid_argument("lattice: cell " + std::to_string(i) + ": expected positive volume");
    const double part = fill.empty() ? 1 : std::min(1.0, std::max(fill[i], material.min_fill));
    for (int corner : c) d.mass[corner] += material.density * volume * part / 8;
    add_cell_springs(
        corners, c, material.youngs_modulus * part, volume, [&](Vec3d along) { return factors.of(i, along); }, shares);
    for (const auto& t : kTets) {
      const std::array<int, 4> tet{c[t[0]], c[t[1]], c[t[2]], c[t[3]]};
      if (!(geometry::volume6(corners[tet[0]], corners[tet[1]], corners[tet[2]], corners[tet[3]]) > 0.05 * volume))
        continue;
      d.tets.push_back(tet);
      out.cell_of_tet.push_back(int(i));
    }
  }
  d.opening_time = opening_time(corners, cells, material);
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& p, const Share& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  for (std::size_t i = 0; i < shares.size();) {
    SpringDescription e;
    e.a = shares[i].a, e.b = shares[i].b;
    for (; i < shares.size() && shares[i].a == e.a && shares[i].b == e.b; ++i) e.k += shares[i].k;
    e.rest_length = length(corners[e.b] - corners[e.a]);
    e.p1 = material.p1, e.p2 = material.p2, e.cap = material.cap;
    e.damping = material.damping_time * e.k;
    d.springs.push_back(e);
  }
  return out;
}

BoxLattice box_lattice(int nx, int ny, int nz, double spacing, Vec3d lowest) {
  BoxLattice box;
  box.nx = nx, box.ny = ny, box.nz = nz;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) box.corners.push_back(lowest + Vec3d{i * spacing, j * spacing, k * spacing});
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        box.cells.push_back({box.corner(i, j, k), box.corner(i + 1, j, k), box.corner(i, j + 1, k),
                             box.corner(i + 1, j + 1, k), box.corner(i, j, k + 1), box.corner(i + 1, j, k + 1),
                             box.corner(i, j + 1, k + 1), box.corner(i + 1, j + 1, k + 1)});
  return box;
}

}  // namespace trocar::tissue
