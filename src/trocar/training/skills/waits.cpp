#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Hands and camera stay where they are.
class Wait final : public Skill {
 public:
  Wait(const sim::Model&, const Given& given) : m_time(given.number("for_s", 1e9)) {}

 private:
  Progress work(Operator&) override { return m_in_phase > m_time ? Progress::done : Progress::working; }
  double m_time;
};

/// Until blood shows somewhere.
class WaitForBlood final : public Skill {
 public:
  WaitForBlood(const sim::Model&, const Given& given) : m_least(given.number("least_s", 1)) {}

 private:
  Progress work(Operator& op) override {
    return op.state().opening_count > 0 && m_in_phase > m_least ? Progress::done : Progress::working;
  }
  double m_least;
};

/// An instrument that others need not see goes out of the way, and so do all that hold nothing.
class MakeRoom final : public Skill {
 public:
  MakeRoom(const sim::Model&, const Given& given) : m_but(given("hand").given ? given.hand() : -1) {}

 private:
  Progress work(Operator& op) override {
    op.make_room(m_but);
    for (int h = 0; h < op.arms().count(); ++h)
      if (h != m_but && op.tool_state(h).holds == 0 && op.tool_state(h).depth > reach::kIdle + 0.001)
        return Progress::working;
    return Progress::done;
  }
  int m_but;
};

std::string no_blood(const sim::Model& model, const Given&) {
  return model.vessels.there() ? "" : "there are no vessels";
}

}  // namespace

const SkillKind kHold{"hold",
                      "wait",
                      {number_parameter("for_s", "so long; none: until its \"until\"", 0, 600)},
                      60,
                      "Keeps hands and camera where they are, for a time or until something is so.",
                      nothing,
                      &making<Wait>};
const SkillKind kWaitForBlood{"wait_for_blood",
                              "wait",
                              {number_parameter("least_s", "so long at least", 0, 600)},
                              120,
                              "Waits until a vessel has opened.",
                              no_blood,
                              &making<WaitForBlood>};
const SkillKind kMakeRoom{"make_room",
                          "draw instruments back",
                          {{"hand", ArgumentKind::hand, "that stays", false}},
                          15,
                          "All instruments that hold nothing go back to their trocars, but for one.",
                          nothing,
                          &making<MakeRoom>};

}  // namespace trocar::training
