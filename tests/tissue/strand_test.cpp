#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/tissue/strand/strand.hpp>

namespace trocar::tissue {
namespace {

/// A straight strand along x, `n` nodes over `length` metres; the first two nodes prescribed (a clamp).
StrandDescription straight(int n, double length, double radius, double modulus, double lumen = 0) {
  StrandDescription d;
  for (int i = 0; i < n; ++i) d.positions.push_back({length * i / (n - 1), 0, 0});
  d.radius.assign(n - 1, radius);
  if (lumen > 0) d.lumen.assign(n - 1, lumen);
  d.youngs_modulus = modulus;
  d.density = 1050;
  d.law = {0, 0, 1};
  d.prescribed.assign(n, 0);
  d.prescribed[0] = d.prescribed[1] = 1;
  d.damping_time = 2e-3;
  return d;
}

/// A Fallopian tube: E 60 kPa, P1 4, P2 40, wall 1 mm, widening, drawn as an arch, carried by its mesosalpinx.
StrandDescription tube(int n = 34) {
  StrandDescription d;
  for (int i = 0; i < n; ++i) {
    const double s = double(i) / (n - 1);
    d.positions.push_back({0.02 + 0.1 * s, 0.015 * 4 * s * (1 - s), 0.01 * 4 * s * (1 - s)});
  }
  for (int e = 0; e + 1 < n; ++e) {
    d.radius.push_back(0.002 + 0.002 * e / n);
    d.lumen.push_back(0.001);
  }
  d.youngs_modulus = 60e3;
  d.law = {4, 40, 0.8};
  d.density = 1050;
  d.lumen_density = 1000;
  d.added_mass.assign(n, 2e-5);
  d.foundation.assign(n, 0.4);
  d.foundation_stiffening = 1e4;
  d.foundation_damping_time = 0.02;
  d.damping_time = 5e-3;
  d.global_damping = 0.5;
  d.gravity = {0, 0, -9.81};
  d.prescribed.assign(n, 0);
  d.prescribed[0] = d.prescribed[1] = 1;
  return d;
}

std::uint64_t hash_of(const StrandState& s) {
  core::Hasher h;
  add_to_hash(h, s);
  return h.value();
}

struct Trial {
  StrandModel model;
  StrandState state;
  StrandWork work;
  explicit Trial(const StrandDescription& d, double tick = 1e-3)
      : model(build(d, tick)), state(rest_state(model)), work(make_work(model)) {}
  StepReport step(std::span<const StrandLoad> loads = {}, std::span<const StrandEnd> ends = {},
                  std::span<StrandReaction> reactions = {}, std::span<Vec3d> load_reactions = {}) {
    return advance(model, ends, loads, reactions, load_reactions, state, work);
  }
  double farthest_from_rest() const {
    double most = 0;
    for (int i = 0; i < model.nodes; ++i) most = std::max(most, length(state.x[i] - model.rest[i]));
    return most;
  }
};

TEST(Strand, StretchFollowsThePolynomial) {
  // [KCM99 eq.5]: sigma = E eps (1 + P1 eps + P2 eps^2), here pulled along x by a dead force.
  StrandDescription d = straight(8, 0.07, 0.002, 60e3, 0.001);
  d.law = {4, 40, 0.8};
  Trial run(d);
  const double area = std::numbers::pi * (4e-6 - 1e-6);
  for (double strain : {0.05, 0.3, 0.6}) {
    const double force = 60e3 * area * strain * (1 + 4 * strain + 40 * strain * strain);
    const StrandLoad load{.element = 6, .w = 1, .f0 = {force, 0, 0}};
    for (int t = 0; t < 3000; ++t) run.step({&load, 1});
    EXPECT_NEAR(element_strain(run.model, run.state, 4), strain, 1e-6);
  }
}

TEST(Strand, HangingChainTakesTheShapeOfACatenary) {
  const int n = 61;
  const double span = 0.1, a = 0.06;  // y = a cosh(x / a)
  StrandDescription d;
  const double half = a * std::sinh(span / 2 / a);
  for (int i = 0; i < n; ++i) {  // drawn as a triangle of the same length, prestress off
    const double s = 2.0 * i / (n - 1) - 1, depth = std::sqrt(half * half - span * span / 4);
    d.positions.push_back({s * span / 2, 0, -(1 - std::fabs(s)) * depth});
  }
  d.radius.assign(n - 1, 2e-4);
  d.youngs_modulus = 5e8;
  d.density = 7800;
  d.law = {0, 0, 1};
  d.gravity = {0, 0, -9.81};
  d.global_damping = 5;
  d.prestress = false;
  d.prescribed.assign(n, 0);
  d.prescribed[0] = d.prescribed[n - 1] = 1;
  StrandModel m = build(d, 1e-3);
  for (double& b : m.bend) b = 0;
  StrandState s = rest_state(m);
  StrandWork w = make_work(m);
  for (int t = 0; t < 12000; ++t) ASSERT_TRUE(advance(m, {}, {}, {}, {}, s, w).fine());
  const double sag = a * (std::cosh(span / 2 / a) - 1);
  for (int i = 0; i < n; ++i) {
    const double expected = a * std::cosh(s.x[i].x / a) - a - sag;
    EXPECT_NEAR(s.x[i].z, expected, 0.01 * sag) << i;
  }
}

TEST(Strand, HangingChainSwingsAtItsFirstFrequency) {
  const int n = 81;
  const double chain = 0.2;
  StrandDescription d;
  for (int i = 0; i < n; ++i) d.positions.push_back({0, 0, -chain * i / (n - 1)});
  d.radius.assign(n - 1, 2e-4);
  d.youngs_modulus = 1e8;
  d.density = 7800;
  d.law = {0, 0, 1};
  d.gravity = {0, 0, -9.81};
  d.prestress = false;
  d.prescribed.assign(n, 0);
  d.prescribed[0] = 1;
  StrandModel m = build(d, 2e-4);  // backward Euler damps: a fine tick for a frequency
  for (double& b : m.bend) b = 0;
  StrandState s = rest_state(m);
  StrandWork w = make_work(m);
  for (int i = 0; i < n; ++i) s.x[i].x = 0.004 * double(i) / (n - 1) * double(i) / (n - 1);
  double previous = s.x.back().x, first = 0, last = 0;
  int crossings = 0;
  for (int t = 0; t < 20000; ++t) {
    advance(m, {}, {}, {}, {}, s, w);
    const double now = s.x.back().x;
    // Count crossings of the mid chain, where the second mode has little.
    if ((now > 0) != (previous > 0)) {
      last = t * 2e-4;
      if (crossings++ == 0) first = last;
    }
    previous = now;
  }
  const double omega = std::numbers::pi * (crossings - 1) / (last - first);
  EXPECT_NEAR(omega, 1.2024 * std::sqrt(9.81 / chain), 0.02 * omega);
}

TEST(Strand, DrawnShapeIsTheEquilibriumUnderGravity) {
  StrandDescription without = tube();
  without.foundation.clear();
  without.prescribed.back() = 1;
  for (Vec3d& x : without.positions) x.z = -x.z;  // hanging: an arch this soft buckles under its weight, rightly
  for (const StrandDescription& d : {tube(), without}) {
    Trial run(d);
    for (int t = 0; t < 5000; ++t) ASSERT_TRUE(run.step().fine());
    EXPECT_LT(run.farthest_from_rest(), 1e-8);
  }
}

TEST(Strand, WithoutPrestressTheSameTubeSags) {
  StrandDescription d = tube();
  d.prestress = false;
  Trial run(d);
  for (int t = 0; t < 2000; ++t) run.step();
  EXPECT_GT(run.farthest_from_rest(), 1e-3);
}

TEST(Strand, AStiffArteryIsCalmAtOneMillisecond) {
  StrandDescription d = tube(60);
  d.youngs_modulus = 630e3;
  d.law = {1, 5, 0.6};
  d.damping_time = 0;
  d.foundation.clear();
  d.prescribed.back() = 1;
  Trial run(d);
  const double start = energy(run.model, run.state).total();
  for (int i = 2; i + 1 < run.model.nodes; ++i) run.state.v[i] = {0, 0.3 * ((i % 2) ? 1 : -1), 0.3};
  const double kicked = energy(run.model, run.state).total();
  for (int t = 0; t < 5000; ++t) {
    ASSERT_TRUE(run.step().fine());
    ASSERT_LT(energy(run.model, run.state).total(), kicked + 0.01 * (kicked - start)) << t;
  }
  EXPECT_LT(run.farthest_from_rest(), 1e-4);
}

TEST(Strand, ATurnedStrandCarriesNoForce) {
  // 70 degrees about an oblique axis: once loose, once with a holder that says how it has turned.
  const Vec3d axis = normalised(Vec3d{1, 2, -1});
  const double c = 0.3420201433256687, s = 0.9396926207859084;
  const auto turn = [&](Vec3d x) { return c * x + s * cross(axis, x) + ((1 - c) * dot(axis, x)) * axis; };
  for (const bool held : {false, true}) {
    StrandDescription d = tube();
    d.foundation.clear();
    d.gravity = {};
    d.prescribed.assign(d.positions.size(), 0);
    d.prescribed[0] = held;
    Trial run(d);
    for (Vec3d& x : run.state.x) x = turn(x);
    const StrandEnd end{.x = run.state.x[0],
                        .turned = true,
                        .turn = Mat3d::from_columns(turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}))};
    double fastest = 0;
    for (int t = 0; t < 200; ++t) {
      run.step({}, held ? std::span(&end, 1) : std::span<const StrandEnd>{});
      for (const Vec3d& v : run.state.v) fastest = std::max(fastest, length(v));
    }
    EXPECT_LT(fastest, 1e-9) << held;
  }
}

