#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_cut.hpp>
#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/tissue/network/spring_medium.hpp>
#include <trocar/tissue/network/volume_force.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

namespace trocar::tissue {
namespace {

using geometry::Tet;

constexpr int kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr double kCrossShare = 0.5;   // of a cell's stiffness that starts in the springs across its faces
constexpr double kAnchor = 0.005;     // pull towards the start: decides what the patch test leaves open
constexpr double kLeastShare = 0.05;  // of the start: no spring goes slack, whatever the fit would like

/// Six strains that are an orthonormal basis of all.
constexpr int kModes = 6;
Symmetric mode(int m) {
  constexpr double half = 0.70710678118654752440;
  const auto one = [m](int i, double value) { return m == i ? value : 0.0; };
  return {one(0, 1), one(1, 1), one(2, 1), one(3, half), one(4, half), one(5, half)};
}

using NodeForces = std::array<Vec3d, kModes>;  // on a node, one for each strain

struct TetSpring {
  int a, b;
  double start;  // k l^2 [N m]
  double length = 0;
  Vec3d n{};                             // from a to b
  std::array<double, kModes> stretch{};  // l n.(strain n)
  std::array<int, 2> cells{-1, -1};      // of a spring across a face
};

[[noreturn]] void refuse_tets(const std::string& what) { throw std::invalid_argument("tetrahedra: expected " + what); }

std::array<Vec3d, 4> corners(std::span<const Vec3d> points, const Tet& c) {
  return {points[std::size_t(c[0])], points[std::size_t(c[1])], points[std::size_t(c[2])], points[std::size_t(c[3])]};
}

/// Gradients of the corners' shape functions times six volumes.
std::array<Vec3d, 4> gradients6(const std::array<Vec3d, 4>& x) {
  std::array<Vec3d, 4> g;
  g[1] = cross(x[2] - x[0], x[3] - x[0]);
  g[2] = cross(x[3] - x[0], x[1] - x[0]);
  g[3] = cross(x[1] - x[0], x[2] - x[0]);
  g[0] = -1.0 * (g[1] + g[2] + g[3]);
  return g;
}

std::vector<double> volumes(std::span<const Vec3d> points, std::span<const Tet> cells) {
  std::vector<double> out;
  for (std::size_t t = 0; t < cells.size(); ++t) {
    for (const int corner : cells[t])
      if (corner < 0 || std::size_t(corner) >= points.size())
        refuse_tets("points that exist in cell " + std::to_string(t));
    const std::array<Vec3d, 4> x = corners(points, cells[t]);
    out.push_back(geometry::volume6(x[0], x[1], x[2], x[3]) / 6);
    if (!(out.back() > 0)) refuse_tets("positive volume in cell " + std::to_string(t));
  }
  return out;
}

/// Two media where every cell may have its own.
class Media {
 public:
  Media(const TetMaterial& m, std::span<const Vec3d> fibres)
      : m_material(m),
        m_fibres(fibres),
        m_springs(bulk_share(m.youngs_modulus, m.poisson).spring_modulus),
        m_everywhere(spring_medium(m_springs, m.fibre, m.fibre_ratio)) {}
  SpringMedium of(std::size_t cell) const {
    if (m_fibres.empty()) return m_everywhere;
    return spring_medium(m_springs, m_fibres[cell], m_material.fibre_ratio);
  }

 private:
  const TetMaterial& m_material;
  std::span<const Vec3d> m_fibres;
  double m_springs;
  SpringMedium m_everywhere;
};

TetSpring spring(std::span<const Vec3d> points, int a, int b) {
  TetSpring s{std::min(a, b), std::max(a, b), 0};
  const Vec3d along = points[std::size_t(s.b)] - points[std::size_t(s.a)];
  s.length = length(along);
  s.n = along / s.length;
  for (int m = 0; m < kModes; ++m) s.stretch[m] = s.length * dot(s.n, mode(m) * s.n);
  return s;
}

/// One for each edge of the mesh, started with a sixth of the stiffness of every cell around it.
std::vector<TetSpring> edge_springs(std::span<const Vec3d> points, std::span<const Tet> cells,
                                    std::span<const double> volume, const Media& media, double share) {
  std::vector<TetSpring> all;
  all.reserve(6 * cells.size());
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const SpringMedium medium = media.of(t);
    for (const auto& p : kPairs) {
      TetSpring s = spring(points, cells[t][std::size_t(p[0])], cells[t][std::size_t(p[1])]);
      s.start = share * volume[t] * medium.s * medium.density(s.n) / 6;
      all.push_back(s);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const TetSpring& p, const TetSpring& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  std::vector<TetSpring> out;
  for (const TetSpring& s : all) {
    if (!out.empty() && out.back().a == s.a && out.back().b == s.b)
      out.back().start += s.start;
    else
      out.push_back(s);
  }
  return out;
}

/// One through each inner face, started with a quarter of the stiffness of the two cells beside it.
void add_cross_springs(std::span<const Vec3d> points, std::span<const Tet> cells, std::span<const double> volume,
                       const Media& media, std::vector<TetSpring>& springs) {
  const std::vector<geometry::Tet> across = geometry::cuttable(points, cells, 0).across;
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      const int u = across[t][f];
      if (u < int(t)) continue;  // the surface, or there already
      const auto& back = across[std::size_t(u)];
      const auto far = std::size_t(std::find(back.begin(), back.end(), int(t)) - back.begin());
      TetSpring s = spring(points, cells[t][f], cells[std::size_t(u)][far]);
      s.cells = {int(t), u};
      for (const int cell : s.cells) {
        const SpringMedium medium = media.of(std::size_t(cell));
        s.start += kCrossShare * volume[std::size_t(cell)] * medium.s * medium.density(s.n) / 4;
      }
      springs.push_back(s);
    }
}

/// What the medium asks of every node, with the sign that makes springs less medium the wrong force.
std::vector<NodeForces> medium_forces(std::span<const Vec3d> points, std::span<const Tet> cells, const Media& media) {
  std::vector<NodeForces> out(points.size());
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const std::array<Vec3d, 4> g = gradients6(corners(points, cells[t]));
    const SpringMedium medium = media.of(t);
    for (int m = 0; m < kModes; ++m) {
      const Symmetric sigma = stress(medium, mode(m));
      for (std::size_t i = 0; i < 4; ++i) out[std::size_t(cells[t][i])][std::size_t(m)] += (sigma * g[i]) / 6.0;
    }
  }
  return out;
}

void add_pull(const TetSpring& s, double k, std::vector<NodeForces>& wrong) {
  for (std::size_t m = 0; m < kModes; ++m) {
    const Vec3d pull = (k * s.stretch[m]) * s.n;
    wrong[std::size_t(s.a)][m] += pull;
    wrong[std::size_t(s.b)][m] -= pull;
  }
}

/// Coordinate descent on the sum of squares of the nodes' wrong forces, which are kept up to date.
void fit(const std::vector<TetSpring>& springs, int sweeps, std::vector<double>& k, std::vector<NodeForces>& wrong) {
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const TetSpring& s = springs[i];
      const NodeForces &a = wrong[std::size_t(s.a)], &b = wrong[std::size_t(s.b)];
      const double start = s.start / (s.length * s.length), curvature = 2 * s.length * s.length;
      double slope = curvature * kAnchor * (k[i] - start);
      for (std::size_t m = 0; m < kModes; ++m) slope += s.stretch[m] * dot(s.n, a[m] - b[m]);
      const double next = std::max(k[i] - slope / (curvature * (1 + kAnchor)), kLeastShare * start);
      add_pull(s, next - k[i], wrong);
      k[i] = next;
    }
}

