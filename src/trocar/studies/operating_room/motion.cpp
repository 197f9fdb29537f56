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

constexpr double kSame = 0.3;    // a fault that comes back within this time is the same one [s]
constexpr int kParts = 16;       // of a move that is shorter than so many steps: 1 % of its greatest speed is missed
constexpr double kClose = 0.25;  // of a step: nearer to each other, times are not told apart

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

/// A time that is looked at.
struct Moment {
  double at = 0;
  int regular = -1;  ///< number of the step, of those that are a fixed time apart
};

/// Poses, the middle of each move, and parts of short ones.
void add_moments(std::vector<Moment>& out, const std::vector<double>& poses_at, double step) {
  for (std::size_t k = 0; k < poses_at.size(); ++k) {
    out.push_back({poses_at[k]});
    if (k + 1 == poses_at.size()) break;
    const double way = poses_at[k + 1] - poses_at[k];
    const int parts = way < kParts * step ? kParts : 2;
    for (int i = 1; i < parts; ++i) out.push_back({poses_at[k] + way * i / parts});
  }
}

/// All times that are looked at, in order. What is close to a pose or a middle is not looked at twice.
std::vector<Moment> moments_of(const RoomMotion& motion, double step) {
  std::vector<Moment> own;
  for (const std::vector<double>& poses_at : motion.poses_at) add_moments(own, poses_at, step);
  add_moments(own, motion.tilts_at, step);
  const auto earlier = [](const Moment& a, const Moment& b) { return a.at < b.at; };
  std::stable_sort(own.begin(), own.end(), earlier);
  std::vector<Moment> all = own;
  const int last = std::max(0, int(std::ceil(motion.length / step - 1e-9)));
  for (int k = 0; k <= last; ++k) {
    const double at = std::min(motion.length, k * step);
    const auto next = std::lower_bound(own.begin(), own.end(), Moment{at - kClose * step}, earlier);
    const bool is_there = next != own.end() && next->at <= at + kClose * step;
    if (is_there) all[std::size_t(next - own.begin())].regular = k;
    if (k == 0 || k == last || !is_there) all.push_back({at, k});
  }
  std::stable_sort(all.begin(), all.end(), earlier);
  std::vector<Moment> out;
  for (const Moment& m : all) {
    if (m.at > motion.length) break;
    if (out.empty() || m.at > out.back().at) out.push_back(m);
    out.back().regular = std::max(out.back().regular, m.regular);
  }
  return out;
}

/// The move that a time is in, or ends; none: length 0.
struct MoveTime {
  double from = 0, to = 0;
  double length() const { return to - from; }
};
MoveTime move_at(const std::vector<double>& poses_at, double at) {
  const auto end = std::lower_bound(poses_at.begin(), poses_at.end(), at);
  if (end == poses_at.begin() || end == poses_at.end()) return {};
  return {*(end - 1), *end};
}

class Going {
 public:
  Going(const RoomModel& model, const RoomMotion& motion, const MotionOptions& options)
      : m(model), m_motion(motion), o(options), m_measured(model.arms().size()) {}

