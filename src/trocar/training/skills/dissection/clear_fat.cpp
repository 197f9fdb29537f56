#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/observe/fat.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// An electrode from lobule to lobule, from the trocar's side inwards, each until it is gone; then back.
class ClearFat final : public Skill {
 public:
  ClearFat(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_fat(args("fat").body()),
        m_bared(args("bare").bodies),
        m_left(args.number("left_share", 0)),
        m_most(int(args.number("most", 1000))) {}

 private:
  enum Phase { kAbove, kReach, kPress, kLift, kAway };

  // Of the metal from tubes [m]: further than sparks jump when the pedal is down; a hot tip touches none.
  static constexpr double kSpark = 0.0017, kHot = 0.0005;

  const interactions::FatBody& body(const Surgeon& op) const { return op.model().fat[m_fat.index()]; }
  const tissue::FatState& state(const Surgeon& op) const { return op.state().fat[m_fat.index()]; }
  Vec3d place(const Surgeon& op, int lobule) const { return position(body(op).fat, state(op), lobule); }
  bool gone(const Surgeon& op, int lobule) const { return state(op).lobules[size_t(lobule)].gone(); }

  void start(Surgeon& op, int) override {
    m_tried.assign(size_t(body(op).fat.lobules()), 0);
    m_lobule = -1;
    m_done = 0;
  }

  /// Is it to stay: on a tube that stays in its fat, or so near to another that hot metal would burn that?
  bool spared(const Surgeon& op, Vec3d p) const {
    constexpr double kInItsFat = 0.0045, kOnIt = 0.0019;  // [m] of its middle from the tube
    return nearest_strand(op.model(), op.state(), p).apart < kOnIt ||
           nearest_strand(op.model(), op.state(), p, m_bared).apart < kInItsFat;
  }

  /// The outermost of those that have not been tried, near to where the hook is.
  int next(Surgeon& op) {
    constexpr double kNear = 1.5;     // what the way there counts beside the depth
    constexpr double kAstray = 0.03;  // [m] from where it was drawn: it has detached
    const Arms::Arm& arm = op.arm(m_hand);
    int best = -1;
    double least = 0;
    for (int n = 0; n < body(op).fat.lobules(); ++n) {
      if (gone(op, n) || m_tried[size_t(n)]) continue;
      const Vec3d p = place(op, n);
      if (length(p - body(op).fat.network.rest[size_t(n)]) > kAstray || spared(op, p)) continue;
      const double cost = length(p - arm.port) + kNear * length(p - arm.tip);
      if (best < 0 || cost < least) least = cost, best = n;
    }
    if (best >= 0) m_tried[size_t(best)] = 1;
    return best;
  }

  /// Its bare metal: the wire's last millimetres, and the foot.
  std::array<interactions::Capsule, 2> metal(const Surgeon& op) const {
    const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    interactions::Capsule wire = shape.part[interactions::kJawA];
    wire.a = wire.b - interactions::kBareWire * shape.frame.axis();
    return {wire, shape.part[interactions::kJawB]};
  }
  /// What the metal is at, if that is to go.
  int at_metal(const Surgeon& op) const {
    for (const interactions::Capsule& rod : metal(op)) {
      const int n = interactions::lobule_at(body(op), state(op), rod);
      if (n >= 0 && !spared(op, place(op, n))) return n;
    }
    return -1;
  }
  /// Is it at least so far off every tube?
  bool off_tubes(const Surgeon& op, double apart) const {
    for (const interactions::Capsule& rod : metal(op))
      for (size_t i = 0; i < op.model().strand_bodies.size(); ++i) {
        const std::vector<Vec3d>& x = op.state().strands[i].x;
        const std::vector<double>& radius = op.model().strand_bodies[i].model.radius;
        for (size_t e = 0; e + 1 < x.size(); ++e) {
          const auto near = geometry::closest_segments(rod.a, rod.b, x[e], x[e + 1]);
          if (length(near.on_second - near.on_first) < radius[e] + rod.radius + apart) return false;
        }
      }
    return true;
  }
  /// Where the tip has to be for what is bare of it to lie there: half of the foot reaches beyond it.
  Vec3d tip_for(const Surgeon& op, const Arms::Arm& arm, Vec3d place) const {
    const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, place, arm.roll);
    return place - 0.5 * op.tool(m_hand).foot * kinematics::forward(arm.port, pose).opening();
  }

  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    if (m_phase == kAway) {
      op.want(m_last);
      return op.arms().move_to_depth(m_hand, reach::kBroughtIn, pace::kTravel) ? Progress::done : Progress::working;
    }
    if (m_lobule < 0) {
      const bool enough = m_done >= m_most || fat_left(op.model(), op.state(), m_fat) <= m_left;
      m_lobule = enough ? -1 : next(op);
      if (m_lobule < 0) go(kAway);
      return Progress::working;
    }
    m_last = place(op, m_lobule);
    op.want(m_last);
    work_at(op, arm);
    return Progress::working;
  }

  void work_at(Surgeon& op, Arms::Arm& arm) {
    constexpr double kTouches = 0.004;                    // [N]
    constexpr double kBefore = 0.006, kDeeper = 0.001;    // [m]
    constexpr double kFar = 2, kLongest = 3, kOff = 0.3;  // [s]
    const Vec3d along = normalised(m_last - arm.port);
    const Vec3d goal = tip_for(op, arm, m_last);
    const double force = norm(op.tool_state(m_hand).contact_force);
    // the foot lies across the way to the nearest tube: so it is no nearer to that
    const Vec3d off = nearest_strand(op.model(), op.state(), m_last).outwards;
    const bool turned = !(op.tool(m_hand).foot > 0) || op.arms().turn_across(m_hand, off);
    if ((m_phase == kReach || m_phase == kPress) && !off_tubes(op, kHot)) lift(op);
    switch (m_phase) {
      case kAbove:
        if (length(arm.tip - goal) < 2 * kBefore ||
            (op.arms().move(m_hand, goal - kBefore * along, pace::kTravel) && turned) || m_in_phase > kFar)
          go(kReach);
        break;
      case kLift:
        if (op.arms().move(m_hand, m_lifted, pace::kTravel) || m_in_phase > kFar) m_lobule = -1, go(kAbove);
        break;
      case kReach:
        if (op.arms().move(m_hand, goal + kDeeper * along, pace::kCareful) || force > kTouches || m_in_phase > kFar)
          press(op);
        break;
      default:
        arm.coagulating = at_metal(op) >= 0 && off_tubes(op, kSpark);
        m_steady = arm.coagulating ? 0 : m_steady + sim::kTick;
        if (force < kTouches) op.arms().move(m_hand, goal + kDeeper * along, pace::kCareful);
        if (!gone(op, m_lobule) && m_in_phase < kLongest && m_steady < kOff) break;
        m_done += gone(op, m_lobule);
        press(op);
    }
  }
  /// Back from a tube, the way it came.
  void lift(Surgeon& op) {
    constexpr double kBy = 0.005;  // [m]
    Arms::Arm& arm = op.arm(m_hand);
    arm.coagulating = false;
    m_lifted = arm.tip + kBy * normalised(arm.port - arm.tip);
    go(kLift);
  }
  /// Continues with what the wire is at; lifts it where there is no more, and off what does not go.
  void press(Surgeon& op) {
    const int was = m_lobule;
    m_lobule = at_metal(op);
    if (m_lobule == was && m_phase == kPress) return lift(op);
    if (m_lobule < 0) op.arm(m_hand).coagulating = false;
    go(m_lobule < 0 ? kAbove : kPress);
  }

  int m_hand;
  BodyId m_fat;
  std::vector<BodyId> m_bared;
  double m_left;
  int m_most, m_lobule = -1, m_done = 0;
  Vec3d m_last, m_lifted;
  std::vector<std::uint8_t> m_tried;  ///< (lobules)
};

std::string lacks_fat(const sim::Model& model, const SkillArgs& args) {
  if (!args("fat").body().is(BodyKind::fat)) return "the body is not fat";
  if (!model.energy.there) return "the scene has no current";
  return lacks_tool(model, args.hand(), &interactions::Abilities::coagulate);
}

}  // namespace

const SkillKind kClearFat{
    "clear_fat",
    "clear fat away",
    {hand_parameter("the hand with a hook"),
     {"fat", ArgumentKind::body, "the fat"},
     {"bare", ArgumentKind::bodies, "rods to bare; fat around others is left", false},
     number_parameter("left_share", "ends when at most this share of its volume is left; default 0", 0, 1),
     number_parameter("most", "most lobules at once; default all", 1, 10000)},
    400,
    "Brings an electrode to the outermost lobule of fat, presses the blue pedal until it boils away, and moves to the "
    "next; then withdraws. Lobules directly on a rod are left, because hot metal would burn it.",
    lacks_fat,
    &making<ClearFat>};

}  // namespace trocar::training
