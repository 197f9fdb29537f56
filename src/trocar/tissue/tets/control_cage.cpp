#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/numerics/dense_lu.hpp>
#include <trocar/numerics/mat3.hpp>
#include <trocar/tissue/network/volume_force.hpp>
#include <trocar/tissue/tets/control_cage.hpp>

namespace trocar::tissue {
namespace {

namespace nurbs = geometry::nurbs;

/// A triangle of a cross-section by the lines along the body that its corners are on, in ascending order of lines.
struct Wedge {
  std::array<int, 3> line;
  bool turned;  ///< that order runs against the section's sense
};

/// How far the copies of the rings next to the poles lie towards the next ring, as a share of the way there: where a
/// surface has a tangent plane at a pole, that ring is in it.
constexpr double kFromEnds = 0.35;

class CageMaker {
 public:
  CageMaker(const nurbs::Surface& surface, double inner)
      : m_columns(surface.u.points()), m_rings(surface.v.points() - 2) {
    m_cage.nodes = nurbs::nodes_of(surface);
    if (!surface.u.periodic || !nurbs::closure_of(surface).like_sphere())
      throw std::invalid_argument("control cage: a surface around in u with poles at both ends of v expected");
    if (m_columns < 3 || m_rings < 2)
      throw std::invalid_argument("control cage: at least 3 control points around and 4 rows expected");
    if (m_cage.nodes.count != m_columns * m_rings + 2)
      throw std::invalid_argument("control cage: control points apart from each other expected but for the poles");
    m_cage.points = nurbs::places_of(m_cage.nodes, surface.points);
    add_inside(inner);
    list_wedges();
  }

  ControlCage run() {
    for (const Wedge& w : m_wedges) add_end(w, 0, 0);
    for (int ring = 0; ring + 1 < m_rings; ++ring)
      for (const Wedge& w : m_wedges) add_between(w, ring);
    for (const Wedge& w : m_wedges) add_end(w, m_rings - 1, m_cage.nodes.count - 1);
    require_few_folds();
    return std::move(m_cage);
  }

 private:
  int m_columns, m_rings;
  ControlCage m_cage;
  std::vector<Wedge> m_wedges;
  double m_deepest = 0;  // volume of the largest folded cell
  int m_deepest_ring = 0;

  // Lines along the body: the axis, then the copies' columns, then those of the control points.
  int lines() const { return 1 + 2 * m_columns; }
  int inner_line(int column) const { return 1 + column % m_columns; }
  int outer_line(int column) const { return 1 + m_columns + column % m_columns; }
  int node(int ring, int line) const {
    const int inside = 1 + m_columns;  // to a ring
    if (line < inside) return m_cage.nodes.count + ring * inside + line;
    return 1 + ring * m_columns + (line - inside);
  }

  void add_inside(double inner) {
    std::vector<std::vector<Vec3d>> inside;  // of each ring the middle, then the copies
    for (int ring = 0; ring < m_rings; ++ring) {
      const auto first = m_cage.points.begin() + node(ring, outer_line(0));
      Vec3d middle;
      std::for_each(first, first + m_columns, [&](Vec3d p) { middle += p / double(m_columns); });
      inside.push_back({middle});
      std::for_each(first, first + m_columns, [&](Vec3d p) { inside.back().push_back(middle + inner * (p - middle)); });
    }
    const std::vector<std::vector<Vec3d>> level = inside;
    for (std::size_t k = 0; k < level[0].size(); ++k) {
      const auto inwards = [&](int end, int next) {
        const Vec3d p = level[std::size_t(end)][k];
        inside[std::size_t(end)][k] = p + kFromEnds * (level[std::size_t(next)][k] - p);
      };
      inwards(0, 1), inwards(m_rings - 1, m_rings - 2);
    }
    for (const std::vector<Vec3d>& ring : inside) m_cage.points.insert(m_cage.points.end(), ring.begin(), ring.end());
  }

  void list_wedges() {
    const auto add = [this](int a, int b, int c) {
      Wedge w{{a, b, c}, false};
      for (int pass = 0; pass < 2; ++pass)
        for (std::size_t k = 0; k + 1 < 3; ++k)
          if (w.line[k] > w.line[k + 1]) std::swap(w.line[k], w.line[k + 1]), w.turned = !w.turned;
      m_wedges.push_back(w);
    };
    for (int i = 0; i < m_columns; ++i) {
      add(0, inner_line(i), inner_line(i + 1));
      add(inner_line(i), outer_line(i), inner_line(i + 1));
      add(inner_line(i + 1), outer_line(i), outer_line(i + 1));
    }
  }

