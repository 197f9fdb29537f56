// What a thread may press on an obstacle with, where a tick could not be solved in full.
#include <algorithm>

#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

/// Of the elements beside one that touches, the greatest pull.
double pull_beside(const Tick& t, int element) {
  double most = 0;
  for (int e = std::max(0, element - 1); e <= std::min(t.m.nodes - 2, element + 1); ++e)
    most = std::max(most, tension(t.m, t.s, e));
  return most;
}

double skin_presses(const Tick& t, int node) {
  if (node >= t.m.skins || !t.given_skin(node) || t.drive.skins[node].node != node) return 0;
  return skin_touch(t, node).press;
}

}  // namespace

/// Every stretch that lies on it pulls with its two ends, is bent as far as it bears, and skin may hold it against it.
double most_press(const Tick& t, int obstacle) noexcept {
  const double bent = t.m.stuff.bend * t.m.stuff.yield_curvature / t.m.spacing;
  double most = 0, pull = 0;
  int last = -2;
  for (int k = 0; k < t.touching; ++k) {
    const Touch& touch = t.w.touch[k];
    if (touch.b != obstacle) continue;
    if (touch.a != last + 1) most += 2 * (pull + bent), pull = 0;
    pull = std::max(pull, pull_beside(t, touch.a));
    most += skin_presses(t, touch.a + 1);
    last = touch.a;
  }
  return most + 2 * (pull + bent);
}

}  // namespace trocar::suture
