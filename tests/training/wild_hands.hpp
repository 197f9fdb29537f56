// Wild hands in the shipped pelvis: what it must bear, and how far it has moved.
#pragma once

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::wild {

using namespace sim;

inline Vec3d node_place(const Model& m, const State& s, int solid, int node) {
  return tissue::position(m.solids[size_t(solid)].network, s.solids[size_t(solid)], node);
}

/// Largest distance of any node from where it is drawn [m], and whose it is.
struct Moved {
  double most = 0;
  std::string body;
};
inline Moved moved(const Model& m, const State& s) {
  Moved r;
  const auto take = [&r](double d, const std::string& name) {
    if (!(d <= r.most)) r = {d, name};
  };
  for (size_t i = 0; i < m.solids.size(); ++i)
    for (int n = 0; n < m.solids[i].network.nodes; ++n)
      take(length(node_place(m, s, int(i), n) - m.solids[i].network.rest[size_t(n)]), m.solids[i].name);
  for (size_t i = 0; i < m.strands.size(); ++i)
    for (size_t n = 0; n < s.strands[i].x.size(); ++n)
      take(length(s.strands[i].x[n] - m.strand_bodies[i].model.rest[n]), m.strands[i].name);
  return r;
}

inline double kinetic_energy(const Model& m, const State& s) {
  double sum = 0;
  for (size_t i = 0; i < m.solids.size(); ++i) sum += tissue::energy(m.solids[i].network, s.solids[i]).kinetic;
  for (size_t i = 0; i < m.strand_bodies.size(); ++i)
    sum += tissue::energy(m.strand_bodies[i].model, s.strands[i]).kinetic;
  return sum;
}

inline constexpr double kLow[3] = {-0.06, -0.19, -0.16}, kHigh[3] = {0.06, -0.12, -0.06};  ///< where tips jump [m]
/// From corner to corner of that: what jaws hold goes as far with them, and not much farther.
inline double reach() {
  double square = 0;
  for (int k = 0; k < 3; ++k) square += (kHigh[k] - kLow[k]) * (kHigh[k] - kLow[k]);
  return std::sqrt(square);
}

/// Hands that jump anywhere near the organs every few milliseconds and open and close.
inline Input abusive(core::Random& random, const Model& m, const Input& last) {
  Input in = last;
  if (random.uniform() > 0.1) return in;
  for (size_t i = 0; i < m.hands.size(); ++i) {
    const Vec3d tip{random.uniform(kLow[0], kHigh[0]), random.uniform(kLow[1], kHigh[1]),
                    random.uniform(kLow[2], kHigh[2])};
    const double handle = random.uniform() < 0.3 ? (random.uniform() < 0.5 ? 0 : 1) : double(last.tools[i].handle);
    in.tools[i] = tool_input(kinematics::inverse(m.hands[i].port, tip, random.uniform(-3, 3)), float(handle));
  }
  return in;
}

/// The law that both the quick test and the soak ask for. Of tissue that does not tear: what is torn can be drawn as
/// far as hands go.
inline void bear_wild_hands(Model m, int ticks) {
  for (SolidModel& solid : m.solids) solid.failure_strain = 0;
  for (StrandAnatomy& strand : m.strands) strand.failure_strain = 0;
  seal(m);
  State s = initial_state(m);
  Work w = make_work(m);
  core::Random random(1);
  Input in = m.start;
  int events = 0;
  double energy = 0, most = 0;
  for (int t = 0; t < ticks; ++t) {
    in = abusive(random, m, in);
    const StepReport report = step(m, in, s, w);
    ASSERT_TRUE(report.fine()) << "tick " << t << " body " << report.first_bad_body.code();
    events += report.event_count;
    if (t % 20 != 0) continue;
    const Moved now = moved(m, s);
    most = std::max(most, now.most);
    ASSERT_LT(now.most, reach() + 0.01) << now.body << " at tick " << t;
    energy = std::max(energy, kinetic_energy(m, s));
  }
  testing::Test::RecordProperty("events", events);
  testing::Test::RecordProperty("kinetic_mJ", int(energy * 1e3));
  testing::Test::RecordProperty("furthest_mm", int(most * 1e3));
  EXPECT_GT(events, 0);
  EXPECT_LT(energy, 1.0) << "[J]";
}

}  // namespace trocar::wild
