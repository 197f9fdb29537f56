#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/training/observe/blades.hpp>
#include <trocar/training/observe/loops.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Scissors around a strand, closed in view where no organ lies between the blades. Half way between two clips, or two
/// loops of thread, unless a place is given.
class CutAt final : public Skill {
 public:
  CutAt(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_strand(args("of").index),
        m_apart(args("apart_mm")),
        m_fixed(args.number("at_mm", -1)),
        m_beyond(args.number("beyond_clip_mm", -1)),
        m_share(args.number("inside_share", 0.82)),  // near the blades' ends: spare what lies behind
        m_closing(args.number("closing_s", 0.6)),
        m_spares(!args.equals("spare", "no")),
        m_length(model.strand_bodies[size_t(m_strand)].length()) {}

 private:
  enum Phase { kReach, kEnter, kClose, kOpen, kLeave };
  static constexpr double kGivesWay = 1.6;  // [s] after which what the blades push is not followed any more

  /// How else the blades may be controlled around it, where something lies behind it or beside it.
  struct Pose {
    double turned;  ///< about the shaft, from square across [rad]
    double nearer;  ///< to the blades' tips than it was wanted [of their length]
  };
  static constexpr Pose kPoses[] = {{0, 0},       {0.4, 0},    {-0.4, 0},    {0, 0.08},   {0.4, 0.08},
                                    {-0.4, 0.08}, {0.8, 0.04}, {-0.8, 0.04}, {0.8, 0.1},  {-0.8, 0.1},
                                    {0, 0.14},    {0.4, 0.14}, {-0.4, 0.14}, {1.1, 0.06}, {-1.1, 0.06}};

  void start(Surgeon& op, int) override {
    m_cuts_before = op.state().cut_count;
    m_lost = nullptr;
    m_pose = 0;
    m_tried = 0;
  }

  Progress work(Surgeon& op) override {
    static constexpr double kPatience[] = {15, 8, 4, 4, 6};  // [s]
    if (m_in_phase > kPatience[m_phase]) {
      if (m_phase == kLeave) return ended(op);
      if (m_phase == kReach || m_phase == kEnter) m_lost = "the instrument did not reach the target";
      go(m_phase == kClose ? kOpen : kLeave);
    }
    switch (m_phase) {
      case kReach:
        return reach(op);
      case kEnter:
        return enter(op);
      case kClose:
        return close(op);
      case kOpen:
        op.want(at(op));
        if (op.arms().grip(m_hand, 0, 0.5)) go(kLeave);
        return Progress::working;
      default:
        return leave(op);
    }
  }

  Vec3d at(Surgeon& op) const { return op.point(m_strand, m_place); }
  double inside(Surgeon& op) const {
    return std::min(1.0, m_share + kPoses[m_pose].nearer) * op.tool(m_hand).jaw_length;
  }
  /// What the blades stand across.
  Vec3d along(Surgeon& op) const {
    const Vec3d out = normalised(at(op) - op.arm(m_hand).port);
    return rotate(quat_from_rotation_vector(kPoses[m_pose].turned * out), op.tangent(m_strand, m_place));
  }
  bool lead(Surgeon& op, double speed) const { return op.aim(m_hand, at(op), along(op), inside(op), 0, speed); }

  /// What closing blades squeeze slides towards their tips, and the hand goes after it: so much is left between the
  /// tips and what lies behind, and, where another pose is chosen, between the strand and the tips.
  static constexpr double kRoom = 0.002, kSlides = 0.0015;  // [m]
  bool organ_between(const Surgeon& op, const interactions::ToolShape& shape, double room) const {
    return organ_between_blades(op.model(), op.state(), op.tool(m_hand), shape, room);
  }
  bool all_between(const Surgeon& op, const interactions::ToolShape& shape) const {
    return strand_between_blades(op.model(), op.state(), op.tool(m_hand), shape, m_strand) >= interactions::kThrough;
  }
  /// So led they would part all of it, and no organ.
  bool looks_free(Surgeon& op) const {
    const bool slides = inside(op) + op.radius(m_strand, m_place) + kSlides > op.tool(m_hand).jaw_length;
    const interactions::ToolShape shape = op.shape_at(m_hand, at(op), along(op), inside(op));
    return !(m_pose > 0 && slides) && all_between(op, shape) && !organ_between(op, shape, kRoom);
  }
  /// The next pose that looks free from here, of those that were not tried; false: there is none.
  bool look_beside(Surgeon& op) {
    const std::size_t now = m_pose;
    for (m_pose = 0; m_pose < std::size(kPoses); ++m_pose)
      if (!(m_tried >> m_pose & 1) && looks_free(op)) return true;
    m_pose = now;
    return false;
  }
  /// Tries it in another pose. False: there is none.
  bool tries_beside(Surgeon& op) {
    m_tried |= 1u << m_pose;
    if (!look_beside(op)) return false;
    go(kEnter);
    return true;
  }

  Progress reach(Surgeon& op) {
    if (!op.still_presented(m_strand)) return fail("the tissue is no longer held");
    m_place = place(op);
    op.keep_postures(m_strand, m_place);
    op.make_room(m_hand);
    op.want(at(op));
    const bool open = op.arms().grip(m_hand, 0, 0.5);
    if (op.approach(m_hand, m_strand, m_place, inside(op), m_in_phase) && open) {
      if (m_spares) look_beside(op);
      go(kEnter);
    }
    return Progress::working;
  }

  Progress enter(Surgeon& op) {
    op.make_room(m_hand);
    op.want(at(op));
    op.want(op.arm(m_hand).tip);
    const bool open = op.arms().grip(m_hand, 0, 0.5);
    const double speed = m_in_phase < 3 ? pace::kCareful : pace::kTrack;
    const bool there = lead(op, speed);
    const bool taken = open && (there || (m_in_phase > kGivesWay && reached_over(op)));
    m_steady = taken && op.sees_tip(m_hand) ? m_steady + sim::kTick : 0;
    if (m_steady > 0.1) close_or_look_beside(op);
    return Progress::working;
  }

  void close_or_look_beside(Surgeon& op) {
    const interactions::ToolShape now = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    m_whole = all_between(op, now);
    if (!m_spares || !organ_between(op, now, kRoom)) return go(kClose);
    if (tries_beside(op)) return;
    if (!organ_between(op, now, 0)) return go(kClose);  // nowhere is more room
    m_lost = "an organ lies between the blades";
    go(kLeave);
  }

  /// The blades reach over all of it, there. What gives way before them is cut where it lies: they push a thick tube on
  /// from where they are as wide as it is, and would never catch up with it.
  bool reached_over(Surgeon& op) const {
    constexpr double kBeyond = 0.0008, kBeside = 0.0015;  // [m] of the tips; along the strand
    const interactions::ToolModel& tool = op.tool(m_hand);
    const Vec3d lies = interactions::to_jaw(sim::shape_of(op.model(), op.state(), size_t(m_hand)), at(op));
    const double radius = op.radius(m_strand, m_place);
    return lies.z > radius && lies.z + radius + kBeyond < tool.jaw_length && std::fabs(lies.y) < kBeside;
  }

  Progress close(Surgeon& op) {
    constexpr double kMeet = 0.25;  // aperture at which it is too late to open again
    op.want(at(op));
    lead(op, pace::kTrack);
    const interactions::ToolShape now = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    const bool organ = organ_between(op, now, 0);
    if (m_spares && op.tool_state(m_hand).aperture > kMeet && (organ || (m_whole && !all_between(op, now)))) {
      if (tries_beside(op)) return Progress::working;
      m_lost = organ ? "an organ came between the blades" : "it slid from between the blades";
      return go(kOpen), Progress::working;
    }
    if (op.arms().grip(m_hand, 1, m_closing)) go(kOpen);
    return Progress::working;
  }

  Progress leave(Surgeon& op) {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(at(op));
    op.want(arm.tip);
    op.arms().grip(m_hand, 0, 0.5);
    if (m_in_phase < 1.5 * sim::kTick) m_left_from = arm.tip;
    if (length(arm.tip - m_left_from) > 0.02 || m_in_phase > 3) return ended(op);
    op.arms().move(m_hand, arm.tip + 0.01 * normalised(arm.port - arm.tip), pace::kCareful);
    return Progress::working;
  }

  Progress ended(Surgeon& op) {
    if (op.state().cut_count != m_cuts_before) return Progress::done;
    return fail(m_lost ? m_lost : "nothing was cut");
  }

  /// Where clips and loops sit on it, one after the other from its beginning [m].
  std::vector<double> closures(Surgeon& op) const {
    std::vector<double> at;
    for (int i = 0; i < op.state().clip_count; ++i)
      if (op.state().clips[size_t(i)].strand == m_strand) at.push_back(op.state().clips[size_t(i)].s);
    const SecuredLoops loops = secured_loops(op.model(), op.state(), m_strand);
    at.insert(at.end(), loops.at.begin(), loops.at.begin() + loops.count);
    std::sort(at.begin(), at.end());
    return at;
  }

  double place(Surgeon& op) const {
    if (m_fixed >= 0 && m_beyond < 0) return m_fixed;
    const std::vector<double> at = closures(op);
    if (m_beyond >= 0) return m_beyond + (at.empty() ? 0 : at.back());
    for (size_t i = 1; i < at.size(); ++i)
      if (m_apart.holds(at[i] - at[i - 1])) return 0.5 * (at[i] + at[i - 1]);
    return 0.5 * m_length;
  }

  int m_hand, m_strand;
  Argument m_apart;
  double m_fixed, m_beyond, m_share, m_closing;
  bool m_spares;
  double m_length;
  double m_place = 0;
  std::size_t m_pose = 0;  ///< of kPoses
  unsigned m_tried = 0;    ///< bits, of kPoses: an organ lay between the blades
  bool m_whole = false;    ///< all of it lay between them when they began to close
  Vec3d m_left_from;
  int m_cuts_before = 0;
  const char* m_lost = nullptr;
};

std::string cut_at_lacks(const sim::Model& model, const SkillArgs& args) {
  if (std::string lack = lacks_tool(model, args.hand(), &interactions::Abilities::cut); !lack.empty()) return lack;
  return Place::lacks(model, args);
}

}  // namespace

const SkillKind kCutAt{
    "cut_at",
    "cut",
    {hand_parameter("the hand with the scissors"),
     {"of", ArgumentKind::strand, "the rod to cut"},
     range_parameter("apart_mm", "half way between two neighbouring clips or loops at this distance", 0, 1000),
     number_parameter("at_mm", "or: exactly this place, from its beginning", 0, 1000),
     number_parameter("beyond_clip_mm", "or: distance beyond the outermost clip", 0, 1000),
     number_parameter("inside_share",
                      "distance of the rod from the hinge, as a share of the blades' length; default 0.82", 0, 1),
     number_parameter("closing_s", "time to close the handle; default 0.6", 0.05, 60),
     word_parameter("spare", "whether other tissue between the blades is avoided; default yes", {"yes", "no"})},
    40,
    "Approaches a rod with scissors, takes it between the blades, turns them away from organs, closes in view, opens, "
    "and withdraws.",
    cut_at_lacks,
    &making<CutAt>};

}  // namespace trocar::training
