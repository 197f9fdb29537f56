#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Open jaws to a place of an organ or a wall, into it, closed, and a feel whether they hold.
class TakeHold final : public Skill {
 public:
  TakeHold(const sim::Model& model, const Given& given)
      : m_hand(given.hand()),
        m_place(model, given),
        m_deep(given.number("deep_mm", 0.004)),
        m_closed(given.number("to", 0.95)) {}

 private:
  enum Phase { kReach, kEnter, kClose };

  /// After each failure somewhere else beside it.
  void start(Operator&, int tries) override {
    constexpr double kBeside = 0.004;  // [m]
    m_beside = kBeside * Vec3d{double(tries % 3) - (tries > 0 ? 1.0 : 0.0), double((tries / 3) % 3), 0};
  }
  Progress work(Operator& op) override {
    constexpr double kPressed = 0.8, kLongest = 4, kFeels = 1.2;  // [N] [s] [s]
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d at = m_place.point(op, m_hand) + m_beside, along = normalised(at - arm.port);
    op.want(arm.tip);
    op.want(at);
    if (m_phase == kReach) {
      const bool open = op.arms().grip(m_hand, 0, 0.8);
      if (op.arms().move(m_hand, at - reach::kBefore * along, pace::kTravel) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      const bool there = op.arms().move(m_hand, at + m_deep * along, pace::kCareful);
      if (there || norm(op.tool_state(m_hand).contact_force) > kPressed || m_in_phase > kLongest) go(kClose);
    } else if (op.arms().grip(m_hand, m_closed, 0.8) && m_in_phase > kFeels) {
      return op.tool_state(m_hand).holds > 0 ? Progress::done : fail("the jaws have not taken it");
    }
    return Progress::working;
  }

  int m_hand;
  Place m_place;
  double m_deep, m_closed;
  Vec3d m_beside;
};

}  // namespace

const SkillKind kTakeHold{
    "take_hold",
    "take hold of it",
    std::vector<Parameter>{hand_parameter(),
                           number_parameter("deep_mm", "how far the open jaws go on beyond the place; 4", 0, 30),
                           number_parameter("to", "how far the handle closes; 0.95", 0, 1)} +
        place_parameters(),
    15,
    "Goes with open jaws to a place of an organ or a wall, closes them, and feels whether they hold.",
    Place::lacks,
    &making<TakeHold>};

}  // namespace trocar::training
