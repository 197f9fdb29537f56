// Jerks: both tails of a loosely tied knot are thrown about by seeded speeds, as long as no test of a hand would allow.
#pragma once

#include <algorithm>

#include <trocar/core/random.hpp>

#include "figures.hpp"
#include "tying.hpp"

namespace trocar::suture::test {

/// Least distance of two elements that do not touch by being neighbours, in diameters.
inline double least_distance(const ThreadModel& m, const std::vector<Vec3d>& x,
                             const std::vector<std::pair<int, int>>& pairs) {
  const auto at = [&x](int i) { return x[std::size_t(i)]; };
  double least = 1e9;
  for (const auto& [a, b] : pairs) {
    const Vec3d p = at(a), d = at(a + 1) - p, q = at(b), e = at(b + 1) - q, r = p - q;
    const double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), det = dd * ee - de * de;
    const auto clamp = [](double w) { return std::min(1.0, std::max(0.0, w)); };
    double s = det > 1e-12 * dd * ee ? clamp((de * dot(e, r) - ee * dot(d, r)) / det) : 0;
    double t = (dot(e, r) + s * de) / ee;
    if (t < 0 || t > 1) t = clamp(t), s = clamp((t * de - dot(d, r)) / dd);
    least = std::min(least, length(r + s * d - t * e));
  }
  return least / m.stuff.diameter;
}

/// Distances of axes are those after each solve: between them nodes go straight, and no two elements by more than half
/// of their distance. A straight line from tick to tick, over six solves, is no way that anything went.
struct Abuse {
  double least = 2;        ///< distance of axes, in diameters
  double least_borne = 2;  ///< the same, in ticks in which the thread is not pulled beyond what breaks it
  long beyond = 0;         ///< ticks in which it is
  double most_lag = 0;     ///< [m]
  int lagging = 0;         ///< ticks
  long ticks = 0, solves = 0;
  std::uint32_t flags = 0;
};

inline Abuse abuse(const char* make, int jerks, std::uint64_t seed, double most_speed, int most_solves) {
  Tying rig({.stuff = find_thread("3-0", make)->stuff, .tension = 2, .most_solves = most_solves});
  rig.begin({1, 1});
  rig.pull();
  rig.lay_next({1, -1});
  core::Random random(seed);
  Abuse found;
  std::vector<std::pair<int, int>> near;
  for (int jerk = 0; jerk < jerks; ++jerk) {
    Vec3d speed[2];
    for (Vec3d& v : speed) {
      v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      v = (random.uniform(0, most_speed) / std::max(0.1, length(v))) * v;
    }
    const int ticks = 3 + int(random.uniform(0, 12));
    for (int k = 0; k < ticks; ++k) {
      for (int h = 0; h < 2; ++h) {
        Vec3d& x = rig.holds[h].x;
        x += rig.m.tick * speed[h];
        if (length(x) > 0.06) x *= 0.06 / length(x);
      }
      const ThreadReport report = rig.tick();
      double least = 1 - report.sunk;
      if (found.ticks % 64 == 0) {  // and whether the thread has overlooked any
        near.clear();
        for (int a = 0; a + 1 < rig.m.nodes; ++a)
          for (int b = a + rig.m.apart; b + 1 < rig.m.nodes; ++b) near.push_back({a, b});
        least = std::min(least, least_distance(rig.m, rig.s.x, near));
      }
      found.least = std::min(found.least, least);
      if (report.tension > rig.m.stuff.break_force)
        ++found.beyond;
      else
        found.least_borne = std::min(found.least_borne, least);
      found.most_lag = std::max(found.most_lag, report.lag);
      found.lagging += (report.flags & ThreadReport::kLagging) != 0;
      found.flags |= report.flags;
      found.solves += report.solves;
      ++found.ticks;
    }
  }
  return found;
}

inline void expect_no_crossing(const char* make, int jerks, std::uint64_t seed) {
  const Abuse found = abuse(make, jerks, seed, 0.4, 6);
  char what[120];
  std::snprintf(what, sizeof what, "K14, %s, %d jerks to 0.4 m/s: least distance of axes, diameters", make, jerks);
  expect_between(what, found.least, 0.3, 2);
  expect_between("  while it is pulled with less than breaks it", found.least_borne, 0.5, 2);
  say("  ticks in which it is pulled with more, share", double(found.beyond) / double(found.ticks), "not judged");
  say("  ticks that lag, share; solves a tick", double(found.lagging) / double(found.ticks),
      std::to_string(double(found.solves) / double(found.ticks)) + ", lag at most [mm] " +
          std::to_string(1000 * found.most_lag));
  EXPECT_EQ(found.flags & (ThreadReport::kIndefinite | ThreadReport::kNonFinite | ThreadReport::kFull), 0u);
}

}  // namespace trocar::suture::test
