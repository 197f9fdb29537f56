#include <trocar/kinematics/loops/conditions.hpp>

namespace trocar::kinematics {

bool is_length(const Condition& c) noexcept { return c.kind == Condition::Kind::along; }

void residuals(std::span<const Closure> closures, const Pose& pose, double* r) noexcept {
  for (const Closure& c : closures) {
    const auto [a, b] = frames_of(c, pose);
    const Vec3d apart = b.p - a.p;
    Vec3d turn;
    if ((c.directions & kR) == kR) turn = turn_between(a.r, b.r);
    for (int n = 0; n < c.count; ++n) {
      const Condition& k = c.conditions[std::size_t(n)];
      const Vec3d axis = a.r.column(k.i);
      *r++ = dot(axis, k.kind == Condition::Kind::along    ? apart
                       : k.kind == Condition::Kind::square ? b.r.column(k.k)
                                                           : turn);
    }
  }
}

namespace {

/// A condition changes by f . (speed of b's origin as if fixed to the moving link) + g . (turning speed), with + where
/// b's side moves and - where a's does.
struct Gradient {
  Vec3d f, g;
};

Gradient gradient(const Condition& k, const Frame& a, const Frame& b) noexcept {
  const Vec3d axis = a.r.column(k.i);
  switch (k.kind) {
    case Condition::Kind::along:
      return {axis, {}};
    case Condition::Kind::square:
      return {{}, cross(b.r.column(k.k), axis)};
    case Condition::Kind::twist:
      break;
  }
  return {{}, axis};  // exact where there is no turn, which is where it matters
}

}  // namespace

void slopes(const Mechanism& m, std::span<const Closure> closures, const Pose& pose, double* j, int rows,
            int first) noexcept {
  const int n = m.u_count();
  for (const Closure& c : closures) {
    for (int u = 0; u < n; ++u)
      for (int k = 0; k < c.count; ++k) j[u * rows + first + k] = 0;
    const auto [fa, fb] = frames_of(c, pose);
    Gradient gradients[6];
    for (int k = 0; k < c.count; ++k) gradients[k] = gradient(c.conditions[std::size_t(k)], fa, fb);
    int a = c.a.body, b = c.b.body;
    while (a != b) {  // what carries both changes nothing
      const bool on_a = a > b;
      const int at = on_a ? a : b;
      const Body& body = m.bodies[std::size_t(at)];
      (on_a ? a : b) = body.parent;
      if (body.motion == Motion::none) continue;
      const Vec3d axis = pose.axes[std::size_t(at)];
      const bool turns = body.motion == Motion::turn;
      const Vec3d move = turns ? cross(axis, fb.p - pose.frames[std::size_t(at)].p) : axis;
      for (int k = 0; k < c.count; ++k) {
        double slope = dot(gradients[k].f, move);
        if (turns) slope += dot(gradients[k].g, axis);
        if (on_a) slope = -slope;
        for (int e = m.expand_start[std::size_t(body.coordinate)]; e < m.expand_start[std::size_t(body.coordinate) + 1];
             ++e)
          j[m.expand[std::size_t(e)].u * rows + first + k] += m.expand[std::size_t(e)].ratio * slope;
      }
    }
    first += c.count;
  }
}

void curvatures(std::span<const Closure> closures, const Pose& pose, std::span<const Twist> speeds,
                std::span<const Twist> bias, double* out) noexcept {
  // Of a point p of a body: v = move + turn x s, a = bias.move + bias.turn x s + turn x (turn x s), s = p - origin.
  const auto speed = [&](int body, Vec3d p) {
    const Twist& t = speeds[std::size_t(body)];
    return t.move + cross(t.turn, p - pose.frames[std::size_t(body)].p);
  };
  const auto acceleration = [&](int body, Vec3d p) {
    const Vec3d s = p - pose.frames[std::size_t(body)].p, w = speeds[std::size_t(body)].turn;
    const Twist& t = bias[std::size_t(body)];
    return t.move + cross(t.turn, s) + cross(w, cross(w, s));
  };
  for (const Closure& c : closures) {
    const auto [a, b] = frames_of(c, pose);
    const Vec3d apart = b.p - a.p;
    const Vec3d v = speed(c.b.body, b.p) - speed(c.a.body, a.p);
    const Vec3d dv = acceleration(c.b.body, b.p) - acceleration(c.a.body, a.p);
    const Vec3d wa = speeds[std::size_t(c.a.body)].turn, wb = speeds[std::size_t(c.b.body)].turn;
    const Vec3d da = bias[std::size_t(c.a.body)].turn, db = bias[std::size_t(c.b.body)].turn;
    for (int n = 0; n < c.count; ++n) {
      const Condition& k = c.conditions[std::size_t(n)];
      const Vec3d axis = a.r.column(k.i), rate = cross(wa, axis), bend = cross(da, axis) + cross(wa, rate);
      if (k.kind == Condition::Kind::along) {
        *out++ = dot(axis, dv) + 2 * dot(rate, v) + dot(bend, apart);
      } else if (k.kind == Condition::Kind::square) {
        const Vec3d other = b.r.column(k.k), other_rate = cross(wb, other);
        *out++ = dot(bend, other) + 2 * dot(rate, other_rate) + dot(axis, cross(db, other) + cross(wb, other_rate));
      } else {
        *out++ = dot(axis, db - da) + dot(rate, wb - wa);
      }
    }
  }
}

}  // namespace trocar::kinematics
