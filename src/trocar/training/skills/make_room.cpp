#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// An instrument that others need not see goes out of the way, and so do all that hold nothing.
class MakeRoom final : public Skill {
 public:
  MakeRoom(const sim::Model&, const SkillArgs& args) : m_but(args("hand").given ? args.hand() : -1) {}

 private:
  Progress work(Surgeon& op) override {
    op.make_room(m_but);
    for (int h = 0; h < op.arms().count(); ++h)
      if (h != m_but && op.tool_state(h).holds == 0 && op.tool_state(h).depth > reach::kIdle + 0.001)
        return Progress::working;
    return Progress::done;
  }
  int m_but;
};

}  // namespace

const SkillKind kMakeRoom{"make_room",
                          "draw instruments back",
                          {{"hand", ArgumentKind::hand, "the hand that stays", false}},
                          15,
                          "Withdraws all empty instruments but one to their ports.",
                          nothing,
                          &making<MakeRoom>};

}  // namespace trocar::training
