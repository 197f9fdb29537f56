// The condensed compliance of an organ's surface, held against the whole system, theory, and itself   [KCM99 eq.6]
#include <cstring>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/tissue/elastostatic/compliance_check.hpp>
#include <trocar/tissue/elastostatic/dense_kernels.hpp>
#include <trocar/tissue/elastostatic/front.hpp>

#include "elastostatic_setup.hpp"

namespace trocar::tissue {
namespace {

using test::Organ;
using test::relative_difference;

constexpr double kPi = 3.14159265358979323846;

/// C f of all nodes, from the compliance that has them all.
std::vector<double> full_solution(const Stiffness& k, const std::vector<double>& f) {
  return test::product(condense(k, test::all_nodes(k)).compliance, f);
}
bool held(const Stiffness& k, std::size_t unknown) { return k.held[unknown / 3] >> (unknown % 3) & 1; }

TEST(Condensation, TheFullSolutionLeavesNoResidual) {  // K u = f [KCM99 eq.6]
  const Organ organ = test::wobbly_organ(5, 4, 6);
  std::vector<double> f = test::random_numbers(3 * organ.k.points.size(), 3), back(f.size());
  for (std::size_t i = 0; i < f.size(); ++i)
    if (held(organ.k, i)) f[i] = 0;
  multiply(organ.k, full_solution(organ.k, f).data(), back.data());
  EXPECT_LT(relative_difference(back, f), 1e-8);
}

TEST(Condensation, InteriorFreeEqualsTheFullSolution) {  // [KCM99 eq.7]
  const Organ organ = test::wobbly_organ(6, 6, 7);
  const std::vector<double> own = test::random_numbers(3 * organ.kept.size(), 5);
  std::vector<double> f(3 * organ.k.points.size(), 0.0), whole;
  for (std::size_t i = 0; i < own.size(); ++i) f[std::size_t(3 * organ.kept[i / 3]) + i % 3] = own[i];
  const std::vector<double> all = full_solution(organ.k, f);
  for (const int node : organ.kept)
    for (int axis = 0; axis < 3; ++axis) whole.push_back(all[std::size_t(3 * node + axis)]);
  const Condensed c = condense(organ.k, organ.kept);
  EXPECT_LT(relative_difference(test::product(c.compliance, own), whole), 1e-8);
}

TEST(Condensation, FieldsOfLoadsOnInnerNodesAreWhatTheFullSolutionSays) {  // [KCM99 eq.8]
  const Organ organ = test::wobbly_organ(6, 5, 5);
  const std::size_t n = 3 * organ.k.points.size();
  const std::vector<double> loads = test::random_numbers(2 * n, 7);
  const Condensed c = condense(organ.k, organ.kept, loads);
  ASSERT_EQ(c.fields.size(), 6 * organ.kept.size());
  for (std::size_t load = 0; load < 2; ++load) {
    const std::vector<double> all =
        full_solution(organ.k, {loads.begin() + long(load * n), loads.begin() + long((load + 1) * n)});
    std::vector<double> whole, field(c.fields.begin() + long(load * 3 * organ.kept.size()),
                                     c.fields.begin() + long((load + 1) * 3 * organ.kept.size()));
    for (const int node : organ.kept)
      for (int axis = 0; axis < 3; ++axis) whole.push_back(all[std::size_t(3 * node + axis)]);
    EXPECT_LT(relative_difference(field, whole), 1e-8);
  }
}

TEST(Condensation, FieldsOfTwoLoadsAddUpToThatOfTheirSum) {
  const Organ organ = test::wobbly_organ(4, 4, 4);
  const std::size_t n = 3 * organ.k.points.size(), m = 3 * organ.kept.size();
  std::vector<double> loads = test::random_numbers(3 * n, 9);
  for (std::size_t i = 0; i < n; ++i) loads[2 * n + i] = loads[i] - 2.5 * loads[n + i];
  const Condensed c = condense(organ.k, organ.kept, loads);
  std::vector<double> sum, whole(c.fields.begin() + long(2 * m), c.fields.end());
  for (std::size_t i = 0; i < m; ++i) sum.push_back(c.fields[i] - 2.5 * c.fields[m + i]);
  EXPECT_LT(relative_difference(sum, whole), 1e-8);
}

TEST(Condensation, ComplianceIsReciprocalAndPositive) {  // Betti 1872
  const Organ organ = test::wobbly_organ(5, 5, 5);
  const Condensed c = condense(organ.k, organ.kept), slow = condense_by_unit_forces(organ.k, organ.kept);
  const std::size_t n = 3 * organ.kept.size();
  double most = 0, apart = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      EXPECT_EQ(c.compliance[i * n + j], c.compliance[j * n + i]);
      apart = std::max(apart, std::fabs(slow.compliance[i * n + j] - slow.compliance[j * n + i]));
      most = std::max(most, std::fabs(slow.compliance[i * n + j]));
    }
  EXPECT_LT(apart, 1e-8 * most) << "by unit forces it is not symmetric by construction";
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const std::vector<double> f = test::random_numbers(n, seed), u = test::product(c.compliance, f);
    double work = 0;
    for (std::size_t i = 0; i < n; ++i) work += f[i] * u[i];
    EXPECT_GT(work, 0);
  }
}

