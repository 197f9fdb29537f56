// A needle in the hands: driven through tissue along its arc, taken by the other hand, drawn out with its thread.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/mark.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>
#include <trocar/training/surgeon/needle_lead.hpp>

namespace trocar::training {
namespace {

sim::MarkPose mark_pose(const Surgeon& op, int target) {
  const sim::VisibilityTarget& t = op.model().targets[std::size_t(target)];
  return sim::pose_of(op.model(), op.state(), op.model().marks[std::size_t(t.index)]);
}

/// In at one mark, out at another, by turning the wrist.
class DriveNeedle final : public Skill {
 public:
  DriveNeedle(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_in(args("in").index),
        m_out(args("out").index),
        m_beyond(args.number("beyond_mm", 0.005)),
        m_speed(args.number("speed_mm_s", 0.008)) {}

 private:
  enum Phase { kAbove, kDown, kDrive, kRest };
  static constexpr double kHigh = 0.016, kBeforeIn = 0.35, kHang = 0.4;  // [m], [rad], [s]

  void start(Surgeon& op, int) override {
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    const sim::MarkPose in = mark_pose(op, m_in), out = mark_pose(op, m_out);
    m_up = normalised(in.normal + out.normal, {0, 0, 1});
    m_way = way_between(m, in.place, out.place, m_up, op.arm(m_hand).port);
    m_angle = -kBeforeIn;
    m_last = m_way.angle + m_beyond / m.radius;
    m_from = training::pose_of(suture_of(op.state()).needle);
    m_share = 0;
    m_bites = suture_of(op.state()).bite_count;
  }
  Progress work(Surgeon& op) override {
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 1) return fail("the jaws lost the needle");
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    op.want(m_way.in);
    op.want(m_way.centre);
    op.want(op.arm(m_hand).tip);
    NeedlePose wanted = m_way.at(m, m_angle);
    if (m_phase == kAbove) {
      // over an arch, so that the needle sweeps nothing on its way
      const NeedlePose to{wanted.x + kHigh * m_up, wanted.q};
      m_share = std::min(1.0, m_share + pace::kTravel * sim::kTick / std::max(0.005, length(to.x - m_from.x)));
      const double arch = 4 * m_share * (1 - m_share);
      const NeedlePose now{m_from.x + m_share * (to.x - m_from.x) + 0.8 * kHigh * arch * m_up,
                           slerp(m_from.q, to.q, m_share)};
      if (lead_needle(op, m_hand, now, 2 * pace::kTravel) && m_share >= 1) go(kDown);
    } else if (m_phase == kDown) {
      if (lead_needle(op, m_hand, wanted, pace::kCareful, 0)) go(kDrive);
    } else if (m_phase == kDrive) {
      m_angle = std::min(m_last, m_angle + m_speed / m.radius * sim::kTick);
      lead_needle(op, m_hand, wanted, pace::kTravel, 0);
      if (m_angle >= m_last) go(kRest);
    } else {
      lead_needle(op, m_hand, wanted, pace::kTravel, 0);
      if (m_in_phase > kHang) return through(op) ? Progress::done : fail("the needle did not emerge");
    }
    return Progress::working;
  }
  bool through(const Surgeon& op) const {
    const interactions::SutureState& s = suture_of(op.state());
    return s.bite_count > m_bites && !s.inside.exists() &&
           s.bites[std::size_t(s.bite_count - 1)].stage == interactions::SutureBite::through;
  }

