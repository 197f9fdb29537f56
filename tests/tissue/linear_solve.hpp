// The linear network of a description, solved: what a body would do under small loads, without time.
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/tissue/network/network.hpp>

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

/// Static answer to nodal forces; the axes of `fixed` (Held bits per node) stay where `given` puts them, 0 where it is
/// empty. The accuracy of a linear solve.
inline std::vector<Vec3d> solve(const NetworkDescription& d, const std::vector<Vec3d>& load,
                                const std::vector<std::uint8_t>& fixed, const std::vector<Vec3d>& given = {}) {
  const int n = 3 * int(d.positions.size());
  const auto held = [&](int i) { return (fixed[size_t(i / 3)] >> (i % 3) & 1) != 0; };
  std::vector<Vec3d> u(d.positions.size());
  for (int i = 0; i < n && !given.empty(); ++i)
    if (held(i)) u[size_t(i / 3)][i % 3] = given[size_t(i / 3)][i % 3];
  const std::vector<Vec3d> from_given = forces(d, u);
  std::vector<double> b(n), x(n, 0.0), diagonal(n, 1.0);
  for (int i = 0; i < n; ++i) b[i] = held(i) ? 0 : load[i / 3][i % 3] - from_given[i / 3][i % 3];
  for (const auto& e : d.springs)
    for (int axis = 0; axis < 3; ++axis) {
      const double c = normalised(d.positions[e.b] - d.positions[e.a])[axis];
      diagonal[3 * e.a + axis] += e.k * c * c, diagonal[3 * e.b + axis] += e.k * c * c;
    }
  numerics::ConjugateGradientWork work(n);
  std::vector<Vec3d> v(d.positions.size());
  const auto apply = [&](const double* p, double* q) {
    for (int i = 0; i < n; ++i) v[i / 3][i % 3] = held(i) ? 0 : p[i];
    const auto f = forces(d, v);
    for (int i = 0; i < n; ++i) q[i] = held(i) ? p[i] : f[i / 3][i % 3];
  };
  const auto result = numerics::conjugate_gradient(apply, numerics::DiagonalPreconditioner{diagonal.data()}, b.data(),
                                                   x.data(), n, {.iterations = 20000, .relative_residual = 1e-9}, work);
  EXPECT_TRUE(result.converged);
  for (int i = 0; i < n; ++i)
    if (!held(i)) u[i / 3][i % 3] = x[i];
  return u;
}

/// The same with whole nodes kept.
inline std::vector<Vec3d> solve(const NetworkDescription& d, const std::vector<Vec3d>& load,
                                const std::vector<bool>& held) {
  std::vector<std::uint8_t> fixed;
  for (const bool h : held) fixed.push_back(h ? kHeld : kFree);
  return solve(d, load, fixed);
}

}  // namespace trocar::tissue