TEST(Condensation, UnitForcesAgree) {
  const Organ organ = test::wobbly_organ(5, 4, 5);
  EXPECT_LT(relative_difference(condense(organ.k, organ.kept).compliance,
                                condense_by_unit_forces(organ.k, organ.kept).compliance),
            1e-8);
}

TEST(Condensation, HeldAxesDoNotMoveAndNothingMovesByThem) {
  const Organ organ = test::wobbly_organ(4, 4, 4);
  const Condensed c = condense(organ.k, organ.kept);
  const std::size_t n = 3 * organ.kept.size();
  int seen = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!held(organ.k, std::size_t(3 * organ.kept[i / 3]) + i % 3)) continue;
    ++seen;
    for (std::size_t j = 0; j < n; ++j) EXPECT_EQ(c.compliance[j * n + i], 0.0);
  }
  EXPECT_GT(seen, 70);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(Condensation, EveryInstructionSetAndNumberOfThreadsMakesTheSameBits) {
  const Organ organ = test::wobbly_organ(9, 8, 9);
  const std::vector<double> load = test::random_numbers(3 * organ.k.points.size(), 13);
  const DenseKernels& before = dense_kernels();
  ASSERT_TRUE(use_dense_kernels(dense_kernels_plain()));
  const Condensed plain = condense(organ.k, organ.kept, load);
  for (const DenseKernels* set : {dense_kernels_avx2(), dense_kernels_avx512()}) {
    if (!use_dense_kernels(set)) continue;
    const Condensed wide = condense(organ.k, organ.kept, load);
    EXPECT_TRUE(same_bits(wide.compliance, plain.compliance)) << set->name;
    EXPECT_TRUE(same_bits(wide.fields, plain.fields)) << set->name;
  }
  use_dense_kernels(&before);
  for (const int threads : {1, 2, 4}) {
    core::ThreadPool pool(threads);
    const Condensed many = condense(organ.k, organ.kept, load, &pool);
    EXPECT_TRUE(same_bits(many.compliance, plain.compliance)) << threads;
    EXPECT_TRUE(same_bits(many.fields, plain.fields)) << threads;
  }
}

