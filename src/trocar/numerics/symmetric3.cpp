#include <algorithm>
#include <cmath>

#include <trocar/numerics/symmetric3.hpp>

namespace trocar::numerics {
namespace {

// Turns rows and columns p and q of a so that a[p][q] becomes 0, and the columns of v with them.
void rotate(Mat3d& a, Mat3d& v, int p, int q) noexcept {
  if (a.m[p][q] == 0.0) return;
  const double theta = (a.m[q][q] - a.m[p][p]) / (2.0 * a.m[p][q]);
  const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  for (int k = 0; k < 3; ++k) {
    const double x = a.m[k][p], y = a.m[k][q];
    a.m[k][p] = c * x - s * y, a.m[k][q] = s * x + c * y;
  }
  for (int k = 0; k < 3; ++k) {
    const double x = a.m[p][k], y = a.m[q][k];
    a.m[p][k] = c * x - s * y, a.m[q][k] = s * x + c * y;
    const double i = v.m[k][p], j = v.m[k][q];
    v.m[k][p] = c * i - s * j, v.m[k][q] = s * i + c * j;
  }
}

Vec3d with_positive_side(Vec3d a) noexcept {
  int largest = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(a[k]) > std::fabs(a[largest])) largest = k;
  return a[largest] < 0.0 ? -a : a;
}

}  // namespace

Principal principal(const Mat3d& given) noexcept {
  Mat3d a = given, v = Mat3d::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) a.m[i][j] = a.m[j][i];
  for (int sweep = 0; sweep < 12; ++sweep) {
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  int order[3] = {0, 1, 2};
  std::stable_sort(order, order + 3, [&a](int i, int j) { return a.m[i][i] > a.m[j][j]; });
  Principal result;
  for (int k = 0; k < 3; ++k) {
    result.value[k] = a.m[order[k]][order[k]];
    result.axis[k] = with_positive_side(v.column(order[k]));
  }
  result.axis[2] = cross(result.axis[0], result.axis[1]);
  return result;
}

}  // namespace trocar::numerics
