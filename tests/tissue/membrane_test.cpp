// The sheet against the theory of elasticity: plane stress, plates, balances of momentum and energy.
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

using namespace trocar;
using namespace trocar::tissue;

namespace {

using core::kTick;

/// A flat sheet in the plane z = 0 from the corner at the origin, columns along x, rows along y, nothing held.
MembraneDescription sheet(int columns, int rows, double width, double height) {
  MembraneDescription d;
  d.columns = columns;
  d.rows = rows;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) d.positions.push_back({c * width, r * height, 0});
  d.thickness = 0.0005;
  d.youngs_modulus = 20e3;
  d.density = 1000;
  d.damping_time = 5e-4;
  d.bending_damping_time = 2e-3;
  return d;
}

void hold_row(MembraneDescription& d, int row) {
  d.held.resize(d.positions.size());
  for (int c = 0; c < d.columns; ++c) d.held[std::size_t(row * d.columns + c)] = 1;
}

Vec3d momentum(const MembraneModel& m, const MembraneState& s) {
  Vec3d sum{0, 0, 0};
  for (int i = 0; i < m.nodes(); ++i) sum += m.network.mass[std::size_t(i)] * velocity(m.network, s.network, i);
  return sum;
}
Vec3d spin(const MembraneModel& m, const MembraneState& s) {
  Vec3d sum{0, 0, 0};
  for (int i = 0; i < m.nodes(); ++i)
    sum += m.network.mass[std::size_t(i)] * cross(position(m.network, s.network, i), velocity(m.network, s.network, i));
  return sum;
}

void shake(const MembraneModel& m, MembraneState& s, double speed, std::uint64_t seed) {
  core::Random random(seed);
  for (int i = 0; i < m.nodes(); ++i) {
    if (m.network.fixed[std::size_t(i)] == kHeld) continue;
    set_velocity(m.network, s.network, i,
                 {random.uniform(-speed, speed), random.uniform(-speed, speed), random.uniform(-speed, speed)});
  }
}

bool run(const MembraneModel& m, MembraneState& s, MembraneWork& w, int ticks) {
  bool fine = true;
  for (int i = 0; i < ticks; ++i) fine = advance(m, {}, {}, {}, s, w).fine() && fine;
  return fine;
}

/// Sum of what the sheet does to the holders in one row.
Vec3d pull_of_row(const MembraneModel& m, const MembraneState& s, int row) {
  MembraneWork w = make_work(m);
  std::vector<BorderPull> pulls(m.held_nodes.size());
  border_pulls(m, s, w, pulls);
  Vec3d sum{0, 0, 0};
  for (std::size_t h = 0; h < pulls.size(); ++h)
    if (m.held_nodes[h] / m.columns == row) sum += pulls[h].force;
  return sum;
}

}  // namespace

TEST(Membrane, StretchedEvenlyItPullsWithModulusTimesThickness) {
  // [Van Gelder 98]'s aim, for cells of several shapes: force = E t eps per width, contraction eps / 3 across, and no
  // force left on any node inside.
  for (double height : {0.0015, 0.002, 0.003}) {
    MembraneDescription d = sheet(9, 7, 0.002, height);
    hold_row(d, 0);
    hold_row(d, 6);
    const MembraneModel m = build(d, kTick);
    MembraneState s = rest_state(m);
    const double strain = 0.001, width = 8 * 0.002;
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d x = d.positions[std::size_t(i)];
      set_position(m.network, s.network, i, {(1 - strain / 3) * (x.x - width / 2), (1 + strain) * x.y, 0});
    }
    const double expected = d.youngs_modulus * d.thickness * strain * width;
    EXPECT_NEAR(pull_of_row(m, s, 0).y, expected, 0.005 * expected) << height;
    EXPECT_NEAR(pull_of_row(m, s, 6).y, -expected, 0.005 * expected) << height;
    MembraneWork w = make_work(m);
    advance(m, {}, {}, {}, s, w);
    for (int r = 1; r < 6; ++r)
      for (int c = 0; c < 9; ++c) {
        const int i = r * 9 + c;
        const double force = m.network.mass[std::size_t(i)] * length(velocity(m.network, s.network, i)) / kTick;
        EXPECT_LT(force, 0.01 * expected / 8) << "column " << c << " row " << r;
      }
  }
}