TEST(Strand, ACutSeparates) {
  StrandDescription d = tube();
  d.foundation.clear();
  d.prescribed.back() = 1;
  Trial run(d);
  const double l = length(run.state.x[16] - run.state.x[15]);
  cut_element(run.state, 15);
  std::vector<StrandReaction> ends(3);
  for (int t = 0; t < 300; ++t) ASSERT_TRUE(run.step({}, {}, ends).fine());
  EXPECT_GT(length(run.state.x[16] - run.state.x[15]), 3 * l);
  EXPECT_EQ(element_strain(run.model, run.state, 15), 0);
}

TEST(Strand, ACutTransmitsNothing) {
  StrandDescription d = straight(20, 0.1, 0.002, 60e3);
  d.gravity = {};
  d.prescribed.back() = 1;
  Trial a(d), b(d);
  cut_element(a.state, 10);
  cut_element(b.state, 10);
  const StrandLoad pull{.element = 14, .w = 0.3, .f0 = {0.1, 0.05, 0}};
  for (int t = 0; t < 200; ++t) {
    a.step();
    b.step({&pull, 1});
  }
  for (int i = 0; i <= 10; ++i) EXPECT_EQ(a.state.x[i], b.state.x[i]);
  EXPECT_GT(length(a.state.x[15] - b.state.x[15]), 1e-4);
}

