// The linear network of a description, solved: what a body would do under small loads, without time.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/tissue/network.hpp>

namespace trocar::tissue {

/// Forces K u of the linear network [N].
inline std::vector<Vec3d> forces(const NetworkDescription& d, const std::vector<Vec3d>& u) {
  std::vector<Vec3d> f(u.size());
  for (const auto& e : d.springs) {
    const Vec3d n = normalised(d.positions[e.b] - d.positions[e.a]);
    const Vec3d s = (e.k * dot(n, u[e.b] - u[e.a])) * n;
    f[e.a] -= s, f[e.b] += s;
  }
  return f;
}

/// Static answer to nodal forces, nodes with `held` kept; the accuracy of a linear solve.
inline std::vector<Vec3d> solve(const NetworkDescription& d, const std::vector<Vec3d>& load,
                                const std::vector<bool>& held) {
  const int n = 3 * int(d.positions.size());
  std::vector<double> b(n), x(n, 0.0), diagonal(n, 1.0);
  for (int i = 0; i < n; ++i) b[i] = held[i / 3] ? 0 : load[i / 3][i % 3];
  for (const auto& e : d.springs)
    for (int axis = 0; axis < 3; ++axis) {
      const double c = normalised(d.positions[e.b] - d.positions[e.a])[axis];
      diagonal[3 * e.a + axis] += e.k * c * c, diagonal[3 * e.b + axis] += e.k * c * c;
    }
  numerics::ConjugateGradientWork work(n);
  std::vector<Vec3d> u(d.positions.size());
  const auto apply = [&](const double* p, double* q) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
    const auto f = forces(d, u);
    for (int i = 0; i < n; ++i) q[i] = held[i / 3] ? p[i] : f[i / 3][i % 3];
  };
  const auto result = numerics::conjugate_gradient(apply, numerics::DiagonalPreconditioner{diagonal.data()}, b.data(),
                                                   x.data(), n, {.iterations = 20000, .relative_residual = 1e-9}, work);
  EXPECT_TRUE(result.converged);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
  return u;
}

}  // namespace trocar::tissue
