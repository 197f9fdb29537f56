// Slender beams, clamped at one end, against beam theory: of a lattice of springs, and as strands.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/strand/strand.hpp>

#include "linear_solve.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::kPi;

// ---- of a lattice

constexpr double kE = 30e3, kRho = 1050, kDeep = 0.02, kLong = 0.2;  // [Pa] [kg/m^3] [m]
constexpr double kInertia = kDeep * kDeep * kDeep * kDeep / 12;

struct Cantilever {
  int n;
  BoxLattice box;
  NetworkDescription d;
  explicit Cantilever(int cells_deep)
      : n(cells_deep), box(box_lattice(10 * cells_deep, cells_deep, cells_deep, kDeep / cells_deep)) {
    d = lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho, .damping_time = 1e-4})
            .network;
    for (std::size_t i = 0; i < d.positions.size(); ++i) d.fixed[i] = d.positions[i].x < 1e-9 ? kHeld : kFree;
  }
  std::vector<Vec3d> force_on_tip(double force) const {
    std::vector<Vec3d> load(d.positions.size());
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j) {
        const double share = (k == 0 || k == n ? 0.5 : 1) * (j == 0 || j == n ? 0.5 : 1);
        load[size_t(box.corner(box.nx, j, k))].z = share * force / (n * n);
      }
    return load;
  }
  std::vector<Vec3d> weight(double gravity) const {
    std::vector<Vec3d> load;
    for (const double m : d.mass) load.push_back({0, 0, gravity * m});
    return load;
  }
  /// Mean displacement of the end face. @param u  of a node
  template <class Displacement>
  double tip(Displacement&& u) const {
    double sum = 0;
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j) sum += u(box.corner(box.nx, j, k)).z / ((n + 1) * (n + 1));
    return sum;
  }
  double tip_under(const std::vector<Vec3d>& load) const {
    const std::vector<Vec3d> u = solve(d, load, d.fixed);
    return tip([&](int i) { return u[size_t(i)]; });
  }
};

constexpr double kForce = 3e-4, kWeight = 2e-2;  // [N] [m/s^2]: both bend the beam by about a hundredth of its length
double bent_by_force() { return kForce * kLong * kLong * kLong / (3 * kE * kInertia); }
double bent_by_weight() { return kWeight * kRho * kDeep * kDeep * kLong * kLong * kLong * kLong / (8 * kE * kInertia); }
/// What shear adds to a beam so deep (Timoshenko, 5/6 of the section, G = 0.4 E), relative.
double shear_by_force() { return kForce * kLong / (5.0 / 6 * 0.4 * kE * kDeep * kDeep) / bent_by_force(); }

TEST(LatticeSprings, CantileverBendsByBeamTheoryAtEightCellsDeep) {
  const Cantilever beam(8);
  expect_within("row 7, force on the tip, 8 cells deep", "f64",
                beam.tip_under(beam.force_on_tip(kForce)) / bent_by_force() - 1, 0.05);
  expect_within("row 7, its own weight, 8 cells deep", "f64",
                beam.tip_under(beam.weight(kWeight)) / bent_by_weight() - 1, 0.05);
}

TEST(LatticeSprings, CantileverConvergesAsCellsShrink) {
  // Not quite with their square: at the edges of a clamp that lets nothing shrink, stress has no bound.
  std::vector<double> errors;
  for (const int cells : {1, 2, 4, 8}) {
    const Cantilever beam(cells);
    errors.push_back(beam.tip_under(beam.force_on_tip(kForce)) / bent_by_force() / (1 + shear_by_force()) - 1);
  }
  expect_order("row 7, force on the tip, 1, 2, 4, 8 cells deep", "f64", errors, 1.6, 0.3);
}

TEST(LatticeSprings, PureBendingConvergesWithTheSquareOfTheCells) {
  // Pulled above and pushed below as the beam's own stress is, at the root kept from moving along it: no singular edge,
  // deflection kappa L^2 / 2.
  const double kappa = 0.1;
  std::vector<double> errors;
  for (const int cells : {2, 4, 8}) {
    Cantilever beam(cells);
    const double h = kDeep / cells;
    std::vector<Vec3d> load(beam.d.positions.size());
    for (int k = 0; k <= cells; ++k)
      for (int j = 0; j <= cells; ++j) {
        const double share = (k == 0 || k == cells ? 0.5 : 1) * (j == 0 || j == cells ? 0.5 : 1);
        load[size_t(beam.box.corner(beam.box.nx, j, k))].x = -share * h * h * kE * kappa * (k * h - kDeep / 2);
        beam.d.fixed[size_t(beam.box.corner(0, j, k))] = kHeldX;
      }
    beam.d.fixed[size_t(beam.box.corner(0, cells / 2, cells / 2))] = kHeld;
    beam.d.fixed[size_t(beam.box.corner(0, cells, cells / 2))] |= kHeldZ;  // no roll
    const std::vector<Vec3d> u = solve(beam.d, load, beam.d.fixed);
    const double bent = u[size_t(beam.box.corner(beam.box.nx, cells / 2, cells / 2))].z;
    errors.push_back(bent / (0.5 * kappa * kLong * kLong) - 1);
  }
  expect_order("row 7, a moment on the end, 2, 4, 8 cells deep", "f64", errors, 2, 0.2);
}

