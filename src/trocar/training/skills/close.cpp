#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A handle that closes wherever the jaws are.
class Close final : public Skill {
 public:
  Close(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()), m_to(args.number("to", 1)), m_time(args.number("in_s", 1)) {}

 private:
  Progress work(Surgeon& op) override {
    op.want(op.arm(m_hand).tip);
    return op.arms().grip(m_hand, m_to, m_time) ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_to, m_time;
};

}  // namespace

const SkillKind kClose{"close",
                       "close the jaws",
                       {hand_parameter(), number_parameter("to", "closing of the handle; default 1", 0, 1),
                        number_parameter("in_s", "time from open to closed; default 1", 0.05, 60)},
                       20,
                       "Closes the handle without moving the jaws.",
                       nothing,
                       &making<Close>};

}  // namespace trocar::training
