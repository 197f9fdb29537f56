// The loops that dense elimination spends its time in, compiled once per instruction set and chosen at run time.
//
// Rows stand in packs of eight: element (row, k) of a pack is at [8 k + row], so that one load has the same column of
// eight rows. Every element's sum is made in the order of k, a product and a difference at a time, and a lane is an
// element: every width gives the same bits.
#pragma once

#include <cstddef>

namespace trocar::tissue {

inline constexpr int kPack = 8;   ///< rows in a pack
inline constexpr int kGroup = 3;  ///< packs that are worked on at once

/// Where up to three packs of rows stand: pack p, row i, column j at [p * pack + j * column + i].
struct DenseTile {
  double* at;
  std::ptrdiff_t pack, column;
};

struct DenseKernels {
  const char* name;
  /// c(i, j) -= a(i, k) b(j, k), k = 0, 1, .. count - 1 one after another; eight columns j.
  /// @param packs   1 to kGroup, of a (`pack` numbers apart) and c  @param b  one pack of eight rows j
  void (*subtract)(int packs, int count, const double* a, std::ptrdiff_t pack, const double* b, const DenseTile& c);
  /// x L^T = c in place, of eight columns. @param l  (8 x 8) lower, by columns, the diagonal as its inverse
  void (*solve_forward)(int packs, const double* l, const DenseTile& c);
  /// x L = c in place, from the last column to the first.
  void (*solve_backward)(int packs, const double* l, const DenseTile& c);
};

const DenseKernels* dense_kernels_plain() noexcept;
const DenseKernels* dense_kernels_avx2() noexcept;    ///< null where it was not compiled
const DenseKernels* dense_kernels_avx512() noexcept;  ///< the same

/// The widest that this machine runs, or what the environment variable TROCAR_SIMD names (avx512, avx2, others: plain).
const DenseKernels& dense_kernels() noexcept;
/// For tests. @return false if this machine cannot
bool use_dense_kernels(const DenseKernels* kernels) noexcept;

}  // namespace trocar::tissue
