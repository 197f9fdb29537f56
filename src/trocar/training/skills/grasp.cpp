#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Closes until the jaws hold the strand.
class Grasp final : public Skill {
 public:
  Grasp(const sim::Model& model, const SkillArgs& args) : m_hand(args.hand()) {
    m_beyond = args("of").given ? stretch_of(model, args("of").index, args("after").word, "").from : -1;
    m_closed = args.number("to", 0.95);
  }

 private:
  Progress work(Surgeon& op) override {
    const Surgeon::Target& t = op.target(m_hand);
    if (t.strand < 0) return fail("the hand has no target: use approach first");
    op.want(op.point(t.strand, t.s));
    if (!op.arms().grip(m_hand, m_closed, 0.8) || m_in_phase < 1.2) return Progress::working;
    const double at = held_arc(op.model(), op.state(), size_t(m_hand), t.strand);
    if (at < 0 || at <= m_beyond) return fail("the jaws did not grasp it");
    return Progress::done;
  }
  int m_hand;
  double m_beyond = -1, m_closed = 0.95;
};

}  // namespace

const SkillKind kGrasp{"grasp",
                       "grasp",
                       {hand_parameter(),
                        {"of", ArgumentKind::strand, "the rod that must be held", false},
                        {"after", ArgumentKind::landmark, "beyond the end of this landmark", false},
                        number_parameter("to", "closing of the handle; default 0.95", 0, 1)},
                       4,
                       "Closes the jaws and tests whether they hold the rod.",
                       Place::lacks,
                       &making<Grasp>};

}  // namespace trocar::training
