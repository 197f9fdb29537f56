#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/studies/operating_room/motion.hpp>

namespace trocar::studies {

using namespace kinematics;
using scene::Programme;
using scene::RoomTilt;

namespace {

constexpr double kSame = 0.3;  // a fault that comes back within this time is the same one [s]

Vec3d mixed(Vec3d a, Vec3d b, double t) { return a + t * (b - a); }

/// The two entries about a moment, and how far between them.
template <class Entry>
std::pair<std::size_t, double> between(const std::vector<Entry>& entries, double at) {
  std::size_t k = 0;
  while (k + 1 < entries.size() && entries[k + 1].at <= at) ++k;
  if (k + 1 >= entries.size() || at <= entries[k].at) return {k, 0};
  return {k, least_jerk((at - entries[k].at) / (entries[k + 1].at - entries[k].at))};
}

ArmGoal goal_of(const std::vector<Programme::Pose>& poses, Vec3d port, double at) {
  const auto [k, t] = between(poses, at);
  const Programme::Pose &a = poses[k], &b = poses[std::min(k + 1, poses.size() - 1)];
  ArmGoal g;
  g.tip = t == 0 ? a.tip : mixed(a.tip, b.tip, t);
  g.aims = a.aims || (t > 0 && b.aims);
  if (!g.aims) return g;
  const auto axes = [&](const Programme::Pose& p) {
    return jaw_axes(length(p.towards) > 0 ? p.towards : p.tip - port, p.roll);
  };
  if (a.aims && b.aims && !(length(a.towards) > 0) && !(length(b.towards) > 0)) {  // along the shaft all the way
    g.axes = jaw_axes(g.tip - port, a.roll + t * (b.roll - a.roll));
    return g;
  }
  const Mat3d from = axes(a);
  if (t == 0) {
    g.axes = from;
    return g;
  }
  const Vec3d turn = turn_between(from, axes(b));
  const double angle = length(turn);
  g.axes = angle > 1e-12 ? turn_about(turn / angle, t * angle) * from : from;
  return g;
}

class Going {
 public:
  Going(const RoomModel& model, const RoomMotion& motion, const MotionOptions& options)
      : m(model), m_motion(motion), o(options) {}

  MotionReport go() {
    r.length = m_motion.length;
    r.least_clearance = 1e9;
    RoomPose pose = m.start();
    pose.tilt = m_motion.tilt(0);
    if (m_motion.tips) pose.tips = m_motion.tips(0);
    const int last = std::max(0, int(std::ceil(m_motion.length / o.step - 1e-9)));
    for (int k = 0; k <= last; ++k) {
      const double at = std::min(m_motion.length, k * o.step);
      const bool keep = k % std::max(1, o.kept_every) == 0 || k == last;
      step(pose, at, k == 0, keep);
      if (o.stops && !r.faults.empty()) break;
    }
    std::stable_sort(r.faults.begin(), r.faults.end(),
                     [](const MotionFault& a, const MotionFault& b) { return a.from < b.from; });
    return std::move(r);
  }

 private:
  void step(RoomPose& pose, double at, bool first, bool keep) {
    ++r.count;
    m_at = at;
    MotionStep s;
    s.at = at;
    s.arms.resize(m.arms().size());
    const RoomPose before = pose;
    pose.tilt = m_motion.tilt(at);
    if (m_motion.tips) pose.tips = m_motion.tips(at);
    if (!m.can_tilt(pose.tilt)) fault(MotionFaultKind::tilt, -1, "table", 0, {}, "the table cannot tilt so far");
    for (const int a : m_motion.moves) lead(pose, a, s, first);
    for (std::size_t a = 0; a < m.arms().size(); ++a) {
      const double gap = port_gap(m.shaft(pose, int(a)), m.arms()[a].port);
      r.port_gap = std::max(r.port_gap, gap);
      if (gap > o.keep_port)
        fault(MotionFaultKind::port, int(a), m.arms()[a].described->port, gap, m.arms()[a].port,
              tr("its shaft misses its port by {:.2f} mm", 1e3 * gap));
      if (!first) speeds(before, pose, int(a), at, s);
    }
    collisions(pose, s);
    if (keep) {
      s.pose = pose;
      r.steps.push_back(std::move(s));
    }
  }

  void lead(RoomPose& pose, int a, MotionStep& s, bool first) {
    const ArmGoal goal = m_motion.goal(a, m_at);
    Reached& reached = s.arms[std::size_t(a)].reached;
    reached = m.lead(pose, a, goal);
    r.loop_gap = std::max(r.loop_gap, reached.loop_gap);
    if (!reached.within_limits)
      fault(MotionFaultKind::limit, a, reached.limit, reached.missed, goal.tip,
            tr("\"{}\" would be beyond its limits", reached.limit));
    else if (!reached.reached)
      fault(MotionFaultKind::reach, a, "", reached.missed, goal.tip,
            tr("does not reach: {:.1f} mm short of ({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * reached.missed, 1e3 * goal.tip.x,
               1e3 * goal.tip.y, 1e3 * goal.tip.z));
    if (first && reached.reached && o.clear_from > 0 && goal.aims) m.clear(pose, a, goal);
  }