TEST(Membrane, ShearedEvenlyItPullsWithItsShearModulus) {
  MembraneDescription d = sheet(41, 5, 0.002, 0.002);
  hold_row(d, 0);
  hold_row(d, 4);
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  const double angle = 0.001;
  for (int i = 0; i < m.nodes(); ++i) {
    const Vec3d x = d.positions[std::size_t(i)];
    set_position(m.network, s.network, i, {x.x + angle * x.y, x.y, 0});
  }
  // G t = E t / 2 (1 + nu); the two end columns lack the shear on their free sides.
  const double expected = d.youngs_modulus * d.thickness / (2 * (1 + kSheetPoisson)) * angle * 40 * 0.002;
  EXPECT_NEAR(pull_of_row(m, s, 0).x, expected, 0.005 * expected);
}

TEST(Membrane, CurledInAnyDirectionItStoresThePlatesEnergy) {
  // D kappa^2 / 2 per area, D = E t^3 / 12 (1 - nu^2). The sides of the grid count as beams: compare what is inside.
  const double curvature = 4, plate = 20e3 * 0.0005 * 0.0005 * 0.0005 / (12 * (1 - 1.0 / 9));
  for (double degrees : {0.0, 25.0, 45.0, 90.0, 120.0}) {
    MembraneDescription d = sheet(41, 41, 0.002, 0.0024);
    const MembraneModel m = build(d, kTick);
    EXPECT_NEAR(m.bending_stiffness, plate, 1e-6 * plate);
    MembraneState s = rest_state(m);
    const double angle = degrees * portable::pi / 180, cx = portable::cos(angle), cy = portable::sin(angle);
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d x = d.positions[std::size_t(i)] - Vec3d{0.04, 0.048, 0};
      const double along = cx * x.x + cy * x.y, across = cx * x.y - cy * x.x;
      const double a = portable::sin(curvature * along) / curvature,
                   up = (1 - portable::cos(curvature * along)) / curvature;
      set_position(m.network, s.network, i, {cx * a - cy * across, cy * a + cx * across, up});
    }
    const double expected = 0.5 * plate * curvature * curvature * 1600 * 0.002 * 0.0024;
    EXPECT_NEAR(energy(m, s).bending, expected, 0.03 * expected) << degrees;
  }
}

TEST(Membrane, CantileverSagsBetweenTheBeamsAndThePlates) {
  // q L^4 / 8 D for a plate, 1 / (1 - nu^2) = 1.125 of that for a beam that may curl across; 12.5 cells free, as two
  // held rows clamp it midway between them; within 5 %.
  for (int columns : {3, 15}) {
    MembraneDescription d = sheet(columns, 14, 0.002, 0.002);
    d.thickness = 0.002;
    d.youngs_modulus = 5e5;
    d.damping_time = 2e-6;
    d.bending_damping_time = 1e-5;
    hold_row(d, 0);
    hold_row(d, 1);
    d.gravity = {0, 0, -9.81};
    const MembraneModel m = build(d, kTick);  // settles
    const MembraneState s = rest_state(m);
    const double load = d.density * d.thickness * 9.81, length = 0.025;
    const double sag = load * length * length * length * length / (8 * m.bending_stiffness);
    ASSERT_LT(sag, 0.12 * length);
    const double tip = -position(m.network, s.network, 13 * columns + columns / 2).z;
    EXPECT_GT(tip, 0.95 * sag) << columns;
    EXPECT_LT(tip, 1.05 * 1.125 * sag) << columns;
  }
}

