// Closed sheets with something inside: against Laplace's law, the thin-wall formulas, Boyle's law, and balances.
#include <cmath>
#include <functional>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/core/tick.hpp>

#include "closed_sheets.hpp"
#include "linear_solve.hpp"
#include "validation.hpp"

using namespace trocar;
using namespace trocar::tissue;
using test::expect_order;
using test::expect_within;
using test::kPi;

namespace {

using core::kTick;
using test::filled;
using test::kRadius;
using test::sphere;
using test::tube;
using test::wall;

/// Answer of the linear wall to a small pressure in double. Three nodes take its six motions as a whole away: the
/// load balances itself, so they bear nothing.
std::vector<Vec3d> inflated(const MembraneDescription& d, double pressure) {
  std::vector<Vec3d> load(d.positions.size());
  enclosed_volume(d.triangles, d.positions, load);
  for (Vec3d& f : load) f *= pressure;
  std::vector<std::uint8_t> fixed(d.positions.size(), kFree);
  size_t low = 0, high = 0, side = 0;
  for (size_t i = 0; i < d.positions.size(); ++i) {
    if (d.positions[i].z < d.positions[low].z) low = i;
    if (d.positions[i].z > d.positions[high].z) high = i;
    if (d.positions[i].x > d.positions[side].x) side = i;
  }
  fixed[low] = kHeld;
  fixed[high] = kHeldX | kHeldY;
  fixed[side] = kHeldY;
  return solve(network_of(d), load, fixed);
}

/// Lets a sheet come to rest; with `drag` it does.
void calm(const MembraneModel& m, MembraneState& s, int ticks) {
  MembraneWork w = make_work(m);
  for (int t = 0; t < ticks; ++t) ASSERT_TRUE(advance(m, {}, {}, {}, s, w).fine());
}
constexpr double kDrag = 30;  // [1/s]

/// Mean tension in the wall [N/m] from its springs' forces, along the directions `part` weighs and over the springs it
/// picks: sum f l w / area.
double tension(const MembraneModel& m, const MembraneState& s, const NetworkDescription& net, double area,
               const std::function<double(Vec3d middle, Vec3d direction)>& part) {
  double sum = 0;
  for (int k = 0; k < m.network.springs; ++k) {
    const SpringDescription& e = net.springs[size_t(k)];
    const Vec3d a = position(m.network, s.network, e.a), b = position(m.network, s.network, e.b);
    const double force = e.k * e.rest_length * m.law.shape(spring_strain(m.network, s.network, k));
    sum += force * length(b - a) * part(0.5 * (a + b), normalised(b - a));
  }
  return sum / area;
}

MembraneState shaken(const MembraneModel& m, double speed) {
  MembraneState s = rest_state(m);
  core::Random random(5);
  for (int i = 0; i < m.nodes(); ++i)
    set_velocity(m.network, s.network, i,
                 {random.uniform(-speed, speed), random.uniform(-speed, speed), random.uniform(-speed, speed)});
  return s;
}

}  // namespace

TEST(Enclosure, TheVolumesGradientIsItsDerivative) {
  geometry::TriMesh mesh = sphere(1);
  core::Random random(3);
  for (Vec3d& p : mesh.positions)
    p += 0.002 * Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  std::vector<Vec3d> gradient(mesh.positions.size());
  const EnclosedVolume whole = enclosed_volume(mesh.triangles, mesh.positions, gradient);
  EXPECT_NEAR(whole.volume, geometry::volume(mesh), 1e-12 * whole.volume);
  EXPECT_LT(length(whole.centre - geometry::centre_of_volume(mesh)), 1e-12);
  double worst = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double h = 1e-6, x = mesh.positions[i][axis];
      mesh.positions[i][axis] = x + h;
      const double up = geometry::volume(mesh);
      mesh.positions[i][axis] = x - h;
      const double down = geometry::volume(mesh);
      mesh.positions[i][axis] = x;
      worst = std::max(worst, std::fabs((up - down) / (2 * h) - gradient[i][axis]));
    }
  expect_within("gradient of the volume, over a node's area", "f64", worst / length(gradient[0]), 1e-7);
}

