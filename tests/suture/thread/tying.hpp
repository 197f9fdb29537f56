// Ties knots as hands would, throw by throw: the first is laid loosely round a post and pulled tight by both tails;
// then the tails are taken out of the air and laid in the next throw above it, and so on. Only free tails are ever
// laid; all that is tight stays as the thread itself has come to rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <trocar/suture/thread/paths.hpp>
#include <trocar/suture/thread/thread.hpp>

namespace trocar::suture::test {

struct TyingSetup {
  ThreadStuff stuff;
  double length = 0.15;
  double spacing = 2;   ///< in diameters
  double tension = 2;   ///< with which throws are pulled tight [N]
  double speed = 0.02;  ///< of the hands [m/s]
  double post_radius = 0.003;
  double post_friction = 0.1;
  double loop_radius = 0.0045;
  double solve_motion = 0.08;
  int most_solves = 64;
  Vec3d gravity{0, 0, -9.81};  ///< [m/s^2] along the post: a loop that has become loose slides down it
};

class Tying {
 public:
  explicit Tying(const TyingSetup& setup)
      : m(build({.stuff = setup.stuff,
                 .length = setup.length,
                 .spacing = setup.spacing * setup.stuff.diameter,
                 .gravity = setup.gravity,
                 .most_solves = setup.most_solves,
                 .solve_motion = setup.solve_motion})),
        w(make_work(m)),
        m_setup(setup) {}

  /// Lays the first throw and the loop round the post.
  void begin(Throw first) {
    const double d = m_setup.stuff.diameter;
    ThrowsPath path{.throws_ = {first}, .thickness = d, .tail = 0.03, .loop_radius = m_setup.loop_radius};
    double length_of = 0;
    const auto probe = laid_throws(path);
    for (std::size_t i = 1; i < probe.size(); ++i) length_of += length(probe[i] - probe[i - 1]);
    path.tail += 0.5 * (m.length - length_of) - 1e-4;
    s = laid(m, laid_throws(path));
    const double centre = -3 * 0.5 * 1.6 * d - m_setup.loop_radius;
    const double y = centre;
    posts[0] = {.present = true,
                .a = {0, y, -0.2},
                .b = {0, y, 0.2},
                .radius = m_setup.post_radius,
                .friction = m_setup.post_friction};
    take_tails();
    sign_a = 1;
  }

  /// Both tails are drawn apart until they pull with the setup's tension, then held for a while.
  bool pull(int most_ticks = 8000, int rest_ticks = 300) {
    for (int k = 0; k < most_ticks; ++k) {
      const double f = 0.5 * (length(pulls[0].force) + length(pulls[1].force));
      if (f >= m_setup.tension) {
        for (int i = 0; i < rest_ticks; ++i) tick();
        return true;
      }
      holds[0].x.x += sign_a * m_setup.speed * m.tick;
      holds[1].x.x -= sign_a * m_setup.speed * m.tick;
      tick();
    }
    return false;
  }

  /// Lays the tails in the next throw above the knot.
  void lay_next(Throw t) {
    const double d = m_setup.stuff.diameter;
    release_hold(s, 0), release_hold(s, 1);
    tick();
    int a = m.nodes, b = 0;  // where the tails leave the knot
    for (int k = 0; k < s.self_count; ++k) a = std::min(a, int(s.self[k].a)), b = std::max(b, int(s.self[k].b) + 1);
    double top = -1, middle = 0;
    for (int i = a; i <= b; ++i)
      if (s.x[i].y > top) top = s.x[i].y, middle = s.x[i].z;
    const double r = 0.8 * d, half = 4 * r * (t.turns + 0.5), y = top + 3.5 * d + r;
    const double side = s.x[a].x >= s.x[b].x ? 1 : -1;  // strand A lies on this side
    // the throw's own path: strand A enters from `side`
    ThrowsPath one{.throws_ = {t}, .thickness = d, .tail = 0.03};
    const auto whole = laid_throws(one);
    std::vector<Vec3d> up = rising(t, r, half, side < 0), other = rising(t, r, half, side > 0);
    for (auto* path : {&up, &other})
      for (Vec3d& p : *path) p += Vec3d{0, y, middle};
    lay_tail(a, -1, up, -side);
    lay_tail(b, 1, other, side);
    sign_a = -side;
    take_tails();
  }

  void tie_throws(std::span<const Throw> throws_) {
    begin(throws_[0]);
    pull();
    for (std::size_t k = 1; k < throws_.size(); ++k) lay_next(throws_[k]), pull();
  }

  /// The hands give way until the tails hang loose, let go, and everything comes to rest.
  void let_go(int rest_ticks = 500) {
    for (int k = 0; k < 400 && std::max(length(pulls[0].force), length(pulls[1].force)) > 0.02; ++k) {
      holds[0].x.x -= sign_a * m_setup.speed * m.tick;
      holds[1].x.x += sign_a * m_setup.speed * m.tick;
      tick();
    }
    release_hold(s, 0), release_hold(s, 1);
    for (int k = 0; k < rest_ticks; ++k) tick();
  }

  /// Nodes where the tails leave the knot.
  std::pair<int, int> knot_ends() const {
    int a = m.nodes, b = 0;
    for (int k = 0; k < s.self_count; ++k) a = std::min(a, int(s.self[k].a)), b = std::max(b, int(s.self[k].b) + 1);
    return {a, b};
  }