TEST(Membrane, HangingBetweenItsBordersItLiesWhereItsTensionBearsItsWeight) {
  // A taut strip with fixed borders sags w: 3 q L^4 = 64 E' t w^3 (E' = E / (1 - nu^2), bending negligible).
  MembraneDescription d = sheet(41, 13, 0.0015, 0.00125);
  hold_row(d, 0);
  hold_row(d, 12);
  d.gravity = {0, 0, -9.81};
  const MembraneModel m = build(d, kTick);
  const MembraneState s = rest_state(m);
  const double q = d.density * d.thickness * 9.81, width = 12 * 0.00125;
  const double stretch = d.youngs_modulus * d.thickness / (1 - kSheetPoisson * kSheetPoisson);
  const double sag = std::cbrt(3 * q * width * width * width * width / (64 * stretch));
  const double middle = -position(m.network, s.network, 6 * 41 + 20).z;
  EXPECT_NEAR(middle, sag, 0.08 * sag);
  // What hangs still gives its holders its weight, but for that of the border rows themselves.
  double weight = 0;
  for (int i = 0; i < m.nodes(); ++i)
    if (m.network.fixed[std::size_t(i)] != kHeld) weight += m.network.mass[std::size_t(i)] * 9.81;
  EXPECT_NEAR(pull_of_row(m, s, 0).z + pull_of_row(m, s, 12).z, -weight, 0.01 * weight);
}

TEST(Membrane, DrawnShapeHangsStillForTwoSeconds) {
  MembraneDescription d = sheet(27, 7, 0.0026, 0.0024);
  for (int i = 0; i < int(d.positions.size()); ++i) {  // a curved border and a narrower one, tilted
    Vec3d& x = d.positions[std::size_t(i)];
    x = {x.x * (1 - 0.3 * x.y / 0.0144), x.y + 0.004 * portable::sin(x.x * 40), -0.8 * x.y + 0.3 * x.x};
  }
  hold_row(d, 0);
  hold_row(d, 6);
  d.gravity = {0, 2.54, -9.47};
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  ASSERT_TRUE(run(m, s, w, 2000));
  for (int i = 0; i < m.nodes(); ++i)
    EXPECT_LT(length(position(m.network, s.network, i) - m.network.rest[std::size_t(i)]), 5e-5) << i;
}

TEST(Membrane, AFreeSheetKeepsItsMomenta) {
  MembraneDescription d = sheet(12, 9, 0.002, 0.0025);
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  shake(m, s, 0.05, 3);
  const Vec3d p = momentum(m, s), l = spin(m, s);
  ASSERT_TRUE(run(m, s, w, 500));
  double mass = 0;
  for (double each : m.network.mass) mass += each;
  EXPECT_LT(length(momentum(m, s) - p), 1e-4 * mass * 0.05);
  EXPECT_LT(length(spin(m, s) - l), 1e-3 * mass * 0.05 * 0.02);
}

TEST(Membrane, EnergyFallsWhereNothingWorksOnIt) {
  MembraneDescription d = sheet(15, 8, 0.002, 0.002);
  hold_row(d, 0);
  hold_row(d, 7);
  d.gravity = {0, 0, -9.81};
  d.law = {0, 0.3, 2};
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  const double still = energy(m, s).total();
  shake(m, s, 0.2, 5);
  double before = energy(m, s).total();
  const double first = before;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(run(m, s, w, 20));
    const double now = energy(m, s).total();
    EXPECT_LT(now, before + 1e-3 * (first - still)) << i;
    before = now;
  }
  EXPECT_LT(before - still, 0.01 * (first - still));
}

TEST(Membrane, ShakenHardItStaysBoundedAtItsCompiledSteps) {
  for (double thickness : {0.0003, 0.001, 0.003})
    for (double modulus : {5e3, 500e3}) {
      MembraneDescription d = sheet(12, 8, 0.002, 0.002);
      d.thickness = thickness;
      d.youngs_modulus = modulus;
      d.law = {1, 5, 1};
      d.damping_time = 0;
      d.bending_damping_time = 0;
      hold_row(d, 0);
      const MembraneModel m = build(d, kTick);
      MembraneState s = rest_state(m);
      MembraneWork w = make_work(m);
      shake(m, s, 0.3, 7);
      const double first = energy(m, s).total();
      double most = 0;
      for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(run(m, s, w, 50)) << thickness << " " << modulus;
        most = std::max(most, energy(m, s).total());
      }
      EXPECT_LT(most, 1.3 * first) << thickness << " " << modulus;
    }
}