TEST(Enclosure, ASphereSwellsByTheThinWallFormula) {
  const double p = 20;
  std::vector<double> errors;
  for (int times : {1, 2, 3}) {
    const MembraneDescription d = wall(sphere(times));
    const double exact = p * kRadius * kRadius * (1 - kSheetPoisson) / (2 * d.youngs_modulus * d.thickness);
    const std::vector<Vec3d> u = inflated(d, p);
    // Whatever the three nodes let it move as a whole drops out of the change of volume.
    std::vector<Vec3d> gradient(u.size());
    const double volume = enclosed_volume(d.triangles, d.positions, gradient).volume;
    double swell = 0;
    for (size_t i = 0; i < u.size(); ++i) swell += dot(gradient[i], u[i]);
    errors.push_back(swell / (3 * volume) * kRadius / exact - 1);
  }
  expect_within("sphere's swelling p r^2 (1 - nu) / 2 E t, edges of r / 7", "f64", errors.back(), 0.02);
  expect_order("sphere's swelling", "f64", errors, 2, 0.3);
}

TEST(Enclosure, ATubeSwellsByTheThinWallFormula) {
  const double p = 20, r = 0.01, half = 0.03;
  std::vector<double> errors;
  for (double edge : {0.005, 0.0025, 0.00125}) {
    const MembraneDescription d = wall(tube(r, half, edge));
    const double exact = p * r / (d.youngs_modulus * d.thickness) * (1 - 0.5 * kSheetPoisson);
    const std::vector<Vec3d> u = inflated(d, p);
    // Mean of the strain around, by the radial way and against the mean of the way sideways.
    double sum = 0, count = 0, x = 0, y = 0;
    for (size_t i = 0; i < u.size(); ++i)
      if (std::fabs(d.positions[i].z) < 0.4 * half) {
        const Vec3d at{d.positions[i].x, d.positions[i].y, 0};
        sum += dot(u[i], normalised(at)) / r, x += u[i].x, y += u[i].y, count += 1;
      }
    errors.push_back(sum / count / exact - 1);
  }
  expect_within("tube's swelling p r^2 (1 - nu / 2) / E t, edges of r / 8", "f64", errors.back(), 0.02);
  expect_within("the same with edges of r / 2", "f64", errors.front(), 0.12);
}

TEST(Enclosure, ASpheresWallBearsLaplacesTension) {
  const double p = 150;
  std::vector<double> errors;
  for (int times : {1, 2, 3}) {
    MembraneDescription d = filled(sphere(times), p, 1e5);
    d.enclosure.kind = Enclosure::constant;
    d.global_damping = kDrag;
    const MembraneModel m = build(d, kTick);
    MembraneState s = rest_state(m);
    calm(m, s, 600);
    std::vector<Vec3d> x;
    double r = 0;
    for (int i = 0; i < m.nodes(); ++i) {
      x.push_back(position(m.network, s.network, i));
      r += length(x.back()) / m.nodes();
    }
    EXPECT_GT(r, 1.01 * kRadius);
    const double t = tension(m, s, network_of(d), geometry::area({x, d.triangles}), [](Vec3d, Vec3d) { return 0.5; });
    errors.push_back(t / (0.5 * p * r) - 1);
  }
  expect_within("tension p r / 2 of an inflated sphere, edges of r / 7", "f32", errors.back(), 0.02);
  expect_order("tension of an inflated sphere", "f32", errors, 2, 0.4);
}

TEST(Enclosure, ATubesWallBearsLaplacesTensionAroundAndHalfOfItAlong) {
  const double p = 150, r0 = 0.01, half = 0.03;
  for (double edge : {0.003, 0.0015}) {
    MembraneDescription d = filled(tube(r0, half, edge), p, 1e5);
    d.enclosure.kind = Enclosure::constant;
    d.global_damping = kDrag;
    const MembraneModel m = build(d, kTick);
    MembraneState s = rest_state(m);
    calm(m, s, 800);
    double r = 0, count = 0;
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d x = position(m.network, s.network, i);
      if (std::fabs(x.z) < 0.4 * half) r += std::sqrt(x.x * x.x + x.y * x.y), count += 1;
    }
    r /= count;
    const double most = 0.4 * half, area = 2 * kPi * r * 2 * most;
    const auto among = [&](Vec3d at) { return std::fabs(at.z) < most ? 1.0 : 0.0; };
    const double along = tension(m, s, network_of(d), area, [&](Vec3d at, Vec3d n) { return among(at) * n.z * n.z; });
    const double around =
        tension(m, s, network_of(d), area, [&](Vec3d at, Vec3d n) { return among(at) * (1 - n.z * n.z); });
    const bool fine = edge < 0.002;
    const std::string of = fine ? "edges of r / 7" : "edges of r / 3";
    expect_within("tension p r around a tube, " + of, "f32", around / (p * r) - 1, fine ? 0.03 : 0.06);
    expect_within("tension p r / 2 along it, " + of, "f32", along / (0.5 * p * r) - 1, fine ? 0.04 : 0.08);
  }
}

