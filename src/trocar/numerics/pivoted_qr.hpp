// Small dense systems of any shape and rank, by Householder reflections with column pivoting: rank, shortest
// least-squares solution, null space. In a fixed order, without allocation once made. The unknowns of a linkage are
// few, and its conditions may depend on each other or contradict: neither is an error here.
//
//   PivotedQr qr(most_rows, most_columns);
//   double* a = qr.matrix(m, n);                  // element (i, j) is a[j * m + i], to be filled in
//   const int rank = qr.factor(1e-9);             // pivots below 1e-9 of the first count as none
//   qr.solve(b, x);                               // shortest x of all that minimise |A x - b|
//   for (int k = 0; k < n - rank; ++k) qr.null_vector(k, z);  // orthonormal: A z is none
//
// Cost: about 2 n^2 (m - n/3) multiplications. [Golub & Van Loan 2013, Matrix Computations, 5.4.2 and 5.4.7]
#pragma once

#include <cstddef>
#include <vector>

namespace trocar::numerics {

class PivotedQr {
 public:
  /// Room for matrices of up to so many rows and columns.
  PivotedQr(int most_rows, int most_columns);

  /// The matrix to be factored, m x n, column by column; what stands there is not cleared.
  double* matrix(int m, int n) noexcept;
  /// Factors what stands in matrix().
  /// @param relative  pivots at most this times the first one are none
  /// @param absolute  nor are pivots at most this
  /// @return the rank
  int factor(double relative, double absolute = 0) noexcept;

  int rank() const noexcept { return m_rank; }
  /// Size of the k-th pivot, k < min(m, n), falling; those beyond the rank are as large as what is left of the matrix.
  double pivot(int k) const noexcept { return m_pivot[std::size_t(k)]; }
  /// The column of A that stands at place k after pivoting.
  int column(int k) const noexcept { return m_order[std::size_t(k)]; }
  /// The shortest of all least-squares solutions. @param b (m), left as it is @param x (n)
  void solve(const double* b, double* x) noexcept;
  /// The k-th of n - rank orthonormal vectors that span the null space. @param z (n)
  void null_vector(int k, double* z) noexcept;

 private:
  void reflect_rows() noexcept;
  void turn_back(double* x) noexcept;

  int m_m = 0, m_n = 0, m_rank = 0;
  std::vector<double> m_a;             ///< R above the diagonal, reflections below and right of it
  std::vector<double> m_tau, m_tau_z;  ///< of reflections from the left (rank), from the right (rank)
  std::vector<double> m_pivot, m_b, m_x;
  std::vector<int> m_order;
};

/// Determinant of an n x n matrix, column by column, by elimination with row pivoting; what stands in `a` is lost.
double determinant(int n, double* a) noexcept;

}  // namespace trocar::numerics
