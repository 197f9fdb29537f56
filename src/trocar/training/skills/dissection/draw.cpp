#include <algorithm>

#include <trocar/training/observe/directions.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Draws what is held, no harder than it shall, and keeps the jaws where that has come to.
class Draw final : public Skill {
 public:
  Draw(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_direction(patient_direction(args("towards").word)),
        m_far(args.number("by_mm", 0.02)),
        m_speed(args.number("speed_mm_s", 0.008)),
        m_most(args.number("pull_N", 3)) {}

 private:
  void start(Surgeon& op, int) override {
    m_from = op.arm(m_hand).tip;
    m_way = 0;
  }
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    if (op.tool_state(m_hand).holds == 0) return fail("it slipped out of the jaws");
    if (norm(op.tool_state(m_hand).pull) < m_most) m_way = std::min(m_way + m_speed * sim::kTick, m_far);
    const bool there = op.arms().move(m_hand, m_from + m_way * m_direction, pace::kCareful);
    return there && m_way >= m_far ? Progress::done : Progress::working;
  }

  int m_hand;
  Vec3d m_direction, m_from;
  double m_far, m_speed, m_most, m_way = 0;
};

}  // namespace

const SkillKind kDraw{"draw",
                      "pull the grasped tissue",
                      {hand_parameter("the hand that holds it"),
                       word_parameter("towards", "direction in the patient; default feet", patient_directions()),
                       number_parameter("by_mm", "distance; default 20", 0, 200),
                       number_parameter("speed_mm_s", "highest speed; default 8", 0.1, 100),
                       number_parameter("pull_N", "waits while the pull is above this; default 3", 0, 50)},
                      30,
                      "Draws the held tissue, and waits while it pulls too hard.",
                      nothing,
                      &making<Draw>};

}  // namespace trocar::training
