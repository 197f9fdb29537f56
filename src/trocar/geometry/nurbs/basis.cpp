#include <algorithm>

#include <trocar/geometry/nurbs/basis.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kRow = kHighestDegree + 1;

// ndu[j][r], r < j: differences of knots; ndu[r][j], r <= j: values of the functions of degree j.  [PT97 A2.3]
void value_table(const Knots& knots, int span, double u, double (*ndu)[kRow]) noexcept {
  double left[kRow], right[kRow];
  ndu[0][0] = 1.0;
  for (int j = 1; j <= knots.degree; ++j) {
    left[j] = u - knots.values[span + 1 - j];
    right[j] = knots.values[span + j] - u;
    double saved = 0.0;
    for (int r = 0; r < j; ++r) {
      ndu[j][r] = right[r + 1] + left[j - r];
      const double share = ndu[r][j - 1] / ndu[j][r];
      ndu[r][j] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    ndu[j][j] = saved;
  }
}

// The d-th derivative of function r, d = 1 .. order, as a combination of functions of degree p - d: its coefficients
// follow from those of the derivative before.  [PT97 eq.2.10]
void differentiate_one(int p, int r, int order, const double (*ndu)[kRow], BasisRow* values) noexcept {
  double a[2][kRow] = {{1.0}, {}};
  int now = 0;
  for (int d = 1; d <= order; ++d) {
    const int lower = r - d, degree = p - d;
    double* const next = a[1 - now];
    const double* const last = a[now];
    double sum = 0.0;
    if (r >= d) {
      next[0] = last[0] / ndu[degree + 1][lower];
      sum = next[0] * ndu[lower][degree];
    }
    const int from = lower >= -1 ? 1 : -lower, to = r - 1 <= degree ? d - 1 : p - r;
    for (int j = from; j <= to; ++j) {
      next[j] = (last[j] - last[j - 1]) / ndu[degree + 1][lower + j];
      sum += next[j] * ndu[lower + j][degree];
    }
    if (r <= degree) {
      next[d] = -last[d - 1] / ndu[degree + 1][r];
      sum += next[d] * ndu[r][degree];
    }
    values[d][r] = sum;
    now = 1 - now;
  }
}

}  // namespace

void basis_values(const Knots& knots, int span, double u, BasisRow& values) noexcept {
  double left[kRow], right[kRow];
  values[0] = 1.0;
  for (int j = 1; j <= knots.degree; ++j) {
    left[j] = u - knots.values[span + 1 - j];
    right[j] = knots.values[span + j] - u;
    double saved = 0.0;
    for (int r = 0; r < j; ++r) {
      const double share = values[r] / (right[r + 1] + left[j - r]);
      values[r] = saved + right[r + 1] * share;
      saved = left[j - r] * share;
    }
    values[j] = saved;
  }
}

void basis_derivatives(const Knots& knots, int span, double u, int order, BasisRow* values) noexcept {
  const int p = knots.degree, highest = std::min(order, p);
  double ndu[kRow][kRow];
  value_table(knots, span, u, ndu);
  for (int d = 0; d <= order; ++d) values[d].fill(0.0);
  for (int k = 0; k <= p; ++k) values[0][k] = ndu[k][p];
  for (int r = 0; r <= p; ++r) differentiate_one(p, r, highest, ndu, values);
  double factor = p;
  for (int d = 1; d <= highest; ++d) {
    for (int k = 0; k <= p; ++k) values[d][k] *= factor;
    factor *= p - d;
  }
}

double basis_function(const Knots& knots, int function, double u) noexcept {
  const double* const t = knots.values.data() + function;
  const int p = knots.degree;
  if (!knots.periodic && function == knots.functions() - 1 && u == knots.end()) return 1.0;
  if (u < t[0] || u >= t[p + 1]) return 0.0;
  double n[kRow];
  for (int j = 0; j <= p; ++j) n[j] = u >= t[j] && u < t[j + 1] ? 1.0 : 0.0;
  for (int k = 1; k <= p; ++k)
    for (int j = 0; j <= p - k; ++j) {
      const double rising = n[j] == 0.0 ? 0.0 : n[j] * (u - t[j]) / (t[j + k] - t[j]);
      const double falling = n[j + 1] == 0.0 ? 0.0 : n[j + 1] * (t[j + k + 1] - u) / (t[j + k + 1] - t[j + 1]);
      n[j] = rising + falling;
    }
  return n[0];
}

Basis2 basis_at(const Knots& knots, double u, int order) noexcept {
  Basis2 basis;
  const double inside = into_domain(knots, u);
  const int span = span_of(knots, inside);
  basis.first = span - knots.degree;
  if (order == 0)
    basis_values(knots, span, inside, basis.value[0]);
  else
    basis_derivatives(knots, span, inside, order, basis.value);
  return basis;
}

}  // namespace trocar::geometry::nurbs
