#include <algorithm>

#include <trocar/numerics/banded.hpp>

namespace trocar::numerics {
namespace {

/// Takes a column whose entries below the diagonal are `reach` many out of as many columns after it, and scales it.
/// Inlined with `reach` and `half` known, this needs no loops.
inline void eliminate(double* __restrict column, int reach, int half) {
  const double scale = 1 / column[0];
  double* __restrict later = column + half + 1;
  for (int k = 1; k <= reach; ++k, later += half + 1) {
    const double l = scale * column[k];
    for (int i = k; i <= reach; ++i) later[i - k] -= l * column[i];
    column[k] = l;
  }
}

/// x_{j+k} -= l_k x_j
inline void forward(const double* __restrict column, int reach, double* __restrict x, int columns) {
  for (int k = 1; k <= reach; ++k)
    for (int c = 0; c < columns; ++c) x[k * columns + c] -= column[k] * x[c];
}

/// x_j -= l_k x_{j+k}, the nearest last: it was known last.
inline void backward(const double* __restrict column, int reach, double* __restrict x, int columns) {
  for (int k = reach; k >= 1; --k)
    for (int c = 0; c < columns; ++c) x[c] -= column[k] * x[k * columns + c];
}

constexpr int kChain = 8;  // half the bandwidth of a chain of nodes that bends: three nodes of three coordinates couple

/// Calls body(j, reach) for column j, with `reach` known to the compiler where it is that of a chain.
template <class Body>
inline void with_reach(int n, int half, int j, Body&& body) {
  if (half == kChain && j + kChain < n)
    body(kChain, kChain);
  else
    body(std::min(half, n - 1 - j), half);
}

}  // namespace

int band_factor(int n, int half, double* a) noexcept {
  for (int j = 0; j < n; ++j) {
    double* const column = a + band_at(half, j, j);
    if (!(column[0] > 0.0)) return j;
    with_reach(n, half, j, [column](int reach, int wide) { eliminate(column, reach, wide); });
  }
  return -1;
}

void band_forward(int n, int half, const double* factor, double* x, int columns, int first) noexcept {
  for (int j = first; j < n; ++j) {
    const double* const column = factor + band_at(half, j, j);
    with_reach(n, half, j, [=](int reach, int) {
      if (columns == 1)
        forward(column, reach, x + j, 1);
      else if (columns == 3)
        forward(column, reach, x + j * 3, 3);
      else
        forward(column, reach, x + j * columns, columns);
    });
  }
}

void band_solve(int n, int half, const double* factor, double* x, int columns) noexcept {
  band_forward(n, half, factor, x, columns);  // L y = b
  for (int i = 0; i < n; ++i)                 // D z = y
    for (int c = 0; c < columns; ++c) x[i * columns + c] /= factor[band_at(half, i, i)];
  for (int j = n - 1; j >= 0; --j) {  // L^T x = z
    const double* const column = factor + band_at(half, j, j);
    with_reach(n, half, j, [=](int reach, int) {
      if (columns == 1)
        backward(column, reach, x + j, 1);
      else
        backward(column, reach, x + j * columns, columns);
    });
  }
}

}  // namespace trocar::numerics
