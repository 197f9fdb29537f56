#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// The tip of an instrument that bends onto a disc, straight against its surface, as into a tube; there it stays, and
/// comes out the same way.
class ReachIn final : public Skill {
 public:
  ReachIn(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()), m_mark(args("mark").index), m_for(args.number("for_s", 0.8)) {}

 private:
  enum Phase { kBring, kIn, kStay, kOut };
  static constexpr double kOver = 0.045, kAt = 0.0015;  // [m] of the tip from the disc

  void start(Surgeon& op, int tries) override {
    Skill::start(op, tries);
    m_plan = {op.tool_state(m_hand).pose(), sim::joints_of(op.state(), size_t(m_hand))};
    m_normal = normal_of_mark(op.model(), op.state(), m_mark).value_or(Vec3d{0, 0, 1});
    m_place = place_of_mark(op.model(), op.state(), m_mark);
    m_height = kOver;
    plan(op, 60);
  }

  Progress work(Surgeon& op) override {
    constexpr double kLongest = 15;  // [s]
    op.want(m_place);
    op.want(tip_of(op.model(), op.state(), size_t(m_hand)));
    switch (m_phase) {
      case kBring: {
        // What wrist and shaft do each take their time.
        const bool there = op.arms().move(m_hand, m_tip, pace::kTravel);
        const bool turned = turn(op), bent = op.arms().bend(m_hand, m_wrist);
        if (there && turned && bent) go(kIn);
        return m_in_phase > kLongest ? fail("the instrument did not reach the position in front of it")
                                     : Progress::working;
      }
      case kIn:
        if (along(op, kAt)) go(kStay);
        return Progress::working;
      case kStay:
        if (m_in_phase > m_for) go(kOut);
        return Progress::working;
      default:
        return along(op, kOver) ? Progress::done : Progress::working;
    }
  }

  /// One tick along the disc's normal.
  bool along(Surgeon& op, double to) {
    const double pace = pace::kCareful * sim::kTick;
    m_height += std::clamp(to - m_height, -pace, pace);
    plan(op, 3);
    Arms::Arm& arm = op.arm(m_hand);
    arm.tip = m_tip;
    arm.roll = m_roll;
    arm.wrist = m_wrist;
    arm.moving = true;
    return std::fabs(to - m_height) < 1e-6;
  }

  bool turn(Surgeon& op) const {
    constexpr double kTurning = 1.5, kTurned = 1e-3;  // [rad/s] [rad]
    double& roll = op.arm(m_hand).roll;
    roll += std::clamp(m_roll - roll, -kTurning * sim::kTick, kTurning * sim::kTick);
    return std::fabs(m_roll - roll) < kTurned;
  }

  /// What the hand does for the tip to be `m_height` before the disc and to point at it.
  void plan(Surgeon& op, int rounds) {
    const interactions::ToolModel& tool = op.tool(m_hand);
    const Vec3d at = m_place + m_height * m_normal;
    if (tool.bends.redundant()) {
      m_tip = at;
      m_roll = op.arm(m_hand).roll;
      const kinematics::TipFrame straight = kinematics::forward(tool.port, kinematics::inverse(tool.port, at, m_roll));
      const Vec3d in{-dot(m_normal, straight.opening()), -dot(m_normal, straight.normal()),
                     dot(m_normal, straight.axis())};
      m_wrist = {float(portable::atan2(in.y, -in.z)),
                 float(portable::atan2(-in.x, std::sqrt(in.y * in.y + in.z * in.z)))};
      return;
    }
    kinematics::Goal goal;
    goal.tip = at;
    const Vec3d x = any_perpendicular(m_normal);
    goal.rotation = Mat3d::from_columns(x, cross(m_normal, x), m_normal);  // its axis is -z
    goal.turn_too = false;
    m_plan = kinematics::reach(tool.bends, tool.limits, tool.port, tool.jaw_length, goal, m_plan, rounds);
    m_tip = kinematics::forward(tool.port, m_plan.pose).tip;
    m_roll = m_plan.pose.roll;
    m_wrist = {float(m_plan.joints.angle[0]), float(m_plan.joints.angle[1])};
  }

  int m_hand, m_mark;
  double m_for;
  Vec3d m_place, m_normal;
  double m_height = 0;  ///< of the tip above the disc [m]
  kinematics::Arm m_plan;
  Vec3d m_tip;  ///< of the straight instrument
  double m_roll = 0;
  sim::WristInput m_wrist;
};

std::string lacks_wrist(const sim::Model& model, const SkillArgs& args) {
  const sim::HandModel& hand = model.hands[size_t(args.hand())];
  if (!hand.rack.front().bends.bends()) return "the instrument at the trocar \"" + hand.name + "\" does not bend";
  const int mark = args("mark").index;
  return can_face(model, model.targets[size_t(mark)]) ? "" : "the mark has no single normal";
}

}  // namespace

const SkillKind kReachIn{
    "reach_in",
    "reach in with a bent wrist",
    {hand_parameter("the hand whose instrument bends"),
     {"mark", ArgumentKind::mark, "the disc to touch"},
     number_parameter("for_s", "time that the tip stays there; default 0.8", 0, 60)},
    40,
    "Bends the wrist so that the jaws point straight at a disc, moves there along its normal, stays, and returns.",
    lacks_wrist,
    &making<ReachIn>};

}  // namespace trocar::training