TEST(LatticeSprings, CantileverInTheKernelRestsWhereTheLinearSolveSays) {
  // In float and at finite strain, from nine tenths of the way.
  Cantilever beam(8);
  beam.d.global_damping = 5;
  const std::vector<Vec3d> force = beam.force_on_tip(kForce), linear = solve(beam.d, force, beam.d.fixed);
  std::vector<NodeLoad> loads;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (force[i].z != 0) loads.push_back({.node = int(i), .f0 = vec_cast<float>(force[i])});
  const NetworkModel m = build(beam.d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  for (int i = 0; i < m.nodes; ++i) set_position(m, s, i, m.rest[size_t(i)] + 0.9 * linear[size_t(i)]);
  for (int t = 0; t < 2500; ++t) ASSERT_TRUE(advance(m, loads, {}, s, w).fine());
  const double tip = beam.tip([&](int i) { return position(m, s, i) - m.rest[size_t(i)]; });
  expect_within("row 7, force on the tip, 8 cells deep", "f32", tip / bent_by_force() - 1, 0.05);
  expect_within("row 7, the same beside the linear solve", "f32",
                tip / beam.tip([&](int i) { return linear[size_t(i)]; }) - 1, 0.01);
}

// ---- strands: double precision only

constexpr double kRadius = 0.002, kStrandE = 1e6, kStrandLong = 0.1;

/// A straight strand along x, its first element a clamp of its own length before x = 0.
StrandDescription strand(int elements, double lumen = 0) {
  StrandDescription d;
  const double h = kStrandLong / elements;
  for (int i = -1; i <= elements; ++i) d.positions.push_back({h * i, 0, 0});
  d.radius.assign(size_t(elements) + 1, kRadius);
  if (lumen > 0) d.lumen.assign(size_t(elements) + 1, lumen);
  d.youngs_modulus = kStrandE;
  d.density = 1050;
  d.prestress = false;
  d.prescribed.assign(size_t(elements) + 2, 0);
  d.prescribed[0] = d.prescribed[1] = 1;
  d.damping_time = 2e-3;
  d.global_damping = 20;
  return d;
}
double stiffness(double lumen = 0) { return kStrandE * kPi / 4 * (std::pow(kRadius, 4) - std::pow(lumen, 4)); }

/// Where the tip rests under a force on it, or its weight.
double strand_tip(const StrandDescription& d, double force) {
  const StrandModel m = build(d, 1e-3);
  StrandState s = rest_state(m);
  StrandWork w = make_work(m);
  const StrandLoad load{.element = m.nodes - 2, .w = 1, .f0 = {0, 0, force}};
  for (int t = 0; t < 4000; ++t) EXPECT_TRUE(advance(m, {}, {&load, 1}, {}, {}, s, w).fine());
  return s.x.back().z;
}

TEST(Strand, CantileverTipDeflectsByBeamTheory) {
  for (const double lumen : {0.0, 0.0015}) {
    const double force = 1e-5, expected = force * std::pow(kStrandLong, 3) / (3 * stiffness(lumen));
    expect_within(std::string("row 7, force on a ") + (lumen > 0 ? "tube" : "strand") + ", 40 elements", "f64",
                  strand_tip(strand(40, lumen), force) / expected - 1, 0.01);
  }
  StrandDescription d = strand(60);
  d.gravity = {0, 0, 0.02};
  const double q = 0.02 * 1050 * kPi * kRadius * kRadius, expected = q * std::pow(kStrandLong, 4) / (8 * stiffness());
  expect_within("row 7, own weight of a strand, 60 elements", "f64", strand_tip(d, 0) / expected - 1, 0.015);
}

TEST(Strand, CantileverDeflectionConvergesWithItsElements) {
  const double force = 1e-5, expected = force * std::pow(kStrandLong, 3) / (3 * stiffness());
  std::vector<double> errors;
  for (const int elements : {5, 10, 20}) {
    errors.push_back(strand_tip(strand(elements), force) / expected - 1);
  }
  expect_order("row 7, force on a strand, 5, 10, 20 elements", "f64", errors, 2, 0.25);
}

}  // namespace
}  // namespace trocar::tissue
