// The loops in which the elastostatic solver spends its time, compiled once per instruction set and chosen at run time.
// Every element is a sum of its own, made in one order, so that every width gives the same bits.
#pragma once

namespace trocar::tissue {

struct FieldKernels {
  const char* name;
  /// sum += factor[0] column[0] + factor[1] column[1] + ..., in this order for each of `rows` elements. Rows come in
  /// whole packs of kFieldPack.
  void (*add_columns)(int rows, int columns, const float* const* column, const float* factor, float* sum);
  /// A = L L^T in place, lower triangle by columns; `turned` gets L^T by columns as well. False at a pivot that is not
  /// positive. @param a, turned  (n x stride)
  bool (*factorise)(int n, int stride, double* a, double* turned);
  /// L L^T x = b, in place.
  void (*substitute)(int n, int stride, const double* l, const double* turned, double* x);
};

inline constexpr int kFieldPack = 16;  ///< floats

const FieldKernels* field_kernels_plain() noexcept;
const FieldKernels* field_kernels_avx2() noexcept;    ///< null where not compiled
const FieldKernels* field_kernels_avx512() noexcept;  ///< null where not compiled

/// The widest that this machine runs; TROCAR_SIMD names another.
const FieldKernels& field_kernels() noexcept;
/// For tests: false where this machine cannot.
bool use_field_kernels(const FieldKernels* kernels) noexcept;

}  // namespace trocar::tissue
