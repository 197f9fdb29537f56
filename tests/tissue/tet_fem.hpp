// Linear tetrahedra of an isotropic elastic solid with nu = 1/4, solved statically: what networks of springs made from
// the same cells are held against. Textbook finite elements [Zienkiewicz & Taylor 2000]; our code.
//
//   const std::vector<Vec3d> u = solve(fem, load, held);
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue::test {

struct TetFem {
  std::vector<Vec3d> points;               ///< [m]
  std::vector<std::array<int, 4>> cells;   ///< upright
  double youngs_modulus = 0, density = 0;  ///< [Pa] [kg/m^3]

  /// Gradients of the corners' shape functions [1/m] and the volume [m^3] of a cell.
  std::pair<std::array<Vec3d, 4>, double> shape(std::size_t cell) const {
    const auto x = [&](int i) { return points[size_t(cells[cell][size_t(i)])]; };
    const Vec3d a = x(1) - x(0), b = x(2) - x(0), c = x(3) - x(0);
    const double six = dot(a, cross(b, c));
    const Vec3d g1 = cross(b, c) / six, g2 = cross(c, a) / six, g3 = cross(a, b) / six;
    return {{-1.0 * (g1 + g2 + g3), g1, g2, g3}, six / 6};
  }
  /// K u [N]. With nu = 1/4 both of Lame's moduli are 0.4 E.
  std::vector<Vec3d> forces(const std::vector<Vec3d>& u) const {
    std::vector<Vec3d> f(u.size());
    const double lame = 0.4 * youngs_modulus;
    for (std::size_t t = 0; t < cells.size(); ++t) {
      const auto [g, volume] = shape(t);
      double grad[3][3] = {};  // d u_i / d x_j
      for (std::size_t n = 0; n < 4; ++n)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) grad[i][j] += u[size_t(cells[t][n])][i] * g[n][j];
      const double swell = grad[0][0] + grad[1][1] + grad[2][2];
      for (std::size_t n = 0; n < 4; ++n)
        for (int i = 0; i < 3; ++i) {
          double sum = swell * g[n][i];
          for (int j = 0; j < 3; ++j) sum += (grad[i][j] + grad[j][i]) * g[n][j];
          f[size_t(cells[t][n])][i] += volume * lame * sum;
        }
    }
    return f;
  }
  std::vector<double> masses() const {
    std::vector<double> m(points.size());
    for (std::size_t t = 0; t < cells.size(); ++t)
      for (const int node : cells[t]) m[size_t(node)] += density * shape(t).second / 4;
    return m;
  }
};

/// Each cell cut into eight; every new node is the middle of an edge. @param held  goes along: a middle is held where
/// both its ends are
inline TetFem refined(const TetFem& fem, std::vector<std::uint8_t>& held) {
  TetFem out{fem.points, {}, fem.youngs_modulus, fem.density};
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [it, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, int(out.points.size()));
    if (fresh) {
      out.points.push_back(0.5 * (fem.points[size_t(a)] + fem.points[size_t(b)]));
      held.push_back(held[size_t(a)] & held[size_t(b)]);
    }
    return it->second;
  };
  for (const auto& c : fem.cells) {
    const int ab = middle(c[0], c[1]), ac = middle(c[0], c[2]), ad = middle(c[0], c[3]);
    const int bc = middle(c[1], c[2]), bd = middle(c[1], c[3]), cd = middle(c[2], c[3]);
    for (const std::array<int, 4>& t : {std::array<int, 4>{c[0], ab, ac, ad},
                                        {ab, c[1], bc, bd},
                                        {ac, bc, c[2], cd},
                                        {ad, bd, cd, c[3]},
                                        // the octahedron in the middle, about its diagonal from ac to bd
                                        {ac, bd, ab, bc},
                                        {ac, bd, bc, cd},
                                        {ac, bd, cd, ad},
                                        {ac, bd, ad, ab}})
      out.cells.push_back(t);
  }
  for (auto& c : out.cells) {
    const auto x = [&](int i) { return out.points[size_t(c[size_t(i)])]; };
    if (dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) < 0) std::swap(c[2], c[3]);
  }
  return out;
}

/// Displacements under `load`, the held nodes kept. The accuracy of a linear solve.
inline std::vector<Vec3d> solve(const TetFem& fem, const std::vector<Vec3d>& load,
                                const std::vector<std::uint8_t>& held) {
  const int n = 3 * int(fem.points.size());
  std::vector<double> b(size_t(n), 0.0), x(size_t(n), 0.0), diagonal(size_t(n), 0.0);
  for (std::size_t t = 0; t < fem.cells.size(); ++t) {
    const auto [g, volume] = fem.shape(t);
    for (std::size_t c = 0; c < 4; ++c)
      for (int i = 0; i < 3; ++i)
        diagonal[size_t(3 * fem.cells[t][c] + i)] +=
            volume * 0.4 * fem.youngs_modulus * (dot(g[c], g[c]) + 2 * g[c][i] * g[c][i]);
  }
  for (int i = 0; i < n; ++i) {
    if (held[size_t(i / 3)]) diagonal[size_t(i)] = 1;
    b[size_t(i)] = held[size_t(i / 3)] ? 0 : load[size_t(i / 3)][i % 3];
  }
  numerics::ConjugateGradientWork work(n);
  std::vector<Vec3d> u(fem.points.size());
  const auto apply = [&](const double* p, double* q) {
    for (int i = 0; i < n; ++i) u[size_t(i / 3)][i % 3] = held[size_t(i / 3)] ? 0 : p[i];
    const std::vector<Vec3d> f = fem.forces(u);
    for (int i = 0; i < n; ++i) q[i] = held[size_t(i / 3)] ? p[i] : f[size_t(i / 3)][i % 3];
  };
  const auto result = numerics::conjugate_gradient(apply, numerics::DiagonalPreconditioner{diagonal.data()}, b.data(),
                                                   x.data(), n, {.iterations = 20000, .relative_residual = 1e-8}, work);
  EXPECT_TRUE(result.converged);
  for (int i = 0; i < n; ++i) u[size_t(i / 3)][i % 3] = x[size_t(i)];
  return u;
}

}  // namespace trocar::tissue::test
