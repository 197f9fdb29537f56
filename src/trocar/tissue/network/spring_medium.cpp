#include <cmath>
#include <stdexcept>

#include <trocar/tissue/network/spring_medium.hpp>

namespace trocar::tissue {
namespace {

/// Moduli along and across the fibres for S = 1.
struct Moduli {
  double along, across;
};

Moduli moduli(double a) {
  // Components with the fibres along 3, from the sphere's moments of fourth and sixth order.
  const double c11 = 1.0 / 5 + a / 35, c12 = 1.0 / 15 + a / 105, c13 = 1.0 / 15 + a / 35, c33 = 1.0 / 5 + a / 7;
  const double pair = c33 * (c11 + c12) - 2 * c13 * c13;
  return {pair / (c11 + c12), (c11 - c12) * pair / (c11 * c33 - c13 * c13)};
}

/// The a at which the moduli have this ratio, which grows with a.
double fibre_term(double ratio) {
  double low = -0.95, high = 200;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    const Moduli m = moduli(middle);
    (m.along < ratio * m.across ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

SpringMedium spring_medium(double across, Vec3d fibre, double ratio) {
  if (!(across > 0)) throw std::invalid_argument("spring medium: expected a modulus > 0");
  if (!(ratio >= 0.5 && ratio <= kMostFibreRatio))
    throw std::invalid_argument("spring medium: expected a fibre ratio of 0.5 to 4");
  SpringMedium m;
  const double size = length(fibre);
  if (size > 0 && ratio != 1) {
    m.f = fibre / size;
    m.a = fibre_term(ratio);
  }
  m.s = across / moduli(m.a).across;
  return m;
}

Symmetric stress(const SpringMedium& m, const Symmetric& e) noexcept {
  const Vec3d ef = e * m.f, f = m.f;
  const double tr = e.trace(), fef = dot(f, ef), plain = m.s * (1.0 / 15 + m.a / 105), fibre = 2 * m.s * m.a / 105;
  const auto component = [&](double strain, double delta, double fi, double fj, double ei, double ej) {
    return plain * (tr * delta + 2 * strain) + fibre * (fi * fj * tr + fef * delta + 2 * (fi * ej + fj * ei));
  };
  return {component(e.xx, 1, f.x, f.x, ef.x, ef.x), component(e.yy, 1, f.y, f.y, ef.y, ef.y),
          component(e.zz, 1, f.z, f.z, ef.z, ef.z), component(e.yz, 0, f.y, f.z, ef.y, ef.z),
          component(e.xz, 0, f.x, f.z, ef.x, ef.z), component(e.xy, 0, f.x, f.y, ef.x, ef.y)};
}

double youngs_modulus(const SpringMedium& m, Vec3d n) {
  // Tension along n: the six strains that make every other stress vanish, by elimination.
  double k[6][7] = {};
  for (int j = 0; j < 6; ++j) {
    double unit[6] = {};
    unit[j] = 1;
    const Symmetric s = stress(m, {unit[0], unit[1], unit[2], unit[3], unit[4], unit[5]});
    const double column[6] = {s.xx, s.yy, s.zz, s.yz, s.xz, s.xy};
    for (int i = 0; i < 6; ++i) k[i][j] = column[i];
  }
  const double pull[6] = {n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.x * n.z, n.x * n.y};
  for (int i = 0; i < 6; ++i) k[i][6] = pull[i];
  for (int p = 0; p < 6; ++p) {
    int best = p;
    for (int i = p + 1; i < 6; ++i)
      if (std::fabs(k[i][p]) > std::fabs(k[best][p])) best = i;
    for (int j = 0; j < 7; ++j) std::swap(k[p][j], k[best][j]);
    for (int i = 0; i < 6; ++i) {
      if (i == p) continue;
      const double factor = k[i][p] / k[p][p];
      for (int j = p; j < 7; ++j) k[i][j] -= factor * k[p][j];
    }
  }
  double strain = 0;  // along n
  for (int i = 0; i < 6; ++i) strain += (i < 3 ? 1 : 2) * pull[i] * k[i][6] / k[i][i];
  return 1 / strain;
}

}  // namespace trocar::tissue
