// An elastic body so large that its far end does not matter: a point force [Boussinesq 1885], a rigid flat punch
// [Sneddon 65] and a rigid sphere [Hertz 1882] on its surface. A quarter is computed, the rest is symmetry; the far
// faces, ten contact radii away, move as the half-space would under the theory's total force. In double as a linear
// solve; in float by the kernel, which runs until the body rests.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <trocar/tissue/network/lattice_springs.hpp>

#include "linear_solve.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::kPi;

constexpr double kE = 10e3, kNu = 0.25;
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

/// The kernel at work: a body whose far faces are where they are held, loads on the others.
struct Kernel {
  NetworkModel model;
  NetworkState state;
  NetworkWork work;
  std::vector<Vec3f> reactions;
  explicit Kernel(const HalfSpace& s) : model(build(description(s), 1e-3)), state(rest_state(model)) {
    work = make_work(model);
    for (int i = 0; i < model.nodes; ++i) set_position(model, state, i, model.rest[size_t(i)] + s.given[size_t(i)]);
  }
  static NetworkDescription description(const HalfSpace& s) {
    NetworkDescription d = s.d;
    d.fixed = s.fixed;
    d.tets.clear();
    d.global_damping = 5 / (s.n * s.h);  // about critical for the slowest waves, of 3 m/s
    for (SpringDescription& e : d.springs) e.damping = 2e-5 * e.k;
    return d;
  }
  void ticks(int n, const std::vector<NodeLoad>& loads) {
    reactions.resize(loads.size());
    for (int i = 0; i < n; ++i) ASSERT_TRUE(advance(model, loads, reactions, state, work).fine());
  }
  double sunk(int node) const { return model.rest[size_t(node)].z - position(model, state, node).z; }
};

double dent(double force, double radius) { return force / (kPi * kContactModulus * radius); }

TEST(HalfSpace, APointForceDentsTheSurfaceAsBoussinesqSays) {
  // u = F (1 - nu^2) / (pi E r), at a fixed place while the cells shrink.
  const double side = 0.06, force = 1e-3;
  std::vector<double> errors;
  for (const int n : {8, 16, 32}) {
    HalfSpace s(n, side / n);
    s.hold_far_faces(force);
    s.load[size_t(s.top(0, 0))].z = -force / 4;
    const std::vector<Vec3d> u = solve(s.d, s.load, s.fixed, s.given);
    double worst = 0;
    for (int i = n / 4; i <= n * 3 / 4; ++i)
      worst = std::max(worst, std::fabs(-u[size_t(s.top(i, 0))].z / dent(force, s.radius(i, 0)) - 1));
    expect_within("row 8, point force, from 15 to 45 mm away, cells: " + std::to_string(n), "f64", worst, 0.1);
    errors.push_back(-u[size_t(s.top(n / 2, 0))].z / dent(force, side / 2) - 1);
  }
  expect_order("row 8, point force, 30 mm away, 8, 16, 32 cells", "f64", errors, 2, 0.25);
}

TEST(HalfSpace, APointForceDentsTheKernelsSurfaceToo) {
  const double side = 0.06, force = 0.02;
  const int n = 16;
  HalfSpace s(n, side / n);
  s.hold_far_faces(force);
  Kernel run(s);
  run.ticks(400, {{.node = s.top(0, 0), .f0 = {0, 0, float(-force / 4)}}});
  double worst = 0;
  for (int i = n / 4; i <= n * 3 / 4; ++i)
    worst = std::max(worst, std::fabs(run.sunk(s.top(i, 0)) / dent(force, s.radius(i, 0)) - 1));
  expect_within("row 8, point force, from 15 to 45 mm away, cells: 16", "f32", worst, 0.1);
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

/// The same by the kernel: stiff one-sided loads push the nodes down, and those that would be pulled up lose theirs.
Pressed press_in_kernel(HalfSpace& s, double total_force, double reach, const std::function<double(double)>& height) {
  s.hold_far_faces(total_force);
  Kernel run(s);
  std::vector<NodeLoad> loads;
  for (int j = 0; j < s.n; ++j)
    for (int i = 0; i < s.n; ++i)
      if (s.radius(i, j) <= reach)
        loads.push_back({.node = s.top(i, j), .k = 1e5, .x0 = {0, 0, float(height(s.radius(i, j)))}, .dir = {0, 0, 1}});
  std::sort(loads.begin(), loads.end(), [](const NodeLoad& a, const NodeLoad& b) { return a.node < b.node; });
  for (int round = 0; round < 8; ++round) {
    run.ticks(50, loads);
    std::vector<NodeLoad> still;
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (run.reactions[i].z < 0) still.push_back(loads[i]);
    loads = still;
  }
  run.ticks(50, loads);
  Pressed out{0, 0};
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Vec3d p = s.d.positions[size_t(loads[i].node)];
    out.force -= 4 * double(run.reactions[i].z);
    out.contact_radius = std::max(out.contact_radius, std::sqrt(p.x * p.x + p.y * p.y));
  }
  return out;
}

