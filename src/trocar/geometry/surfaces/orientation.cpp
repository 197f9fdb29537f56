#include <array>
#include <cmath>

#include <trocar/geometry/surfaces/orientation.hpp>

namespace trocar::geometry {
namespace {

constexpr double kRounding = 0x1p-53;

/// A number as the sum of two doubles: what rounding gave, and what it lost.
struct TwoPart {
  double high = 0, low = 0;
};

TwoPart exact_sum(double a, double b) {
  const double high = a + b, from_b = high - a, from_a = high - from_b;
  return {high, (a - from_a) + (b - from_b)};
}
TwoPart exact_difference(double a, double b) { return exact_sum(a, -b); }

/// The upper and the lower half of the digits. [Dekker 1971]
TwoPart halves(double a) {
  const double scaled = 134217729.0 * a, high = scaled - (scaled - a);  // 2^27 + 1
  return {high, a - high};
}
TwoPart exact_product(double a, double b) {
  const double high = a * b;
  const TwoPart p = halves(a), q = halves(b);
  return {high, p.low * q.low - (((high - p.high * q.high) - p.low * q.high) - p.high * q.low)};
}

/// A sum of doubles that do not overlap, the smallest first; its sign is that of the last. [Shewchuk 1997, fig. 6]
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < m_count; ++i) {
      const TwoPart sum = exact_sum(value, m_parts[i]);
      value = sum.high;
      if (sum.low != 0) m_parts[kept++] = sum.low;
    }
    if (value != 0) m_parts[kept++] = value;
    m_count = kept;
  }
  void add(TwoPart value) { add(value.low), add(value.high); }
  /// a b c
  void add_product(double a, double b, double c) {
    if (a == 0 || b == 0 || c == 0) return;
    const TwoPart ab = exact_product(a, b);
    add(exact_product(ab.low, c)), add(exact_product(ab.high, c));
  }
  void add_product(TwoPart a, TwoPart b, TwoPart c) {
    for (const double x : {a.low, a.high})
      for (const double y : {b.low, b.high})
        for (const double z : {c.low, c.high}) add_product(x, y, z);
  }
  int sign() const { return m_count == 0 ? 0 : (m_parts[m_count - 1] > 0 ? 1 : -1); }

 private:
  std::array<double, 200> m_parts{};  // 6 products of 2 x 2 x 2 parts give four each: 192
  int m_count = 0;
};

using ExactVector = std::array<TwoPart, 3>;

ExactVector exact_way(Vec3d from, Vec3d to) {
  return {exact_difference(to.x, from.x), exact_difference(to.y, from.y), exact_difference(to.z, from.z)};
}
TwoPart negative(TwoPart a) { return {-a.high, -a.low}; }

int exact_side_of_plane(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const ExactVector u = exact_way(a, b), v = exact_way(a, c), w = exact_way(a, d);
  ExactSum sum;
  for (int k = 0; k < 3; ++k) {
    const std::size_t x = std::size_t(k), y = (x + 1) % 3, z = (x + 2) % 3;
    sum.add_product(u[x], v[y], w[z]);
    sum.add_product(negative(u[x]), v[z], w[y]);
  }
  return sum.sign();
}

}  // namespace

int side_of_plane(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d u = b - a, v = c - a, w = d - a;
  const double xy = u.x * v.y, yx = u.y * v.x, yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z;
  const double value = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double size = (std::fabs(yz) + std::fabs(zy)) * std::fabs(w.x) +
                      (std::fabs(zx) + std::fabs(xz)) * std::fabs(w.y) +
                      (std::fabs(xy) + std::fabs(yx)) * std::fabs(w.z);
  const double doubt = (7.0 + 56.0 * kRounding) * kRounding * size;  // [Shewchuk 1997, o3derrboundA]
  if (value > doubt) return 1;
  if (value < -doubt) return -1;
  return size == 0 ? 0 : exact_side_of_plane(a, b, c, d);
}

int side_of_line(Vec3d a, Vec3d b, Vec3d c, int first_axis, int second_axis) {
  const double ux = b[first_axis] - a[first_axis], uy = b[second_axis] - a[second_axis];
  const double vx = c[first_axis] - a[first_axis], vy = c[second_axis] - a[second_axis];
  const double left = ux * vy, right = uy * vx, value = left - right;
  const double doubt = (3.0 + 16.0 * kRounding) * kRounding * (std::fabs(left) + std::fabs(right));  // [ccwerrboundA]
  if (value > doubt) return 1;
  if (value < -doubt) return -1;
  if (left == 0 && right == 0) return 0;
  const ExactVector u = exact_way(a, b), v = exact_way(a, c);
  const TwoPart one{1, 0};
  ExactSum sum;
  sum.add_product(u[std::size_t(first_axis)], v[std::size_t(second_axis)], one);
  sum.add_product(negative(u[std::size_t(second_axis)]), v[std::size_t(first_axis)], one);
  return sum.sign();
}

}  // namespace trocar::geometry
