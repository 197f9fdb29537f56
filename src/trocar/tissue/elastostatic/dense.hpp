// Elimination in dense symmetric matrices, and their inversion in place. What is kept of them is the lower triangle.
//
// Columns that are eliminated stand packed, eight rows beside each other (dense_kernels.hpp), what remains as usual, by
// columns. All sizes are multiples of eight; what fills up is ones on the diagonal where it is eliminated, else zeros.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>

#include <trocar/core/parallel.hpp>

namespace trocar::tissue {

inline constexpr double kLeastPivot = 1e-11;  ///< share of its original diagonal that a pivot must have left
inline constexpr int kBlock = 192;            ///< columns that are eliminated at once: part of what the bits are

/// Numbers that begin where a cache line does. They come as zeros from the system, in huge pages where it has them:
/// clearing and faulting in pages would be half of all time.
class AlignedNumbers {
 public:
  /// n zeros. @throws std::bad_alloc
  void assign(std::size_t n);
  void free() noexcept { m_store.reset(); }
  double* data() const noexcept;

 private:
  struct Free {
    void operator()(double* p) const noexcept { std::free(p); }
  };
  std::unique_ptr<double[], Free> m_store;
};

/// Lets pages of memory that is not touched yet be huge, if it is large.
void ask_for_huge_pages(void* begin, std::size_t bytes) noexcept;

/// Packed rows: element (i, k) at [(i / 8) step + 8 k + i % 8].
struct PackedRows {
  double* at;
  std::ptrdiff_t step;
  double* pack(int p) const noexcept { return at + p * step; }
  double& operator()(int i, int k) const noexcept { return pack(i / 8)[8 * k + i % 8]; }
};

/// A lower triangle, by columns.
struct LowerMatrix {
  double* at;
  std::ptrdiff_t height;
  double& operator()(int i, int j) const noexcept { return at[i + j * height]; }
};

/// Eliminates `pivots` unknowns: rest -= X X^T, with X = A_21 L^-T.
/// @param x         (rows x pivots) A_11 (its lower triangle) and A_21; X when it is done
/// @param rest      (rows - pivots)^2
/// @param original  (pivots) diagonal that pivots are held against, 0: none
/// @return the first pivot that is not positive, or -1
int eliminate(PackedRows x, int rows, int pivots, const double* original, LowerMatrix rest, core::ThreadPool* pool);

/// The first n unknowns of `a` become -A^-1, the rows below them A_21 A^-1, by symmetric sweeps of whole blocks.
/// @param rows  n and those below, multiples of eight
/// @param said  receives how many of the n are done
/// @return the first pivot that is not positive, or -1
int invert_in_place(LowerMatrix a, int n, int rows, const double* original, core::ThreadPool* pool,
                    const std::function<void(int)>& said);

}  // namespace trocar::tissue
