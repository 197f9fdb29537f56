#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Where an object's middle is.
Vec3d middle_of_object(const Surgeon& op, BodyId body) {
  Vec3d at;
  interactions::visit_object(body, [&](auto kind) {
    at = kind.middle(interactions::part_of<decltype(kind)>(op.model()),
                     interactions::part_of<decltype(kind)>(op.state()), body.index());
  });
  return at;
}

/// Half open jaws around an object that lies about, closed, and lifted a little.
class PickUp final : public Skill {
 public:
  PickUp(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_body(args("body").body()),
        m_open(args.number("open_to", 0.45)),
        m_lift(args.number("lift_mm", 0.012)) {}

 private:
  enum Phase { kReach, kEnter, kClose, kLift };

  /// After each failure a little beside its middle, and with the jaws turned.
  void start(Surgeon&, int tries) override {
    constexpr double kBeside = 0.0015, kTurn = 0.7;  // [m] [rad]
    m_beside = kBeside * Vec3d{double(tries % 3) - (tries > 0 ? 1.0 : 0.0), double((tries / 3) % 3), 0};
    m_turn = kTurn * (tries % 4);
  }
  Progress work(Surgeon& op) override {
    constexpr double kAtTip = 0.8, kPressed = 1.2, kLongest = 4, kFeels = 0.8;  // of the jaws' length; [N] [s] [s]
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d at = middle_of_object(op, m_body) + m_beside, along = normalised(at - arm.port);
    const Vec3d tip = at + (1 - kAtTip) * op.tool(m_hand).jaw_length * along;
    op.want(arm.tip);
    op.want(at);
    if (m_phase == kReach) {
      const bool open = op.arms().grip(m_hand, m_open, 0.8);
      const Vec3d across = any_perpendicular(along);
      op.arms().turn_across(m_hand, portable::cos(m_turn) * across + portable::sin(m_turn) * cross(along, across));
      if (op.arms().move(m_hand, tip - reach::kBefore * along, pace::kTravel) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      const bool there = op.arms().move(m_hand, tip, pace::kCareful);
      if (there || norm(op.tool_state(m_hand).contact_force) > kPressed || m_in_phase > kLongest) go(kClose);
    } else if (m_phase == kClose) {
      if (!op.arms().grip(m_hand, 1, 0.8) || m_in_phase < kFeels) return Progress::working;
      const interactions::ToolState& tool = op.tool_state(m_hand);
      if (tool.holds == 0 || tool.hold[0].at.body != m_body) return fail("the jaws did not grasp it");
      m_from = arm.tip;
      go(kLift);
    } else if (op.arms().move(m_hand, m_from - m_lift * along, pace::kCareful)) {
      return op.tool_state(m_hand).holds > 0 ? Progress::done : fail("it slipped out of the jaws");
    }
    return Progress::working;
  }

  int m_hand;
  BodyId m_body;
  double m_open, m_lift, m_turn = 0;
  Vec3d m_beside, m_from;
};

/// What is held to a place, the camera on the jaws. What pulls back is given time, and goes slowly.
class Carry final : public Skill {
 public:
  Carry(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_at{args.number("x_mm", 0), args.number("y_mm", 0), args.number("z_mm", 0)},
        m_minds_pull(args("pull_N").given),
        m_most(args.number("pull_N", 0)) {}

 private:
  Progress work(Surgeon& op) override {
    op.want(op.arm(m_hand).tip);
    op.want(m_at);
    if (op.tool_state(m_hand).holds == 0) return fail("it slipped out of the jaws");
    if (m_minds_pull && strains(op)) return Progress::working;
    const double speed = m_minds_pull ? pace::kCareful : pace::kTravel;
    return op.arms().move(m_hand, m_at, speed) ? Progress::done : Progress::working;
  }
  /// It pulls too hard already, and would still harder on the way: what gives way to the pull need not wait.
  bool strains(const Surgeon& op) const {
    const double(&pull)[3] = op.tool_state(m_hand).pull;
    return norm(pull) > m_most && dot(m_at - op.arm(m_hand).tip, Vec3d{pull[0], pull[1], pull[2]}) <= 0;
  }

  int m_hand;
  Vec3d m_at;
  bool m_minds_pull;
  double m_most;  ///< [N]
};

std::string lacks_object(const sim::Model& model, const SkillArgs& args) {
  if (!args("body").body().is(BodyKind::rigid)) return "the object to pick up is not rigid";
  return lacks_tool(model, args.hand(), &interactions::Abilities::grip);
}

}  // namespace

const SkillKind kPickUp{
    "pick_up",
    "pick it up",
    {hand_parameter(),
     {"body", ArgumentKind::body, "a rigid object"},
     number_parameter("open_to", "closing of the handle before the jaws go around it; default 0.45", 0, 1),
     number_parameter("lift_mm", "distance to draw back then; default 12", 0, 100)},
    15,
    "Puts half open jaws around a loose object, closes them, and draws it back a little.",
    lacks_object,
    &making<PickUp>};
const SkillKind kCarry{
    "carry",
    "carry the grasped object",
    {hand_parameter("the hand that holds it"),
     {"x_mm", ArgumentKind::number, "to the patient's left", true, -1000, 1000},
     {"y_mm", ArgumentKind::number, "towards the head", true, -1000, 1000},
     {"z_mm", ArgumentKind::number, "to the front", true, -1000, 1000},
     number_parameter("pull_N", "moves slowly, and waits while the pull is above this; default no limit", 0, 50)},
    15,
    "Carries the held object to a place.",
    nothing,
    &making<Carry>};

}  // namespace trocar::training
