#include <algorithm>
#include <cmath>

#include <trocar/numerics/dense_lu.hpp>

namespace trocar::numerics {

DenseLu::DenseLu(int n, std::vector<double> a) : m_n(n), m_a(std::move(a)) {
  const auto at = [this](int i, int j) -> double& { return m_a[static_cast<std::size_t>(i) * m_n + j]; };
  for (int i = 0; i < n; ++i) m_order.push_back(i);
  double largest = 0.0;
  for (double value : m_a) largest = std::max(largest, std::fabs(value));
  for (int k = 0; k < n && !m_singular; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(at(i, k)) > std::fabs(at(pivot, k))) pivot = i;
    m_singular = !(std::fabs(at(pivot, k)) > 1e-15 * largest);
    if (m_singular) break;
    if (pivot != k) {
      std::swap(m_order[pivot], m_order[k]);
      for (int j = 0; j < n; ++j) std::swap(at(pivot, j), at(k, j));
    }
    for (int i = k + 1; i < n; ++i) {
      const double factor = at(i, k) / at(k, k);
      at(i, k) = factor;
      if (factor != 0.0)
        for (int j = k + 1; j < n; ++j) at(i, j) -= factor * at(k, j);
    }
  }
}

void DenseLu::solve(double* x, int columns) const {
  const auto row = [this](int i) { return m_a.data() + static_cast<std::size_t>(i) * m_n; };
  const auto at = [columns](int i, int c) { return static_cast<std::size_t>(i) * columns + c; };
  std::vector<double> y(static_cast<std::size_t>(m_n));
  for (int c = 0; c < columns; ++c) {
    for (int i = 0; i < m_n; ++i) {
      double sum = x[at(m_order[i], c)];
      for (int j = 0; j < i; ++j) sum -= row(i)[j] * y[j];
      y[i] = sum;
    }
    for (int i = m_n - 1; i >= 0; --i) {
      double sum = y[i];
      for (int j = i + 1; j < m_n; ++j) sum -= row(i)[j] * y[j];
      y[i] = sum / row(i)[i];
    }
    for (int i = 0; i < m_n; ++i) x[at(i, c)] = y[i];
  }
}

}  // namespace trocar::numerics