  /// @param turned  in this order the volume would be below 0
  void add_cell(std::array<int, 4> cell, bool turned, int ring) {
    if (turned) std::swap(cell[2], cell[3]);
    const auto& p = m_cage.points;
    const double volume = geometry::volume6(p[std::size_t(cell[0])], p[std::size_t(cell[1])], p[std::size_t(cell[2])],
                                            p[std::size_t(cell[3])]) /
                          6;
    if (volume == 0) return;
    const bool folded = volume < 0;
    if (folded) std::swap(cell[2], cell[3]);
    if (folded && -volume > m_deepest) m_deepest = -volume, m_deepest_ring = ring;
    m_cage.volume += std::fabs(volume);
    m_cage.folded_volume += folded ? -volume : 0.0;
    m_cage.cells.push_back(cell);
    m_cage.folded.push_back(folded);
  }
  void require_few_folds() const {
    constexpr double kMostFolded = 0.2;  // of the volume
    if (m_cage.folded_volume > kMostFolded * m_cage.volume)
      throw std::invalid_argument(
          "control cage: rings that go around the middle of their points and do not cross expected, got other ones, "
          "such as that of row " +
          std::to_string(m_deepest_ring + 1));
  }

  /// A prism from a ring to the next. Which diagonals its sides have follows from the order of lines alone, so that
  /// neighbours agree.
  void add_between(const Wedge& w, int ring) {
    std::array<int, 3> b, t;
    for (std::size_t k = 0; k < 3; ++k) b[k] = node(ring, w.line[k]), t[k] = node(ring + 1, w.line[k]);
    add_cell({b[0], b[1], b[2], t[2]}, w.turned, ring);
    add_cell({b[0], b[1], t[1], t[2]}, !w.turned, ring);
    add_cell({b[0], t[0], t[1], t[2]}, w.turned, ring);
  }

