// The elastostatic solver's tick: what is prescribed is met, loads superpose, contacts do not pull, frames turn.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/elastostatic/elastostatic.hpp>
#include <trocar/tissue/elastostatic/field_kernels.hpp>

#include "linear_solve.hpp"
#include "test_bodies.hpp"

namespace trocar::tissue {
namespace {

/// A block of cells, without gravity, whose every node is kept: compliance by unit forces.
struct Block {
  NetworkDescription d;
  std::vector<Anchor> anchors;
  NetworkModel network;
  ElastostaticModel model;
  std::vector<NodeState> rows;
  ElastostaticState state;
  ElastostaticWork work;
  std::vector<Vec3f> reactions;

  explicit Block(double hung_by = 0) {  ///< [N/m] each of 16 springs; 0: held rigidly
    const bool hung = hung_by > 0;
    const BoxLattice box = box_lattice(3, 3, 2, 0.01, {0.02, -0.03, 0.1});
    d = lattice_network(box.corners, box.cells, {}, {.youngs_modulus = 5.4e3, .density = 1060}).network;
    const int n = int(d.positions.size());
    for (int i = 0; i < 16; ++i) {
      if (hung)
        anchors.push_back({i, hung_by, d.positions[size_t(i)]});
      else
        d.fixed[size_t(i)] = kHeld;
    }
    network = build(d, 1e-3);
    Vec3d centre{0, 0, 0};
    std::vector<int> kept;
    for (int i = 0; i < n; ++i) kept.push_back(i), centre += d.positions[size_t(i)] / double(n);
    std::vector<float> c, fields;
    for (int j = 0; j < 3 * n; ++j) {
      std::vector<double> f(size_t(3 * n), 0.0);
      f[size_t(j)] = 1;
      append(answer(f), c);
    }
    if (hung) {
      const std::vector<double> loads = frame_loads(d.positions, d.mass, anchors, centre);
      for (int i = 0; i < kFrameFields; ++i)
        append(answer({loads.begin() + i * 3 * n, loads.begin() + (i + 1) * 3 * n}), fields);
    }
    model = make_elastostatic({d.positions, d.fixed, network.row_of_node, network.origin, d.gravity}, kept, c, fields,
                              1e-3);
    rows = tissue::rest_state(network).nodes;
    state = tissue::rest_state(model);
    work = make_work(model, 512);
  }

  static void append(const std::vector<double>& from, std::vector<float>& to) {
    to.insert(to.end(), from.begin(), from.end());
  }

  void multiply(const double* x, double* y) const {
    const int n = int(d.positions.size());
    std::vector<Vec3d> u;
    for (int i = 0; i < n; ++i) u.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    const std::vector<Vec3d> f = forces(d, u);
    for (int i = 0; i < 3 * n; ++i) y[i] = f[size_t(i / 3)][i % 3];
    for (const Anchor& a : anchors)
      for (int k = 0; k < 3; ++k) y[3 * a.node + k] += a.k * x[3 * a.node + k];
    for (int i = 0; i < 3 * n; ++i)
      if (d.fixed[size_t(i / 3)]) y[i] = x[i];
  }

  std::vector<double> answer(std::vector<double> f) const {
    const int n = int(f.size());
    for (int i = 0; i < n; ++i)
      if (d.fixed[size_t(i / 3)]) f[size_t(i)] = 0;
    std::vector<double> u(size_t(n), 0.0);
    numerics::ConjugateGradientWork cg(n);
    conjugate_gradient([this](const double* x, double* y) { multiply(x, y); }, numerics::NoPreconditioner{}, f.data(),
                       u.data(), n, {.iterations = 5000, .relative_residual = 1e-12}, cg);
    return u;
  }

  int far_corner() const { return int(d.positions.size()) - 1; }
  Vec3d at(int node) const { return place_of(model, state, node); }

