#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/parallel.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/network_reference.hpp>

#include "test_bodies.hpp"

namespace trocar::tissue {
namespace {

using test::wobbly_block;

std::uint64_t hash_of(const NetworkState& s) {
  core::Hasher h;
  add_to_hash(h, s);
  return h.value();
}

std::vector<NodeLoad> some_loads(const NetworkModel& m, int tick) {
  const Vec3f tip = vec_cast<float>(m.rest[m.nodes - 1] + Vec3d{0.002, 0.001 * std::fabs(double(tick % 7)), 0.004});
  return {{.node = m.nodes - 5, .f0 = {0.01f, 0, 0}},
          {.node = m.nodes - 1, .k = 50, .x0 = tip},
          {.node = m.nodes - 1, .k = 2000, .x0 = tip, .dir = {0, 0.6f, 0.8f}, .d = 0.3f}};
}

NetworkState run(const NetworkModel& m, int ticks, core::ThreadPool* pool = nullptr, int cut_at = -1) {
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m, pool ? pool->threads() : 1);
  for (int t = 0; t < ticks; ++t) {
    if (t == cut_at)
      for (int spring = 0; spring < m.springs; spring += 11) cut_spring(m, s, spring);
    const auto loads = some_loads(m, t);
    std::vector<Vec3f> reactions(loads.size());
    EXPECT_TRUE(advance(m, loads, reactions, s, w, pool).fine());
  }
  return s;
}

TEST(SpringNetwork, EveryNodeHasOneRowAndEverySpringOnePlace) {
  const NetworkDescription d = wobbly_block(5, 4, 3);
  const NetworkModel m = build(d, 1e-3);
  std::vector<int> seen(m.rows, 0);
  for (int i = 0; i < m.nodes; ++i) {
    ++seen[m.row_of_node[i]];
    EXPECT_EQ(m.node_of_row[m.row_of_node[i]], i);
  }
  for (int r = 0; r < m.nodes; ++r) EXPECT_EQ(seen[r], 1);
  std::vector<int> taken(m.packs.size() * kSlice, 0);
  for (int s = 0; s < m.springs; ++s) {
    const int place = m.place[s];
    EXPECT_EQ(++taken[place], 1);
    const int a = m.row_of_node[d.springs[s].a], b = m.row_of_node[d.springs[s].b];
    const int other = int(m.packs[place / kSlice].offset[place % kSlice] / sizeof(NodeState));
    EXPECT_TRUE(other == a || other == b) << s;
  }
}

TEST(SpringNetwork, RowOrderKeepsNeighboursClose) {
  const NetworkModel m = build(wobbly_block(20, 6, 6), 1e-3);
  int widest = 0;
  for (int s = 0; s < m.springs; ++s)
    widest =
        std::max(widest, std::abs(m.row_of_node[m.spring_nodes[2 * s]] - m.row_of_node[m.spring_nodes[2 * s + 1]]));
  EXPECT_LT(widest, 2 * 49 + 2 * 256);  // two layers of the short cross-section and two sorting windows
}

TEST(SpringNetwork, AllInstructionSetsGiveTheSameBits) {
  for (const bool mixed_laws : {false, true}) {
    NetworkDescription d = wobbly_block(9, 7, 6);
    if (mixed_laws)
      for (std::size_t s = 0; s < d.springs.size(); s += 3) d.springs[s].p2 = 20, d.springs[s].cap = 0.2;
    const NetworkModel m = build(d, 1e-3);
    const std::string before = simd_name();
    ASSERT_TRUE(set_simd("generic"));
    const std::uint64_t expected = hash_of(run(m, 60, nullptr, 30));
    int tried = 0;
    for (const char* name : {"sse2", "avx2", "avx512"}) {
      if (!set_simd(name)) continue;
      ++tried;
      EXPECT_EQ(hash_of(run(m, 60, nullptr, 30)), expected) << name;
    }
    ASSERT_TRUE(set_simd(before));
    if (tried == 0) GTEST_SKIP() << "this machine runs none of sse2, avx2, avx512";
  }
}

TEST(SpringNetwork, BitsDoNotDependOnTheNumberOfThreads) {
  const NetworkModel m = build(wobbly_block(30, 20, 12), 1e-3);
  const std::uint64_t expected = hash_of(run(m, 20));
  for (int threads : {1, 2, 3}) {
    core::ThreadPool pool(threads);
    EXPECT_EQ(hash_of(run(m, 20, &pool)), expected) << threads;
  }
}

TEST(SpringNetwork, KernelGivesTheBitsOfThePlainReference) {
  const NetworkDescription d = wobbly_block(6, 5, 4);
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  ReferenceNetwork<float> reference(d, m);
  for (int t = 0; t < 50; ++t) {
    advance(m, {}, {}, s, w);
    for (int i = 0; i < m.substeps; ++i) reference.step(m.dt);
  }
  for (int i = 0; i < m.nodes; ++i) {
    const NodeState& n = s.nodes[m.row_of_node[i]];
    const auto& r = reference.node(i);
    EXPECT_EQ(n.x, r.x.x);
    EXPECT_EQ(n.y, r.x.y);
    EXPECT_EQ(n.z, r.x.z);
    EXPECT_EQ(n.vx, r.v.x);
    EXPECT_EQ(n.vy, r.v.y);
    EXPECT_EQ(n.vz, r.v.z);
  }
}

TEST(SpringNetwork, WorkFilledWithNanBetweenTicksChangesNothing) {
  const NetworkModel m = build(wobbly_block(6, 5, 4), 1e-3);
  NetworkState a = rest_state(m), b = a;
  NetworkWork wa = make_work(m), wb = make_work(m);
  for (int t = 0; t < 30; ++t) {
    const auto loads = some_loads(m, t);
    advance(m, loads, {}, a, wa);
    const auto spoil = [](auto& v) { std::memset(static_cast<void*>(v.data()), 0xff, v.size() * sizeof(v[0])); };
    spoil(wb.other);
    spoil(wb.forces[0].forces);
    spoil(wb.forces[0].sums);
    std::fill(wb.open_tets.begin(), wb.open_tets.end(), 0x7fffffff);
    std::fill(wb.below.begin(), wb.below.end(), std::uint16_t(0xffff));
    advance(m, loads, {}, b, wb);
  }
  EXPECT_EQ(hash_of(a), hash_of(b));
}

TEST(SpringNetwork, SaveAndContinueGivesTheSameBits) {
  const NetworkModel m = build(wobbly_block(6, 5, 4), 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  for (int t = 0; t < 21; ++t) advance(m, some_loads(m, t), {}, s, w);
  NetworkState saved = s;
  NetworkWork fresh = make_work(m);
  for (int t = 21; t < 50; ++t) {
    advance(m, some_loads(m, t), {}, s, w);
    advance(m, some_loads(m, t), {}, saved, fresh);
  }
  EXPECT_EQ(hash_of(s), hash_of(saved));
}

TEST(SpringNetwork, BodyAtRestDoesNotSinkIntoDenormals) {
  NetworkDescription d = wobbly_block(3, 3, 3);
  d.gravity = {};
  d.global_damping = 1000;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  for (int t = 0; t < 3000; ++t) advance(m, {}, {}, s, w);
  for (const NodeState& n : s.nodes)
    for (float v : {n.vx, n.vy, n.vz}) EXPECT_TRUE(v == 0 || std::fabs(v) > 1e-30f) << v;
}

// ---- loads

TEST(NodeLoads, AnyStiffnessIsStableAndReachesItsPoint) {
  const NetworkModel m = build(wobbly_block(5, 5, 5), 1e-3);
  for (float k : {1.0f, 1e3f, 1e6f, 1e9f}) {
    NetworkState s = rest_state(m);
    NetworkWork w = make_work(m);
    const int node = m.nodes - 1;
    const Vec3d goal = m.rest[node] + Vec3d{0.003, 0, 0.003};
    const NodeLoad load{.node = node, .k = k, .x0 = vec_cast<float>(goal)};
    StepReport report;
    for (int t = 0; t < 1500; ++t) report = report | advance(m, {&load, 1}, {}, s, w);
    EXPECT_TRUE(report.fine());
    if (k >= 1e6f) {
      EXPECT_LT(length(position(m, s, node) - goal), 1e-5);
    }
  }
}

TEST(NodeLoads, ReactionsAccountForEveryChangeOfMomentum) {
  NetworkDescription d = wobbly_block(4, 4, 4);
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  Vec3d given{};
  for (int t = 0; t < 200; ++t) {
    const auto loads = some_loads(m, t);
    std::vector<Vec3f> reactions(loads.size());
    advance(m, loads, reactions, s, w);
    for (const Vec3f& r : reactions) given += 1e-3 * vec_cast<double>(r);
  }
  Vec3d momentum{};
  for (int i = 0; i < m.nodes; ++i) momentum += m.mass[i] * velocity(m, s, i);
  EXPECT_GT(length(given), 1e-5);
  EXPECT_LT(length(momentum - given), 1e-4 * length(given));
}

TEST(NodeLoads, DirectionalLoadLeavesTheOtherAxesAlone) {
  NetworkDescription d;
  d.positions = {{0, 0, 0}};
  d.mass = {0.01};
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  set_velocity(m, s, 0, {0.1, 0, 0});
  const NodeLoad load{.node = 0, .k = 1e5, .x0 = {0, 0, 0.01f}, .dir = {0, 0, 1}, .d = 1};
  for (int t = 0; t < 100; ++t) advance(m, {&load, 1}, {}, s, w);
  EXPECT_NEAR(velocity(m, s, 0).x, 0.1, 1e-8);
  EXPECT_EQ(velocity(m, s, 0).y, 0);
  EXPECT_NEAR(position(m, s, 0).z, 0.01, 1e-6);
}

TEST(NodeLoads, HeldAxesDoNotMoveHoweverHardThePull) {
  NetworkDescription d;
  d.positions = {{0, 0, 0}};
  d.mass = {0.01};
  d.fixed = {kHeldZ};
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  const float c = 0.70710678f;
  const NodeLoad load{.node = 0, .k = 1e5, .x0 = {0, c * 0.01f, c * 0.01f}, .dir = {0, c, c}};
  Vec3f reaction;
  for (int t = 0; t < 200; ++t) advance(m, {&load, 1}, {&reaction, 1}, s, w);
  EXPECT_EQ(position(m, s, 0).z, 0);
  EXPECT_TRUE(std::isfinite(reaction.y));
}

TEST(NodeLoads, NonsenseIsReportedAndLeftOut) {
  const NetworkModel m = build(wobbly_block(2, 2, 2), 1e-3);
  NetworkState s = rest_state(m), clean = s;
  NetworkWork w = make_work(m);
  const NodeLoad bad[] = {{.node = 5, .k = std::numeric_limits<float>::quiet_NaN()}, {.node = 999}};
  Vec3f reactions[2];
  const StepReport report = advance(m, bad, reactions, s, w);
  EXPECT_TRUE(report.flags & StepReport::kBadLoad);
  EXPECT_EQ(report.first_bad, 0);
  advance(m, {}, {}, clean, w);
  EXPECT_EQ(hash_of(s), hash_of(clean));
}

// ---- faults

TEST(SpringNetwork, NonFiniteStateIsReportedWithItsNode) {
  const NetworkModel m = build(wobbly_block(3, 3, 3), 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  set_velocity(m, s, 40, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const StepReport report = advance(m, {}, {}, s, w);
  EXPECT_TRUE(report.flags & StepReport::kNonFinite);
  EXPECT_GE(report.first_bad, 0);
  EXPECT_LE(report.first_bad, 40);
}

TEST(SpringNetwork, UnsoundDescriptionsAreRefusedByName) {
  const auto message = [](NetworkDescription d) -> std::string {
    try {
      build(d, 1e-3);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  NetworkDescription d = wobbly_block(2, 2, 2);
  EXPECT_EQ(message(d), "");
  NetworkDescription e = d;
  e.mass[3] = 0;
  EXPECT_NE(message(e).find("mass of node 3"), std::string::npos);
  e = d;
  e.springs[7].rest_length = -1;
  EXPECT_NE(message(e).find("spring 7"), std::string::npos);
  e = d;
  e.springs[2].p1 = -4, e.springs[2].p2 = 5;
  EXPECT_NE(message(e).find("law of spring 2"), std::string::npos);
  e = d;
  std::swap(e.tets[1][0], e.tets[1][1]);
  EXPECT_NE(message(e).find("cell 1"), std::string::npos);
}

// ---- cutting

TEST(Cutting, CutSpringsCarryNothingAndTheBodyFallsApart) {
  NetworkDescription d = wobbly_block(4, 4, 6);
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  // Cut between the third and the fourth layer: what is above falls freely, through the table.
  const double plane = m.rest[0].z + 0.025;
  for (int k = 0; k < m.springs; ++k) {
    const double za = m.rest[m.spring_nodes[2 * k]].z, zb = m.rest[m.spring_nodes[2 * k + 1]].z;
    if ((za < plane) != (zb < plane)) cut_spring(m, s, k);
  }
  Vec3d before{};
  double mass = 0;
  for (int i = 0; i < m.nodes; ++i)
    if (m.rest[i].z > plane) before += m.mass[i] * position(m, s, i), mass += m.mass[i];
  for (int t = 0; t < 200; ++t) ASSERT_TRUE(advance(m, {}, {}, s, w).fine());
  Vec3d after{};
  for (int i = 0; i < m.nodes; ++i)
    if (m.rest[i].z > plane) after += m.mass[i] * position(m, s, i);
  const double fallen = (before.z - after.z) / mass;
  EXPECT_NEAR(fallen, 0.5 * 9.81 * 0.2 * 0.2, 0.01 * fallen);
}

// ---- volume protection

TEST(VolumeProtection, AMirroredCellComesBack) {
  for (double p2 : {0.0, 100.0}) {
    NetworkDescription d;
    const double l = 0.005;
    d.positions = {{0, 0, 0}, {l, 0, 0}, {l / 2, l * 0.866, 0}, {l / 2, l * 0.2887, l * 0.8165}};
    d.mass.assign(4, 1e-4);
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        d.springs.push_back({.a = a,
                             .b = b,
                             .rest_length = length(d.positions[b] - d.positions[a]),
                             .k = 60,
                             .p1 = 2,
                             .p2 = p2,
                             .cap = 0.35,
                             .damping = 0.02});
    d.tets = {{0, 1, 2, 3}};
    const NetworkModel m = build(d, 1e-3);
    NetworkState s = rest_state(m);
    NetworkWork w = make_work(m);
    Vec3d apex = d.positions[3];
    apex.z = -apex.z;
    set_position(m, s, 3, apex);
    const auto volume = [&] {
      const Vec3d o = position(m, s, 0);
      return dot(position(m, s, 1) - o, cross(position(m, s, 2) - o, position(m, s, 3) - o));
    };
    const double rest = dot(d.positions[1], cross(d.positions[2], d.positions[3]));
    EXPECT_LT(volume(), -0.9 * rest);
    std::uint32_t flags = 0;
    for (int t = 0; t < 500; ++t) flags |= advance(m, {}, {}, s, w).flags;
    EXPECT_TRUE(flags & StepReport::kInverted);
    EXPECT_NEAR(volume(), rest, 0.05 * rest) << "P2 = " << p2;
    EXPECT_EQ(advance(m, {}, {}, s, w).flags, 0u);
    EXPECT_EQ(s.open_tets, 0u);
  }
}

TEST(VolumeProtection, WithoutProtectionTheMirrorImageStays) {
  NetworkDescription d;
  const double l = 0.005;
  d.positions = {{0, 0, 0}, {l, 0, 0}, {l / 2, l * 0.866, 0}, {l / 2, l * 0.2887, l * 0.8165}};
  d.mass.assign(4, 1e-4);
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b)
      d.springs.push_back({.a = a, .b = b, .rest_length = length(d.positions[b] - d.positions[a]), .k = 60});
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  Vec3d apex = d.positions[3];
  apex.z = -apex.z;
  set_position(m, s, 3, apex);
  for (int t = 0; t < 500; ++t) advance(m, {}, {}, s, w);
  EXPECT_LT(position(m, s, 3).z, -0.5 * l);
}

TEST(VolumeProtection, ABlockTurnedInsideOutLocallyUnfolds) {
  NetworkDescription d = wobbly_block(6, 6, 6);
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  for (int t = 0; t < 300; ++t) advance(m, {}, {}, s, w);
  // Push the whole top face two cells deep into the body.
  for (int i = 0; i < m.nodes; ++i)
    if (m.rest[i].z > m.rest[m.nodes - 1].z - 1e-6) set_position(m, s, i, position(m, s, i) - Vec3d{0, 0, 0.022});
  std::uint32_t seen = 0;
  StepReport last;
  for (int t = 0; t < 3000; ++t) {
    last = advance(m, {}, {}, s, w);
    seen |= last.flags;
    ASSERT_TRUE(last.fine());
  }
  EXPECT_TRUE(seen & StepReport::kInverted);
  EXPECT_EQ(last.flags, 0u);
  for (const auto& t : d.tets) {
    const Vec3d o = position(m, s, t[0]);
    EXPECT_GT(dot(position(m, s, t[1]) - o, cross(position(m, s, t[2]) - o, position(m, s, t[3]) - o)), 0);
  }
}

/// A block of uterus, its middle layers at rest, one corner pushed through its cell to the far side of it: there the
/// springs balance each other and the corner would stay.
struct PushedCorner {
  NetworkModel model;
  NetworkState state;
  int corner = 0;
  explicit PushedCorner(double fill) {
    const double h = 0.0034;
    const BoxLattice box = box_lattice(4, 4, 4, h);
    const std::vector<double> fills(box.cells.size(), fill);
    NetworkDescription d =
        lattice_network(
            box.corners, box.cells, fills,
            {.youngs_modulus = 30e3, .density = 1050, .p1 = 5, .p2 = 100, .cap = 0.08, .damping_time = 2e-4})
            .network;
    d.global_damping = 0.5;
    for (int k = 0; k <= 4; ++k)
      for (int j = 0; j <= 4; ++j) d.fixed[size_t(box.corner(4, j, k))] = kHeld;
    model = build(d, 1e-3);
    state = rest_state(model);
    corner = box.corner(0, 0, 0);
    set_position(model, state, corner, model.rest[size_t(corner)] + Vec3d{0.95 * h, 0.95 * h, 0.95 * h});
  }
  double away() const { return length(position(model, state, corner) - model.rest[size_t(corner)]); }
};

TEST(VolumeProtection, ACornerThatSpringsHoldOnTheFarSideOfItsCellComesBack) {
  for (double fill : {1.0, 0.15}) {
    PushedCorner body(fill);
    NetworkWork w = make_work(body.model);
    for (int t = 0; t < 100; ++t) ASSERT_TRUE(advance(body.model, {}, {}, body.state, w).fine());
    EXPECT_GT(body.away(), 0.004) << "it is held there, or this test proves nothing";
    double most = 0;
    for (int t = 0; t < 900; ++t) {
      ASSERT_TRUE(advance(body.model, {}, {}, body.state, w).fine());
      const NetworkEnergy e = energy(body.model, body.state);
      most = std::max(most, e.kinetic + e.elastic);
    }
    EXPECT_LT(body.away(), 1e-4);
    EXPECT_EQ(body.state.open_tets, 0u);
    EXPECT_LT(most, 1e-3) << "[J]";
  }
}

/// A block of a liver's coarse cells, held below, whose middle a blunt tip presses down and stays there.
struct PressedLiver {
  BoxLattice box = box_lattice(8, 8, 4, 0.009);
  NetworkModel model;
  NetworkState state;
  NetworkWork work;
  std::vector<NodeLoad> tip;
  std::vector<Vec3f> felt;
  double rest = 0, put_in = 0;  ///< energy as drawn, work of the tip [J]

  PressedLiver() {
    NetworkDescription d =
        lattice_network(box.corners, box.cells, {},
                        {.youngs_modulus = 5400, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.1, .damping_time = 6e-3})
            .network;
    for (int j = 0; j <= 8; ++j)
      for (int i = 0; i <= 8; ++i) d.fixed[size_t(box.corner(i, j, 0))] = kHeld;
    model = build(d, 1e-3);
    state = rest_state(model);
    work = make_work(model);
    for (int j = 3; j <= 5; ++j)
      for (int i = 3; i <= 5; ++i) tip.push_back({.node = box.corner(i, j, 4), .k = 1500, .dir = {0, 0, 1}, .d = 0.3f});
    felt.resize(tip.size());
    rest = held();
  }
  double held() const {
    const NetworkEnergy e = energy(model, state);
    return e.kinetic + e.elastic - rest;
  }
  bool step(double depth, double speed) {
    for (NodeLoad& l : tip) l.x0 = vec_cast<float>(box.corners[size_t(l.node)] - Vec3d{0, 0, depth});
    const bool fine = advance(model, tip, felt, state, work, nullptr, Hands::on).first_bad < 0;
    for (const Vec3f& f : felt) put_in -= 1e-3 * speed * double(f.z);
    return fine;
  }
};

TEST(VolumeProtection, CoarseCellsThatAreKeptPressedFeedNoMotion) {
  PressedLiver liver;
  const double deep = 0.024, speed = deep / 0.1;
  double most = 0;
  for (int t = 0; t < 2000; ++t) {
    ASSERT_TRUE(t < 100 ? liver.step(speed * 1e-3 * t, speed) : liver.step(deep, 0));
    most = std::max(most, liver.held());
  }
  EXPECT_GT(liver.state.open_tets, 10u) << "cells have collapsed, or this test proves nothing";
  EXPECT_LT(most, liver.put_in) << "[J]";
  EXPECT_LT(energy(liver.model, liver.state).kinetic, 0.05 * liver.put_in);
}

TEST(VolumeProtection, AFoldIsNotDrivenHomeWhileHandsAreOn) {
  PushedCorner body(1);
  NetworkWork w = make_work(body.model);
  for (int t = 0; t < 1000; ++t) advance(body.model, {}, {}, body.state, w, nullptr, Hands::on);
  EXPECT_GT(body.away(), 0.004);
  for (int t = 0; t < 900; ++t) advance(body.model, {}, {}, body.state, w);
  EXPECT_LT(body.away(), 1e-4);
}

TEST(VolumeProtection, AFoldThatNeverRestsIsDrivenHomeOnceHandsAreOff) {
  PushedCorner body(1);
  NetworkWork w = make_work(body.model);
  const float shake = float(0.3 * body.model.mass[size_t(body.corner)] / 1e-3);  // 0.3 m/s to and fro
  const auto tremble = [&](int ticks, Hands hands) {
    for (int t = 0; t < ticks; ++t) {
      const NodeLoad push{.node = body.corner, .f0 = {t % 2 ? shake : -shake, 0, 0}};
      ASSERT_TRUE(advance(body.model, {&push, 1}, {}, body.state, w, nullptr, hands).fine());
    }
  };
  tremble(1000, Hands::on);
  EXPECT_GT(body.away(), 0.004) << "it is held there, or this test proves nothing";
  tremble(900, Hands::off);
  EXPECT_LT(body.away(), 5e-4);
  EXPECT_EQ(body.state.open_tets, 0u);
}

TEST(VolumeProtection, AHandThatKeepsCellsFoldedFeedsNoMotion) {
  const PushedCorner start(0.15);
  for (int node : {start.corner, start.corner + 6}) {
    PushedCorner body(0.15);
    NetworkWork w = make_work(body.model);
    const Vec3d there = body.model.rest[size_t(node)] + Vec3d{0.006, 0.005, 0.004};
    NodeLoad hold{.node = node, .k = 1200, .x0 = vec_cast<float>(there), .d = 0.5f};
    Vec3f force;
    double most = 0, fastest = 0;
    for (int t = 0; t < 2000; ++t) {
      ASSERT_TRUE(advance(body.model, {&hold, 1}, {&force, 1}, body.state, w).fine());
      const NetworkEnergy e = energy(body.model, body.state);
      if (t > 20) most = std::max(most, e.kinetic + e.elastic);
      for (int i = 0; t > 20 && i < body.model.nodes; ++i)
        fastest = std::max(fastest, length(velocity(body.model, body.state, i)));
    }
    EXPECT_LT(most, 5e-3) << "[J]";
    EXPECT_LT(fastest, 20) << "[m/s] its own way, some millimetres, within a millisecond";
  }
}

TEST(VolumeProtection, NodesThatAreThrownOutOfTheirPlaceComeToRest) {
  // A light node with all its springs on one side can be held stiffer than the time step bears, and leaps to and fro:
  // without catch_leaps() the last of these throws ends at 108 m/s, for ever.
  const PushedCorner body(1);
  const NetworkModel& m = body.model;
  std::uint32_t x = 1;
  const auto random = [&x] { return double((x = x * 1664525u + 1013904223u) >> 8) / (1 << 23) - 1; };
  for (int trial = 0; trial < 42; ++trial) {
    NetworkState s = rest_state(m);
    NetworkWork w = make_work(m);
    for (int thrown = 0; thrown <= trial % 6; ++thrown) {
      const int k = int(2.5 * (random() + 1)) % 5, j = int(2.5 * (random() + 1)) % 5, i = int(2 * (random() + 1)) % 3;
      const int node = (k * 5 + j) * 5 + i;
      const double a = random(), b = random(), c = random();
      set_position(m, s, node, m.rest[size_t(node)] + 3 * 0.0034 * Vec3d{a, b, c});
      NodeState& n = s.nodes[m.row_of_node[node]];
      n.vx = float(60 * random()), n.vy = float(60 * random()), n.vz = float(60 * random());
    }
    for (int t = 0; t < 700; ++t) ASSERT_TRUE(advance(m, {}, {}, s, w).fine());
    double fastest = 0;
    for (int i = 0; i < m.nodes; ++i) fastest = std::max(fastest, length(velocity(m, s, i)));
    EXPECT_LT(fastest, 1) << "[m/s] after throw " << trial;
  }
}

TEST(VolumeProtection, AWildNodeIsCaughtAtOnce) {
  // In ticks in which slower leaps are left alone. Without it these take six ticks and seven.
  for (const float held : {0.0f, 3000.0f}) {
    const PushedCorner body(1);
    const NetworkModel& m = body.model;
    NetworkState s = rest_state(m);
    NetworkWork w = make_work(m);
    const Vec3d aside = m.rest[1] - Vec3d{0.004, 0.004, 0.004};
    const NodeLoad hold{.node = 1, .k = held, .x0 = vec_cast<float>(aside)};
    NodeState& thrown = s.nodes[m.row_of_node[0]];
    thrown.vx = thrown.vy = thrown.vz = 3000;
    int last_fast = 0;
    for (int t = 1; t <= 190; ++t) {
      ASSERT_TRUE(advance(m, {&hold, 1}, {}, s, w, nullptr, Hands::on).fine());
      for (int i = 0; i < m.nodes; ++i)
        if (length(velocity(m, s, i)) > 20) last_fast = t;
    }
    EXPECT_LE(last_fast, 4) << "[ticks] held with " << held << " N/m";
  }
}

TEST(VolumeProtection, MomentumIsConservedWhileCellsAreOpened) {
  NetworkDescription d = wobbly_block(3, 3, 3);
  d.fixed.clear();
  d.gravity = {};
  d.global_damping = 0;
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  set_position(m, s, m.nodes - 1, m.rest[0]);
  std::uint32_t flags = 0;
  double fastest = 0, mass = 0;
  for (int t = 0; t < 100; ++t) {
    flags |= advance(m, {}, {}, s, w).flags;
    for (int i = 0; i < m.nodes; ++i) fastest = std::max(fastest, length(velocity(m, s, i)));
  }
  EXPECT_TRUE(flags & StepReport::kInverted);
  Vec3d momentum{};
  for (int i = 0; i < m.nodes; ++i) momentum += m.mass[i] * velocity(m, s, i), mass += m.mass[i];
  EXPECT_LT(length(momentum) / mass, 1e-5 * fastest);
}

}  // namespace
}  // namespace trocar::tissue
