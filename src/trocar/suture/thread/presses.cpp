// What a thread can do to what holds it or lies in its way, where a tick could not be solved in full.
#include <algorithm>

#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

/// Of the elements beside one that touches, the greatest pull; no more than the thread bears.
double pull_beside(const Tick& t, int element) {
  double most = 0;
  for (int e = std::max(0, element - 1); e <= std::min(t.m.nodes - 2, element + 1); ++e)
    most = std::max(most, tension(t.m, t.s, e));
  return std::min(most, t.m.stuff.break_force);
}

/// Across itself, bent as far as it bears.
double bent(const Tick& t) { return t.m.stuff.bend * t.m.stuff.yield_curvature / t.m.spacing; }

/// Of the skin that a node has gone into, without what hardens there: that only keeps the node out.
double skin_presses(const Tick& t, int node) {
  if (node >= t.m.skins || !t.given_skin(node) || t.drive.skins[node].node != node) return 0;
  const SkinContact& c = t.drive.skins[node];
  const double gap = dot(t.s.x[node] - c.point, c.normal) - 0.5 * t.m.stuff.diameter;
  return gap < 0 ? -gap * c.stiffness : 0;
}

}  // namespace

double most_pull(const Tick& t, int element) noexcept { return 2 * (pull_beside(t, element) + bent(t)); }

/// Every stretch that lies on it pulls with its two ends, is bent as far as it bears, and skin may hold it against it.
double most_press(const Tick& t, int obstacle) noexcept {
  double most = 0, pull = 0;
  int last = -2;
  for (int k = 0; k < t.touching; ++k) {
    const Touch& touch = t.w.touch[k];
    if (touch.b != obstacle) continue;
    if (last >= 0 && touch.a != last + 1) most += 2 * (pull + bent(t)), pull = 0;
    pull = std::max(pull, pull_beside(t, touch.a));
    most += skin_presses(t, touch.a + 1);
    last = touch.a;
  }
  return most + 2 * (pull + bent(t));
}

}  // namespace trocar::suture