  StepReport tick(const std::vector<NodeLoad>& loads) {
    std::vector<std::int32_t> point;
    for (size_t i = 0; i < loads.size(); ++i) point.push_back(std::int32_t(i));
    reactions.assign(loads.size(), {});
    return advance(model, loads, point, reactions, {}, state, rows, work);
  }
  void settle(const std::vector<NodeLoad>& loads, int ticks = 400) {
    for (int i = 0; i < ticks; ++i) ASSERT_TRUE(tick(loads).fine());
  }
};

NodeLoad held_at(int node, Vec3d place) { return {.node = node, .k = 1e9f, .x0 = vec_cast<float>(place)}; }
NodeLoad pushed(int node, Vec3f f) { return {.node = node, .f0 = f}; }

double size_of(Vec3f f) { return length(vec_cast<double>(f)); }

TEST(Elastostatic, WithoutLoadsItStaysWhereItIsDrawn) {
  Block b;
  b.settle({}, 10);
  for (int i = 0; i <= b.far_corner(); ++i) EXPECT_EQ(length(b.at(i) - b.d.positions[size_t(i)]), 0);
}

TEST(Elastostatic, AForceMovesItToKInverseTimesForce) {
  Block b;
  std::vector<double> f(3 * b.d.positions.size(), 0.0);
  f[size_t(3 * b.far_corner() + 2)] = 0.01;
  const std::vector<double> u = b.answer(f);
  b.settle({pushed(b.far_corner(), {0, 0, 0.01f})});
  double most = 0, error = 0;
  for (int i = 0; i <= b.far_corner(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double x = (b.at(i) - b.d.positions[size_t(i)])[k];
      most = std::max(most, std::fabs(x));
      error = std::max(error, std::fabs(x - u[size_t(3 * i + k)]));
    }
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(error, 1e-5 * most);
}

TEST(Elastostatic, APrescribedNodeIsHitInEveryTick) {
  Block b;
  const int node = b.far_corner();
  const Vec3d drawn = b.d.positions[size_t(node)];
  for (int i = 1; i <= 50; ++i) {
    const Vec3d place = drawn + Vec3d{2e-5 * i, 0, 4e-5 * i};
    b.tick({held_at(node, place)});
    EXPECT_LT(length(b.at(node) - place), 2e-7) << i;
  }
}

TEST(Elastostatic, AtRestTheForceAtThePrescribedNodeIsTheOneThatMovesItThere) {
  Block b;
  const int node = b.far_corner();
  b.settle({held_at(node, b.d.positions[size_t(node)] + Vec3d{0, 0, 0.001})});
  std::vector<double> f(3 * b.d.positions.size(), 0.0);
  for (int k = 0; k < 3; ++k) f[size_t(3 * node + k)] = double(b.reactions[0][k]);
  EXPECT_NEAR(b.answer(f)[size_t(3 * node + 2)], 0.001, 1e-6);
}

TEST(Elastostatic, LoadsSuperpose) {
  Block one, two, both;
  const NodeLoad p = pushed(one.far_corner(), {0.004f, 0, 0}), q = pushed(one.far_corner() - 3, {0, -0.006f, 0.002f});
  one.settle({p});
  two.settle({q});
  both.settle({p, q});
  for (int i = 0; i <= both.far_corner(); ++i) {
    const Vec3d drawn = both.d.positions[size_t(i)];
    const Vec3d sum = one.at(i) + two.at(i) - 2.0 * drawn;
    EXPECT_LT(length(both.at(i) - drawn - sum), 1e-8);
  }
}

TEST(Elastostatic, APointBetweenNodesIsHeldByItsShares) {
  Block b;
  const int i = b.far_corner(), j = i - 1;
  const Vec3d drawn = 0.25 * b.d.positions[size_t(i)] + 0.75 * b.d.positions[size_t(j)];
  const Vec3d place = drawn + Vec3d{0, 0.0004, 0.0004};
  NodeLoad a = held_at(i, place), c = held_at(j, place);
  a.k *= 0.25f, c.k *= 0.75f;
  const Vec3f shift = vec_cast<float>(place - drawn);
  const std::vector<std::int32_t> same{7, 7};
  for (int t = 0; t < 30; ++t) {
    // Both shares pull by the same way from where their nodes are.
    a.x0 = vec_cast<float>(b.at(i)) + vec_cast<float>(place - 0.25 * b.at(i) - 0.75 * b.at(j));
    c.x0 = vec_cast<float>(b.at(j)) + vec_cast<float>(place - 0.25 * b.at(i) - 0.75 * b.at(j));
    b.reactions.assign(2, {});
    const std::vector<NodeLoad> loads{a, c};
    advance(b.model, loads, same, b.reactions, {}, b.state, b.rows, b.work);
  }
  EXPECT_GT(length(vec_cast<double>(shift)), 0);
  EXPECT_LT(length(0.25 * b.at(i) + 0.75 * b.at(j) - place), 1e-6);
  EXPECT_NEAR(3 * size_of(b.reactions[0]), size_of(b.reactions[1]), 1e-4 * size_of(b.reactions[1]));
}

TEST(Elastostatic, AContactPushesAndNeverPulls) {
  Block b;
  const int node = b.far_corner();
  NodeLoad contact = held_at(node, b.d.positions[size_t(node)] + Vec3d{0, 0, -0.001});
  contact.dir = {0, 0, -1};
  contact.k = 1500;
  b.settle({contact});
  EXPECT_LT(b.reactions[0].z, -0.001f);
  EXPECT_EQ(b.reactions[0].x, 0);
  contact.x0 = vec_cast<float>(b.d.positions[size_t(node)] + Vec3d{0, 0, 0.001});  // drawn back
  b.settle({contact});
  EXPECT_EQ(b.reactions[0].z, 0);
  EXPECT_LT(length(b.at(node) - b.d.positions[size_t(node)]), 1e-7);
}

TEST(Elastostatic, OfTwoContactsTheOneThatWouldPullIsLeftOut) {
  Block b;
  const int far = b.far_corner(), beside = far - 1;
  NodeLoad deep = held_at(far, b.d.positions[size_t(far)] + Vec3d{0, 0, -0.002});
  deep.dir = {0, 0, -1};
  NodeLoad shallow = held_at(beside, b.d.positions[size_t(beside)] + Vec3d{0, 0, -0.0001});
  shallow.dir = {0, 0, -1};
  b.settle({deep, shallow});
  EXPECT_LT(b.reactions[0].z, 0);
  EXPECT_EQ(b.reactions[1].z, 0);
  EXPECT_LT(b.at(beside).z, b.d.positions[size_t(beside)].z - 0.0001);
}

TEST(Elastostatic, LetGoFromAFarPullItGoesBackWithoutAJump) {
  Block b;
  const int node = b.far_corner();
  const Vec3d drawn = b.d.positions[size_t(node)];
  b.settle({held_at(node, drawn + Vec3d{0, 0, 0.012})}, 3000);
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d before = b.at(node);
    b.tick({});
    most = std::max(most, length(b.at(node) - before));
  }
  EXPECT_LT(most, 0.0002);
  EXPECT_LT(length(b.at(node) - drawn), 1e-6);
}

TEST(Elastostatic, AHeldOrganTellsHowFarItHasTurned) {
  Block b;
  const Vec3d axis{0, 1, 0};
  const double angle = 12 * portable::pi / 180;
  std::vector<NodeLoad> all;
  for (int i = 16; i <= b.far_corner(); ++i) {
    const Vec3d r = b.d.positions[size_t(i)] - b.model.centre;
    all.push_back(held_at(i, b.model.centre + rotate(quat_from_axis_angle(axis, angle), r)));
  }
  b.settle(all, 5);
  EXPECT_GT(b.state.turn, 0.6 * angle);
}

TEST(Elastostatic, AHungOrganTurnsByNinetyDegreesWithoutStrain) {
  Block b(0.02);
  // Springs are anchored where they were; a firm grip on three nodes turns all of it.
  const int grips[3] = {b.far_corner(), b.far_corner() - 3, b.far_corner() - 12};
  for (int degree = 1; degree <= 90; ++degree)
    for (int t = 0; t < 20; ++t) {
      const Quatd q = quat_from_axis_angle(Vec3d{0, 0, 1}, degree * portable::pi / 180);
      std::vector<NodeLoad> loads;
      for (const int g : grips)
        loads.push_back(held_at(g, b.model.centre + rotate(q, b.d.positions[size_t(g)] - b.model.centre)));
      ASSERT_TRUE(b.tick(loads).fine());
    }
  const Quatd turned{b.state.frame.w, b.state.frame.x, b.state.frame.y, b.state.frame.z};
  EXPECT_NEAR(length(rotation_vector(turned)), portable::pi / 2, 0.02);
  for (int i = 1; i <= b.far_corner(); ++i) {  // edges are as long as drawn
    const double now = length(b.at(i) - b.at(i - 1));
    EXPECT_NEAR(now / length(b.d.positions[size_t(i)] - b.d.positions[size_t(i - 1)]), 1, 0.02) << i;
  }
}

TEST(Elastostatic, AHungOrganUnderAForceRestsWhereItsSpringsBalanceIt) {
  Block b(2.0);
  std::vector<NodeLoad> loads;
  for (int i = 0; i <= b.far_corner(); ++i) loads.push_back(pushed(i, {0, 0, 0.32f / 48}));
  b.settle(loads, 3000);
  double way = 0;
  for (int i = 0; i < 16; ++i) way += (b.at(i) - b.d.positions[size_t(i)]).z / 16;
  EXPECT_NEAR(way, 0.32 / (16 * 2.0), 1e-5);  // all of the force on all of the springs
  EXPECT_NEAR(b.state.frame.shift.x, 0, 1e-4);
}

TEST(Elastostatic, AWholeThatSpringsHoldOnlyReturnsToItsPlace) {
  Block b(2.0);
  b.settle({pushed(b.far_corner(), {0.02f, 0.01f, 0})}, 500);
  EXPECT_GT(length(b.at(0) - b.d.positions[0]), 1e-4);
  b.settle({}, 3000);
  for (int i = 0; i <= b.far_corner(); ++i) EXPECT_LT(length(b.at(i) - b.d.positions[size_t(i)]), 2e-6) << i;
}

std::vector<float> played(const FieldKernels* kernels, bool poisoned) {
  use_field_kernels(kernels);
  Block b;
  const int node = b.far_corner();
  for (int i = 0; i < 60; ++i) {
    NodeLoad contact = held_at(node - 1, b.d.positions[size_t(node - 1)] + Vec3d{0, 0, -2e-5 * i});
    contact.dir = {0, 0, -1};
    b.tick(
        {held_at(node, b.d.positions[size_t(node)] + Vec3d{1e-5 * i, 0, 0}), contact, pushed(node - 2, {0.01f, 0, 0})});
    if (!poisoned) continue;
    for (std::vector<float>* v : {&b.work.start, &b.work.next, &b.work.force})
      for (float& x : *v) x = std::nanf("");
    for (std::vector<double>* v : {&b.work.load_case.factor, &b.work.load_case.compliance, &b.work.load_case.made_for})
      for (double& x : *v) x = std::nan("");
    b.work.load_case.made = 77;
  }
  return b.state.u;
}

TEST(Elastostatic, EveryInstructionSetAndSpoiltScratchGiveTheSameBits) {
  const FieldKernels* before = &field_kernels();
  const std::vector<float> plain = played(field_kernels_plain(), false);
  for (const FieldKernels* k : {field_kernels_plain(), field_kernels_avx2(), field_kernels_avx512()}) {
    if (!k || !use_field_kernels(k)) continue;
    for (const bool poisoned : {false, true}) {
      const std::vector<float> u = played(k, poisoned);
      EXPECT_EQ(std::memcmp(u.data(), plain.data(), 4 * u.size()), 0) << k->name << ' ' << poisoned;
    }
  }
  use_field_kernels(before);
}

TEST(Elastostatic, LoadsOnInnerNodesAndNonsenseAreLeftOutAndSaid) {
  Block b;
  StepReport r = b.tick({pushed(4711, {0, 0, 1}), pushed(3, {std::nanf(""), 0, 0})});
  EXPECT_TRUE(r.flags & StepReport::kBadLoad);
  EXPECT_EQ(r.first_bad, 0);
  EXPECT_EQ(length(b.at(b.far_corner()) - b.d.positions[size_t(b.far_corner())]), 0);
}

}  // namespace
}  // namespace trocar::tissue
