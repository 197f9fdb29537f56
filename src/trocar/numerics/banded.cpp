#include <algorithm>
#include <cstring>

#include <trocar/numerics/banded.hpp>

namespace trocar::numerics {
namespace {

constexpr int kChain = 8;  // half the bandwidth of a chain of nodes that bends:
                           // three nodes of three coordinates couple

/// Takes a column whose entries below the diagonal are `reach` many out of as
/// many columns after it, and scales it. Inlined with `reach` and `half` known,
/// this needs no loops.
inline void eliminate(double* __restrict column, int reach, int half) {
  const double scale = 1 / column[0];
  double* __restrict later = column + half + 1;
  for (int k = 1; k <= reach; ++k, later += half + 1) {
    const double l = scale * column[k];
    for (int i = k; i <= reach; ++i) later[i - k] -= l * column[i];
    column[k] = l;
  }
}

typedef double Two __attribute__((vector_size(16)));  // of two right hand sides, side by side

template <class T>
inline T load(const double* x) {
  T a;
  std::memcpy(&a, x, sizeof a);
  return a;
}
template <class T>
inline void store(double* x, T a) {
  std::memcpy(x, &a, sizeof a);
}

/// A right hand side, or two of several.
struct Rows {
  double* x;
  int stride;
  double* operator[](int row) const { return x + row * stride; }
};

/// x_{j+k} -= l_k x_j for the columns from `first` on.
template <class T>
void forward(int n, int half, const double* factor, Rows x, int first) {
  for (int j = first; j < n; ++j) {
    const double* const l = factor + band_at(half, j, j);
    const T y = load<T>(x[j]);
    for (int k = 1; k <= std::min(half, n - 1 - j); ++k) store(x[j + k], load<T>(x[j + k]) - l[k] * y);
  }
}

/// The same for a chain. The rows that a column reaches stay in registers:
/// nothing waits for what was just written.
template <class T>
void forward_chain(int n, const double* factor, Rows x, int first) {
  if (first + kChain < n) {
    T near[kChain];
    for (int k = 0; k < kChain; ++k) near[k] = load<T>(x[first + k]);
    for (; first + kChain < n; ++first) {
      const double* const l = factor + band_at(kChain, first, first);
      const T y = near[0];
      store(x[first], y);
      for (int k = 1; k < kChain; ++k) near[k - 1] = near[k] - l[k] * y;
      near[kChain - 1] = load<T>(x[first + kChain]) - l[kChain] * y;
    }
    for (int k = 0; k < kChain; ++k) store(x[first + k], near[k]);
  }
  forward<T>(n, kChain, factor, x, first);
}

/// x_j -= l_k x_{j+k} for the columns from n - 1 down to `last`, the nearest
/// row last: it was known last.
template <class T>
void backward(int n, int half, const double* factor, Rows x, int last) {
  for (int j = n - 1; j >= last; --j) {
    const double* const l = factor + band_at(half, j, j);
    T sum = load<T>(x[j]);
    for (int k = std::min(half, n - 1 - j); k >= 1; --k) sum -= l[k] * load<T>(x[j + k]);
    store(x[j], sum);
  }
}

template <class T>
void backward_chain(int n, const double* factor, Rows x) {
  int j = std::max(n - kChain, 0);
  backward<T>(n, kChain, factor, x, j);
  if (j == 0) return;
  T near[kChain];
  for (int k = 0; k < kChain; ++k) near[k] = load<T>(x[j + k]);
  for (--j; j >= 0; --j) {
    const double* const l = factor + band_at(kChain, j, j);
    T sum = load<T>(x[j]);
    for (int k = kChain; k >= 1; --k) sum -= l[k] * near[k - 1];
    for (int k = kChain - 1; k >= 1; --k) near[k] = near[k - 1];
    near[0] = sum;
    store(x[j], sum);
  }
}

/// Calls one(Rows) for single right hand sides and two(Rows) for pairs.
template <class One, class Pair>
void for_sides(double* x, int columns, One&& one, Pair&& two) {
  int c = 0;
  for (; c + 1 < columns; c += 2) two(Rows{x + c, columns});
  if (c < columns) one(Rows{x + c, columns});
}

}  // namespace

int band_factor(int n, int half, double* a) noexcept {
  for (int j = 0; j < n; ++j) {
    double* const column = a + band_at(half, j, j);
    if (!(column[0] > 0.0)) return j;
    if (half == kChain && j + kChain < n)
      eliminate(column, kChain, kChain);
    else
      eliminate(column, std::min(half, n - 1 - j), half);
  }
  return -1;
}

void band_forward(int n, int half, const double* factor, double* x, int columns, int first) noexcept {
  if (half == kChain)
    for_sides(
        x, columns, [=](Rows r) { forward_chain<double>(n, factor, r, first); },
        [=](Rows r) { forward_chain<Two>(n, factor, r, first); });
  else
    for_sides(
        x, columns, [=](Rows r) { forward<double>(n, half, factor, r, first); },
        [=](Rows r) { forward<Two>(n, half, factor, r, first); });
}

void band_solve(int n, int half, const double* factor, double* x, int columns) noexcept {
  band_forward(n, half, factor, x, columns);  // L y = b
  for (int i = 0; i < n; ++i)                 // D z = y
    for (int c = 0; c < columns; ++c) x[i * columns + c] /= factor[band_at(half, i, i)];
  if (half == kChain)  // L^T x = z
    for_sides(
        x, columns, [=](Rows r) { backward_chain<double>(n, factor, r); },
        [=](Rows r) { backward_chain<Two>(n, factor, r); });
  else
    for_sides(
        x, columns, [=](Rows r) { backward<double>(n, half, factor, r, 0); },
        [=](Rows r) { backward<Two>(n, half, factor, r, 0); });
}

}  // namespace trocar::numerics