  int m_hand, m_in, m_out, m_bites = 0;
  double m_beyond, m_speed, m_angle = 0, m_last = 0, m_share = 0;
  NeedleWay m_way;
  NeedlePose m_from;
  Vec3d m_up{0, 0, 1};
};

/// Open jaws around the needle at a place of its length, then closed.
class TakeNeedle final : public Skill {
 public:
  TakeNeedle(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_at(args.number("at_mm", 0.003)), m_open(args.number("open_to", 0.35)) {
    (void)model;
  }

 private:
  enum Phase { kReach, kEnter, kClose };
  static constexpr double kInside = 0.55, kFeels = 0.6, kLongest = 5;  // of the jaws' length, [s]

  void start(Surgeon&, int tries) override { m_beside = 0.0004 * (tries % 3); }
  Progress work(Surgeon& op) override {
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    const suture::NeedleState& s = suture_of(op.state()).needle;
    const double arc = m_at + m_beside;
    const Vec3d at = suture::needle_point(m, s, arc), along = normalised(at - op.arm(m_hand).port);
    const Vec3d tip = at + (1 - kInside) * op.tool(m_hand).jaw_length * along;
    op.want(at);
    op.want(op.arm(m_hand).tip);
    if (m_phase != kClose) op.arms().turn_across(m_hand, suture::needle_direction(m, s, arc));
    if (m_phase == kReach) {
      const bool open = op.arms().grip(m_hand, m_open, 0.8);
      if (op.arms().move(m_hand, tip - 0.018 * along, pace::kTravel) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      if (op.arms().move(m_hand, tip, pace::kCareful) || m_in_phase > kLongest) go(kClose);
    } else {
      give_way(op, at);
      if (!op.arms().grip(m_hand, 1, 1.0) || m_in_phase < kFeels + 1.0) return Progress::working;
      return held_of_suture(op.model(), op.state(), std::size_t(m_hand)) == 1 ? Progress::done
                                                                              : fail("the jaws did not grasp it");
    }
    return Progress::working;
  }

  /// A needle that another hand holds stays where it is: jaws that close on it come to it.
  void give_way(Surgeon& op, Vec3d at) const {
    constexpr double kPace = 0.004, kGives = 2e-5, kMost = 2e-5;  // [m/s], [m/N] a tick, [m] a tick
    Arms::Arm& arm = op.arm(m_hand);
    if (op.tool_state(m_hand).holds == 0) {
      const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), std::size_t(m_hand));
      const double off = interactions::to_jaw(shape, at).x, step = kPace * sim::kTick;
      arm.tip += interactions::direction_from_jaw(shape, {std::clamp(off, -step, step), 0, 0});
      return;
    }
    const double* f = op.tool_state(m_hand).pull;
    const Vec3d pull{f[0], f[1], f[2]};
    const double size = length(pull);
    if (size > 0.2) arm.tip += (std::min(kMost, kGives * (size - 0.2)) / size) * pull;
  }