  MotionReport go() {
    r.length = m_motion.length;
    r.least_clearance = 1e9;
    RoomPose pose = m.start();
    pose.tilt = m_motion.tilt(0);
    if (m_motion.tips) pose.tips = m_motion.tips(0);
    const std::vector<Moment> moments = moments_of(m_motion, o.step);
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const int regular = moments[k].regular;
      const bool keep = (regular >= 0 && regular % std::max(1, o.kept_every) == 0) || k + 1 == moments.size();
      step(pose, moments[k].at, k == 0, keep);
      if (o.stops && !r.faults.empty()) break;
    }
    std::stable_sort(r.faults.begin(), r.faults.end(),
                     [](const MotionFault& a, const MotionFault& b) { return a.from < b.from; });
    return std::move(r);
  }

 private:
  /// Where something stood when its speed was measured last.
  struct Measured {
    double at = 0;
    std::vector<double> u;
  };

  void step(RoomPose& pose, double at, bool first, bool keep) {
    ++r.count;
    m_at = at;
    const std::size_t faults_before = r.faults.size();
    MotionStep s;
    s.at = at;
    s.arms.resize(m.arms().size());
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
      speeds(pose, int(a), first, s);
    }
    table_speed(pose.tilt, first);
    collisions(pose, s);
    if (keep || r.faults.size() > faults_before) {
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

  /// How long after the last measurement the next may be: over less, a solver's last digits would count.
  bool can_measure(const Measured& last, const MoveTime& move) const {
    const double part = move.length() > 0 ? 0.999 * move.length() / kParts : o.step;
    return m_at - last.at >= std::min(kClose * o.step, part);
  }

  /// " the move from 1 to 1.01 s needs 0.2 s at least", of a programme's.
  std::string too_fast(const std::string& what, double share, const MoveTime& move) const {
    if (!(move.length() > 0)) return tr("{} would move at {:.2f} times its greatest speed", what, share);
    return tr("{} would move at {:.4g} times its greatest speed: the move from {:.6g} to {:.6g} s needs {:.2g} s", what,
              share, move.from, move.to, share * move.length());
  }

  void speeds(const RoomPose& pose, int a, bool first, MotionStep& s) {
    const auto i = std::size_t(a);
    const Mechanism& mech = m.arms()[i].mechanism;
    const scene::RoomArm& arm = *m.arms()[i].described;
    const MoveTime move = i < m_motion.poses_at.size() ? move_at(m_motion.poses_at[i], m_at) : MoveTime{};
    Measured& last = m_measured[i];
    const double time = m_at - last.at;
    if (first) last = {m_at, pose.u[i]};
    if (first || !can_measure(last, move)) return;
    int fastest = -1;
    double most = 0;
    for (std::size_t k = 0; k < mech.independent.size(); ++k) {
      const auto q = std::size_t(mech.independent[k]);
      const double allowed = mech.measures[q] == Measure::length ? arm.fastest_slide : arm.fastest_turn;
      const double share = std::fabs(pose.u[i][k] - last.u[k]) / time / allowed;
      if (share > most) most = share, fastest = int(q);
    }
    last = {m_at, pose.u[i]};
    s.arms[i].speed = most;
    r.most_speed = std::max(r.most_speed, most);
    if (most > 1 + 1e-9) {
      const std::string& name = mech.coordinates[std::size_t(fastest)];
      fault(MotionFaultKind::speed, a, name, most, m.tip(pose, a).p, too_fast("\"" + name + "\"", most, move));
    }
  }

  void table_speed(const scene::RoomTilt& tilt, bool first) {
    const MoveTime move = move_at(m_motion.tilts_at, m_at);
    const double time = m_at - m_table.at;
    if (first) m_table = {m_at, {tilt.head_down, tilt.left_down}};
    if (first || !can_measure(m_table, move)) return;
    const double way = std::max(std::fabs(tilt.head_down - m_table.u[0]), std::fabs(tilt.left_down - m_table.u[1]));
    m_table = {m_at, {tilt.head_down, tilt.left_down}};
    const double share = way / time / m.room().table.fastest;
    r.most_speed = std::max(r.most_speed, share);
    if (share > 1 + 1e-9) fault(MotionFaultKind::speed, -1, "table", share, {}, too_fast(tr("the table"), share, move));
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
  std::vector<Measured> m_measured;  ///< (arms)
  Measured m_table;
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
  for (const std::vector<Programme::Pose>& of : poses) {
    std::vector<double>& at = motion.poses_at.emplace_back();
    for (const Programme::Pose& p : of) at.push_back(p.at);
  }
  for (const Programme::Tilt& t : programme.tilts) motion.tilts_at.push_back(t.at);
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

const MotionStep& step_at(const MotionReport& report, double at) noexcept {
  const auto later = std::lower_bound(report.steps.begin(), report.steps.end(), at,
                                      [](const MotionStep& s, double time) { return s.at < time; });
  if (later == report.steps.begin()) return *later;
  const auto earlier = later - 1;
  return later == report.steps.end() || at - earlier->at < later->at - at ? *earlier : *later;
}

MotionReport go_through(const RoomModel& model, const RoomMotion& motion, const MotionOptions& options) {
  return Going(model, motion, options).go();
}

}  // namespace trocar::studies
