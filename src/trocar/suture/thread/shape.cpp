// Lengths, directions and bends of a thread, and how they change when its nodes move.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

constexpr double kMostSpeed = 3;  ///< that a node is taken to have [m/s]

Vec3d bend_in_space(const Tick& t, int i) {
  const Vec3d d = t.w.node_director[i];
  return t.s.bend[i].x * d + t.s.bend[i].y * cross(t.w.node_along[i], d);
}

}  // namespace

void measure(Tick& t) noexcept {
  ThreadWork& w = t.w;
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    const Vec3d d = t.s.x[e + 1] - t.s.x[e];
    w.length[e] = length(d);
    w.along[e] = w.length[e] > 1e-30 ? d / w.length[e] : Vec3d{1, 0, 0};
  }
  const double scale = 1 / t.m.spacing;
  for (int i = 1; i + 1 < t.m.nodes; ++i) {
    const Vec3d before = w.along[i - 1], after = w.along[i];
    const Vec3d along = normalised(before + after, after);
    const Vec3d d = turned(before, along, t.s.director[i - 1]) + turned(after, along, t.s.director[i]);
    const Vec3d q = scale * (w.length[i] * after - w.length[i - 1] * before);
    w.node_along[i] = along;
    w.node_director[i] = normalised(d - dot(d, along) * along, any_perpendicular(along));
    w.bend_now[i] = q - dot(q, along) * along;
    w.bend_rest[i] = bend_in_space(t, i);
  }
}

void move_nodes(Tick& t, double share) noexcept {
  double most = 0;
  for (int i = 0; i < t.m.nodes; ++i) {
    const Vec3d move = share * t.w.delta[i], v = (1 / t.h) * move;
    const double size = dot(move, move), speed2 = dot(v, v);
    most = std::max(most, size);
    t.s.v[i] = speed2 > kMostSpeed * kMostSpeed ? (kMostSpeed / std::sqrt(speed2)) * v : v;
    t.s.x[i] += move;
  }
  t.moved += std::sqrt(most);
  for (int e = 0; e + 1 < t.m.nodes; ++e)
    t.s.director[e] = carried(t.w.along[e], normalised(t.s.x[e + 1] - t.s.x[e], t.w.along[e]), t.s.director[e]);
}

void flow(Tick& t) noexcept {
  const double yield = t.m.stuff.yield_curvature * t.m.spacing;
  const double harden = t.m.stuff.hardening / (1 - t.m.stuff.hardening);
  for (int i = 1; i + 1 < t.m.nodes; ++i) {
    if (!bends(t.s, i)) continue;
    t.w.bend_rest[i] = bend_in_space(t, i);  // the material has spun
    if (!(yield > 0)) continue;
    const Vec3d over = t.w.bend_now[i] - (1 + harden) * t.w.bend_rest[i];
    const double size = length(over);
    Vec3d& bend = t.s.bend[i];
    bend.z = size;
    if (!(size > yield)) continue;
    const Vec3d more = ((size - yield) / (size * (1 + harden))) * over;
    bend.x += dot(more, t.w.node_director[i]);
    bend.y += dot(more, cross(t.w.node_along[i], t.w.node_director[i]));
    t.w.bend_rest[i] = bend_in_space(t, i);
  }
}

}  // namespace trocar::suture
