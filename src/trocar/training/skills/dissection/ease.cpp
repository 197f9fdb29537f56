#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Follows what pulls at the jaws until it hardly does: what was drawn tight goes slack.
class Ease final : public Skill {
 public:
  Ease(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()), m_far(args.number("by_mm", 0.03)), m_least(args.number("pull_N", 0.3)) {}

 private:
  void start(Surgeon& op, int) override {
    m_at = op.arm(m_hand).tip;
    m_way = 0;
  }
  Progress work(Surgeon& op) override {
    constexpr double kSpeed = 0.012;  // [m/s]
    op.want(op.arm(m_hand).tip);
    const interactions::ToolState& tool = op.tool_state(m_hand);
    if (tool.holds == 0 || norm(tool.pull) <= m_least || m_way >= m_far) return Progress::done;
    const double step = kSpeed * sim::kTick;
    m_way += step;
    m_at += step * normalised(Vec3d{tool.pull[0], tool.pull[1], tool.pull[2]});
    op.arms().move(m_hand, m_at, pace::kCareful);
    return Progress::working;
  }

  int m_hand;
  double m_far, m_least, m_way = 0;  ///< [m] [N] [m]
  Vec3d m_at;
};

}  // namespace

const SkillKind kEase{"ease",
                      "yield to the pull",
                      {hand_parameter("the hand that holds it"),
                       number_parameter("pull_N", "until the pull is below this; default 0.3", 0, 50),
                       number_parameter("by_mm", "largest distance; default 30", 0, 200)},
                      8,
                      "Follows the pull at the jaws until it is low.",
                      nothing,
                      &making<Ease>};

}  // namespace trocar::training
