// A retrieval bag: opened where it is wanted, filled, drawn shut, and out by its trocar.
#include <algorithm>

#include <trocar/interactions/objects/bag_contents.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

using interactions::Bag;
using interactions::BagModel;
using interactions::BagState;

const BagModel& bag_model(const Surgeon& op) { return interactions::part_of<Bag>(op.model()).list.front(); }
const BagState& bag_state(const Surgeon& op) { return interactions::part_of<Bag>(op.state()).front(); }
Vec3d mouth_of(const Surgeon& op) { return bag_state(op).middle(bag_model(op)); }

double share_inside(const Surgeon& op, BodyId body) {
  const interactions::BagShare share = share_in(bag_model(op), bag_state(op), body);
  return share.all > 0 ? double(share.inside) / share.all : 0;
}

Vec3d upwards(const Surgeon& op) { return -normalised(op.model().gravity, {0, 0, -1}); }

std::string lacks_bag(const sim::Model& model, const SkillArgs&) {
  return interactions::part_of<Bag>(model).list.empty() ? "there is no bag" : "";
}
std::string lacks_bag_in_hand(const sim::Model& model, const SkillArgs& args) {
  if (std::string lack = lacks_bag(model, args); !lack.empty()) return lack;
  return lacks_tool(model, args.hand(), &interactions::Abilities::bag);
}

/// The middle of the mouth to a place, the mouth facing up, and the hoop out.
class OpenBag final : public Skill {
 public:
  OpenBag(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()), m_at{args.number("x_mm", 0), args.number("y_mm", 0), args.number("z_mm", 0)} {}

 private:
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d along = normalised(m_at - arm.port), tip = m_at - bag_model(op).hoop * along;
    op.want(arm.tip);
    op.want(m_at);
    const bool there = op.arms().move(m_hand, tip, pace::kTravel);
    const bool level = turn_up(op, arm);
    if (!there || !level) return Progress::working;
    const bool pushed = op.arms().grip(m_hand, 0, 1.0);
    return pushed && bag_state(op).open() ? Progress::done : Progress::working;
  }
  /// All the way round if it must: a mouth that faces down is of no use.
  bool turn_up(Surgeon& op, Arms::Arm& arm) const {
    constexpr double kTurns = 1.5, kLevel = 0.03;  // [rad/s] [rad]
    const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, arm.tip, arm.roll);
    double left = kinematics::roll_towards(pose, upwards(op)) - arm.roll;
    while (left > portable::pi) left -= 2 * portable::pi;
    while (left < -portable::pi) left += 2 * portable::pi;
    arm.roll += std::clamp(left, -kTurns * sim::kTick, kTurns * sim::kTick);
    return std::fabs(left) < kLevel;
  }

  int m_hand;
  Vec3d m_at;
};

/// What is held to over the mouth, through it, let go of, and back.
class PutInBag final : public Skill {
 public:
  PutInBag(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_deep(args.number("deep_mm", 0.015)),
        m_above(args.number("above_mm", 0.03)),
        m_least(args.number("least_share", 1)) {}

 private:
  enum Phase { kOver, kIn, kLetGo, kBack, kFalls };

  void start(Surgeon& op, int) override {
    const interactions::ToolState& tool = op.tool_state(m_hand);
    m_body = tool.holds > 0 ? tool.hold[0].at.body : BodyId{};
  }
  Progress work(Surgeon& op) override {
    const Vec3d up = bag_state(op).frame.up, mouth = mouth_of(op), over = mouth + m_above * up;
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    op.want(mouth);
    if (!m_body.exists()) return fail("there is nothing in the jaws");
    if (m_phase <= kIn && op.tool_state(m_hand).holds == 0) return fail("it slipped out of the jaws");
    if (m_phase == kOver) {
      if (op.arms().move(m_hand, over, pace::kTravel)) go(kIn);
    } else if (m_phase == kIn) {
      if (op.arms().move(m_hand, mouth - m_deep * up, pace::kCareful)) go(kLetGo);
    } else if (m_phase == kLetGo) {
      loosen(op);
    } else if (m_phase == kBack) {
      op.arms().grip(m_hand, m_loose, 0.5);
      if (op.arms().move(m_hand, over, pace::kCareful)) go(kFalls);
    } else {
      op.arms().grip(m_hand, 0, 0.5);
      if (share_inside(op, m_body) >= m_least) return Progress::done;
      if (m_in_phase > 1.5) return fail("part of it is still outside the bag");
    }
    return Progress::working;
  }
  /// Only as far as it comes free: jaws that open wide in a fold take that along. A stone falls out of open ones.
  void loosen(Surgeon& op) {
    constexpr double kMore = 0.08;  // of the handle
    const bool wide = op.arms().grip(m_hand, 0, 0.5);
    const bool falls = m_body.is(BodyKind::rigid);
    m_loose = falls ? 0.0 : std::max(0.0, op.arm(m_hand).handle - kMore);
    if (wide || (!falls && op.tool_state(m_hand).holds == 0)) go(kBack);
  }

  int m_hand;
  double m_deep, m_above, m_least;
  double m_loose = 0;  ///< of the handle, with which it draws back
  BodyId m_body;
};

/// Closed jaws push what rises over the mouth down into it, again and again.
class PushIntoBag final : public Skill {
 public:
  PushIntoBag(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_body(args("body").body()),
        m_deep(args.number("deep_mm", 0.025)),
        m_least(args.number("least_share", 1)) {}

 private:
  enum Phase { kShut, kOver, kDown, kUp };
  static constexpr double kClear = 0.012;  ///< above what rises highest [m]
  static constexpr int kMostPushes = 8;

  void start(Surgeon&, int) override { m_pushes = 0; }
  Progress work(Surgeon& op) override {
    const Vec3d up = bag_state(op).frame.up, mouth = mouth_of(op);
    op.want(op.arm(m_hand).tip);
    op.want(mouth);
    if (m_phase == kShut) {
      if (op.arms().grip(m_hand, 1, 0.5)) go(kOver);
    } else if (m_phase == kOver) {
      if (m_in_phase < 1.5 * sim::kTick) m_over = aim(op);
      if (op.arms().move(m_hand, m_over, pace::kTravel)) go(kDown);
    } else if (m_phase == kDown) {
      const Vec3d below = m_over - (dot(m_over - mouth, up) + m_deep) * up;
      if (op.arms().move(m_hand, below, pace::kCareful)) go(kUp);
    } else if (op.arms().move(m_hand, m_over, pace::kCareful)) {
      if (share_inside(op, m_body) >= m_least) return Progress::done;
      if (++m_pushes >= kMostPushes) return fail("part of it is still outside the bag");
      go(kOver);
    }
    return Progress::working;
  }
  /// Over the middle of what rises over the mouth.
  static Vec3d aim(const Surgeon& op) {
    const BagModel& bag = bag_model(op);
    const BagState& state = bag_state(op);
    const Vec3d up = state.frame.up, mouth = mouth_of(op);
    Vec3d sum;
    double highest = 0;
    int count = 0;
    for (const interactions::BagPouch& p : bag.pouches) {
      const tissue::NodeView nodes = view_of(op.model().membranes[size_t(p.membrane)].sheet.network,
                                             op.state().membranes[size_t(p.membrane)].network);
      for (std::int32_t n = 0; n < p.count; ++n) {
        if (state.points[size_t(p.first + n)].where != interactions::BagPoint::over_mouth) continue;
        sum += nodes.position(n);
        highest = std::max(highest, dot(nodes.position(n) - mouth, up));
        ++count;
      }
    }
    const Vec3d middle = count > 0 ? (1.0 / count) * sum : mouth;
    return middle + (highest + kClear - dot(middle - mouth, up)) * up;
  }

  int m_hand, m_pushes = 0;
  BodyId m_body;
  double m_deep, m_least;
  Vec3d m_over;
};

/// The hoop back into its sleeve.
class CloseBag final : public Skill {
 public:
  CloseBag(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()) {}

