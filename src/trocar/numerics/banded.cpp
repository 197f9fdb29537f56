#include <algorithm>

#include <trocar/numerics/banded.hpp>

namespace trocar::numerics {

int band_factor(int n, int half, double* a) noexcept {
  for (int i = 0; i < n; ++i) {
    const int first = std::max(0, i - half);
    double* const row = a + band_at(half, i, first);  // row[j - first] is the entry (i, j)
    for (int j = first; j < i; ++j) {
      const int common = std::max(first, j - half);
      const double* const mine = row + (common - first);
      const double* const other = a + band_at(half, j, common);  // entries (j, common) .. of a finished row
      double sum = row[j - first];
      for (int k = 0; k < j - common; ++k) sum -= mine[k] * other[k];
      row[j - first] = sum;  // l_ij d_j
    }
    double pivot = row[i - first];
    for (int j = first; j < i; ++j) {
      const double scaled = row[j - first];
      row[j - first] = scaled / a[band_at(half, j, j)];
      pivot -= scaled * row[j - first];
    }
    row[i - first] = pivot;
    if (!(pivot > 0.0)) return i;
  }
  return -1;
}

void band_solve(int n, int half, const double* factor, double* x, int columns) noexcept {
  for (int i = 0; i < n; ++i)  // L y = b
    for (int j = std::max(0, i - half); j < i; ++j) {
      const double l = factor[band_at(half, i, j)];
      for (int c = 0; c < columns; ++c) x[i * columns + c] -= l * x[j * columns + c];
    }
  for (int i = 0; i < n; ++i)  // D z = y
    for (int c = 0; c < columns; ++c) x[i * columns + c] /= factor[band_at(half, i, i)];
  for (int i = n - 1; i >= 0; --i)  // L^T x = z
    for (int j = std::min(n - 1, i + half); j > i; --j) {
      const double l = factor[band_at(half, j, i)];
      for (int c = 0; c < columns; ++c) x[i * columns + c] -= l * x[j * columns + c];
    }
}

}  // namespace trocar::numerics
