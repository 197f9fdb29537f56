// The cavity's ends: what has been torn or cut off stays in the patient, and what is where it belongs is not touched.
#include <gtest/gtest.h>

#include <trocar/sim/stages/containing.hpp>

#include "abuse.hpp"
#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

/// A body goes out by about its own thickness [m].
constexpr double kOut = 0.03;

/// The small scene with an organ that nothing holds, a tube that nothing carries, and no floor.
const Model& loose() {
  static const Model compiled = [] {
    scene::Description d = small::description();
    d.solids[0].anchors[0].stiffness = d.solids[2].anchors[0].stiffness = 200;
    d.membranes.clear();
    d.vessels.clear();
    d.walls.clear();
    d.fluids.reset();
    Model m = scene::compile(d);
    m.solids[0].anchors.clear();
    m.cuttables[0].body.anchors.clear();
    m.strands[0].start.kind = StrandEndModel::free;
    std::fill(m.strand_bodies[0].model.foundation.begin(), m.strand_bodies[0].model.foundation.end(), 0);
    seal(m);
    return m;
  }();
  return compiled;
}

double outside(const tissue::Box& box, Vec3d p) {
  const Vec3d low = vec_cast<double>(box.low), high = vec_cast<double>(box.high);
  double most = -1;
  for (int k = 0; k < 3; ++k) most = std::max({most, low[k] - p[k], p[k] - high[k]});
  return most;
}

/// Of the node that is farthest out [m]; below 0: all are inside.
double outside(const Model& m, const State& s) {
  double most = -1;
  for (size_t i = 0; i < m.solids.size(); ++i)
    for (int n = 0; n < m.solids[i].network.nodes; ++n)
      most = std::max(most, outside(m.cavity, tissue::position(m.solids[i].network, s.solids[i], n)));
  for (size_t i = 0; i < m.cuttables.size(); ++i)
    for (int n = 0; n < s.cuttables[i].tets.nodes; ++n)
      most = std::max(most, outside(m.cavity, tissue::position(m.cuttables[i].body, s.cuttables[i], n)));
  for (const tissue::StrandState& strand : s.strands)
    for (Vec3d x : strand.x) most = std::max(most, outside(m.cavity, x));
  return most;
}

void throw_everything(const Model& m, Vec3d v, State& s) {
  for (int n = 0; n < m.solids[0].network.nodes; ++n) set_velocity(m.solids[0].network, s.solids[0], n, v);
  for (int n = 0; n < s.cuttables[0].tets.nodes; ++n) set_velocity(m.cuttables[0].body, s.cuttables[0], n, v);
  std::fill(s.strands[0].v.begin(), s.strands[0].v.end(), v);
}

TEST(Cavity, HoldsEverythingAsDrawnAndTheTrocars) {
  for (const Model* m : {&small::model(), &loose()}) {
    EXPECT_LT(outside(*m, initial_state(*m)), 0);
    for (const HandModel& h : m->hands) EXPECT_LT(outside(m->cavity, h.port), 0);
    EXPECT_LT(outside(m->cavity, m->scope.port), 0);
  }
}

TEST(Cavity, WhatIsThrownStaysInsideAndComesToRest) {
  const Model& m = loose();
  for (const Vec3d way : {Vec3d{8, 0, 0}, Vec3d{-8, 0, 0}, Vec3d{0, 8, 3}, Vec3d{0, -8, 0}, Vec3d{2, 1, 8}}) {
    State s = initial_state(m);
    Work w = make_work(m);
    throw_everything(m, way, s);
    const double start = abuse::energy(m, s);
    double most = 0;
    bool came = false;
    for (int t = 0; t < 2000; ++t) {
      ASSERT_TRUE(step(m, m.start, s, w).fine());
      ASSERT_LT(outside(m, s), kOut) << "tick " << t;
      came = came || outside(m, s) > 0;
      most = std::max(most, abuse::energy(m, s));
    }
    EXPECT_LT(most, start);
    EXPECT_LT(abuse::energy(m, s), 0.01 * start);
    EXPECT_TRUE(came) << "nothing ever came to the end";
  }
}

TEST(Cavity, WhatFallsComesToLie) {
  const Model& m = loose();
  State s = initial_state(m);
  Work w = make_work(m);
  for (int t = 0; t < 4000; ++t) ASSERT_TRUE(step(m, m.start, s, w).fine());
  const double start = abuse::energy(m, s);
  double lowest = 1;
  for (int n = 0; n < m.solids[0].network.nodes; ++n) {
    lowest = std::min(lowest, tissue::position(m.solids[0].network, s.solids[0], n).z);
    EXPECT_LT(length(tissue::velocity(m.solids[0].network, s.solids[0], n)), 0.05);
  }
  EXPECT_NEAR(lowest, double(m.cavity.low.z), 0.02);
  for (int t = 0; t < 1000; ++t) ASSERT_TRUE(step(m, m.start, s, w).fine());
  EXPECT_NEAR(abuse::energy(m, s), start, 1e-4) << "[J]";
}

TEST(Cavity, WhatIsInsideIsNotTouched) {
  Model open = small::model();
  open.cavity = Model{}.cavity;
  State a = initial_state(small::model()), b = a;
  Work wa = make_work(small::model()), wb = make_work(open);
  small::Hands one(small::model()), other(open);
  for (int t = 0; t < 4400; ++t) {
    step(small::model(), one.next(a), a, wa);
    step(open, other.next(b), b, wb);
  }
  EXPECT_EQ(hash_of(a), hash_of(b));
}

}  // namespace