  int m_hand;
  double m_at, m_open, m_beside = 0;
};

/// Along its own arc until its swage is out, then away with the thread behind it.
class DrawThrough final : public Skill {
 public:
  DrawThrough(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_thread(args.number("thread_mm", 0.08)),
        m_at{args.number("x_mm", 0), args.number("y_mm", 0), args.number("z_mm", 0)},
        m_pull(args.number("pull_N", 1.5)) {}

 private:
  enum Phase { kArc, kLift, kAway };
  static constexpr double kPace = 0.010, kTurns = 1.6, kFarthest = 0.045;  // [m/s], [rad], [m]

  void start(Surgeon& op, int) override {
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    const suture::NeedleState& s = suture_of(op.state()).needle;
    m_from = training::pose_of(s);
    m_centre = suture::place_of(s, m.centre);
    m_axis = rotate(s.q, Vec3d{0, 0, 1});
    m_turned = 0;
  }
  void lift_from(Surgeon& op) {
    m_pose = training::pose_of(suture_of(op.state()).needle);
    m_lifted = 0;
    go(kLift);
  }
  /// Along the wire where it leaves tissue, and a little up.
  Vec3d way_out(const Surgeon& op) const {
    const interactions::SutureState& s = suture_of(op.state());
    double arc = 0;
    for (int i = 0; i < s.hole_count; ++i) {
      const interactions::SutureHole& hole = s.holes[std::size_t(i)];
      if (hole.slot < 0 && hole.kind == interactions::SutureHole::exit) arc = double(hole.arc);
    }
    const Vec3d along = suture::needle_direction(suture_of(op.model()).needle, s.needle, arc);
    return normalised(along - 0.5 * normalised(op.model().gravity, {0, 0, -1}));
  }
  bool needle_is_out(const Surgeon& op) const {
    const interactions::SutureState& s = suture_of(op.state());
    for (int i = 0; i < s.hole_count; ++i)
      if (s.holes[std::size_t(i)].slot < 0) return false;
    return true;
  }
  double drawn(const Surgeon& op) const {
    const interactions::SutureState& s = suture_of(op.state());
    double least = 1e9;
    for (int i = 0; i < s.hole_count; ++i)
      if (s.holes[std::size_t(i)].slot >= 0) least = std::min(least, double(s.holes[std::size_t(i)].arc));
    return least < 1e8 ? least : 0;
  }
  Progress work(Surgeon& op) override {
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 1) return fail("the jaws lost the needle");
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    op.want(m_centre);
    op.want(op.arm(m_hand).tip);
    if (m_phase == kArc) {
      m_turned += kPace / m.radius * sim::kTick;
      const Quatd by = quat_from_axis_angle(m_axis, m_turned);
      lead_needle(op, m_hand, {m_centre + rotate(by, m_from.x - m_centre), by * m_from.q}, pace::kTravel);
      if (needle_is_out(op)) go(kAway);
      if (m_turned > kTurns) lift_from(op);
      return Progress::working;
    }
    if (m_phase == kLift) {
      // as far as a wrist turns; the rest follows the way that the wire lies in its last hole
      const double step = kPace * sim::kTick;
      m_pose.x += step * way_out(op);
      m_lifted += step;
      lead_needle(op, m_hand, m_pose, pace::kTravel);
      if (needle_is_out(op)) go(kAway);
      return m_lifted > kFarthest ? fail("the needle did not emerge") : Progress::working;
    }
    if (drawn(op) >= m_thread) return Progress::done;
    if (suture_of(op.state()).strain > m_pull) return Progress::working;  // the thread is given time
    if (op.arms().move(m_hand, m_at, pace::kCareful)) return fail("the thread did not follow far enough");
    return Progress::working;
  }

  int m_hand;
  double m_thread;
  Vec3d m_at;
  double m_pull, m_turned = 0, m_lifted = 0;
  NeedlePose m_from, m_pose;
  Vec3d m_centre, m_axis;
};

std::string lacks_needle(const sim::Model& model, const SkillArgs& args) {
  if (!needs_needle(model).empty()) return std::string(needs_needle(model));
  return lacks_tool(model, args.hand(), &interactions::Abilities::grip);
}

}  // namespace

const SkillKind kDriveNeedle{
    "drive_needle",
    "drive the needle through",
    {hand_parameter("the hand that holds it"),
     {"in", ArgumentKind::mark, "mark of the entry"},
     {"out", ArgumentKind::mark, "mark of the exit"},
     number_parameter("beyond_mm", "length of the tip beyond the exit; default 5", 0, 20),
     number_parameter("speed_mm_s", "speed along its arc; default 8", 0.5, 50)},
    25,
    "Brings the needle to the tissue and drives it through from mark to mark along its own arc.",
    lacks_needle,
    &making<DriveNeedle>};
const SkillKind kTakeNeedle{
    "take_needle",
    "take the needle",
    {hand_parameter(), number_parameter("at_mm", "place on it, from its tip; default 3", 0, 100),
     number_parameter("open_to", "closing of the handle before; default 0.35", 0, 1)},
    20,
    "Encloses the needle with open jaws and closes them.",
    lacks_needle,
    &making<TakeNeedle>};
const SkillKind kDrawThrough{
    "draw_through",
    "draw needle and thread through",
    {hand_parameter("the hand that holds the needle"),
     number_parameter("thread_mm", "length of thread to draw through; default 80", 0, 900),
     {"x_mm", ArgumentKind::number, "towards this point, to the patient's left", true, -1000, 1000},
     {"y_mm", ArgumentKind::number, "towards the head", true, -1000, 1000},
     {"z_mm", ArgumentKind::number, "to the front", true, -1000, 1000},
     number_parameter("pull_N", "waits while the tension is above this; default 1.5", 0, 50)},
    40,
    "Turns the needle along its arc until it is out, then draws the thread after it.",
    lacks_needle,
    &making<DrawThrough>};

}  // namespace trocar::training
