#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/training/observe/fat.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Jaws take fat off strands, bite by bite: they open along the tube, close on what lies on it, and draw it off.
class StripFat final : public Skill {
 public:
  StripFat(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_fat(args("fat").body()),
        m_off(args("off").bodies),
        m_about(args.number("about_mm", 0.0025)),
        m_far(args.number("by_mm", 0.012)),
        m_hardest(args.number("pull_N", 1)),
        m_most(int(args.number("most", 1000))) {}

 private:
  enum Phase { kChoose, kAbove, kReach, kClose, kDraw, kOpen, kAway };

  const interactions::FatBody& body(const Surgeon& op) const { return op.model().fat[m_fat.index()]; }
  const tissue::FatState& state(const Surgeon& op) const { return op.state().fat[m_fat.index()]; }

  /// What the jaws did not get hold of is not tried again for the same goal.
  void start(Surgeon& op, int tries) override {
    const size_t lobules = size_t(body(op).fat.lobules());
    if (tries == 0 || m_missed.size() != lobules) m_missed.assign(lobules, 0);
    m_tried = m_missed;
    m_bites = 0;
    m_lobule = -1;
  }

  /// Would the instrument strike another hand's on its way there?
  bool is_barred(const Surgeon& op, Vec3d place) const {
    constexpr double kRoom = 0.006;  // [m] for half a shaft and a hand that is not quite steady
    for (int h = 0; h < int(hands(op.model())); ++h) {
      if (h == m_hand) continue;
      const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), size_t(h));
      for (const interactions::Capsule& rod : shape.part) {
        const auto near = geometry::closest_segments(op.arm(m_hand).port, place, rod.a, rod.b);
        if (length(near.on_second - near.on_first) < rod.radius + kRoom) return true;
      }
    }
    return false;
  }

  /// The outermost of those about one of the strands, near to where the jaws are.
  int next(Surgeon& op) {
    constexpr double kAstray = 0.012;  // [m] from where it was drawn: it has detached
    constexpr double kNear = 1.5;      // what the way there counts beside the depth
    const Arms::Arm& arm = op.arm(m_hand);
    const interactions::FatBody& fat = body(op);
    int best = -1;
    double least = 0;
    for (int n = 0; n < fat.fat.lobules(); ++n) {
      if (state(op).lobules[size_t(n)].gone() || m_tried[size_t(n)]) continue;
      const Vec3d p = position(fat.fat, state(op), n);
      if (length(p - fat.fat.network.rest[size_t(n)]) > kAstray) continue;
      const NearStrand near = nearest_strand(op.model(), op.state(), p);
      if (near.apart > m_about || std::find(m_off.begin(), m_off.end(), near.strand) == m_off.end()) continue;
      if (is_barred(op, p)) continue;
      const double cost = length(p - arm.port) + kNear * length(p - arm.tip);
      if (best < 0 || cost < least) least = cost, best = n;
    }
    return best;
  }

  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    if (m_lobule >= 0) m_at = position(body(op).fat, state(op), m_lobule), op.want(m_at);
    switch (m_phase) {
      case kChoose:
        choose(op);
        break;
      case kAbove:
        above(op, arm);
        break;
      case kReach:
        reach(op, arm);
        break;
      case kClose:
        close(op);
        break;
      case kDraw:
        draw(op);
        break;
      case kOpen:
        if (op.arms().grip(m_hand, kSpread, 0.4)) go(kChoose);
        break;
      default:
        op.arms().grip(m_hand, 1, 0.4);
        return op.arms().move_to_depth(m_hand, reach::kBroughtIn, pace::kTravel) ? Progress::done : Progress::working;
    }
    return Progress::working;
  }

  void choose(Surgeon& op) {
    m_lobule = m_bites < m_most ? next(op) : -1;
    if (m_lobule < 0) return go(kAway);
    m_tried[size_t(m_lobule)] = 1;
    ++m_bites;
    m_at = position(body(op).fat, state(op), m_lobule);
    const NearStrand near = nearest_strand(op.model(), op.state(), m_at);
    m_outwards = near.outwards;
    m_along = near.along;
    go(kAbove);
  }
  /// Jaws that open along the tube close on what lies on it, not around it.
  bool turned(Surgeon& op, const Arms::Arm& arm) {
    return op.arms().turn_across(m_hand, cross(m_along, normalised(m_at - arm.port)));
  }
  /// Beyond the lobule, so that it lies between the jaws, but with the tips off every tube.
  Vec3d goal(const Surgeon& op) const {
    constexpr double kDeepest = 0.004, kStride = 0.0005, kOff = 0.0012;  // [m]
    const Vec3d along = normalised(m_at - op.arm(m_hand).port);
    for (double deep = kDeepest; deep > 0; deep -= kStride)
      if (nearest_strand(op.model(), op.state(), m_at + deep * along).apart > kOff) return m_at + deep * along;
    return m_at;
  }

  void above(Surgeon& op, Arms::Arm& arm) {
    constexpr double kBefore = 0.006, kLongest = 2.5;  // [m] [s]
    const Vec3d along = normalised(m_at - arm.port);
    const bool open = op.arms().grip(m_hand, kSpread, 0.4), ready = turned(op, arm);
    if ((op.arms().move(m_hand, goal(op) - kBefore * along, pace::kTravel) && open && ready) || m_in_phase > kLongest)
      go(kReach);
  }
  void reach(Surgeon& op, Arms::Arm& arm) {
    constexpr double kPressed = 0.4, kLongest = 1.5;  // [N] [s]
    turned(op, arm);
    const bool pressed = norm(op.tool_state(m_hand).contact_force) > kPressed;
    if (op.arms().move(m_hand, goal(op), pace::kCareful) || pressed || m_in_phase > kLongest) go(kClose);
  }
  void close(Surgeon& op) {
    constexpr double kFeels = 0.15;  // [s]
    if (!op.arms().grip(m_hand, kClosed, 0.35)) return;
    m_steady += sim::kTick;
    if (m_steady < kFeels) return;
    m_way = 0;
    m_from = op.arm(m_hand).tip;
    const bool taken = takes_fat_alone(op);
    if (!taken) m_missed[size_t(m_lobule)] = 1;
    go(taken ? kDraw : kOpen);
  }
  bool takes_fat_alone(const Surgeon& op) const {
    const interactions::ToolState& tool = op.tool_state(m_hand);
    return tool.holds > 0 && std::all_of(tool.hold, tool.hold + tool.holds,
                                         [&](const interactions::Hold& hold) { return hold.at.body == m_fat; });
  }
  /// Off the tube and back towards the trocar, no harder than it shall.
  void draw(Surgeon& op) {
    constexpr double kSpeed = 0.03, kLongest = 3;  // [m/s] [s]
    const Arms::Arm& arm = op.arm(m_hand);
    const interactions::ToolState& tool = op.tool_state(m_hand);
    const Vec3d way = normalised(m_outwards + normalised(arm.port - m_from));
    if (norm(tool.pull) < m_hardest) m_way = std::min(m_way + kSpeed * sim::kTick, m_far);
    const bool there = op.arms().move(m_hand, m_from + m_way * way, pace::kTravel) && m_way >= m_far;
    if (there || tool.holds == 0 || m_in_phase > kLongest) go(kOpen);
  }

  static constexpr double kSpread = 0.55, kClosed = 1;  ///< of the handle

  int m_hand;
  BodyId m_fat;
  std::vector<BodyId> m_off;
  double m_about, m_far, m_hardest;  ///< [m] [m] [N]
  int m_most, m_bites = 0, m_lobule = -1;
  Vec3d m_at, m_outwards, m_along, m_from;
  double m_way = 0;                             ///< [m]
  std::vector<std::uint8_t> m_tried, m_missed;  ///< (lobules)
};

std::string lacks_strip(const sim::Model& model, const SkillArgs& args) {
  if (!args("fat").body().is(BodyKind::fat)) return "the body is not fat";
  return lacks_tool(model, args.hand(), &interactions::Abilities::grip);
}

}  // namespace

const SkillKind kStripFat{
    "strip_fat",
    "tear fat off",
    {hand_parameter("a hand with jaws"),
     {"fat", ArgumentKind::body, "the fat"},
     {"off", ArgumentKind::bodies, "rods to bare"},
     number_parameter("about_mm", "distance from their surface; default 2.5", 0, 50),
     number_parameter("by_mm", "distance of each pull; default 12", 1, 50),
     number_parameter("pull_N", "waits while the pull is above this; default 1", 0, 20),
     number_parameter("most", "most bites at once; default all", 1, 10000)},
    300,
    "Removes fat from rods bite by bite: jaws that open along the rod close on the fat, draw it off, and drop it.",
    lacks_strip,
    &making<StripFat>};

}  // namespace trocar::training