TEST(Strand, AClipStiffensItsElements) {
  const auto bend = [](double scale) {
    StrandDescription d = straight(22, 0.105, 0.002, 1e6);
    d.global_damping = 20;  // it has come to rest
    Trial run(d);
    for (int e = 8; e < 13; ++e) run.state.scale[e] = scale;
    const StrandLoad load{.element = 20, .w = 1, .f0 = {0, 0, 1e-3}};
    for (int t = 0; t < 6000; ++t) run.step({&load, 1});
    return run.state.x.back().z;
  };
  EXPECT_LT(bend(50), 0.9 * bend(1));
}

TEST(Strand, ViolentHandlingLeavesEnergyBounded) {
  StrandDescription d = tube();
  d.prescribed.back() = 1;
  Trial run(d);
  std::vector<StrandEnd> ends(3);
  for (int k = 0; k < 3; ++k) ends[k].x = run.model.rest[run.model.prescribed_nodes[k]];
  double most = 0;
  const double start = energy(run.model, run.state).total();
  for (int t = 0; t < 4000; ++t) {
    // The far end swept to and fro by 40 mm at 0.4 m/s, turning abruptly.
    const double speed = (t / 100) % 2 ? -0.4 : 0.4;
    ends[2].v = {0, speed, 0};
    ends[2].x += 1e-3 * ends[2].v;
    ASSERT_TRUE(run.step({}, ends).fine()) << t;
    most = std::max(most, energy(run.model, run.state).total() - start);
  }
  EXPECT_LT(most, 0.1);  // [J]; the sweep stores a few mJ in the tube and its sheet
  ends[2].v = {};
  for (int t = 0; t < 3000; ++t) run.step({}, ends);
  EXPECT_LT(energy(run.model, run.state).kinetic, 1e-9);
}

TEST(Strand, SurvivesAPullOfTenNewtons) {
  Trial run(tube());
  const StrandLoad pull{.element = 20, .w = 0.5, .f0 = {0, 0, 10}};
  double most = 0;
  for (int t = 0; t < 1500; ++t) {
    ASSERT_TRUE(run.step({&pull, 1}).fine());
    for (const Vec3d& x : run.state.x) most = std::max(most, length(x));
  }
  EXPECT_LT(most, 0.5);
  for (int t = 0; t < 6000; ++t) ASSERT_TRUE(run.step().fine());
  EXPECT_LT(run.farthest_from_rest(), 1e-3);
}

TEST(Strand, AGraspHoldsItsPointWhateverItsStiffness) {
  for (double k : {10.0, 1e3, 1e6, 1e9}) {
    Trial run(tube());
    const Vec3d goal = 0.5 * (run.model.rest[20] + run.model.rest[21]) + Vec3d{0, 0.004, 0.006};
    const StrandLoad grasp{.element = 20, .w = 0.5, .k = k, .x0 = goal, .d = 0.01};
    Vec3d reaction;
    for (int t = 0; t < 2000; ++t) ASSERT_TRUE(run.step({&grasp, 1}, {}, {}, {&reaction, 1}).fine());
    const Vec3d point = 0.5 * (run.state.x[20] + run.state.x[21]);
    const Vec3d expected = k * (goal - point);
    EXPECT_LT(length(reaction - expected), 1e-3 * length(expected) + 1e-6) << k;
    if (k >= 1e6) {
      EXPECT_LT(length(point - goal), 1e-5);
    }
  }
}