TEST(Condensation, ProgressGoesFromNothingToAll) {
  const Organ organ = test::wobbly_organ(5, 5, 5);
  std::vector<double> shares;
  condense(organ.k, organ.kept, {}, nullptr, [&](double share) { shares.push_back(share); });
  ASSERT_GT(shares.size(), 3u);
  EXPECT_EQ(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
}

/// A chain of nodes along x.
Stiffness chain(const std::vector<double>& k, std::span<const Anchor> anchors,
                const std::vector<std::uint8_t>& fixed = {}) {
  std::vector<Vec3d> points;
  std::vector<SpringDescription> springs;
  for (std::size_t i = 0; i <= k.size(); ++i) points.push_back({0.01 * double(i), 0, 0});
  for (std::size_t i = 0; i < k.size(); ++i)
    springs.push_back({.a = int(i), .b = int(i) + 1, .rest_length = 0.01, .k = k[i]});
  StiffnessBuilder builder(points, fixed);
  builder.add_springs(springs);
  builder.add_anchors(anchors);
  return builder.build();
}
constexpr std::uint8_t kLineOnly = kHeldY | kHeldZ;

TEST(Condensation, OneNodeAndNoneAndOnlyHeldOnes) {
  const Anchor anchor{.node = 0, .k = 4, .x0 = {}};
  const Stiffness one = chain({}, {&anchor, 1});
  const int node = 0;
  const Condensed c = condense(one, {&node, 1}, std::vector<double>{1, 2, 3});
  EXPECT_EQ(c.compliance, (std::vector<double>{0.25, 0, 0, 0, 0.25, 0, 0, 0, 0.25}));
  EXPECT_EQ(c.fields, (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_TRUE(condense(one, {}).compliance.empty());
  const Stiffness fixed = chain({5}, {}, {kHeld, kHeld});
  EXPECT_EQ(condense(fixed, test::all_nodes(fixed)).compliance, std::vector<double>(36, 0.0));
  EXPECT_TRUE(condense(Stiffness{{}, {}, {0}, {}, {}}, {}).compliance.empty());
}

TEST(Condensation, SpringsInARowAddUp) {
  const Stiffness k = chain({2, 4, 8}, {}, {kHeld, kLineOnly, kLineOnly, kLineOnly});
  const int last = 3;
  EXPECT_NEAR(condense(k, {&last, 1}).compliance[0], 0.5 + 0.25 + 0.125, 1e-14);
}

void expect_not_held(const Stiffness& k, const std::vector<int>& kept) { EXPECT_THROW(condense(k, kept), NotHeld); }

TEST(Condensation, ABodyThatNothingHoldsIsRefused) {
  const BoxLattice box = box_lattice(6, 5, 5, 0.01);
  StiffnessBuilder builder(box.corners, {});
  builder.add_springs(
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = 5e3, .density = 1000}).network.springs);
  Organ organ{builder.build(), test::surface_of_box(6, 5, 5)};
  expect_not_held(organ.k, organ.kept);
  expect_not_held(organ.k, test::all_nodes(organ.k));
  expect_not_held(organ.k, {});
  organ.k.held[0] = kHeld;
  expect_not_held(organ.k, organ.kept);  // it still turns about it
}

TEST(Condensation, OfTwoLoosePartsTheOneThatNothingHoldsIsNamed) {
  const std::vector<std::uint8_t> fixed{kHeld, kLineOnly, kLineOnly, kLineOnly};
  const Stiffness k = chain({3, 0, 3}, {}, fixed);
  for (const std::vector<int>& kept : {std::vector<int>{0, 1}, {1, 3}, {}, {0, 1, 2, 3}}) {
    try {
      condense(k, kept);
      ADD_FAILURE() << "was condensed";
    } catch (const NotHeld& e) {
      EXPECT_TRUE(e.node == 2 || e.node == 3) << e.what();
    }
  }
  const Anchor anchor{.node = 2, .k = 1, .x0 = {}};
  const Stiffness both = chain({3, 0, 3}, {&anchor, 1}, fixed);
  const Condensed c = condense(both, std::vector<int>{1, 3});
  EXPECT_NEAR(c.compliance[0], 1.0 / 3, 1e-14);
  EXPECT_NEAR(c.compliance[21], 1 + 1.0 / 3, 1e-14);
  EXPECT_EQ(c.compliance[3], 0);
}

TEST(Condensation, WhatIsNoNumberIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {nan, infinite, -infinite}) {
    for (const std::size_t entry : {std::size_t(0), std::size_t(400), std::size_t(401)}) {
      Organ organ = test::wobbly_organ(5, 5, 5);
      std::fill(organ.k.held.begin(), organ.k.held.end(), std::uint8_t(kFree));
      for (int i = 0; i < organ.k.nodes(); ++i)
        organ.k.block[std::size_t(organ.k.first[std::size_t(i) + 1] - 1)] =
            organ.k.block[std::size_t(organ.k.first[std::size_t(i) + 1] - 1)] + Mat3d::identity();
      condense(organ.k, organ.kept);
      organ.k.block[entry].m[1][0] = wrong;
      expect_not_held(organ.k, organ.kept);
    }
    Organ organ = test::wobbly_organ(3, 3, 3);
    organ.k.points[20].x = wrong;
    expect_not_held(organ.k, organ.kept);
  }
  const Organ organ = test::wobbly_organ(2, 2, 2);
  std::vector<double> load(3 * organ.k.points.size(), 0.0);
  load[70] = nan;
  EXPECT_THROW(condense(organ.k, organ.kept, load), std::invalid_argument);
}

