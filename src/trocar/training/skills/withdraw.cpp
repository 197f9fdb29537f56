#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Along its shaft to a depth.
class Withdraw final : public Skill {
 public:
  Withdraw(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_depth(args.number("to_mm", reach::kBroughtIn)),
        m_pace(args.equals("pace", "brisk") ? pace::kTravel : pace::kCareful),
        m_watched(!args.equals("watch", "no")) {}

 private:
  Progress work(Surgeon& op) override {
    if (m_watched) op.want(op.arm(m_hand).tip);
    return op.arms().move_to_depth(m_hand, m_depth, m_pace) ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_depth, m_pace;
  bool m_watched;
};

}  // namespace

const SkillKind kWithdraw{
    "withdraw",
    "draw an instrument back",
    {hand_parameter(), number_parameter("to_mm", "depth of the tip from the port; default 85", 5, 290),
     word_parameter("pace", "speed; default careful", {"careful", "brisk"}),
     word_parameter("watch", "whether the camera follows; default yes", {"yes", "no"})},
    6,
    "Moves an instrument along its shaft to a depth.",
    nothing,
    &making<Withdraw>};

}  // namespace trocar::training
