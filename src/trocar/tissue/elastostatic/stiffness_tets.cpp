// Linear tetrahedra: one gradient of displacement a cell, and the stress that it makes.
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/tissue/elastostatic/stiffness.hpp>
#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::tissue {
namespace {

struct TetShape {
  Vec3d gradient[4];  ///< of the corners' shape functions [1/m]
  double volume;      ///< [m^3]
};

TetShape shape_of(Vec3d a, Vec3d b, Vec3d c) {
  const double six = dot(a, cross(b, c));
  const Vec3d p = cross(b, c) / six, q = cross(c, a) / six, r = cross(a, b) / six;
  return {{-(p + q + r), p, q, r}, six / 6};
}

/// The force on one corner by the displacement of another, over the volume: of Lame's moduli lambda and mu, and of what
/// `extra` [Pa] resists along the unit vector `fibre` alone.
struct TetMedium {
  double lambda, mu, extra;
  Vec3d fibre;
  Mat3d between(Vec3d own, Vec3d other) const {
    const Mat3d isotropic = outer(lambda * own, other) + mu * (outer(other, own) + dot(own, other) * Mat3d::identity());
    return isotropic + outer((extra * dot(own, fibre) * dot(other, fibre)) * fibre, fibre);
  }
};

}  // namespace

void StiffnessBuilder::add_tetrahedra(std::span<const std::array<int, 4>> cells, double young, double poisson,
                                      Vec3d fibre, double fibre_ratio) {
  if (!(poisson >= 0 && poisson <= kMostPoisson)) throw std::invalid_argument("Poisson's ratio: 0 to 0.45");
  const TetMedium medium{young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson)),
                         (fibre_ratio - 1) * young, fibre};
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto x = [&](int i) { return m_points.at(std::size_t(cells[c][std::size_t(i)])); };
    const TetShape shape = shape_of(x(1) - x(0), x(2) - x(0), x(3) - x(0));
    if (!(shape.volume > 0)) throw std::invalid_argument("cell " + std::to_string(c) + " has no volume");
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        add(cells[c][i], cells[c][j], shape.volume * medium.between(shape.gradient[i], shape.gradient[j]));
  }
}

}  // namespace trocar::tissue
