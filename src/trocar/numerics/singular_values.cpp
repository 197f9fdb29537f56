#include <algorithm>
#include <cmath>
#include <cstddef>

#include <trocar/numerics/singular_values.hpp>

namespace trocar::numerics {
namespace {

/// Makes two columns perpendicular; were they so already?
bool turn_apart(int m, double* p, double* q) noexcept {
  double pp = 0, qq = 0, pq = 0;
  for (int i = 0; i < m; ++i) {
    pp += p[i] * p[i];
    qq += q[i] * q[i];
    pq += p[i] * q[i];
  }
  if (!(std::fabs(pq) > 1e-16 * std::sqrt(pp * qq)) || pq == 0) return true;
  const double zeta = (qq - pp) / (2 * pq);
  const double t = (zeta > 0 ? 1 : -1) / (std::fabs(zeta) + std::sqrt(1 + zeta * zeta));
  const double c = 1 / std::sqrt(1 + t * t), s = c * t;
  for (int i = 0; i < m; ++i) {
    const double x = p[i];
    p[i] = c * x - s * q[i];
    q[i] = s * x + c * q[i];
  }
  return false;
}

}  // namespace

void singular_values(int m, int n, double* a, double* values) noexcept {
  constexpr int kMostSweeps = 40;  // some six are the rule
  bool done = false;
  for (int sweep = 0; sweep < kMostSweeps && !done; ++sweep) {
    done = true;
    for (int j = 0; j + 1 < n; ++j)
      for (int k = j + 1; k < n; ++k)
        done = turn_apart(m, a + std::size_t(j) * std::size_t(m), a + std::size_t(k) * std::size_t(m)) && done;
  }
  for (int j = 0; j < n; ++j) {
    double sum = 0;
    for (int i = 0; i < m; ++i) sum += a[std::size_t(j) * std::size_t(m) + i] * a[std::size_t(j) * std::size_t(m) + i];
    values[j] = std::sqrt(sum);
  }
  std::sort(values, values + n, [](double x, double y) { return x > y; });
}

}  // namespace trocar::numerics
