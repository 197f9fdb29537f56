// K is what the dynamic network is, linearised; and linear tetrahedra are what textbooks say         [KCM99 eq.6]
#include <gtest/gtest.h>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/prestress.hpp>
#include <trocar/tissue/network/volume_force.hpp>

#include "elastostatic_setup.hpp"

namespace trocar::tissue {
namespace {

/// On nodes, by springs, minus: what K u is at first order [N].
std::vector<double> resisting(const NetworkDescription& d, const std::vector<double>& u) {
  std::vector<double> f(u.size(), 0.0);
  for (const SpringDescription& e : d.springs) {
    const auto x = [&](int node) {
      const double* const at = u.data() + 3 * node;
      return d.positions[std::size_t(node)] + Vec3d{at[0], at[1], at[2]};
    };
    const Vec3d r = x(e.b) - x(e.a);
    const double now = length(r), strain = now / e.rest_length - 1;
    const Vec3d s = (e.k * e.rest_length * SpringLaw{e.p1, e.p2, e.cap}.shape(strain) / now) * r;
    for (int axis = 0; axis < 3; ++axis)
      f[std::size_t(3 * e.a + axis)] -= s[axis], f[std::size_t(3 * e.b + axis)] += s[axis];
  }
  return f;
}

void expect_tangent(NetworkDescription d, double tolerance) {
  StiffnessBuilder builder(d.positions, {});
  builder.add_springs(d.springs);
  const Stiffness k = builder.build();
  std::vector<double> u = test::random_numbers(3 * d.positions.size(), 2), product(u.size()), slope;
  multiply(k, u.data(), product.data());
  constexpr double kStep = 1e-9;  // the law's slope has a kink at rest: 2 P1 times the strain
  for (double& x : u) x *= kStep;
  const std::vector<double> there = resisting(d, u);
  for (double& x : u) x = -x;
  const std::vector<double> back = resisting(d, u);
  for (std::size_t i = 0; i < u.size(); ++i) slope.push_back((there[i] - back[i]) / (2 * kStep));
  EXPECT_LT(test::relative_difference(product, slope), tolerance);
}

TEST(SpringStiffness, IsTheSlopeOfTheNetworksForces) {
  NetworkDescription d = test::wobbly_block(3, 3, 4);
  expect_tangent(d, 1e-6);
  for (SpringDescription& e : d.springs)
    e.rest_length = length(d.positions[std::size_t(e.b)] - d.positions[std::size_t(e.a)]);
  expect_tangent(d, 1e-6);
}

TEST(SpringStiffness, AnchorsAndHeldAxesStandWhereTheyShould) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}};
  const std::vector<std::uint8_t> held{kFree, kHeldX};
  StiffnessBuilder builder(points, held);
  const SpringDescription spring{.a = 1, .b = 0, .rest_length = 1, .k = 3};
  const Anchor anchor{.node = 1, .k = 2, .x0 = {}};
  builder.add_springs({&spring, 1});
  builder.add_anchors({&anchor, 1});
  const double x[] = {1, 1, 1, 5, 1, 1};
  double y[6];
  multiply(builder.build(), x, y);
  const double expected[] = {3, 0, 0, 0, 2, 2};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(y[i], expected[i]) << i;
}

/// A soft block that stands under its own weight, its lowest layer held, its rest lengths as prestress() has them.
struct StandingBlock {
  NetworkDescription d;
  NetworkModel model;
  NetworkState rest;
  NetworkWork work;
  int pushed = 0;  ///< the middle of the top

  StandingBlock() {
    const BoxLattice box = box_lattice(4, 4, 5, 0.01);
    d = lattice_network(
            box.corners, box.cells, {},
            {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.35, .damping_time = 4e-3})
            .network;
    for (std::size_t i = 0; i < 25; ++i) d.fixed[i] = kHeld;
    d.gravity = {0, 0, -9.81};
    d.global_damping = 1;
    EXPECT_TRUE(prestress(d).converged);
    pushed = box.corner(2, 2, 5);
    model = build(d, 1e-3);
    rest = rest_state(model);
    work = make_work(model);
    run(rest, {});
  }
  void run(NetworkState& state, std::span<const NodeLoad> loads) {
    for (int i = 0; i < 4000; ++i) ASSERT_TRUE(advance(model, loads, {}, state, work).fine());
  }
  /// How far a force moves a node on the mean of its two directions [m/N].
  Vec3d answer(Vec3d force, int node) {
    Vec3d moved[2];
    for (int i = 0; i < 2; ++i) {
      NetworkState state = rest;
      const NodeLoad load{.node = pushed, .f0 = vec_cast<float>((i == 0 ? 1.0 : -1.0) * force)};
      run(state, {&load, 1});
      moved[i] = position(model, state, node);
    }
    return (moved[0] - moved[1]) / (2 * length(force));
  }
};

TEST(SpringStiffness, AnOrganUnderItsWeightAnswersAsTheDynamicNetworkDoes) {
  StandingBlock block;
  StiffnessBuilder builder(block.d.positions, block.d.fixed);
  builder.add_springs(block.d.springs);
  const int beside = block.pushed - 1;
  const std::vector<double> c = condense(builder.build(), std::vector<int>{beside, block.pushed}).compliance;
  const double force = 0.002;  // 40 um
  EXPECT_NEAR(c[5 * 6 + 5] / block.answer({0, 0, force}, block.pushed).z, 1, 0.01);
  EXPECT_NEAR(c[5 * 6 + 2] / block.answer({0, 0, force}, beside).z, 1, 0.01);
  EXPECT_NEAR(c[3 * 6 + 3] / block.answer({force, 0, 0}, block.pushed).x, 1, 0.01)
      << "sideways, where springs' push counts";
}

