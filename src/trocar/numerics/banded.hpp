// Symmetric positive definite systems whose matrix has entries only near the diagonal, as chains of nodes have:
// factored as L D L^T and solved on the caller's memory, in a fixed order, without allocation (made for the step).
//
//   std::vector<double> a(band_size(n, 2));                   // pentadiagonal: half bandwidth 2
//   a[band_at(2, i, i)] = 6, a[band_at(2, i, i - 1)] = -4, ...  // the lower half only
//   if (band_factor(n, 2, a.data()) < 0) band_solve(n, 2, a.data(), x.data());
//
// Cost: n half^2 multiplications to factor, 2 n half to solve a right hand side.
// [Golub & Van Loan 2013, Matrix Computations, section 4.3.5-6]
#pragma once

#include <cstddef>

namespace trocar::numerics {

/// Doubles that n rows take. Column j holds the entries (j, j) .. (j + half, j); those below row n - 1 are never read.
constexpr std::size_t band_size(int n, int half) { return std::size_t(n) * std::size_t(half + 1); }
/// Where the entry (row, column) lies, row - half <= column <= row. Columns lie whole, because that is how factoring
/// and solving go through them: whole columns at a time, in registers as wide as there are.
constexpr std::size_t band_at(int half, int row, int column) {
  return std::size_t(column) * std::size_t(half + 1) + std::size_t(row - column);
}

/// Replaces the lower half of A by L (unit diagonal, not stored) and D (in the diagonal's place).
/// @return -1 when done, else the first row whose pivot is not > 0 (the matrix is not positive definite there, or
///         not a number); the rows before it are factored, the rest is garbage.
int band_factor(int n, int half, double* a) noexcept;

/// x becomes the solution of A x = b, given b in x and the factor from above. x is n rows of `columns` numbers
/// (right hand sides side by side, as the three coordinates of a node are).
void band_solve(int n, int half, const double* factor, double* x, int columns = 1) noexcept;

/// The first half of that: x becomes y of L y = b. The rows before `first` are zero and not looked at. With all y
/// known, b^T A^-1 b is the sum of y_i^2 / d_i, which takes no second half.
void band_forward(int n, int half, const double* factor, double* x, int columns = 1, int first = 0) noexcept;

}  // namespace trocar::numerics
