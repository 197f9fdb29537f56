#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Opens, and holds nothing up any more.
class LetGo final : public Skill {
 public:
  LetGo(const sim::Model&, const Given& given) : m_hand(given.hand()) {}

 private:
  Progress work(Operator& op) override {
    op.posture(m_hand).end();
    op.want(op.arm(m_hand).tip);
    return op.arms().grip(m_hand, 0, 0.4) ? Progress::done : Progress::working;
  }
  int m_hand;
};

}  // namespace

const SkillKind kLetGo{"let_go", "let go", {hand_parameter()}, 4, "Opens the jaws.", nothing, &making<LetGo>};

}  // namespace trocar::training
