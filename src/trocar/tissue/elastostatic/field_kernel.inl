// Compiled once per instruction set: see field_kernels.hpp.
#include <cmath>

#include <trocar/tissue/elastostatic/field_kernels.hpp>

namespace trocar::tissue {
namespace {

constexpr int kTogether = 6;  // columns that are read at once: streams that a core can look ahead in

/// Each element's sum goes on where it stood, a column at a time: how many are taken at once changes no bit.
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

bool factorise(int n, int stride, double* a, double* turned) {
  for (int k = 0; k < n; ++k) {
    double* const own = a + k * stride;
    if (!(own[k] > 0)) return false;
    const double root = std::sqrt(own[k]), inverse = 1 / root;
    for (int i = k; i < n; ++i) own[i] *= inverse;
    own[k] = root;
    for (int i = k; i < n; ++i) turned[i * stride + k] = own[i];
    for (int j = k + 1; j < n; ++j) {
      double* __restrict const other = a + j * stride;
      const double f = own[j];
      for (int i = j; i < n; ++i) other[i] -= f * own[i];
    }
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