TEST(Strand, ReactionsAccountForEveryForce) {
  // Everything outside that acts, over a tick, makes up the change of momentum.
  StrandDescription d = tube();
  d.foundation.clear();
  d.global_damping = 0;
  d.prescribed.back() = 1;
  Trial run(d);
  std::vector<StrandEnd> ends(3);
  for (int k = 0; k < 3; ++k) ends[k].x = run.model.rest[run.model.prescribed_nodes[k]];
  std::vector<StrandReaction> reactions(3);
  const StrandLoad loads[] = {
      {.element = 12, .w = 0.2, .k = 300, .x0 = {0.06, 0.02, 0.03}, .d = 0.2},
      {.element = 25, .w = 0.9, .f0 = {0.02, 0, 0.01}, .k = 40, .x0 = {0.1, 0, 0.02}, .dir = {0, 0.6, 0.8}}};
  Vec3d felt[2];
  const auto momentum = [&] {
    Vec3d p{};
    for (int i = 0; i < run.model.nodes; ++i) p += run.model.mass[i] * run.state.v[i];
    return p;
  };
  double mass = 0;
  for (double m : run.model.mass) mass += m;
  for (int t = 0; t < 50; ++t) {
    for (int k = 0; k < 3; ++k) {
      ends[k].v = {0.05, 0.01 * k, -0.02};
      ends[k].x += 1e-3 * ends[k].v;
    }
    const Vec3d before = momentum();
    ASSERT_TRUE(run.step(loads, ends, reactions, felt).fine());
    Vec3d sum = mass * run.model.gravity + felt[0] + felt[1];
    for (const auto& r : reactions) sum -= r.force;
    const Vec3d change = (1 / 1e-3) * (momentum() - before);
    EXPECT_LT(length(change - sum), 1e-7 * (length(sum) + length(felt[0]))) << t;
  }
}

TEST(Strand, TangentPredictsHowTheForceFallsAsTheHolderMoves) {
  StrandDescription d = tube();
  d.prescribed.back() = 1;
  Trial run(d);
  for (int t = 0; t < 100; ++t) run.step();
  std::vector<StrandEnd> ends(3);
  for (int k = 0; k < 3; ++k) ends[k].x = run.model.rest[run.model.prescribed_nodes[k]];
  std::vector<StrandReaction> here(3), there(3);
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      Trial a = run, b = run;
      a.step({}, ends, here);
      auto moved = ends;
      const double step = 1e-7;
      moved[k].x[axis] += step;
      b.step({}, moved, there);
      for (int row = 0; row < 3; ++row) {
        const double measured = -(there[k].force[row] - here[k].force[row]) / step;
        const double size = here[k].tangent.m[axis][axis];
        EXPECT_NEAR(here[k].tangent.m[row][axis], measured, 1e-5 * size + 1e-4);
      }
    }
  }
}

TEST(Strand, SameInputSameBitsAndWorkDoesNotMatter) {
  Trial a(tube()), b(tube());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const StrandLoad load{.element = 12, .w = 0.2, .k = 300, .x0 = {0.06, 0.02, 0.03}};
  StrandState saved;
  for (int t = 0; t < 60; ++t) {
    a.step({&load, 1});
    if (t == 30) saved = b.state;
    for (auto* v : {&b.work.matrix, &b.work.saved, &b.work.rhs, &b.work.force, &b.work.columns})
      std::fill(v->begin(), v->end(), nan);
    b.step({&load, 1});
  }
  EXPECT_EQ(hash_of(a.state), hash_of(b.state));
  Trial c(tube());
  c.state = saved;
  for (int t = 30; t < 60; ++t) c.step({&load, 1});
  EXPECT_EQ(hash_of(c.state), hash_of(a.state));
}

TEST(Strand, NonsenseIsReported) {
  Trial run(tube());
  const StrandLoad bad{.element = 99};
  EXPECT_TRUE(run.step({&bad, 1}).flags & StepReport::kBadLoad);
  run.state.v[5].x = std::numeric_limits<double>::quiet_NaN();
  const StepReport report = run.step();
  EXPECT_FALSE(report.fine());
  EXPECT_GE(report.first_bad, 0);
}

TEST(Strand, AStrandThatNothingHoldsUpIsRefused) {
  StrandDescription d = tube();
  d.foundation.clear();
  d.prescribed.assign(d.positions.size(), 0);
  d.prescribed[0] = 1;  // a pivot: free to swing
  EXPECT_THROW(build(d, 1e-3), std::invalid_argument);
  d.prestress = false;
  EXPECT_NO_THROW(build(d, 1e-3));
}

}  // namespace
}  // namespace trocar::tissue
