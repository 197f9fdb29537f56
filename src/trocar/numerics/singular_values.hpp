// Singular values of small dense matrices, by one-sided Jacobi rotations: columns are turned against each other until
// all are perpendicular; their lengths are the singular values, small ones as exact as large ones. In a fixed order.
// [Golub & Van Loan 2013, Matrix Computations, 8.6.3]
#pragma once

namespace trocar::numerics {

/// @param a       m x n, column by column; lost
/// @param values  (n) the singular values, falling; those beyond min(m, n) are 0 up to rounding
void singular_values(int m, int n, double* a, double* values) noexcept;

}  // namespace trocar::numerics