  void add_end(const Wedge& w, int ring, int pole) {
    const bool below = ring == 0 && pole == 0;
    add_cell({node(ring, w.line[0]), node(ring, w.line[1]), node(ring, w.line[2]), pole}, w.turned != below, ring);
  }
};

// A fourth moment of springs' directions by the numbers of x, y and z in it: 15 of them are all there is to the energy
// under uniform strains.
constexpr int kMoments = 15;
constexpr int kPowers[kMoments][3] = {{4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {2, 2, 0}, {2, 0, 2},
                                      {0, 2, 2}, {3, 1, 0}, {3, 0, 1}, {1, 3, 0}, {0, 3, 1},
                                      {1, 0, 3}, {0, 1, 3}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
using Moments = std::array<double, kMoments>;

/// l^2 times the products of the direction's components.
Moments moments_of(Vec3d along) {
  const double l2 = dot(along, along);
  Moments out{};
  for (std::size_t m = 0; m < kMoments; ++m) {
    double product = 1 / l2;
    for (int k = 0; k < 3; ++k)
      for (int n = 0; n < kPowers[m][k]; ++n) product *= along[k];
    out[m] = product;
  }
  return out;
}

/// Those of the tissue: 2/5 E V (delta delta + delta delta + delta delta).
Moments wanted_moments(double youngs_modulus, double volume) {
  Moments out{};
  for (std::size_t m = 0; m < kMoments; ++m) {
    const int highest = std::max({kPowers[m][0], kPowers[m][1], kPowers[m][2]});
    if (m < 6) out[m] = 0.4 * youngs_modulus * volume * (highest == 4 ? 3 : 1);
  }
  return out;
}

constexpr double kLeastFactor = 0.3;  // no spring goes slack
constexpr int kBalanceRounds = 20;

/// Stiffnesses k (1 + a.lambda), the change that is least in sum of squares over k, so that their moments a are the
/// wanted ones; what would fall below 0.3 of it stays there.
class Balance {
 public:
  Balance(NetworkDescription& network, const Moments& wanted) : m_network(network), m_wanted(wanted) {
    for (const SpringDescription& s : network.springs) {
      m_moments.push_back(moments_of(network.positions[std::size_t(s.b)] - network.positions[std::size_t(s.a)]));
      m_scale = std::max(m_scale, m_moments.back()[0] + m_moments.back()[1] + m_moments.back()[2]);
    }
    m_least.assign(m_moments.size(), 0);
  }

  void run() {
    for (int round = 0; round < kBalanceRounds && solve() && clamp(); ++round) {
    }
    for (std::size_t i = 0; i < m_moments.size(); ++i)
      m_network.springs[i].k *= m_least[i] ? kLeastFactor : std::max(factor(i), kLeastFactor);
  }

 private:
  NetworkDescription& m_network;
  Moments m_wanted, m_lambda{};
  std::vector<Moments> m_moments;     // of springs, per stiffness
  std::vector<std::uint8_t> m_least;  // springs that stay at their least
  double m_scale = 0;                 // so that the system is of the order of stiffnesses

  double factor(std::size_t i) const {
    double sum = 1;
    for (std::size_t m = 0; m < kMoments; ++m) sum += m_moments[i][m] * m_lambda[m] / m_scale;
    return sum;
  }
  bool solve() {
    std::vector<double> system(std::size_t(kMoments * kMoments), 0.0);
    Moments missing = m_wanted;
    for (std::size_t i = 0; i < m_moments.size(); ++i) {
      const double k = m_network.springs[i].k;
      const Moments& a = m_moments[i];
      for (std::size_t m = 0; m < kMoments; ++m) {
        missing[m] -= (m_least[i] ? kLeastFactor : 1) * k * a[m];
        for (std::size_t n = 0; n < kMoments && !m_least[i]; ++n) system[m * kMoments + n] += k * a[m] * a[n] / m_scale;
      }
    }
    const numerics::DenseLu lu(kMoments, std::move(system));
    if (lu.singular()) return false;
    lu.solve(missing.data());
    m_lambda = missing;
    return true;
  }
  /// @return whether there are more of them at their least
  bool clamp() {
    bool more = false;
    for (std::size_t i = 0; i < m_moments.size(); ++i)
      if (!m_least[i] && factor(i) < kLeastFactor) m_least[i] = 1, more = true;
    return more;
  }
};

constexpr double kLeastMass = 0.1;  // of what the cells give a node

constexpr double kStiffShare = 0.2;  // of the mass, that nodes get for their stiffness

/// A part of the mass goes to where springs are stiff and short, as at the poles: they would set the time step alone.
/// More than a fifth weighs down the small cells there, until they buckle.
void share_by_stiffness(NetworkDescription& network) {
  double whole = 0, all = 0;
  std::vector<double> k(network.mass.size(), 0.0);
  for (const SpringDescription& s : network.springs)
    for (const int end : {s.a, s.b}) k[std::size_t(end)] += s.k, all += s.k;
  for (const double m : network.mass) whole += m;
  for (std::size_t i = 0; i < k.size(); ++i)
    network.mass[i] = (1 - kStiffShare) * network.mass[i] + kStiffShare * whole * k[i] / all;
}

/// The masses, times a + b.(x - c).
void tilt(std::vector<double>& mass, const std::vector<Vec3d>& x, double wanted, Vec3d centre) {
  double sum = 0;
  Vec3d c;
  for (std::size_t i = 0; i < mass.size(); ++i) sum += mass[i], c += mass[i] * x[i];
  c = c / sum;
  Mat3d spread{};
  for (std::size_t i = 0; i < mass.size(); ++i) spread = spread + mass[i] * outer(x[i] - c, x[i] - c);
  const Vec3d b = inverse(spread) * (wanted * (centre - c));
  const double a = wanted / sum;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const double share = a + dot(b, x[i] - c);
    if (!(share > kLeastMass * a))
      throw std::invalid_argument("control cage: control points around the body's centre of mass expected");
    mass[i] *= share;
  }
}

}  // namespace

ControlCage control_cage(const nurbs::Surface& surface, double inner) { return CageMaker(surface, inner).run(); }

TetNetwork cage_network(const ControlCage& cage, const TetMaterial& material, double volume, Vec3d centre) {
  TetMaterial in_cage = material;
  in_cage.youngs_modulus *= volume / cage.volume;
  TetNetwork out = tet_network(cage.points, cage.cells, in_cage);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < cage.cells.size(); ++t)
    if (!cage.folded[t]) out.network.tets[kept++] = cage.cells[t];
  out.network.tets.resize(kept);
  out.network.opening_time *= std::sqrt(volume / cage.volume);  // of the tissue's own waves
  const double springs = bulk_share(material.youngs_modulus, material.poisson).spring_modulus;
  Balance(out.network, wanted_moments(springs, volume)).run();
  share_by_stiffness(out.network);
  tilt(out.network.mass, cage.points, material.density * volume, centre);
  return out;
}

}  // namespace trocar::tissue