  void speeds(const RoomPose& before, const RoomPose& pose, int a, double at, MotionStep& s) {
    const Mechanism& mech = m.arms()[std::size_t(a)].mechanism;
    const scene::RoomArm& arm = *m.arms()[std::size_t(a)].described;
    const double time = std::min(o.step, at);
    if (!(time > 0)) return;
    int fastest = -1;
    double most = 0;
    for (std::size_t i = 0; i < mech.independent.size(); ++i) {
      const auto q = std::size_t(mech.independent[i]);
      const double allowed = mech.measures[q] == Measure::length ? arm.fastest_slide : arm.fastest_turn;
      const double share = std::fabs(pose.u[std::size_t(a)][i] - before.u[std::size_t(a)][i]) / time / allowed;
      if (share > most) most = share, fastest = int(q);
    }
    s.arms[std::size_t(a)].speed = most;
    r.most_speed = std::max(r.most_speed, most);
    if (most > 1 + 1e-9)
      fault(MotionFaultKind::speed, a, mech.coordinates[std::size_t(fastest)], most, m.tip(pose, a).p,
            tr("\"{}\" would move at {:.2f} times its greatest speed", mech.coordinates[std::size_t(fastest)], most));
  }

  void collisions(const RoomPose& pose, MotionStep& s) {
    for (MotionStep::Arm& a : s.arms) a.clearance = 1e9;
    for (const Near& n : m.nearest(pose)) {
      for (const int a : {n.arm, n.other}) {
        if (a < 0) continue;
        MotionStep::Arm& arm = s.arms[std::size_t(a)];
        if (n.distance < arm.clearance) {
          arm.clearance = n.distance;
          arm.nearest = a == n.arm ? n.second : n.first;
        }
      }
      if (n.distance < r.least_clearance) {
        r.least_clearance = n.distance;
        r.least_at = m_at;
        r.least_pair = n.first + " and " + n.second;
      }
      if (n.distance < m.room().margin)
        fault(MotionFaultKind::collision, n.arm, n.second.substr(0, n.second.find(':')), n.distance, n.where(),
              n.distance < 0 ? tr("\"{}\" and \"{}\" overlap by {:.1f} mm", n.first, n.second, -1e3 * n.distance)
                             : tr("\"{}\" and \"{}\" are {:.1f} mm apart, less than the margin of {:.1f}", n.first,
                                  n.second, 1e3 * n.distance, 1e3 * m.room().margin));
    }
  }

  /// A fault that continues is one; the worst of it is reported.
  void fault(MotionFaultKind kind, int arm, const std::string& with, double worst, Vec3d where, std::string words) {
    for (MotionFault& f : r.faults) {
      if (f.kind != kind || f.arm != arm || f.with != with || f.to < m_at - std::max(1.5 * o.step, kSame)) continue;
      f.to = m_at;
      const bool less = kind == MotionFaultKind::collision;
      if (less ? worst < f.worst : worst > f.worst) {
        f.worst = worst;
        f.worst_at = m_at;
        f.where = where;
        f.words = std::move(words);
      }
      return;
    }
    r.faults.push_back({kind, arm, with, m_at, m_at, worst, m_at, where, std::move(words)});
  }

  const RoomModel& m;
  const RoomMotion& m_motion;
  const MotionOptions& o;
  double m_at = 0;
  MotionReport r;
};

}  // namespace

double least_jerk(double t) noexcept { return t * t * t * (10 + t * (-15 + 6 * t)); }

RoomMotion motion_of(const RoomModel& model, const Programme& programme) {
  RoomMotion motion;
  motion.length = programme.length();
  std::vector<std::vector<Programme::Pose>> poses(model.arms().size());
  std::vector<Vec3d> ports;
  for (const ArmModel& a : model.arms()) ports.push_back(a.port);
  for (const Programme::Move& m : programme.moves)
    if (const int arm = model.arm(m.arm); arm >= 0) {
      motion.moves.push_back(arm);
      poses[std::size_t(arm)] = m.poses;
    }
  motion.goal = [poses, ports](int arm, double at) {
    return goal_of(poses[std::size_t(arm)], ports[std::size_t(arm)], at);
  };
  const RoomTilt still = model.room().table.tilt;
  motion.tilt = [tilts = programme.tilts, still](double at) {
    if (tilts.empty()) return still;
    const auto [k, t] = between(tilts, at);
    const RoomTilt &a = tilts[k].tilt, &b = tilts[std::min(k + 1, tilts.size() - 1)].tilt;
    return RoomTilt{a.head_down + t * (b.head_down - a.head_down), a.left_down + t * (b.left_down - a.left_down)};
  };
  return motion;
}

const char* word_of(MotionFaultKind kind) {
  constexpr const char* kWords[] = {"reach", "limit", "speed", "port", "collision", "tilt"};
  return kWords[std::size_t(kind)];
}

MotionReport go_through(const RoomModel& model, const RoomMotion& motion, const MotionOptions& options) {
  return Going(model, motion, options).go();
}

}  // namespace trocar::studies
