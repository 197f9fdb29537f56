// Two instruments of a scene that are steered across each other and pressed on, and how deep they are in each other by
// their own shapes. It shares no code with contact: places along one axis against the other.
//
//   expect_apart(model);                         // all pairs of hands
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/sim/stages/step.hpp>

namespace trocar {

struct Crossing {
  std::size_t first = 0, second = 0;  ///< hands
  double deepest = -1;                ///< greatest overlap [m]; negative: they were apart
  double longest_deep = 0;            ///< for which they were deeper than 1 mm without a break [s]
  double most_force = 0;              ///< on the first one while they met [N]
};

namespace crossing {

/// Distance of p to the segment.
inline double distance(Vec3d p, const interactions::Capsule& rod) {
  const Vec3d along = rod.b - rod.a;
  const double size2 = dot(along, along);
  const double t = size2 > 0 ? std::clamp(dot(p - rod.a, along) / size2, 0.0, 1.0) : 0;
  return length(p - rod.a - t * along);
}

/// By how much two rods overlap, from places 0.1 mm apart around the nearest of some farther apart [m].
inline double overlap(const interactions::Capsule& a, const interactions::Capsule& b) {
  const auto at = [&](double t) { return distance(a.a + t * (a.b - a.a), b); };
  constexpr int kPlaces = 64;
  int best = 0;
  for (int i = 1; i <= kPlaces; ++i)
    if (at(double(i) / kPlaces) < at(double(best) / kPlaces)) best = i;
  double low = std::max(0.0, double(best - 1) / kPlaces), high = std::min(1.0, double(best + 1) / kPlaces);
  for (int i = 0; i < 30; ++i) {  // the distance of a place on a line to a segment has one minimum
    const double third = (high - low) / 3;
    (at(low + third) < at(high - third) ? high : low) += at(low + third) < at(high - third) ? -third : third;
  }
  return a.radius + b.radius - at(0.5 * (low + high));
}

inline double overlap(const interactions::ToolShape& a, const interactions::ToolShape& b) {
  double most = -1;
  for (int p = interactions::kShaft; p < end_of(a); p = interactions::next(p))
    for (int q = interactions::kShaft; q < end_of(b); q = interactions::next(q))
      most = std::max(most, overlap(a.rod(p), b.rod(q)));
  return most;
}

}  // namespace crossing

/// Shafts that cross like an X, each beside the other; then each goes 15 mm to the other one's side and stays. It goes
/// so slowly that it cannot pass without an overlap that is measured; around the other one's tip it may go.
inline Crossing crossing_of(const sim::Model& m, std::size_t i, std::size_t j, double speed = 0.1) {
  constexpr double kHigh = 0.015, kBeyond = 0.025;
  constexpr int kGoThere = 700, kPress = 150;
  sim::State s = sim::initial_state(m);
  sim::Work w = sim::make_work(m);
  sim::Input in = m.start;
  const Vec3d pi = m.hands[i].port, pj = m.hands[j].port;
  const auto tip_of = [&](std::size_t t) { return kinematics::forward(m.hands[t].port, s.tools[t].pose()).tip; };
  // nearer to the ports than the work, where there is less tissue
  const Vec3d meet = 0.35 * 0.5 * (pi + pj) + 0.65 * 0.5 * (tip_of(i) + tip_of(j));
  const Vec3d way_i = normalised(meet - pi), way_j = normalised(meet - pj), across = normalised(cross(way_i, way_j));
  const auto aim = [&](double high) {
    const auto put = [&](std::size_t t, Vec3d to) {
      in.tools[t] = sim::tool_input(kinematics::inverse(m.hands[t].port, to, double(in.tools[t].roll)), 1,
                                    m.start.tools[t].instrument);
    };
    put(i, meet + kBeyond * way_i + high * across);
    put(j, meet + kBeyond * way_j - high * across);
  };
  Crossing c{i, j};
  double deep_for = 0;
  const int sweep = int(2 * kHigh / (speed * sim::kTick));
  for (int t = 0; t < kGoThere + sweep + kPress; ++t) {
    aim(kHigh - std::clamp(speed * sim::kTick * (t - kGoThere), 0.0, 2 * kHigh));
    sim::step(m, in, s, w);
    const double now = crossing::overlap(sim::shape_of(m, s, i), sim::shape_of(m, s, j));
    deep_for = now > 0.001 ? deep_for + sim::kTick : 0;
    c.deepest = std::max(c.deepest, now);
    c.longest_deep = std::max(c.longest_deep, deep_for);
    const double(&f)[3] = s.tools[i].contact_force;
    if (now > -1e-4) c.most_force = std::max(c.most_force, length(Vec3d{f[0], f[1], f[2]}));
  }
  return c;
}

/// All pairs of hands meet, and none is deeper than 1 mm in the other for longer than 50 ms.
inline void expect_apart(const sim::Model& m) {
  for (std::size_t i = 0; i < m.hands.size(); ++i)
    for (std::size_t j = i + 1; j < m.hands.size(); ++j) {
      SCOPED_TRACE(m.name + ": " + m.hands[i].name + " and " + m.hands[j].name);
      const Crossing c = crossing_of(m, i, j);
      std::printf("    %s, %s and %s: deepest %.2f mm, deeper than 1 mm for %.0f ms, %.1f N\n", m.name.c_str(),
                  m.hands[i].name.c_str(), m.hands[j].name.c_str(), 1e3 * c.deepest, 1e3 * c.longest_deep,
                  c.most_force);
      EXPECT_GT(c.deepest, -1e-4) << "they have not met";
      EXPECT_LE(c.longest_deep, 0.050) << "[s]";
      EXPECT_GT(c.most_force, 1) << "[N]";
    }
}

}  // namespace trocar