TEST(Condensation, KeptNodesOutOfOrderAreRefused) {
  const Organ organ = test::wobbly_organ(2, 2, 2);
  for (const std::vector<int>& kept : {std::vector<int>{2, 1}, {1, 1}, {-1}, {27}})
    EXPECT_THROW(condense(organ.k, kept), std::invalid_argument);
}

TEST(Condensation, SliversDoNoHarm) {
  BoxLattice box = box_lattice(4, 4, 4, 0.01);
  box.corners[std::size_t(box.corner(2, 2, 2))].z = box.corners[std::size_t(box.corner(2, 2, 1))].z + 1e-8;
  std::vector<std::uint8_t> fixed(box.corners.size(), kFree);
  for (std::size_t i = 0; i < 25; ++i) fixed[i] = kHeld;
  StiffnessBuilder builder(box.corners, fixed);
  builder.add_tetrahedra(test::tets_of(box), 5e3, 0.4);
  const Stiffness k = builder.build();
  const std::vector<int> kept = test::surface_of_box(4, 4, 4);
  const Condensed c = condense(k, kept), whole = condense(k, test::all_nodes(k));
  std::vector<double> part;
  const std::size_t n = 3 * k.points.size();
  for (std::size_t j = 0; j < 3 * kept.size(); ++j)
    for (std::size_t i = 0; i < 3 * kept.size(); ++i)
      part.push_back(
          whole.compliance[(std::size_t(3 * kept[j / 3]) + j % 3) * n + std::size_t(3 * kept[i / 3]) + i % 3]);
  EXPECT_LT(relative_difference(c.compliance, part), 1e-8);
}

TEST(Condensation, MemoryIsNotUnderstated) {
  for (const auto& [nx, ny, nz] :
       {std::array{4, 4, 4}, {12, 12, 12}, {19, 19, 17}, {60, 8, 8}, {40, 30, 3}, {1, 1, 1}}) {
    const Organ organ = test::wobbly_organ(nx, ny, nz);
    const double needed = memory_of(dissect(organ.k, organ.kept), 1);
    const double said = memory_to_condense(organ.k.nodes(), int(organ.kept.size()));
    EXPECT_GE(said, needed) << nx << " x " << ny << " x " << nz;
    EXPECT_LE(said, 3.5 * needed + 4e6) << nx << " x " << ny << " x " << nz;
  }
}

