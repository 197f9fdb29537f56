#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Raises what is held until a place of it lies straight and across another instrument's shaft, under a gentle pull. It
/// stays so while other skills work there.
class Lift final : public Skill {
 public:
  Lift(const sim::Model& model, const SkillArgs& args) : m_hand(args.hand()), m_at(args.number("at_mm", 0)) {
    m_aim.strand = args("of").index;
    m_aim.beyond = stretch_of(model, m_aim.strand, args("after").word, "").from;
    m_aim.across = args("across").index;
    m_aim.pull_low = args("pull_N").low;
    m_aim.pull_high = args("pull_N").high;
    m_aim.slant = args.number("slant", 0);
    m_inner = args.number("outwards_from_mm", m_at);
    m_straightness = args.number("straightness", 0);
    m_time = args.number("for_s", 0.2);
  }

 private:
  void start(Surgeon& op, int) override {
    const Surgeon::Target& target = op.target(m_hand);
    m_held = target.strand == m_aim.strand ? target.s : m_aim.beyond;
    op.posture(m_hand).begin(op, m_hand, m_aim, m_held, m_inner);
  }
  Progress work(Surgeon& op) override {
    Posture& posture = op.posture(m_hand);
    op.want(op.point(m_aim.strand, m_held));
    op.want(op.point(m_aim.strand, m_at));
    if (!posture.holding(op)) return fail("it slipped out of the jaws");
    posture.keep(op, m_at);
    const double slant = posture.slant(op, m_at), pull = posture.pull(op);
    if (m_aim.slant > 0) {  // pushed down, the jaws leave the picture first
      op.want(op.arm(m_hand).tip);
      return slant > m_aim.slant - 0.02 ? Progress::done : Progress::working;
    }
    const bool good = std::fabs(slant) < 0.13 && pull > m_aim.pull_low + 0.08 && pull < 0.9 * m_aim.pull_high &&
                      straightness_of(op.model(), op.state(), m_aim.strand, m_aim.beyond) > m_straightness + 0.002;
    m_steady = good ? m_steady + sim::kTick : 0;
    return m_steady > 2 * m_time ? Progress::done : Progress::working;
  }

  int m_hand;
  double m_at, m_inner = 0, m_held = 0, m_straightness = 0, m_time = 0.2;
  Posture::Aim m_aim;
};

/// Back to where it was taken.
class Lower final : public Skill {
 public:
  Lower(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()) {}

 private:
  Progress work(Surgeon& op) override {
    const Posture& posture = op.posture(m_hand);
    op.want(op.arm(m_hand).tip);
    if (!posture.up()) return Progress::done;
    return op.arms().move(m_hand, posture.from(), pace::kCareful) ? Progress::done : Progress::working;
  }
  int m_hand;
};

std::string lift_lacks(const sim::Model& model, const SkillArgs& args) { return Place::lacks(model, args); }

}  // namespace

const SkillKind kLift{
    "lift",
    "lift the tissue",
    {hand_parameter("the hand that holds it"),
     {"of", ArgumentKind::strand, "the rod that it holds"},
     {"after", ArgumentKind::landmark, "landmark; it is held beyond its end, and the part before must be straight",
      false},
     {"at_mm", ArgumentKind::number, "place where others will work, from its beginning", true, 0, 1000},
     {"across", ArgumentKind::hand, "the hand whose shaft it must cross"},
     {"pull_N", ArgumentKind::range, "range of the pull", true, 0, 50},
     number_parameter("straightness", "least ratio of chord to length before the end of `after`", 0, 1),
     number_parameter("outwards_from_mm", "the direction from here to the jaws is outwards; default `at_mm`", 0, 1000),
     number_parameter("for_s", "half of the time that it must stay so; default 0.2", 0, 60),
     number_parameter("slant", "sine of the angle to the other shaft; default 0", 0, 1)},
    15,
    "Raises and draws a held rod until a place of it crosses another instrument's shaft. Skills that work on this rod "
    "keep it so, until `let_go`.",
    lift_lacks,
    &making<Lift>};
const SkillKind kLower{"lower",
                       "lay the tissue down",
                       {hand_parameter("the hand that holds it")},
                       8,
                       "Returns a lifted rod to the place where it was grasped.",
                       nothing,
                       &making<Lower>};

}  // namespace trocar::training
