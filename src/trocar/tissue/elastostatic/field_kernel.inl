// Compiled once per instruction set: see field_kernels.hpp.
#include <cmath>

#include <trocar/tissue/elastostatic/field_kernels.hpp>

namespace trocar::tissue {
namespace {

constexpr int kTogether = 6;  // columns that are read at once: streams that a core can look ahead in

/// Each element's sum continues where it stood, a column at a time: how many are taken at once changes no bit.
template <int N>
void add_some(int rows, const float* const* column, const float* factor, float* __restrict sum) {
  const float* c[N];
  float f[N];
  for (int j = 0; j < N; ++j) c[j] = column[j], f[j] = factor[j];
  for (int i = 0; i < rows; ++i) {
    float s = sum[i];
    for (int j = 0; j < N; ++j) s = s + f[j] * c[j][i];
    sum[i] = s;
  }
}

void add_columns(int rows, int columns, const float* const* column, const float* factor, float* sum) {
  int j = 0;
  for (; j + kTogether <= columns; j += kTogether) add_some<kTogether>(rows, column + j, factor + j, sum);
  for (; j < columns; ++j) add_some<1>(rows, column + j, factor + j, sum);
}

constexpr int kPanel = 4;  // columns of the factor that are taken off the others in one pass

/// Takes columns k .. k + N of the factor off column j, from row j on, one after the other as it would be one by one.
template <int N>
void take_off(int n, int stride, double* a, int k, int j) {
  double* __restrict const other = a + j * stride;
  const double* own[N];
  double f[N];
  for (int p = 0; p < N; ++p) own[p] = a + (k + p) * stride, f[p] = own[p][j];
  for (int i = j; i < n; ++i) {
    double x = other[i];
    for (int p = 0; p < N; ++p) x = x - f[p] * own[p][i];
    other[i] = x;
  }
}

bool factorise(int n, int stride, double* a, double* turned) {
  for (int first = 0; first < n; first += kPanel) {
    const int last = first + kPanel < n ? first + kPanel : n;
    for (int k = first; k < last; ++k) {
      double* const own = a + k * stride;
      if (!(own[k] > 0)) return false;
      const double root = std::sqrt(own[k]), inverse = 1 / root;
      for (int i = k; i < n; ++i) own[i] *= inverse;
      own[k] = root;
      for (int i = k; i < n; ++i) turned[i * stride + k] = own[i];
      for (int j = k + 1; j < last; ++j) take_off<1>(n, stride, a, k, j);
    }
    for (int j = last; j < n; ++j) take_off<kPanel>(n, stride, a, first, j);
  }
  return true;
}

void substitute(int n, int stride, const double* l, const double* turned, double* x) {
  double* __restrict const v = x;
  for (int k = 0; k < n; ++k) {
    const double* const own = l + k * stride;
    const double f = v[k] / own[k];
    v[k] = f;
    for (int i = k + 1; i < n; ++i) v[i] -= f * own[i];
  }
  for (int k = n - 1; k >= 0; --k) {
    const double* const own = turned + k * stride;
    const double f = v[k] / own[k];
    v[k] = f;
    for (int i = 0; i < k; ++i) v[i] -= f * own[i];
  }
}

}  // namespace

const FieldKernels* TROCAR_FIELD_KERNELS() noexcept {
  static constexpr FieldKernels kernels{TROCAR_FIELD_NAME, add_columns, factorise, substitute};
  return &kernels;
}

}  // namespace trocar::tissue