TEST(Enclosure, InTheKernelTheSphereSwellsAsTheLinearSolveSays) {
  const double p = 5;
  MembraneDescription d = filled(sphere(2), p, 1e5);
  d.enclosure.kind = Enclosure::constant;
  d.global_damping = kDrag;
  const std::vector<Vec3d> u = inflated(d, p);
  std::vector<Vec3d> gradient(u.size());
  const double volume = enclosed_volume(d.triangles, d.positions, gradient).volume;
  double swell = 0;
  for (size_t i = 0; i < u.size(); ++i) swell += dot(gradient[i], u[i]);
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  calm(m, s, 600);
  // Bending, which the solve has not, and finite strain stay.
  expect_within("swelling of the kernel's sphere, off the linear solve's", "f32",
                (enclosed_volume(m, s).volume - volume) / swell - 1, 0.05);
}

TEST(Enclosure, ASphereStoresThePlatesBendingEnergy) {
  std::vector<double> errors;
  for (int times : {1, 2, 3}) {
    const MembraneDescription d = wall(sphere(times));
    const MembraneModel m = build(d, kTick);
    errors.push_back(energy(m, rest_state(m)).bending / (8 * kPi * m.bending_stiffness) - 1);
  }
  expect_within("bending energy 8 pi D of a sphere, edges of r / 7", "f64", errors.back(), 0.05);
}

TEST(Enclosure, LiquidKeepsItsVolumeWhenItIsSqueezed) {
  for (double bulk : {2e5, 2.2e9}) {
    const MembraneDescription d = filled(sphere(2), 0, bulk);
    const MembraneModel m = build(d, kTick);
    MembraneState s = rest_state(m);
    MembraneWork w = make_work(m, 2 * size_t(m.nodes()));
    double worst = 0, mean = 0, by_law = 0;
    // Two plates come together until a fifth of the height is gone.
    for (int t = 0; t < 1500; ++t) {
      const double plate = kRadius * (1 - 0.2 * std::min(1.0, t / 800.0));
      std::vector<NodeLoad> loads;
      for (int i = 0; i < m.nodes(); ++i) {
        const Vec3d x = position(m.network, s.network, i);
        if (std::fabs(x.z) <= plate) continue;
        NodeLoad load;
        load.node = i;
        load.k = 3000, load.d = 0.5f;
        load.dir = {0, 0, 1};
        load.x0 = vec_cast<float>(Vec3d{x.x, x.y, x.z > 0 ? plate : -plate});
        loads.push_back(load);
      }
      std::vector<Vec3f> reactions(loads.size());
      ASSERT_TRUE(advance(m, {}, loads, reactions, s, w).fine());
      worst = std::max(worst, std::fabs(enclosed_volume(m, s).volume / m.enclosure.volume - 1));
      if (t < 1300) continue;
      mean += s.enclosure.pressure / 200;
      by_law += bulk * (1 - enclosed_volume(m, s).volume / m.enclosure.volume) / 200;
    }
    EXPECT_GT(mean, 30) << "squeezed, it presses";
    const bool water = bulk > 1e9;
    expect_within(water ? "volume squeezed by a fifth, K of water" : "volume squeezed by a fifth, K = 0.2 MPa", "f32",
                  worst, water ? 1e-3 : 0.01);
    if (!water) {
      expect_within("its mean pressure, off the law's", "f32", by_law / mean - 1, 0.03);
    }
  }
}

TEST(Enclosure, GasFollowsBoylesLaw) {
  MembraneDescription d = filled(sphere(2), 2000, 0);
  d.enclosure.kind = Enclosure::gas;
  d.global_damping = kDrag;
  d.youngs_modulus = 100e3;
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  calm(m, s, 600);
  const double volume = enclosed_volume(m, s).volume;
  EXPECT_GT(volume, 1.005 * m.enclosure.volume);
  const double product = (s.enclosure.pressure + kAtmosphere) * volume;
  expect_within("p V of gas that has spread", "f32", product / ((2000 + kAtmosphere) * m.enclosure.volume) - 1, 1e-5);
}