/// K's forces under a uniform strain are those of a uniform stress: none inside, sigma n A at the faces.
TEST(TetStiffness, PassesThePatchTest) {
  BoxLattice box = box_lattice(4, 3, 3, 0.01);
  core::Random random(4);
  for (int z = 1; z < 3; ++z)
    for (int y = 1; y < 3; ++y)
      for (int x = 1; x < 4; ++x)
        for (int axis = 0; axis < 3; ++axis)
          box.corners[std::size_t(box.corner(x, y, z))][axis] += random.uniform(-1e-3, 1e-3);
  constexpr double kYoung = 8e3, kPoisson = 0.4;
  StiffnessBuilder builder(box.corners, {});
  builder.add_tetrahedra(test::tets_of(box), kYoung, kPoisson);
  const Mat3d gradient{{{0.01, 0.004, -0.003}, {0.002, -0.02, 0.005}, {0.001, 0.007, 0.015}}};
  std::vector<double> u, f(3 * box.corners.size());
  for (const Vec3d& p : box.corners)
    for (int axis = 0; axis < 3; ++axis) u.push_back((gradient * p)[axis]);
  multiply(builder.build(), u.data(), f.data());
  const double lambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson)), mu = kYoung / (2 * (1 + kPoisson));
  const Mat3d stress = (lambda * trace(gradient)) * Mat3d::identity() + mu * (gradient + transposed(gradient));
  Vec3d right{}, top{};
  for (std::size_t i = 0; i < box.corners.size(); ++i) {
    const Vec3d p = box.corners[i], force{f[3 * i], f[3 * i + 1], f[3 * i + 2]};
    const bool inside = p.x > 1e-3 && p.x < 0.039 && p.y > 1e-3 && p.y < 0.029 && p.z > 1e-3 && p.z < 0.029;
    if (inside) {
      EXPECT_LT(length(force), 1e-13) << i;
    }
    right += p.x * force, top += p.z * force;  // sum of x f = volume * stress
  }
  const double volume = 0.04 * 0.03 * 0.03;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(right[axis], volume * stress.m[axis][0], 1e-10 * volume * kYoung);
    EXPECT_NEAR(top[axis], volume * stress.m[axis][2], 1e-10 * volume * kYoung);
  }
}

TEST(TetStiffness, FibresStiffenAlongThemselvesOnly) {
  const BoxLattice box = box_lattice(2, 2, 2, 0.01);
  const auto energy = [&](double ratio, int axis) {
    StiffnessBuilder builder(box.corners, {});
    builder.add_tetrahedra(test::tets_of(box), 1e3, 0, {0, 0, 1}, ratio);
    std::vector<double> u(3 * box.corners.size(), 0.0), f(u.size());
    for (std::size_t i = 0; i < box.corners.size(); ++i) u[3 * i + std::size_t(axis)] = 0.01 * box.corners[i][axis];
    multiply(builder.build(), u.data(), f.data());
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * f[i];
    return sum;
  };
  EXPECT_NEAR(energy(2.5, 2) / energy(1, 2), 2.5, 1e-9);
  EXPECT_NEAR(energy(2.5, 0) / energy(1, 0), 1, 1e-9);
}

TEST(TetStiffness, RefusesWhatHasNoVolume) {
  const BoxLattice box = box_lattice(1, 1, 1, 0.01);
  StiffnessBuilder builder(box.corners, {});
  const std::array<int, 4> flat{0, 1, 2, 3};
  EXPECT_THROW(builder.add_tetrahedra({&flat, 1}, 1e3, 0.3), std::invalid_argument);
}

/// A uniform swelling by the factor 1 + 3 s costs kappa / 2 (3 s)^2 a volume, a shear nothing.
TEST(VolumeStiffness, IsKappaTimesTheChangeOfVolume) {
  const BoxLattice box = box_lattice(3, 3, 3, 0.01);
  constexpr double kKappa = 7e3, kStrain = 0.01;
  StiffnessBuilder builder(box.corners, {});
  builder.add_volume(test::tets_of(box), kKappa);
  const Stiffness k = builder.build();
  std::vector<double> swollen, sheared, f(3 * box.corners.size());
  for (const Vec3d& p : box.corners)
    for (int axis = 0; axis < 3; ++axis)
      swollen.push_back(kStrain * p[axis]), sheared.push_back(axis == 0 ? kStrain * p.y : 0);
  const auto energy = [&](const std::vector<double>& u) {
    multiply(k, u.data(), f.data());
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += 0.5 * u[i] * f[i];
    return sum;
  };
  const double volume = 0.03 * 0.03 * 0.03;
  EXPECT_NEAR(energy(swollen) / (0.5 * kKappa * 9 * kStrain * kStrain * volume), 1, 1e-9);
  EXPECT_NEAR(energy(sheared), 0, 1e-12 * energy(swollen) + 1e-20);
}

}  // namespace
}  // namespace trocar::tissue
