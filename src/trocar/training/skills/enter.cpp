#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// From there until the tissue lies between the jaws.
class Enter final : public Skill {
 public:
  Enter(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()) {}

 private:
  Progress work(Surgeon& op) override {
    const Surgeon::Target& t = op.target(m_hand);
    if (t.strand < 0) return fail("the hand has no target: use approach first");
    op.want(op.point(t.strand, t.s));
    op.want(op.arm(m_hand).tip);
    const bool there = op.aim_at(m_hand, t.strand, t.s, t.inside, 0, pace::kCareful);
    return there ? Progress::done : Progress::working;
  }
  int m_hand;
};

}  // namespace

const SkillKind kEnter{"enter",
                       "take the tissue between the jaws",
                       {hand_parameter()},
                       8,
                       "Moves forward until the rod is between the jaws.",
                       nothing,
                       &making<Enter>};

}  // namespace trocar::training