  /// Force that the loop's two posts are drawn apart with [N]. The second post appears where the first is.
  double loop_force() const { return 0.5 * (std::fabs(presses[0].force.x) + std::fabs(presses[1].force.x)); }
  double opening() const { return posts[1].a.x - posts[0].a.x; }
  void begin_loop() {
    posts[1] = posts[0];
    tick();
  }
  void draw_loop(double speed) {
    for (int side = 0; side < 2; ++side) {
      const double dx = (side == 0 ? -0.5 : 0.5) * speed * m.tick;
      posts[side].a.x += dx, posts[side].b.x += dx;
    }
    tick();
  }
  /// Draws until the loop bears `force`, or is `most_opening` wide: what it bore at most.
  double draw_to(double force, double most_opening, double speed = 0.01) {
    double most = 0;
    while (opening() < most_opening) {
      draw_loop(speed);
      most = std::max(most, loop_force());
      if (loop_force() >= force) break;
    }
    return most;
  }
  /// Keeps the force for a time; the loop's opening in it [m].
  double keep(double force, int most_ticks, double most_opening) {
    const double before = opening();
    for (int k = 0; k < most_ticks && opening() < most_opening; ++k)
      draw_loop(std::max(-0.02, std::min(0.02, 0.04 * (force - loop_force()) / force)));
    return opening() - before;
  }

  ThreadReport tick() {
    last = advance(m, {.holds = holds, .obstacles = posts}, {.holds = pulls, .obstacles = presses}, s, w);
    flags |= last.flags;
    solves += last.solves;
    ++ticks;
    return last;
  }

  void take_tails() {
    take_hold(m, s, 0, 0.001), take_hold(m, s, 1, m.length - 0.001);
    holds[0].x = point_at(m, s, 0.001), holds[1].x = point_at(m, s, m.length - 0.001);
  }

  ThreadModel m;
  ThreadState s;
  ThreadWork w;
  Hold holds[2];
  HoldReaction pulls[2];
  Obstacle posts[2];
  ObstacleReaction presses[2];
  ThreadReport last;
  std::uint32_t flags = 0;
  long solves = 0, ticks = 0;
  double sign_a = 1;

 private:
  /// A strand of a throw, from below to above, from the left or from the right.
  static std::vector<Vec3d> rising(Throw t, double r, double half, bool from_left) {
    std::vector<Vec3d> path;
    const double whole = (2 * t.turns + 1) * 3.14159265358979;
    const int pieces = 16 * (2 * t.turns + 1);
    for (int k = 0; k <= pieces; ++k) {
      const double u = double(k) / pieces, along = from_left ? u : 1 - u;
      const double angle = (from_left ? -0.5 : 0.5) * 3.14159265358979 + t.sign * whole * along;
      path.push_back({(from_left ? -1 : 1) * (half - 2 * half * u), r * std::sin(angle), r * std::cos(angle)});
    }
    return path;
  }

  /// Nodes beyond `from` (towards -1: the beginning, 1: the end) are laid along the path and then straight to a side.
  void lay_tail(int from, int step, std::vector<Vec3d> path, double out) {
    path.insert(path.begin(), s.x[from]);
    const Vec3d end = path.back() + Vec3d{out * 0.2, 0.02, 0};
    path.push_back(end);
    path = smoothed(path, 2);
    ThreadModel tail = m;
    tail.nodes = step < 0 ? from + 1 : m.nodes - from;
    if (tail.nodes < 2) return;
    const ThreadState laid_tail = laid(tail, path);
    for (int k = 1; k < tail.nodes; ++k) {
      const int i = from + step * k;
      s.x[i] = laid_tail.x[k], s.v[i] = {}, s.bend[i] = {}, s.twist[i] = 0;
      const int e = step < 0 ? i : i - 1;
      s.director[e] = laid_tail.director[k - 1];
    }
    s.bend[from] = {}, s.twist[from] = 0;
    // what the knot's side has for a director goes on without twist
    const int inner = step < 0 ? from : from - 1, first = step < 0 ? from - 1 : from;
    Vec3d t = normalised(s.x[inner + 1] - s.x[inner]), d = s.director[inner];
    for (int e = first; e >= 0 && e < m.nodes - 1; e += step) {
      const Vec3d next = normalised(s.x[e + 1] - s.x[e]), axis = cross(t, next);
      const double c = 1 + dot(t, next);
      d = d + cross(axis, d) + (1 / std::max(c, 0.02)) * cross(axis, cross(axis, d));
      d = normalised(d - dot(d, next) * next);
      s.director[e] = d;
      t = next;
    }
  }

  TyingSetup m_setup;
};

/// The least distance of axes that touch, in diameters.
inline double least_distance(const Tying& rig) {
  double least = 2;
  for (int k = 0; k < rig.last.contacts; ++k) {
    const Touch& q = rig.w.self[k];
    const Vec3d p =
        (1 - q.s) * rig.s.x[q.a] + q.s * rig.s.x[q.a + 1] - (1 - q.t) * rig.s.x[q.b] - q.t * rig.s.x[q.b + 1];
    least = std::min(least, length(p) / rig.m.stuff.diameter);
  }
  return least;
}

}  // namespace trocar::suture::test
