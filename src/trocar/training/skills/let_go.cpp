#include <algorithm>

#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Opens, and holds nothing up any more. Where it shall draw back first, the jaws open only as far as what they hold
/// comes free: wide open inside a fold of it they would take that along.
class LetGo final : public Skill {
 public:
  LetGo(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()), m_back(args.number("back_mm", 0)) {}

 private:
  enum Phase { kLoosen, kBack, kOpen };

  void start(Surgeon& op, int) override { m_depth = op.tool_state(m_hand).depth - m_back; }
  Progress work(Surgeon& op) override {
    constexpr double kLoose = 0.7, kSlow = 2;  // of the handle [s] all the way
    op.posture(m_hand).end();
    op.want(op.arm(m_hand).tip);
    if (m_back <= 0 || m_phase == kOpen) return op.arms().grip(m_hand, 0, 0.4) ? Progress::done : Progress::working;
    if (m_phase == kLoosen) {
      const bool loose = op.arms().grip(m_hand, std::min(kLoose, op.arm(m_hand).handle), 0.4);
      if (loose && op.tool_state(m_hand).holds > 0) op.arms().grip(m_hand, 0, kSlow);  // it would tear on the way back
      if (loose && op.tool_state(m_hand).holds == 0) go(kBack);
    } else if (op.arms().move_to_depth(m_hand, m_depth, pace::kCareful)) {
      go(kOpen);
    }
    return Progress::working;
  }
  int m_hand;
  double m_back, m_depth = 0;  ///< [m]
};

}  // namespace

const SkillKind kLetGo{
    "let_go",
    "let go",
    {hand_parameter(),
     number_parameter("back_mm", "distance to draw back before the jaws open wide; default 0", 0, 200)},
    6,
    "Opens the jaws.",
    nothing,
    &making<LetGo>};

}  // namespace trocar::training
