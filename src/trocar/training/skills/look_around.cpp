#include <fmt/format.h>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// One mark after the other comes into the picture; what instruments hide shows when they are drawn back.
class LookAround final : public Skill {
 public:
  LookAround(const sim::Model& model, const SkillArgs& args) : m_time(args.number("for_s", 1)) {
    for (const std::int32_t mark : args("at").marks) {
      const bool cord = model.targets[size_t(mark)].kind == sim::VisibilityTarget::strand;
      m_marks.push_back({mark, cord ? 0.5 : args.number("organ_share", 0.5), 0});
    }
  }

 private:
  Progress work(Surgeon& op) override {
    constexpr double kGlance = 1.4, kSure = 0.1, kHidden = 2.5;  // [s] at the picture as it is; longer; then draw back
    const LookedFor* missing = nullptr;
    for (LookedFor& l : m_marks) {
      if (l.seen_for >= m_time + kSure) continue;
      const bool seen = sim::visible_share(op.model(), op.state(), l.mark) >= l.share;
      l.seen_for = seen ? l.seen_for + sim::kTick : 0;
      if (!missing) missing = &l;
    }
    if (!missing) return Progress::done;
    if (m_in_phase < kGlance) return Progress::working;
    op.want_all_of(missing->mark);
    op.from(0.07);
    if (m_in_phase > kGlance + kHidden) op.make_room(-1);
    return Progress::working;
  }

  struct LookedFor {
    int mark = -1;
    double share = 0.5, seen_for = 0;
  };
  double m_time = 1;
  std::vector<LookedFor> m_marks;
};

}  // namespace

const SkillKind kLookAround{
    "look_around",
    "look around",
    {{"at", ArgumentKind::marks, "marks that must be seen"},
     {"for_s", ArgumentKind::number, "time that each must be in view without a break", false, 0, 60},
     {"organ_share", ArgumentKind::number, "share of an organ's samples that must be in view; of a rod's samples half",
      false, 0, 1}},
    25,
    "Shows one mark after the other until each has been in view for long enough.",
    nothing,
    &making<LookAround>};

}  // namespace trocar::training
