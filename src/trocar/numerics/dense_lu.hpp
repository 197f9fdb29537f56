// Small dense systems without symmetry, by elimination with row pivoting: factored once, solved for many right hand
// sides, in a fixed order.
//
//   const DenseLu lu(n, a);                        // a: n x n, row by row
//   if (!lu.singular()) lu.solve(x.data(), 3);     // x: n rows of 3 numbers, right hand sides side by side
//
// Cost: n^3 / 3 multiplications to factor, n^2 a right hand side. [Golub & Van Loan 2013, Matrix Computations, 3.4.3]
#pragma once

#include <vector>

namespace trocar::numerics {

class DenseLu {
 public:
  DenseLu(int n, std::vector<double> a);

  /// A pivot is 0, or rounding against the largest of its column as given; nothing may be solved then.
  bool singular() const noexcept { return m_singular; }
  int size() const noexcept { return m_n; }
  /// x becomes the solution of A x = b, given b in x: n rows of `columns` numbers.
  void solve(double* x, int columns = 1) const;

 private:
  int m_n;
  bool m_singular = false;
  std::vector<double> m_a;
  std::vector<int> m_order;  ///< which row of A stands in row i
};

}  // namespace trocar::numerics
