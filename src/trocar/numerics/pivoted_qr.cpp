#include <algorithm>
#include <cmath>

#include <trocar/numerics/pivoted_qr.hpp>

namespace trocar::numerics {

PivotedQr::PivotedQr(int most_rows, int most_columns) {
  const auto rows = std::size_t(most_rows), columns = std::size_t(most_columns);
  m_a.resize(rows * columns);
  for (std::vector<double>* v : {&m_tau, &m_tau_z, &m_pivot, &m_x}) v->resize(columns);
  m_b.resize(rows);
  m_order.resize(columns);
}

double* PivotedQr::matrix(int m, int n) noexcept {
  m_m = m;
  m_n = n;
  return m_a.data();
}

int PivotedQr::factor(double relative, double absolute) noexcept {
  m_rank = 0;
  for (int j = 0; j < m_n; ++j) m_order[std::size_t(j)] = j;
  const int most = std::min(m_m, m_n);
  double least = absolute;
  for (int k = 0; k < most; ++k) {
    int best = k;
    double largest = -1;
    for (int j = k; j < m_n; ++j) {
      const double* c = m_a.data() + std::size_t(j) * m_m;
      double sum = 0;
      for (int i = k; i < m_m; ++i) sum += c[i] * c[i];
      if (sum > largest) {
        largest = sum;
        best = j;
      }
    }
    const double size = std::sqrt(std::max(largest, 0.0));
    if (k == 0) least = std::max(least, relative * size);
    if (!(size > least)) {
      for (int i = k; i < most; ++i) m_pivot[std::size_t(i)] = size;
      break;
    }
    if (best != k) {
      std::swap(m_order[std::size_t(k)], m_order[std::size_t(best)]);
      double *a = m_a.data() + std::size_t(k) * m_m, *b = m_a.data() + std::size_t(best) * m_m;
      for (int i = 0; i < m_m; ++i) std::swap(a[i], b[i]);
    }
    m_pivot[std::size_t(k)] = size;
    double* c = m_a.data() + std::size_t(k) * m_m;
    // v = (1, c[k+1..] / (c[k] + sign |c|)); H = 1 - tau v v^T takes c to (-sign |c|, 0, ...)
    const double beta = c[k] > 0 ? -size : size, head = c[k] - beta;
    const double tau = -head / beta;
    m_tau[std::size_t(k)] = tau;
    for (int i = k + 1; i < m_m; ++i) c[i] /= head;
    c[k] = beta;
    for (int j = k + 1; j < m_n; ++j) {
      double* d = m_a.data() + std::size_t(j) * m_m;
      double sum = d[k];
      for (int i = k + 1; i < m_m; ++i) sum += c[i] * d[i];
      sum *= tau;
      d[k] -= sum;
      for (int i = k + 1; i < m_m; ++i) d[i] -= sum * c[i];
    }
    m_rank = k + 1;
  }
  if (m_rank < m_n) reflect_rows();
  return m_rank;
}

/// [R11 R12] becomes [T 0] by reflections from the right, the last row's first. Row k's reflection is 1 - tau w w^T
/// with w = 1 at k, and what is kept in R12's row k.
void PivotedQr::reflect_rows() noexcept {
  const auto at = [this](int i, int j) -> double& { return m_a[std::size_t(j) * m_m + i]; };
  for (int k = m_rank - 1; k >= 0; --k) {
    double tail = 0;
    for (int j = m_rank; j < m_n; ++j) tail += at(k, j) * at(k, j);
    if (!(tail > 0)) {
      m_tau_z[std::size_t(k)] = 0;
      continue;
    }
    const double head = at(k, k), size = std::sqrt(head * head + tail), beta = head > 0 ? -size : size;
    const double first = head - beta, tau = -first / beta;
    m_tau_z[std::size_t(k)] = tau;
    at(k, k) = beta;
    for (int j = m_rank; j < m_n; ++j) at(k, j) /= first;
    for (int i = 0; i < k; ++i) {
      double sum = at(i, k);
      for (int j = m_rank; j < m_n; ++j) sum += at(i, j) * at(k, j);
      sum *= tau;
      at(i, k) -= sum;
      for (int j = m_rank; j < m_n; ++j) at(i, j) -= sum * at(k, j);
    }
  }
}

/// From the coordinates in which the matrix is [T 0], in m_x, to those of its columns.
void PivotedQr::turn_back(double* x) noexcept {
  if (m_rank < m_n) {
    for (int k = 0; k < m_rank; ++k) {
      const double tau = m_tau_z[std::size_t(k)];
      if (tau == 0) continue;
      double sum = m_x[std::size_t(k)];
      for (int j = m_rank; j < m_n; ++j) sum += m_a[std::size_t(j) * m_m + k] * m_x[std::size_t(j)];
      sum *= tau;
      m_x[std::size_t(k)] -= sum;
      for (int j = m_rank; j < m_n; ++j) m_x[std::size_t(j)] -= sum * m_a[std::size_t(j) * m_m + k];
    }
  }
  for (int j = 0; j < m_n; ++j) x[m_order[std::size_t(j)]] = m_x[std::size_t(j)];
}

void PivotedQr::solve(const double* b, double* x) noexcept {
  std::copy(b, b + m_m, m_b.begin());
  for (int k = 0; k < m_rank; ++k) {
    const double* c = m_a.data() + std::size_t(k) * m_m;
    double sum = m_b[std::size_t(k)];
    for (int i = k + 1; i < m_m; ++i) sum += c[i] * m_b[std::size_t(i)];
    sum *= m_tau[std::size_t(k)];
    m_b[std::size_t(k)] -= sum;
    for (int i = k + 1; i < m_m; ++i) m_b[std::size_t(i)] -= sum * c[i];
  }
  for (int k = m_rank - 1; k >= 0; --k) {
    double sum = m_b[std::size_t(k)];
    for (int j = k + 1; j < m_rank; ++j) sum -= m_a[std::size_t(j) * m_m + k] * m_x[std::size_t(j)];
    m_x[std::size_t(k)] = sum / m_a[std::size_t(k) * m_m + k];
  }
  for (int j = m_rank; j < m_n; ++j) m_x[std::size_t(j)] = 0;
  turn_back(x);
}

void PivotedQr::null_vector(int k, double* z) noexcept {
  for (int j = 0; j < m_n; ++j) m_x[std::size_t(j)] = j == m_rank + k ? 1 : 0;
  turn_back(z);
}

double determinant(int n, double* a) noexcept {
  const auto at = [a, n](int i, int j) -> double& { return a[std::size_t(j) * n + i]; };
  double product = 1;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(at(i, k)) > std::fabs(at(pivot, k))) pivot = i;
    if (at(pivot, k) == 0) return 0;
    if (pivot != k) {
      product = -product;
      for (int j = k; j < n; ++j) std::swap(at(k, j), at(pivot, j));
    }
    product *= at(k, k);
    for (int i = k + 1; i < n; ++i) {
      const double factor = at(i, k) / at(k, k);
      for (int j = k + 1; j < n; ++j) at(i, j) -= factor * at(k, j);
    }
  }
  return product;
}

}  // namespace trocar::numerics
