#include <algorithm>
#include <cmath>

#include <trocar/interactions/verbs/between_blades.hpp>
#include <trocar/training/observe/blades.hpp>
#include <trocar/training/observe/folds.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A fold divided along the strand that it carries, bite by bite from its far end on.
class CutFold final : public Skill {
 public:
  CutFold(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_fold(int(args("of").body().index())),
        m_strand(model.membranes[size_t(m_fold)].strand),
        m_columns(model, m_fold),
        m_away(args.number("away_mm", 0.005)),
        m_to(args.number("to_mm", 0)),
        m_bite(args.number("bite_mm", 0.008)),
        m_most(int(args.number("most", 40))) {}

 private:
  enum Phase { kReach, kEnter, kClose, kOpen, kBack };
  static constexpr double kBefore = 0.024;  // [m] out of the fold, from where the blades go straight in
  /// Beside where it was wanted, for a bite that would have gone into something else.
  struct Beside {
    double farther, back;  ///< [m] from the strand; along the shaft
  };
  static constexpr Beside kBeside[] = {{0, 0},           {0, 0.0012},     {0.0015, 0.0006}, {0.0015, 0.0018},
                                       {0.003, 0.0012},  {0.003, 0.0024}, {-0.001, 0.0012}, {-0.002, 0.002},
                                       {0.0045, 0.0018}, {0.0045, 0.0032}};

  void start(Surgeon& op, int) override {
    m_bites = m_vain = 0;
    m_column = -1;
    look(op);
  }

  /// The last column that is whole, and how many before it the blades shall reach over.
  void look(Surgeon& op) {
    const int before = m_column;
    m_column = -1;
    for (int c = 0; c < m_columns.count(); ++c)
      if (m_columns.s(c) >= m_to && m_columns.whole(op.model(), op.state(), c)) m_column = c;
    m_vain = before == m_column && before >= 0 ? m_vain + 1 : 0;
    m_inner = m_column;
    while (m_inner > 0 && goes_on(m_inner - 1) && m_columns.s(m_column) - m_columns.s(m_inner - 1) <= m_bite) --m_inner;
  }
  /// The last column is cut alone, with the blades' tips just beyond it: what the strand comes out of lies behind.
  bool is_last(int column) const { return column == 0 || m_columns.s(column - 1) < m_to; }
  bool goes_on(int column) const { return m_columns.s(column) >= m_to && !is_last(column); }

  Vec3d at(Surgeon& op, int column) const { return m_columns.point(op.model(), op.state(), column, m_away); }
  Vec3d middle(Surgeon& op) const { return 0.5 * (at(op, m_column) + at(op, m_inner)); }
  /// From the strand to the root: the blades close across that.
  Vec3d across(Surgeon& op) const {
    constexpr double kAround = 0.003;  // [m]
    const Vec3d near = m_columns.point(op.model(), op.state(), m_column, m_away - kAround);
    const Vec3d far = m_columns.point(op.model(), op.state(), m_column, m_away + kAround);
    return normalised(far - near, {0, 1, 0});
  }

  /// To where it lay before the blades touched it: what they push they would never catch up with.
  bool aim(Surgeon& op, double back, double speed) const {
    // a bite in vain is made again a little deeper, then a little less deep
    constexpr double kInside = 0.62, kAtTips = 0.88, kElsewhere[] = {0, -0.12, 0.12, -0.24};
    const double share = m_at_last ? kAtTips : kInside + kElsewhere[m_vain % 4];
    const Beside& beside = kBeside[m_beside];
    return op.aim(m_hand, m_at + beside.farther * m_across, m_across, share * op.tool(m_hand).jaw_length,
                  back + beside.back, speed);
  }

  Progress work(Surgeon& op) override {
    constexpr int kInVain = 8;
    constexpr double kLooks = 0.2, kUnseen = 3.5;  // [s] at what has been divided; to wait for the camera
    if (m_column < 0) return m_in_phase > kLooks ? Progress::done : Progress::working;
    if (m_vain >= kInVain) return fail("the fold does not lie between the blades");
    if (m_column >= 0) op.want(middle(op));
    op.want(op.arm(m_hand).tip);
    switch (m_phase) {
      case kReach:
        return reach(op);
      case kEnter: {
        const bool there = aim(op, 0, pace::kCareful);
        m_steady = there && (op.sees_tip(m_hand) || m_in_phase > kUnseen) ? m_steady + sim::kTick : 0;
        if (m_steady <= 0.1 && m_in_phase <= kUnseen + 2) return Progress::working;
        if (m_settled)
          go(kClose);
        else
          look_beside(op);
        return Progress::working;
      }
      case kClose:
        if (op.arms().grip(m_hand, 1, 0.5)) go(kOpen);
        return Progress::working;
      case kOpen:
        if (op.arms().grip(m_hand, 0, 0.4)) go(kBack);
        return Progress::working;
      default:
        return back(op);
    }
  }

  /// Whether the blades close here. Where something else lies between them another place is tried; where there is none
  /// that is free, the one where they would nick least of what the fold hangs on, but never an organ.
  void look_beside(Surgeon& op) {
    constexpr double kMisses = 2, kUnseen = 0.3;  // as bad as nicking so much of the strand
    const interactions::ToolModel& tool = op.tool(m_hand);
    const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    const bool organ = organ_between_blades(op.model(), op.state(), tool, shape);
    const bool takes = crosses_column(op, interactions::closed_blades(tool, shape));
    const double nick = strand_between_blades(op.model(), op.state(), tool, shape, m_strand);
    if (!organ && takes && nick <= 0) return go(kClose);
    const double bad = nick + (takes ? 0 : kMisses) + (op.sees_tip(m_hand) ? 0 : kUnseen);
    if (!organ && (m_least_bad < 0 || bad < m_badness)) m_least_bad = int(m_beside), m_badness = bad;
    if (++m_beside < std::size(kBeside)) return go(kEnter);
    m_settled = m_least_bad >= 0;
    m_beside = size_t(std::max(0, m_least_bad));
    go(m_settled ? kEnter : kBack);
  }
  bool crosses_column(const Surgeon& op, const geometry::Blade& blade) const {
    constexpr double kStep = 0.001, kDeepest = 0.02;  // [m] from the strand
    const geometry::BladePlane plane(blade);
    Vec3d from = m_columns.point(op.model(), op.state(), m_column, 0);
    for (double away = kStep; away < kDeepest; away += kStep) {
      const Vec3d to = m_columns.point(op.model(), op.state(), m_column, away);
      if (plane.crosses(from, to)) return true;
      from = to;
    }
    return false;
  }

  Progress reach(Surgeon& op) {
    m_at = middle(op);
    m_across = across(op);
    m_at_last = is_last(m_column);
    m_beside = 0;
    m_least_bad = -1;
    m_settled = false;
    // where something lay between blades that were wide open, or nothing was cut, they go in less open
    constexpr double kLessOpen = 0.5;
    const bool open = op.arms().grip(m_hand, m_vain % 2 == 1 ? kLessOpen : 0, 0.4);
    if ((aim(op, kBefore, pace::kTravel) && open) || m_in_phase > 8) go(kEnter);
    return Progress::working;
  }

  /// Out of what was cut before the next bite is looked for.
  Progress back(Surgeon& op) {
    Arms::Arm& arm = op.arm(m_hand);
    if (m_in_phase < 1.5 * sim::kTick) m_from = arm.tip;
    const bool away = op.arms().move(m_hand, m_from + kBefore * normalised(arm.port - m_from), pace::kCareful);
    if (!away && m_in_phase < 3) return Progress::working;
    look(op);
    if (m_column < 0) return go(kReach), Progress::working;
    if (++m_bites >= m_most) return fail("it is not divided yet");
    go(kReach);
    return Progress::working;
  }

  int m_hand, m_fold, m_strand;
  FoldColumns m_columns;
  double m_away, m_to, m_bite;
  int m_most, m_bites = 0, m_vain = 0, m_column = -1, m_inner = -1;
  Vec3d m_from, m_at, m_across{0, 1, 0};
  bool m_at_last = false, m_settled = false;
  double m_badness = 0;      ///< of m_least_bad
  int m_least_bad = -1;      ///< of kBeside
  std::size_t m_beside = 0;  ///< of kBeside
};

std::string lacks_fold(const sim::Model& model, const SkillArgs& args) {
  if (!FoldColumns::there(model, args("of").body())) return "the body is not a fold that hangs on a strand";
  return lacks_tool(model, args.hand(), &interactions::Abilities::cut);
}

}  // namespace

const SkillKind kCutFold{"cut_fold",
                         "divide the fold",
                         {hand_parameter("the hand with the scissors"),
                          {"of", ArgumentKind::body, "a membrane on a rod"},
                          number_parameter("away_mm", "distance from the rod's surface; default 5", 0, 100),
                          number_parameter("to_mm", "end along the rod, from its beginning; default 0", 0, 1000),
                          number_parameter("bite_mm", "reach of each bite; default 8", 1, 30),
                          number_parameter("most", "most bites at once; default 40", 1, 200)},
                         240,
                         "Divides a membrane along its rod, bite by bite from the far end towards the rod's beginning.",
                         lacks_fold,
                         &making<CutFold>};

}  // namespace trocar::training