TEST(Membrane, HeldNodesGoWhereTheirHoldersAre) {
  MembraneDescription d = sheet(6, 5, 0.002, 0.002);
  hold_row(d, 0);
  hold_row(d, 4);
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  std::vector<Vec3d> targets;
  for (int t = 1; t <= 50; ++t) {
    targets.clear();
    for (int i : m.held_nodes) targets.push_back(d.positions[std::size_t(i)] + Vec3d{1e-4 * t, 0, 2e-4 * t});
    ASSERT_TRUE(advance(m, targets, {}, {}, s, w).fine());
  }
  for (std::size_t h = 0; h < targets.size(); ++h) {
    EXPECT_LT(length(position(m.network, s.network, m.held_nodes[h]) - targets[h]), 1e-8);
    EXPECT_NEAR(velocity(m.network, s.network, m.held_nodes[h]).z, 0.2, 1e-4);
  }
  EXPECT_NEAR(velocity(m.network, s.network, 2 * 6 + 3).z, 0.2, 0.05);
}

TEST(Membrane, AFirmHoldOnALightNodeReportsWhatTheSheetPullsWith) {
  MembraneDescription d = sheet(9, 9, 0.002, 0.002);
  hold_row(d, 0);
  hold_row(d, 8);
  const MembraneModel m = build(d, kTick);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m, 1);
  NodeLoad hold;
  hold.node = 4 * 9 + 4;
  hold.k = 5000;
  hold.d = 1;
  hold.x0 = vec_cast<float>(d.positions[std::size_t(hold.node)] + Vec3d{0, 0, 0.004});
  Vec3f force{};
  for (int i = 0; i < 1500; ++i) ASSERT_TRUE(advance(m, {}, {&hold, 1}, {&force, 1}, s, w).fine());
  const Vec3d borders = pull_of_row(m, s, 0) + pull_of_row(m, s, 8);
  EXPECT_GT(double(force.z), 1e-4);
  EXPECT_NEAR(double(force.z), borders.z, 0.01 * borders.z);
}

TEST(Membrane, TheSameBitsWhateverTheInstructionSet) {
  MembraneDescription d = sheet(12, 8, 0.002, 0.002);
  hold_row(d, 0);
  d.gravity = {0, 0, -9.81};
  const std::string usual = simd_name();
  std::vector<std::uint64_t> hashes;
  for (const char* name : {"generic", "sse2", "avx2", "avx512"}) {
    if (!set_simd(name)) continue;
    const MembraneModel m = build(d, kTick);
    MembraneState s = rest_state(m);
    MembraneWork w = make_work(m);
    shake(m, s, 0.1, 11);
    run(m, s, w, 100);
    core::Hasher h;
    add_to_hash(h, m);
    add_to_hash(h, s);
    hashes.push_back(h.value());
  }
  set_simd(usual);
  for (std::uint64_t h : hashes) EXPECT_EQ(h, hashes.front());
}

TEST(Membrane, RefusesWhatIsUnsound) {
  const MembraneDescription good = sheet(4, 4, 0.002, 0.002);
  EXPECT_NO_THROW(build(good, kTick));
  const auto refuses = [&](auto&& change) {
    MembraneDescription d = good;
    change(d);
    EXPECT_THROW(build(d, kTick), std::invalid_argument);
  };
  refuses([](MembraneDescription& d) { d.columns = 1; });
  refuses([](MembraneDescription& d) { d.positions.pop_back(); });
  refuses([](MembraneDescription& d) { d.thickness = 0; });
  refuses([](MembraneDescription& d) { d.held = {1}; });
  refuses([](MembraneDescription& d) { d.law = {-3, 1, 1}; });
  refuses([](MembraneDescription& d) { d.positions[5] = d.positions[4]; });
  refuses([](MembraneDescription& d) {
    for (Vec3d& x : d.positions) x.y = 0;
  });
}