TEST(Enclosure, NoBulkModulusAsksForAShorterStep) {
  for (double bulk : {1e3, 1e6, 1e9, 1e12}) {
    const MembraneModel m = build(filled(sphere(2), 500, bulk), kTick);
    EXPECT_EQ(m.bend_steps * m.network.substeps, [&] {
      const MembraneModel soft = build(filled(sphere(2), 500, 1e3), kTick);
      return soft.bend_steps * soft.network.substeps;
    }());
    MembraneState s = shaken(m, 0.5);
    MembraneWork w = make_work(m);
    const double before = energy(m, s).kinetic;
    for (int t = 0; t < 1000; ++t) ASSERT_TRUE(advance(m, {}, {}, {}, s, w).fine());
    const MembraneEnergy after = energy(m, s);
    EXPECT_LT(after.kinetic, 0.2 * before) << "K = " << bulk;
    EXPECT_TRUE(std::isfinite(s.enclosure.pressure));
  }
}

TEST(Enclosure, PressureChangesNeitherMomentum) {
  MembraneDescription d = filled(sphere(2), 500, 1e6);
  d.bending_damping_time = 0;  // along differences, not along distances: it brakes spin
  const MembraneModel m = build(d, kTick);
  MembraneState s = shaken(m, 0.2);
  const auto sums = [&] {
    std::array<Vec3d, 2> sum{};
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d p = m.network.mass[size_t(i)] * velocity(m.network, s.network, i);
      sum[0] += p, sum[1] += cross(position(m.network, s.network, i), p);
    }
    return sum;
  };
  double scale = 0;
  for (int i = 0; i < m.nodes(); ++i) scale += m.network.mass[size_t(i)] * length(velocity(m.network, s.network, i));
  const auto before = sums();
  MembraneWork w = make_work(m);
  for (int t = 0; t < 300; ++t) advance(m, {}, {}, {}, s, w);
  const auto after = sums();
  expect_within("momentum of a filled sphere, 300 ticks", "f32", length(after[0] - before[0]) / scale, 1e-4);
  expect_within("its angular momentum", "f32", length(after[1] - before[1]) / (scale * kRadius), 1e-4);
}

TEST(Enclosure, WhatHangsFromItsHolderWeighsAsMuchAsWallAndContents) {
  MembraneDescription d = filled(sphere(2), 300, 1e5);
  d.enclosure.density = 1010;
  d.gravity = {0, 0, -9.81};
  d.held.resize(d.positions.size());
  for (size_t i = 0; i < d.positions.size(); ++i) d.held[i] = d.positions[i].z > 0.8 * kRadius;
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  double worst = 0;
  for (int t = 0; t < 1500; ++t) {
    ASSERT_TRUE(advance(m, {}, {}, {}, s, w).fine());
    for (int i = 0; i < m.nodes(); ++i)
      worst = std::max(worst, length(position(m.network, s.network, i) - m.network.rest[size_t(i)]));
  }
  std::vector<BorderPull> pulls(m.held_nodes.size());
  border_pulls(m, s, w, pulls);
  Vec3d sum{0, 0, 0};
  for (const BorderPull& p : pulls) sum += p.force;
  double free = 0;  // held nodes' own weight is their holders' own
  for (int i = 0; i < m.nodes(); ++i)
    if (m.network.fixed[size_t(i)] != kHeld) free += m.network.mass[size_t(i)] - m.contents[size_t(i)];
  const double fill = enclosed_volume(m, s).volume * d.enclosure.density;
  EXPECT_GT(fill, 2 * free);
  expect_within("pull of a hanging filled sphere, off the weight", "f32", -sum.z / (9.81 * (free + fill)) - 1, 0.01);
  expect_within("the drawn shape moves in 1.5 s, over the radius", "f32", worst / kRadius, 0.01);
}

TEST(Enclosure, RefusesWhatIsUnsound) {
  MembraneDescription open = filled(sphere(1), 100, 1e5);
  open.triangles.pop_back();
  EXPECT_THROW(build(open, kTick), std::invalid_argument);
  MembraneDescription inside_out = filled(sphere(1), 100, 1e5);
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  EXPECT_THROW(build(inside_out, kTick), std::invalid_argument);
  MembraneDescription both = filled(sphere(1), 100, 1e5);
  both.columns = 2, both.rows = 2;
  EXPECT_THROW(build(both, kTick), std::invalid_argument);
  EXPECT_THROW(build(filled(sphere(1), 100, 0), kTick), std::invalid_argument);
  MembraneDescription vacuum = filled(sphere(1), -2e5, 1e5);
  vacuum.enclosure.kind = Enclosure::gas;
  EXPECT_THROW(build(vacuum, kTick), std::invalid_argument);
}
