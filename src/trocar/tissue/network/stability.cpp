#include <cmath>
#include <limits>

#include <trocar/tissue/network/stability.hpp>

namespace trocar::tissue {

bool stable_as_printed(double mass, double k, double d, double dt) noexcept {
  return d > dt * k / 2 - mass / dt;  // [KCM99 eq.4] (4a)
}

double dt_limit_as_printed(double mass, double k, double d) noexcept {
  return (d + std::sqrt(d * d + 2 * mass * k)) / k;  // [KCM99 eq.4] (4b)
}

double dt_limit_explicit_damping(double mass, double k, double d) noexcept {
  return (-d + std::sqrt(d * d + 4 * mass * k)) / k;
}

double dt_limit_implicit_damping(double mass, double k, double d) noexcept {
  return (d + std::sqrt(d * d + 4 * mass * k)) / k;
}

double dt_limit_node(double mass, double k_max, double d_max) noexcept {
  // Positive root of dt^2 k + 2 dt d - 2 m = 0, in the form that does not cancel.
  const double divisor = d_max + std::sqrt(d_max * d_max + 2 * mass * k_max);
  return divisor > 0 ? 2 * mass / divisor : std::numeric_limits<double>::infinity();
}

double largest_eigenvalue(double xx, double yy, double zz, double xy, double xz, double yz) noexcept {
  double a[3][3] = {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int i = 0; i < 3; ++i) {
          const double ip = a[i][p], iq = a[i][q];
          a[i][p] = c * ip - s * iq, a[i][q] = s * ip + c * iq;
        }
        for (int i = 0; i < 3; ++i) {
          const double pi = a[p][i], qi = a[q][i];
          a[p][i] = c * pi - s * qi, a[q][i] = s * pi + c * qi;
        }
      }
    }
  }
  const double m = a[0][0] > a[1][1] ? a[0][0] : a[1][1];
  return m > a[2][2] ? m : a[2][2];
}

int substeps_for(double tick, double limit, double safety) noexcept {
  const double count = tick / (safety * limit);
  if (!(count > 1)) return 1;
  if (count > 1e6) return 1000000;
  const int n = int(count);
  return double(n) >= count ? n : n + 1;
}

}  // namespace trocar::tissue
