#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Lets go of what it holds and goes back to the trocar, where instruments are changed.
class PutDown final : public Skill {
 public:
  PutDown(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()), m_least(args.number("least_s", 0)) {}

 private:
  Progress work(Surgeon& op) override {
    op.posture(m_hand).end();
    if (op.tool_state(m_hand).holds > 0 || op.arm(m_hand).handle > 0) {
      op.arms().grip(m_hand, 0, 0.4);
      return Progress::working;
    }
    const bool back = op.arms().move_to_depth(m_hand, reach::kIdle, 2 * pace::kTravel);
    return back && m_in_phase > m_least ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_least;
};

}  // namespace

const SkillKind kPutDown{"put_down",
                         "draw an instrument back",
                         {hand_parameter(), number_parameter("least_s", "minimum time", 0, 60)},
                         15,
                         "Opens the jaws and withdraws the instrument to its port.",
                         nothing,
                         &making<PutDown>};

}  // namespace trocar::training