 private:
  Progress work(Surgeon& op) override {
    op.want(op.arm(m_hand).tip);
    op.want(mouth_of(op));
    if (op.arms().grip(m_hand, 1, 2.0) && bag_state(op).shut()) return Progress::done;
    return m_in_phase > 5 ? fail("something lies in its mouth") : Progress::working;
  }
  int m_hand;
};

/// Back along the sleeve until its neck is in the trocar.
class TakeOutBag final : public Skill {
 public:
  TakeOutBag(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()) {}

 private:
  Progress work(Surgeon& op) override {
    constexpr double kInPort = 0.010;  // [m]
    op.want(op.arm(m_hand).tip);
    op.arms().move_to_depth(m_hand, kInPort, pace::kCareful);  // what is in it comes along
    return bag_state(op).out != 0 ? Progress::done : Progress::working;
  }
  int m_hand;
};

}  // namespace

const SkillKind kOpenBag{"open_bag",
                         "open the bag",
                         {hand_parameter("the hand with the bag"),
                          {"x_mm", ArgumentKind::number, "to the patient's left", true, -1000, 1000},
                          {"y_mm", ArgumentKind::number, "towards the head", true, -1000, 1000},
                          {"z_mm", ArgumentKind::number, "to the front", true, -1000, 1000}},
                         15,
                         "Moves the bag's mouth to a position, facing up, and pushes the hoop out.",
                         lacks_bag_in_hand,
                         &making<OpenBag>};
const SkillKind kPutInBag{
    "put_in_bag",
    "put it into the bag",
    {hand_parameter("the hand that holds it"),
     number_parameter("deep_mm", "depth below the mouth for the release; default 15", 0, 200),
     number_parameter("above_mm", "height above the mouth; default 30", 0, 200),
     number_parameter("least_share", "least share that must be inside then; default 1", 0, 1)},
    20,
    "Carries the held object above the bag's mouth, lowers it through, releases it, and withdraws.",
    lacks_bag,
    &making<PutInBag>};
const SkillKind kPushIntoBag{
    "push_into_bag",
    "push it into the bag",
    {hand_parameter("the hand that pushes with closed jaws"),
     {"body", ArgumentKind::body, "the body that is partly outside"},
     number_parameter("deep_mm", "depth below the mouth; default 25", 0, 200),
     number_parameter("least_share", "least share that must be inside then; default 1", 0, 1)},
    60,
    "Closes the jaws and pushes contents that rise above the bag's mouth down into it, at most eight times.",
    lacks_bag,
    &making<PushIntoBag>};
const SkillKind kCloseBag{"close_bag",
                          "draw the bag shut",
                          {hand_parameter("the hand with the bag")},
                          10,
                          "Draws the hoop back into its sleeve until the mouth is shut.",
                          lacks_bag_in_hand,
                          &making<CloseBag>};
const SkillKind kTakeOutBag{"take_out_bag",
                            "take the bag out",
                            {hand_parameter("the hand with the bag")},
                            15,
                            "Draws the bag back until its neck is in the port.",
                            lacks_bag_in_hand,
                            &making<TakeOutBag>};

}  // namespace trocar::training
