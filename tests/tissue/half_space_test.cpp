// An elastic body so large that its far end does not matter: a point force [Boussinesq 1885], a rigid flat punch
// [Sneddon 65] and a rigid sphere [Hertz 1882] on its surface. A quarter is computed, the rest is symmetry; the far
// faces move as the half-space would under the theory's total force.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <trocar/tissue/lattice_springs.hpp>

#include "linear_solve.hpp"

namespace trocar::tissue {
namespace {

constexpr double kE = 10e3, kNu = 0.25, kPi = 3.14159265358979323846;
constexpr double kContactModulus = kE / (1 - kNu * kNu);

/// n^3 cells; z = 0 is the surface, the tissue is below, x = 0 and y = 0 are planes of symmetry.
struct HalfSpace {
  int n;
  double h;
  BoxLattice box;
  NetworkDescription d;
  std::vector<std::uint8_t> fixed;
  std::vector<Vec3d> load, given;

  HalfSpace(int cells, double spacing)
      : n(cells), h(spacing), box(box_lattice(cells, cells, cells, spacing, {0, 0, -cells * spacing})) {
    d = lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = 1000}).network;
    fixed.assign(d.positions.size(), kFree);
    load.assign(d.positions.size(), {});
    given.assign(d.positions.size(), {});
    for (size_t i = 0; i < fixed.size(); ++i) {
      if (d.positions[i].x == 0) fixed[i] |= kHeldX;
      if (d.positions[i].y == 0) fixed[i] |= kHeldY;
    }
  }
  int top(int i, int j) const { return box.corner(i, j, n); }
  double radius(int i, int j) const { return h * std::sqrt(double(i * i + j * j)); }

  /// Displacement under a point force F down on the origin [Boussinesq 1885].
  static Vec3d boussinesq(double force, Vec3d p) {
    const double r = std::sqrt(p.x * p.x + p.y * p.y), z = -p.z, rho = std::sqrt(r * r + z * z);
    const double c = force * (1 + kNu) / (2 * kPi * kE);
    const double out = c * (r * z / (rho * rho * rho) - (1 - 2 * kNu) * r / (rho * (rho + z)));
    const double down = c * (z * z / (rho * rho * rho) + 2 * (1 - kNu) / rho);
    return {r > 0 ? out * p.x / r : 0, r > 0 ? out * p.y / r : 0, -down};
  }
  void hold_far_faces(double force) {
    const double side = n * h, close = 1e-9 * side;
    for (size_t i = 0; i < fixed.size(); ++i) {
      const Vec3d p = d.positions[i];
      if (p.x < side - close && p.y < side - close && p.z > -side + close) continue;
      fixed[i] = kHeld;
      given[i] = boussinesq(force, p);
    }
  }
};

TEST(HalfSpace, APointForceDentsTheSurfaceAsBoussinesqSays) {
  // u = F (1 - nu^2) / (pi E r), at a fixed place while the cells shrink.
  const double side = 0.06, force = 1e-3;
  double before = 0;
  for (const int n : {12, 24}) {
    HalfSpace s(n, side / n);
    s.hold_far_faces(force);
    s.load[size_t(s.top(0, 0))].z = -force / 4;
    const std::vector<Vec3d> u = solve(s.d, s.load, s.fixed, s.given);
    double worst = 0;
    for (int i = n / 4; i <= n * 3 / 4; ++i) {
      const double exact = force / (kPi * kContactModulus * s.radius(i, 0));
      worst = std::max(worst, std::fabs(-u[size_t(s.top(i, 0))].z - exact) / exact);
    }
    EXPECT_LT(worst, 0.015);
    if (before > 0) {
      EXPECT_LT(worst, 0.6 * before);
    }
    before = worst;
  }
}

struct Pressed {
  double force, contact_radius;
};
/// Presses a rigid body without friction into the surface. @param height  of its lower side at a distance from the axis
Pressed press(HalfSpace& s, double total_force, double reach, const std::function<double(double)>& height) {
  s.hold_far_faces(total_force);
  std::vector<int> nodes;
  for (int j = 0; j < s.n; ++j)
    for (int i = 0; i < s.n; ++i)
      if (s.radius(i, j) <= reach) nodes.push_back(s.top(i, j));
  std::vector<Vec3d> u;
  for (int round = 0; round < 20; ++round) {  // whatever would be pulled up lets go
    std::vector<std::uint8_t> fixed = s.fixed;
    for (const int node : nodes) {
      const Vec3d p = s.d.positions[size_t(node)];
      fixed[size_t(node)] |= kHeldZ;
      s.given[size_t(node)].z = height(std::sqrt(p.x * p.x + p.y * p.y));
    }
    u = solve(s.d, s.load, fixed, s.given);
    const std::vector<Vec3d> f = forces(s.d, u);
    std::vector<int> still;
    for (const int node : nodes)
      if (f[size_t(node)].z < 0) still.push_back(node);
    const bool settled = still.size() == nodes.size();
    nodes = still;
    if (settled) break;
  }
  Pressed out{0, 0};
  const std::vector<Vec3d> f = forces(s.d, u);
  for (const int node : nodes) {
    const Vec3d p = s.d.positions[size_t(node)];
    out.force -= 4 * f[size_t(node)].z;
    out.contact_radius = std::max(out.contact_radius, std::sqrt(p.x * p.x + p.y * p.y));
  }
  return out;
}

TEST(HalfSpace, AFlatPunchSinksInProportionToItsForceAndRadius) {
  // F = 2 E* a delta, with the radius of the disc whose area the pressed nodes stand for. The far faces are ten away.
  const double h = 0.002, depth = 0.001;
  double before = 1;
  for (const int cells : {2, 4}) {
    HalfSpace s(10 * cells, h);
    int nodes = 0;
    for (int j = -cells; j <= cells; ++j)
      for (int i = -cells; i <= cells; ++i) nodes += i * i + j * j <= cells * cells;
    const double theory = 2 * kContactModulus * h * std::sqrt(nodes / kPi) * depth;
    const Pressed p = press(s, theory, cells * h * 1.0001, [&](double) { return -depth; });
    const double error = std::fabs(p.force / theory - 1);
    EXPECT_LT(error, 0.1) << cells;
    EXPECT_LT(error, 0.7 * before) << cells;
    before = error;
  }
}

TEST(HalfSpace, ASphereSinksWithThePowerOfThreeHalves) {
  // F = 4/3 E* sqrt(R) delta^1.5, and it touches within sqrt(R delta).
  const double h = 0.002, radius = 0.05;
  for (const int cells : {2, 3}) {
    HalfSpace s(10 * cells, h);
    const double a = cells * h, depth = a * a / radius;
    const double theory = 4.0 / 3 * kContactModulus * std::sqrt(radius) * std::pow(depth, 1.5);
    const Pressed p = press(s, theory, 1.5 * a, [&](double r) { return -depth + r * r / (2 * radius); });
    EXPECT_NEAR(p.force, theory, 0.03 * theory) << cells;
    EXPECT_NEAR(p.contact_radius, a, 0.5 * h) << cells;
  }
}

}  // namespace
}  // namespace trocar::tissue