double rms(const std::vector<NodeForces>& forces) {
  double sum = 0;
  for (const NodeForces& f : forces)
    for (const Vec3d& v : f) sum += dot(v, v);
  return std::sqrt(sum / double(forces.size()));
}

NetworkDescription bare_network(std::span<const Vec3d> points, std::span<const Tet> cells,
                                std::span<const double> volume, double density) {
  NetworkDescription d;
  d.positions.assign(points.begin(), points.end());
  d.mass.assign(points.size(), 0.0);
  d.fixed.assign(points.size(), kFree);
  d.tets.assign(cells.begin(), cells.end());
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (const int corner : cells[t]) d.mass[std::size_t(corner)] += density * volume[t] / 4;
  for (std::size_t i = 0; i < d.mass.size(); ++i)
    if (!(d.mass[i] > 0)) refuse_tets("a cell that uses point " + std::to_string(i));
  return d;
}

/// A collapsed cell is driven open no faster than twice a wave's time across a cell: one that is driven faster meets
/// neighbours that do not follow yet, and such a body once worked itself up to 80 m/s.
double opening_time(const std::vector<TetSpring>& springs, std::size_t edges, const TetMaterial& m) {
  double sum = 0;
  for (std::size_t i = 0; i < edges; ++i) sum += springs[i].length;
  return 2 * sum / double(edges) * std::sqrt(m.density / m.youngs_modulus);
}

}  // namespace

TetNetwork tet_network(std::span<const Vec3d> points, std::span<const Tet> cells, const TetMaterial& material,
                       std::span<const Vec3d> fibres) {
  if (cells.empty()) refuse_tets("at least one cell");
  if (!(material.density > 0)) refuse_tets("density > 0");
  if (!(material.poisson >= 0.25 && material.poisson <= kMostPoisson))
    refuse_tets("a Poisson's ratio of 0.25 to " + std::to_string(kMostPoisson));
  if (!fibres.empty() && fibres.size() != cells.size())
    refuse_tets("one fibre per cell, got " + std::to_string(fibres.size()));
  const std::vector<double> volume = volumes(points, cells);
  const Media media(material, fibres);

  TetNetwork out;
  out.network = bare_network(points, cells, volume, material.density);
  if (material.poisson > 0.25) out.network.kappa = bulk_share(material.youngs_modulus, material.poisson).kappa;
  std::vector<TetSpring> springs =
      edge_springs(points, cells, volume, media, material.across_faces ? 1 - kCrossShare : 1.0);
  out.edge_springs = int(springs.size());
  out.network.opening_time = opening_time(springs, springs.size(), material);
  if (material.across_faces) add_cross_springs(points, cells, volume, media, springs);

  std::vector<NodeForces> wrong = medium_forces(points, cells, media);
  const double asked = rms(wrong);
  std::vector<double> k;
  for (const TetSpring& s : springs) {
    k.push_back(s.start / (s.length * s.length));
    add_pull(s, k.back(), wrong);
  }
  out.misfit_start = rms(wrong) / asked;
  fit(springs, material.sweeps, k, wrong);
  out.misfit = rms(wrong) / asked;

  for (std::size_t i = 0; i < springs.size(); ++i) {
    const TetSpring& s = springs[i];
    SpringDescription e;
    e.a = s.a, e.b = s.b;
    e.k = k[i];
    e.rest_length = s.length;
    e.p1 = material.p1, e.p2 = material.p2, e.cap = material.cap;
    e.damping = material.damping_time * k[i];
    out.network.springs.push_back(e);
    if (s.cells[0] >= 0) out.cells_of_cross_spring.push_back(s.cells);
  }
  return out;
}

}  // namespace trocar::tissue
