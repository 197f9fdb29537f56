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

/// Rest bends are those of the nodes as they lie.
void remember_bends(const SutureModel& m, int last, SutureState& s) noexcept {
  suture::ThreadState& t = s.thread;
  for (int n = 1; n + 1 < m.thread.nodes; ++n) {
    const size_t i = size_t(n);
    t.bend[i] = {};
    if (n >= last) continue;
    const Vec3d before = (t.x[i] - t.x[i - 1]) / m.thread.spacing, after = (t.x[i + 1] - t.x[i]) / m.thread.spacing;
    const Vec3d along = normalised(before + after, after), q = after - before;
    t.bend[i] = {dot(q, t.director[i]), dot(q, cross(along, t.director[i])), 0};
  }
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
  remember_bends(m, last, s);
  t.self_count = t.touch_count = 0;
}

}  // namespace trocar::interactions