constexpr double kCell = 0.002;  // [m]

/// A punch of so many cells: F = 2 E* a delta with the radius of the disc whose area the pressed nodes stand for.
struct Punch {
  int cells;
  double depth = 1e-4;
  double theory() const {
    int nodes = 0;
    for (int j = -cells; j <= cells; ++j)
      for (int i = -cells; i <= cells; ++i) nodes += i * i + j * j <= cells * cells;
    return 2 * kContactModulus * kCell * std::sqrt(nodes / kPi) * depth;
  }
  template <class Press>
  double error(Press&& press_it) const {
    HalfSpace s(10 * cells, kCell);
    const Pressed p = press_it(s, theory(), cells * kCell * 1.0001, [&](double) { return -depth; });
    return p.force / theory() - 1;
  }
};

TEST(HalfSpace, AFlatPunchSinksInProportionToItsForceAndRadius) {
  std::vector<double> errors;
  for (const int cells : {1, 2, 4}) errors.push_back(Punch{cells}.error(press));
  expect_within("row 8, flat punch, radius 2 cells", "f64", errors[1], 0.1);
  expect_within("row 8, flat punch, radius 4 cells", "f64", errors[2], 0.1);
  // At the rim of a punch pressure has no bound: the step of the cells, not its square.
  expect_order("row 8, flat punch, radius 1, 2, 4 cells", "f64", errors, 1, 0.25);
  expect_within("row 8, flat punch, radius 2 cells", "f32", Punch{2}.error(press_in_kernel), 0.1);
}

/// A sphere that touches within so many cells: F = 4/3 E* sqrt(R) delta^1.5, a = sqrt(R delta).
struct Sphere {
  double cells, radius = 0.2;
  double depth() const { return cells * cells * kCell * kCell / radius; }
  double theory() const { return 4.0 / 3 * kContactModulus * std::sqrt(radius) * std::pow(depth(), 1.5); }
  template <class Press>
  Pressed pressed(Press&& press_it, int box) const {
    HalfSpace s(box, kCell);
    const double a = cells * kCell;
    return press_it(s, theory(), 1.5 * a, [&](double r) { return -depth() + r * r / (2 * radius); });
  }
};

TEST(HalfSpace, ASphereSinksWithThePowerOfThreeHalves) {
  // The contact grows by whole nodes, so the errors fall without an order of their own.
  for (const int cells : {1, 2, 3}) {
    const Sphere sphere{double(cells)};
    const Pressed p = sphere.pressed(press, 10 * cells);
    const std::string at = ", contact radius " + std::to_string(cells) + " cells";
    expect_within("row 8, sphere" + at, "f64", p.force / sphere.theory() - 1, 0.1);
    EXPECT_NEAR(p.contact_radius, cells * kCell, 0.5 * kCell) << cells;
  }
  const Pressed p = Sphere{2}.pressed(press_in_kernel, 20);
  expect_within("row 8, sphere, contact radius 2 cells", "f32", p.force / Sphere{2}.theory() - 1, 0.1);
  EXPECT_NEAR(p.contact_radius, 2 * kCell, 0.5 * kCell);
}

TEST(HalfSpace, TheSpheresExponentIsThreeHalves) {
  // From 1 to 2 cells of contact radius in one box, the force must grow with depth to the power 3/2.
  const Sphere small{1}, large{2};
  const double slope = std::log(large.pressed(press, 20).force / small.pressed(press, 20).force) /
                       std::log(large.depth() / small.depth());
  expect_within("row 8, sphere, exponent of depth beside 3/2", "f64", slope - 1.5, 0.05);
}

}  // namespace
}  // namespace trocar::tissue