/// A quarter of a half-space of tetrahedra, z = 0 its surface; the surface near the origin is kept.
struct QuarterSpace {
  static constexpr int kCells = 22, kNear = 9;
  static constexpr double kCell = 0.001, kYoung = 10e3, kPoisson = 0.3;
  static constexpr double kGrowth = 0.2;
  BoxLattice box = box_lattice(kCells, kCells, kCells, kCell, {0, 0, -kCells* kCell});
  std::vector<int> kept;
  Condensed c;
  QuarterSpace() {
    // Finer near the origin: the far faces are three hundred cells away.
    for (Vec3d& p : box.corners)
      for (int axis = 0; axis < 3; ++axis) p[axis] = graded(p[axis]);
    std::vector<std::uint8_t> fixed(box.corners.size(), kFree);
    const double far = graded(kCells * kCell) - 1e-9;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      const Vec3d p = box.corners[i];
      if (p.x == 0) fixed[i] |= kHeldX;
      if (p.y == 0) fixed[i] |= kHeldY;
      if (p.x > far || p.y > far || p.z < -far) fixed[i] = kHeld;
    }
    StiffnessBuilder builder(box.corners, fixed);
    builder.add_tetrahedra(test::tets_of(box), kYoung, kPoisson);
    for (int j = 0; j < kNear; ++j)
      for (int i = 0; i < kNear; ++i) kept.push_back(box.corner(i, j, kCells));
    c = condense(builder.build(), kept);
  }
  static double graded(double x) {
    const double s = std::fabs(x) / kCell;
    return std::copysign(kCell * (s <= 8 ? s : s + 0.5 * (s - 8) * (s - 8) * (kGrowth * (s - 8))), x);
  }
  double down(std::size_t i, std::size_t j) const { return c.compliance[(3 * j + 2) * 3 * kept.size() + 3 * i + 2]; }
  Vec3d at(std::size_t i) const { return box.corners[std::size_t(kept[i])]; }
  static double contact_modulus() { return kYoung / (1 - kPoisson * kPoisson); }
};
const QuarterSpace& quarter_space() {
  static const QuarterSpace q;
  return q;
}

TEST(Condensation, APointForceMakesBoussinesqsSurface) {  // [Boussinesq 1885]
  const QuarterSpace& q = quarter_space();
  for (std::size_t i = 3; i <= 6; ++i) {
    const double r = q.at(i).x, theory = 4 / (kPi * q.contact_modulus() * r);  // four quarters with a newton each
    EXPECT_NEAR(q.down(i, 0) / theory, 1, 0.1) << r;
  }
}

/// Forces of a quarter's nodes that a rigid sphere presses by `deep`, none pulling: projected Gauss-Seidel.
double sphere_force(const QuarterSpace& q, double radius, double deep) {
  const std::size_t n = q.kept.size();
  std::vector<double> f(n, 0.0);
  for (int round = 0; round < 3000; ++round)
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d p = q.at(i);
      double gap = (p.x * p.x + p.y * p.y) / (2 * radius) - deep;
      for (std::size_t j = 0; j < n; ++j) gap += q.down(i, j) * f[j];
      f[i] = std::max(0.0, f[i] - gap / q.down(i, i));
    }
  double sum = 0;
  for (const double x : f) sum += x;
  return 4 * sum;
}

TEST(Condensation, ASphereIsBorneAsHertzSays) {  // [Hertz 1882]
  const QuarterSpace& q = quarter_space();
  const double radius = 0.03, deep = 0.0006;  // a contact of 4.2 mm
  const double theory = 4.0 / 3 * q.contact_modulus() * std::sqrt(radius) * deep * std::sqrt(deep);
  EXPECT_NEAR(sphere_force(q, radius, deep) / theory, 1, 0.1);
}

TEST(Condensation, IsFoundToBeTheBodysAlsoWithFieldsAndHeldAxes) {
  const Organ organ = test::wobbly_organ(6, 6, 7);
  const std::vector<double> loads = test::random_numbers(15 * 3 * organ.k.points.size(), 3);
  const Condensed c = condense(organ.k, organ.kept, loads);
  const std::vector<float> columns(c.compliance.begin(), c.compliance.end());
  std::vector<float> fields(c.fields.begin(), c.fields.end());
  EXPECT_EQ(fault_of_compliance(organ.k, organ.kept, loads, columns, fields), "");
  for (float& v : fields) v *= 1.1f;
  EXPECT_NE(fault_of_compliance(organ.k, organ.kept, loads, columns, fields), "");
}

}  // namespace
}  // namespace trocar::tissue
