#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/observe/bare_wall.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Open jaws to a place of an organ or a wall, into it, closed, and a feel whether they hold. Of a wall that is named
/// they take what lies barest near there, and nothing else will do.
class TakeHold final : public Skill {
 public:
  TakeHold(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_place(model, args),
        m_wall(args("wall").given ? model.membrane_index(args("wall").word) : -1),
        m_deep(args.number("deep_mm", 0.004)),
        m_closed(args.number("to", 0.95)) {}

 private:
  enum Phase { kReach, kEnter, kClose };

  /// After each failure somewhere else beside it.
  void start(Surgeon& op, int tries) override {
    constexpr double kBeside = 0.004;  // [m]
    if (tries == 0) m_missed.clear();
    if (m_wall >= 0)
      m_node = wall_to_take(op.model(), op.state(), m_wall, {m_place.point(op, m_hand), op.arm(m_hand).port, m_deep},
                            m_missed);
    m_beside = kBeside * Vec3d{double(tries % 3) - (tries > 0 ? 1.0 : 0.0), double((tries / 3) % 3), 0};
  }
  Vec3d goal(Surgeon& op) const {
    if (m_wall < 0) return m_place.point(op, m_hand) + m_beside;
    return tissue::position(op.model().membranes[size_t(m_wall)].sheet.network,
                            op.state().membranes[size_t(m_wall)].network, m_node);
  }
  bool is_taken(const Surgeon& op) const {
    const interactions::ToolState& tool = op.tool_state(m_hand);
    if (m_wall < 0) return tool.holds > 0;
    return std::any_of(tool.hold, tool.hold + tool.holds,
                       [&](const interactions::Hold& h) { return h.at.body == BodyId::membrane(size_t(m_wall)); });
  }
  Progress work(Surgeon& op) override {
    constexpr double kPressed = 0.8, kLongest = 4, kFeels = 1.2;  // [N] [s] [s]
    if (m_wall >= 0 && m_node < 0) return fail("no part of it is exposed");
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d at = goal(op), along = normalised(at - arm.port);
    op.want(arm.tip);
    op.want(at);
    if (m_phase == kReach) {
      const bool open = op.arms().grip(m_hand, 0, 0.8);
      if (op.arms().move(m_hand, at - reach::kBefore * along, pace::kTravel) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      const bool there = op.arms().move(m_hand, at + m_deep * along, pace::kCareful);
      if (there || norm(op.tool_state(m_hand).contact_force) > kPressed || m_in_phase > kLongest) go(kClose);
    } else if (op.arms().grip(m_hand, m_closed, 0.8) && m_in_phase > kFeels) {
      if (is_taken(op)) return Progress::done;
      if (m_node >= 0) m_missed.push_back(m_node);
      return fail("the jaws did not grasp it");
    }
    return Progress::working;
  }

  int m_hand;
  Place m_place;
  int m_wall, m_node = -1;
  double m_deep, m_closed;
  Vec3d m_beside;
  std::vector<int> m_missed;  ///< nodes of the wall
};

std::string lacks_wall_or_place(const sim::Model& model, const SkillArgs& args) {
  if (args("wall").given && model.membrane_index(args("wall").word) < 0)
    return tr("there is no wall \"{}\"", args("wall").word);
  return Place::lacks(model, args);
}

}  // namespace

const SkillKind kTakeHold{
    "take_hold",
    "grasp it",
    std::vector<Parameter>{
        hand_parameter(),
        {"wall", ArgumentKind::word, "a closed membrane: its most exposed part within 18 mm of the place", false},
        number_parameter("deep_mm", "distance that the open jaws move beyond the place; default 4", 0, 30),
        number_parameter("to", "closing of the handle; default 0.95", 0, 1)} +
        place_parameters(),
    15,
    "Moves open jaws to a place of an organ or closed membrane, closes them, and tests whether they hold.",
    lacks_wall_or_place,
    &making<TakeHold>};

}  // namespace trocar::training
