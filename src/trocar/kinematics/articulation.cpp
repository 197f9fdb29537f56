#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <trocar/kinematics/articulation.hpp>
#include <trocar/kinematics/chains/frame.hpp>

namespace trocar::kinematics {
namespace {

constexpr int kShaftCoordinates = 4;
constexpr int kArmCoordinates = kShaftCoordinates + kMaxJoints;
constexpr int kRows = 6;
constexpr double kShortest = 1e-9;    // [m] a piece of the chain that counts as none
constexpr double kMetre = 20;         // a radian weighs as 50 mm do
constexpr double kDamping = 1e-4;     // squared, where the goal is reached
constexpr double kMoreDamping = 0.1;  // of the error's square on top, as far from the goal slopes mislead
constexpr double kStraighten = 0.1;   // of what is left over, in a round
constexpr double kFarthest = 0.5;     // scaled error that a round answers to

/// Motion of the tip by one coordinate: turn, and way in scaled metres.
using Column = std::array<double, kRows>;
struct Slopes {
  std::array<Column, kArmCoordinates> by{};
  int count = 0;
};

void put_column(Column& c, Vec3d turn, Vec3d way) noexcept {
  for (int k = 0; k < 3; ++k) {
    c[std::size_t(k)] += kMetre * way[k];
    c[std::size_t(3 + k)] += turn[k];
  }
}

/// Turning about `axis` through `at` moves the tip so.
void add_turn(Column& c, Vec3d axis, Vec3d at, Vec3d tip, double share = 1) noexcept {
  put_column(c, share * axis, share * cross(axis, tip - at));
}

/// Of the tip, by yaw, pitch, roll, depth and the joints.
Slopes slopes_of(const Articulation& bends, Vec3d port, const Arm& arm, Vec3d tip, double jaw_length) noexcept {
  Slopes s;
  s.count = kShaftCoordinates + bends.joints;
  const double cy = portable::cos(arm.pose.yaw), sy = portable::sin(arm.pose.yaw);
  const TipFrame straight = forward(port, arm.pose);
  add_turn(s.by[0], {0, 1, 0}, port, tip);
  add_turn(s.by[1], {cy, 0, -sy}, port, tip);
  add_turn(s.by[2], straight.rotation.column(2), port, tip);
  put_column(s.by[3], {0, 0, 0}, straight.axis());
  Frame at{straight.rotation, straight.tip - (jaw_length + bends.length()) * straight.axis()};
  for (int h = 0; h < bends.hinges; ++h) {
    const Hinge& hinge = bends.hinge[h];
    at.p = at.p - hinge.before * at.r.column(2);
    const Vec3d axis = at.r.column(hinge.across ? 1 : 0);
    add_turn(s.by[std::size_t(kShaftCoordinates + hinge.joint)], axis, at.p, tip, hinge.share);
    at.r =
        at.r * turn_about(hinge.across ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, hinge.share * arm.joints.angle[hinge.joint]);
  }
  return s;
}

/// Turns about that axis count no more.
void let_turn(Slopes& s, Vec3d axis) noexcept {
  for (int c = 0; c < s.count; ++c) {
    Column& column = s.by[std::size_t(c)];
    const double about = dot(Vec3d{column[3], column[4], column[5]}, axis);
    for (int k = 0; k < 3; ++k) column[std::size_t(3 + k)] -= about * axis[k];
  }
}

/// What is missing, scaled; no further than a round can answer to.
Column missing(const Goal& goal, const TipFrame& tip) noexcept {
  Column e{};
  Vec3d turn = turn_between(tip.rotation, goal.rotation);
  if (!goal.turn_too) {
    // The turn that brings axis to axis: what the jaws do about theirs is free.
    const Vec3d from = tip.axis(), to = -goal.rotation.column(2), across = cross(from, to);
    const double sine = length(across);
    turn = sine > 1e-12 ? (portable::atan2(sine, dot(from, to)) / sine) * across : Vec3d{0, 0, 0};
  }
  put_column(e, turn, goal.tip - tip.tip);
  double size2 = 0;
  for (const double v : e) size2 += v * v;
  const double size = std::sqrt(size2), share = size > kFarthest ? kFarthest / size : 1.0;
  for (double& v : e) v *= share;
  return e;
}

/// A x = b of a symmetric positive matrix, by Cholesky. b becomes x.
void solve(double (&a)[kRows][kRows], Column& b) noexcept {
  for (int j = 0; j < kRows; ++j) {
    for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    a[j][j] = std::sqrt(std::max(a[j][j], 1e-18));
    for (int i = j + 1; i < kRows; ++i) {
      for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  for (int i = 0; i < kRows; ++i) {
    for (int k = 0; k < i; ++k) b[std::size_t(i)] -= a[i][k] * b[std::size_t(k)];
    b[std::size_t(i)] /= a[i][i];
  }
  for (int i = kRows - 1; i >= 0; --i) {
    for (int k = i + 1; k < kRows; ++k) b[std::size_t(i)] -= a[k][i] * b[std::size_t(k)];
    b[std::size_t(i)] /= a[i][i];
  }
}

using Coordinates = std::array<double, kArmCoordinates>;

/// The step W Jt (J W Jt + damping)^-1 (e - J z) + z: towards e, and along z where e does not care.
Coordinates step_of(const Slopes& s, const Coordinates& weight, const Column& error, const Coordinates& along,
                    double damping) noexcept {
  double a[kRows][kRows] = {};
  Column b = error;
  for (int c = 0; c < s.count; ++c) {
    const Column& column = s.by[std::size_t(c)];
    for (std::size_t i = 0; i < kRows; ++i) {
      b[i] -= column[i] * along[std::size_t(c)];
      for (std::size_t k = 0; k <= i; ++k) a[i][k] += weight[std::size_t(c)] * column[i] * column[k];
    }
  }
  for (int i = 0; i < kRows; ++i) a[i][i] += damping;
  solve(a, b);
  Coordinates step = along;
  for (int c = 0; c < s.count; ++c) {
    double sum = 0;
    for (std::size_t i = 0; i < kRows; ++i) sum += s.by[std::size_t(c)][i] * b[i];
    step[std::size_t(c)] += weight[std::size_t(c)] * sum;
  }
  return step;
}

struct Range {
  double low, high;
};
Range range_of(const Articulation& bends, const FulcrumLimits& limits, int c) noexcept {
  if (c < 2) return {-limits.angle, limits.angle};
  if (c == 2) return {-limits.roll, limits.roll};
  if (c == 3) return {limits.depth_min, limits.depth_max};
  return {bends.low[c - kShaftCoordinates], bends.high[c - kShaftCoordinates]};
}

Coordinates coordinates_of(const Arm& arm) noexcept {
  Coordinates q{arm.pose.yaw, arm.pose.pitch, arm.pose.roll, arm.pose.depth};
  for (int j = 0; j < kMaxJoints; ++j) q[std::size_t(kShaftCoordinates + j)] = arm.joints.angle[j];
  return q;
}
Arm arm_of(const Coordinates& q) noexcept {
  Arm arm{{q[0], q[1], q[2], q[3]}, {}};
  for (int j = 0; j < kMaxJoints; ++j) arm.joints.angle[j] = q[std::size_t(kShaftCoordinates + j)];
  return arm;
}

}  // namespace

double Articulation::length() const noexcept {
  double sum = after;
  for (int h = 0; h < hinges; ++h) sum += hinge[h].before;
  return sum;
}

int Articulation::links() const noexcept {
  int n = after > kShortest ? 1 : 0;
  for (int h = 0; h < hinges; ++h) n += hinge[h].before > kShortest ? 1 : 0;
  return n;
}

Articulation wrist(double between, double after, double most_pitch, double most_yaw) noexcept {
  Articulation a;
  a.joints = a.hinges = 2;
  a.hinge[0] = {0, 1, 0, 0};
  a.hinge[1] = {between, 1, 1, 1};
  a.low[0] = -most_pitch, a.high[0] = most_pitch;
  a.low[1] = -most_yaw, a.high[1] = most_yaw;
  a.after = after;
  return a;
}

Chain chain(const Articulation& bends, Vec3d port, const FulcrumPose& pose, const Joints& joints,
            double jaw_length) noexcept {
  Chain c;
  c.shaft = forward(port, pose);
  c.shaft.tip = c.shaft.tip - (jaw_length + bends.length()) * c.shaft.axis();
  Frame at{c.shaft.rotation, c.shaft.tip};
  c.bend[0] = at.p;
  const auto go_on = [&c, &at](double way) {
    at.p = at.p - way * at.r.column(2);
    if (way > kShortest && c.links < kMaxLinks) c.bend[++c.links] = at.p;
  };
  for (int h = 0; h < bends.hinges; ++h) {
    const Hinge& hinge = bends.hinge[h];
    go_on(hinge.before);
    const double angle = hinge.share * joints.angle[hinge.joint];
    if (angle != 0) at.r = at.r * turn_about(hinge.across ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, angle);
  }
  go_on(bends.after);
  c.tip = {at.p - jaw_length * at.r.column(2), at.r};
  return c;
}

TipFrame forward(const Articulation& bends, Vec3d port, const FulcrumPose& pose, const Joints& joints,
                 double jaw_length) noexcept {
  return bends.bends() ? chain(bends, port, pose, joints, jaw_length).tip : forward(port, pose);
}

Joints clamped(const Articulation& bends, const Joints& joints) noexcept {
  Joints out;
  for (int j = 0; j < bends.joints; ++j) out.angle[j] = std::clamp(joints.angle[j], bends.low[j], bends.high[j]);
  return out;
}

TipFrame led(Vec3d port, const FulcrumPose& pose, double pitch, double yaw) noexcept {
  TipFrame frame = forward(port, pose);
  frame.rotation = frame.rotation * turn_about({1, 0, 0}, pitch) * turn_about({0, 1, 0}, yaw);
  return frame;
}

Arm reach(const Articulation& bends, const FulcrumLimits& limits, Vec3d port, double jaw_length, const Goal& goal,
          const Arm& from, int rounds) noexcept {
  Arm arm{clamped(from.pose, limits), clamped(bends, from.joints)};
  for (int round = 0; round < rounds; ++round) {
    const TipFrame tip = forward(bends, port, arm.pose, arm.joints, jaw_length);
    Slopes slopes = slopes_of(bends, port, arm, tip.tip, jaw_length);
    if (!goal.turn_too) let_turn(slopes, tip.axis());
    const Column error = missing(goal, tip);
    double size2 = 0;
    for (const double e : error) size2 += e * e;
    Coordinates q = coordinates_of(arm), weight{}, along{};
    for (int c = 0; c < slopes.count; ++c) weight[std::size_t(c)] = c == 3 ? 1 / (kMetre * kMetre) : 1.0;
    for (int c = kShaftCoordinates; c < slopes.count; ++c) along[std::size_t(c)] = -kStraighten * q[std::size_t(c)];
    const double damping = kDamping + kMoreDamping * size2;
    Coordinates step = step_of(slopes, weight, error, along, damping);
    // What would leave its range rests where that ends, and the others do its share.
    bool again = false;
    Coordinates stays{};
    for (int c = 0; c < slopes.count; ++c) {
      const Range r = range_of(bends, limits, c);
      const double to = std::clamp(q[std::size_t(c)] + step[std::size_t(c)], r.low, r.high);
      if (to == q[std::size_t(c)] + step[std::size_t(c)]) continue;
      stays[std::size_t(c)] = to - q[std::size_t(c)];
      weight[std::size_t(c)] = 0;
      again = true;
    }
    if (again) {
      for (int c = 0; c < slopes.count; ++c)
        if (weight[std::size_t(c)] == 0) along[std::size_t(c)] = stays[std::size_t(c)];
      step = step_of(slopes, weight, error, along, damping);
    }
    for (int c = 0; c < slopes.count; ++c) {
      const Range r = range_of(bends, limits, c);
      q[std::size_t(c)] = std::clamp(q[std::size_t(c)] + step[std::size_t(c)], r.low, r.high);
    }
    arm = arm_of(q);
  }
  return arm;
}

}  // namespace trocar::kinematics
