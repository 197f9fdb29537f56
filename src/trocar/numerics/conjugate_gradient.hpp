// Preconditioned conjugate gradients in double for symmetric positive definite systems given only as a product A x.
// Sums run in index order, so the result is the same everywhere. No allocation once the work arrays are sized.
// [Hestenes & Stiefel 1952; preconditioned form: Golub & Van Loan 2013, section 11.5]
//
//   ConjugateGradientWork work(n);
//   const auto done = conjugate_gradient([&](const double* x, double* y) { ... y = A x ... },
//                                        DiagonalPreconditioner{diagonal.data()}, b.data(), x.data(), n, {}, work);
#pragma once

#include <cmath>
#include <vector>

#include <trocar/numerics/mat3.hpp>

namespace trocar::numerics {

struct ConjugateGradientLimits {
  int iterations = 1000;
  double relative_residual = 1e-10;  ///< stop at |b - A x| <= this |b|
};

struct ConjugateGradientResult {
  int iterations = 0;
  double relative_residual = 0.0;  ///< |b - A x| / |b|, by the recursion
  bool converged = false;
  bool not_positive = false;  ///< a direction p with p A p <= 0 was met: A is not positive definite; x is the last good
};

struct ConjugateGradientWork {
  ConjugateGradientWork() = default;
  explicit ConjugateGradientWork(int n) { resize(n); }
  void resize(int n) {
    for (std::vector<double>* v : {&residual, &preconditioned, &direction, &product}) v->assign(n, 0.0);
  }
  std::vector<double> residual, preconditioned, direction, product;
};

struct NoPreconditioner {
  void operator()(const double* r, double* z, int n) const noexcept {
    for (int i = 0; i < n; ++i) z[i] = r[i];
  }
};
/// Jacobi: divides by the diagonal of A (n numbers > 0).
struct DiagonalPreconditioner {
  const double* diagonal;
  void operator()(const double* r, double* z, int n) const noexcept {
    for (int i = 0; i < n; ++i) z[i] = r[i] / diagonal[i];
  }
};
/// Block Jacobi: multiplies by the inverses of the 3x3 diagonal blocks of A (n / 3 of them; use inverse(block)).
struct BlockPreconditioner {
  const Mat3d* inverse_blocks;
  void operator()(const double* r, double* z, int n) const noexcept {
    for (int b = 0; 3 * b < n; ++b) {
      const Vec3d out = inverse_blocks[b] * Vec3d{r[3 * b], r[3 * b + 1], r[3 * b + 2]};
      z[3 * b] = out.x, z[3 * b + 1] = out.y, z[3 * b + 2] = out.z;
    }
  }
};

namespace detail {
inline double dot_in_order(const double* a, const double* b, int n) noexcept {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}
}  // namespace detail

/// Solves A x = b. `apply(x, y)` writes A x to y; `precondition(r, z, n)` writes M^-1 r to z, M symmetric positive
/// definite. x holds the first guess and becomes the solution; work must be sized for n.
template <class Apply, class Precondition>
ConjugateGradientResult conjugate_gradient(const Apply& apply, const Precondition& precondition, const double* b,
                                           double* x, int n, const ConjugateGradientLimits& limits,
                                           ConjugateGradientWork& work) {
  double* const r = work.residual.data();
  double* const z = work.preconditioned.data();
  double* const p = work.direction.data();
  double* const q = work.product.data();
  ConjugateGradientResult result;

  const double scale = std::sqrt(detail::dot_in_order(b, b, n));
  if (!(scale > 0.0)) {  // A x = 0
    for (int i = 0; i < n; ++i) x[i] = 0.0;
    result.converged = scale == 0.0;
    return result;
  }
  apply(static_cast<const double*>(x), q);
  for (int i = 0; i < n; ++i) r[i] = b[i] - q[i];
  precondition(static_cast<const double*>(r), z, n);
  for (int i = 0; i < n; ++i) p[i] = z[i];
  double rz = detail::dot_in_order(r, z, n);

  for (;;) {
    result.relative_residual = std::sqrt(detail::dot_in_order(r, r, n)) / scale;
    result.converged = result.relative_residual <= limits.relative_residual;
    if (result.converged || result.iterations >= limits.iterations) return result;

    apply(static_cast<const double*>(p), q);
    const double pq = detail::dot_in_order(p, q, n);
    if (!(pq > 0.0)) {
      result.not_positive = true;
      return result;
    }
    const double step = rz / pq;
    for (int i = 0; i < n; ++i) x[i] += step * p[i];
    for (int i = 0; i < n; ++i) r[i] -= step * q[i];
    precondition(static_cast<const double*>(r), z, n);
    const double rz_next = detail::dot_in_order(r, z, n);
    const double turn = rz_next / rz;
    for (int i = 0; i < n; ++i) p[i] = z[i] + turn * p[i];
    rz = rz_next;
    ++result.iterations;
  }
}

}  // namespace trocar::numerics
