#include <algorithm>

#include <trocar/interactions/objects/suture_sling_shape.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

/// Lengths of the bend apart and of the straight piece, radii of that bend and of the arc, for a metre of thread.
struct Pear {
  double flare = 0, leg = 0, bends = 0, round = 0;

  /// Curvature at a share of the thread, positive to the inside [1/m].
  double curvature(double share) const noexcept {
    const double from_end = std::min(share, 1 - share);
    if (from_end < flare) return -1 / bends;
    return from_end < flare + leg ? 0 : 1 / round;
  }
};
Pear pear() noexcept {
  constexpr double kApart = 0.6, kFlare = 0.106;  // [rad] of each leg from the tube's axis; of the thread
  const double c = portable::cos(kApart), s = portable::sin(kApart), turn = portable::pi + 2 * kApart;
  Pear p;
  p.flare = kFlare;
  p.bends = p.flare / kApart;
  // the arc's middle lies on the axis: round c = bends (1 - c) + leg s
  p.leg = (1 - 2 * p.flare - turn * p.bends * (1 - c) / c) / (2 + turn * s / c);
  p.round = (p.bends * (1 - c) + p.leg * s) / c;
  return p;
}

/// The material's frame at a node.
struct SlingFrame {
  Vec3d along, director;
};
SlingFrame frame_at(const suture::ThreadState& t, size_t i) noexcept {
  const Vec3d along = normalised(t.x[i + 1] - t.x[i - 1]), d = t.director[i - 1] + t.director[i];
  return {along, normalised(d - dot(d, along) * along, any_perpendicular(along))};
}

}  // namespace

void lay_loop(const SutureModel& m, double thread, SutureState& s) noexcept {
  suture::ThreadState& t = s.thread;
  const SlingMouth& mouth = s.sling.mouth;
  const Pear shape = pear();
  const double h = m.thread.spacing, off = kThreadsApart * m.thread.stuff.diameter;
  const int last = std::min(m.thread.nodes - 1, int(thread / h));  // node out of the tube
  double x = 0, y = -off, angle = 0;
  // A step more than there is thread: what it misses the mouth by is shared out.
  double end_x = 0, end_y = 0;
  for (int n = 0; n < m.thread.nodes; ++n) {
    if (n <= last) {
      t.x[size_t(n)] = {x, y, 0};
      const double step = n < last ? h : thread - last * h;
      const double turn = step / thread * shape.curvature(std::min(1.0, (n * h + 0.5 * step) / thread));
      x += step * portable::cos(angle + 0.5 * turn), y += step * portable::sin(angle + 0.5 * turn);
      angle += turn;
      end_x = x, end_y = y;
    } else {
      t.x[size_t(n)] = {-(n * h - thread), off, 0};
    }
  }
  const Vec3d across = cross(mouth.axis, mouth.up);
  for (int n = 0; n < m.thread.nodes; ++n) {
    Vec3d& p = t.x[size_t(n)];
    if (n <= last) p += (n * h / thread) * Vec3d{-end_x, off - end_y, 0};
    p = mouth.tip + p.x * mouth.axis + p.y * mouth.up;
    t.v[size_t(n)] = {};
    t.twist[size_t(n)] = 0;
  }
  for (Vec3d& d : t.director) d = across;
  for (int n = 1; n + 1 < m.thread.nodes; ++n) t.bend[size_t(n)] = {};
  keep_shape(m, thread, s);
  t.self_count = t.touch_count = 0;
}

void keep_shape(const SutureModel& m, double thread, SutureState& s) noexcept {
  suture::ThreadState& t = s.thread;
  const SlingMouth& mouth = s.sling.mouth;
  const Pear shape = pear();
  const double h = m.thread.spacing;
  double angle = 0;
  for (int n = 1; n + 1 < m.thread.nodes && n * h < thread; ++n) {
    const double turn = h / thread * shape.curvature(n * h / thread);
    angle += turn;
    const double at = angle - 0.5 * turn;
    const Vec3d inside = portable::cos(at) * mouth.up - portable::sin(at) * mouth.axis;
    const SlingFrame f = frame_at(t, size_t(n));
    const Vec3d q = turn * (inside - dot(inside, f.along) * f.along);
    Vec3d& bend = t.bend[size_t(n)];
    bend.x = dot(q, f.director), bend.y = dot(q, cross(f.along, f.director));
  }
}

}  // namespace trocar::interactions
