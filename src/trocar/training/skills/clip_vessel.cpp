#include <algorithm>

#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>
#include <trocar/training/skills/vessel_carrier.hpp>

namespace trocar::training {
namespace {

/// A clip on the artery that bleeds, beside the place: around the strand that carries it, or around itself. A hand that
/// does not get there, or sees no tip, draws back; what slid along a leg's end is met a little further on that side
/// next time.
class ClipVessel final : public Skill {
 public:
  ClipVessel(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_upstream(!args.equals("side", "beyond")),
        m_beside(args.number("beside_mm", 0.006)),
        m_cover(args.number("cover", 0.98)),
        m_closing(args.number("closing_s", 2.6)),
        m_inside(args.number("inside_mm", -1)),
        m_careless(args.equals("seen", "whatever")),
        m_away(args.equals("look", "away")) {}

 private:
  enum Phase { kReach, kEnter, kInspect, kClose, kOpen, kLeave };
  void start(Surgeon& op, int tries) override {
    m_tries = tries;
    m_lost = "no clip encloses it";
    if (tries == 0) m_aside = {0, 0, 0};
    m_clips_before = op.state().clip_count;
  }

  Progress work(Surgeon& op) override {
    switch (m_phase) {
      case kReach:
        return reach(op);
      case kEnter:
        return enter(op);
      case kInspect:
        return inspect(op);
      case kClose:
        return close(op);
      case kOpen:
        op.want(bleeding(op));
        if (op.arms().grip(m_hand, 0, 0.5)) go(kLeave);
        return Progress::working;
      default:
        return leave(op);
    }
  }

  Progress reach(Surgeon& op) {
    m_carrier = carrier(op);
    op.want(bleeding(op));
    op.want(spot(op, place(op)).place);
    op.want(op.arm(m_hand).tip);
    m_clips_before = op.state().clip_count;
    m_unseen = 0;
    if (op.arms().grip(m_hand, 0, 0.5) && aim(op, reach::kBefore, pace::kTravel)) go(kEnter);
    if (m_in_phase > 15) give_up("the instrument did not reach the target");
    return Progress::working;
  }

  Progress enter(Surgeon& op) {
    op.want(bleeding(op));
    op.want(op.arm(m_hand).tip);
    if (m_careless && m_in_phase > 2) return go(kInspect), Progress::working;
    if (!aim(op, 0, pace::kCareful) && m_in_phase < 8) return Progress::working;
    m_steady += sim::kTick;
    if (between_legs(op)) return go(kInspect), Progress::working;
    if (m_steady < 0.3) return Progress::working;  // it still slides in
    learn_from_a_miss(op);
    give_up("it slid off the legs");
    return Progress::working;
  }

  Progress inspect(Surgeon& op) {
    look(op);
    if (!m_away) op.want(op.arm(m_hand).tip);
    m_seen_from = 0.052 + 0.008 * double(int(m_in_phase / 1.5) % 4);
    op.from(m_seen_from);
    aim(op, 0, pace::kTrack);
    if (!op.arms().grip(m_hand, kHalfClosed, 1.6)) return Progress::working;
    if (m_careless && m_in_phase > 4) return go(kClose), Progress::working;
    m_unseen += op.sees_tip(m_hand) ? 0 : sim::kTick;
    m_steady = op.sees_tip(m_hand) && !m_careless ? m_steady + sim::kTick : 0;
    if (m_steady > 0.3) go(kClose);
    if (m_in_phase > 8) give_up("no tip came into view");
    return Progress::working;
  }

  Progress close(Surgeon& op) {
    look(op);
    op.from(m_seen_from + (m_unseen > 0.5 ? 0.008 * double(int(m_unseen / 1.5) % 4) : 0));
    if (!m_away) op.want(op.arm(m_hand).tip);
    aim(op, 0, pace::kTrack);
    const bool set = op.state().clip_count > m_clips_before;
    if (!op.sees_tip(m_hand) && !m_careless && !set && m_in_phase < 7) {  // wait for the camera
      m_unseen += sim::kTick;
      return Progress::working;
    }
    if (op.arms().grip(m_hand, 1, m_closing) && set) go(kOpen);
    if (m_in_phase > 11) go(kOpen);
    return Progress::working;
  }

  Progress leave(Surgeon& op) {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(bleeding(op));
    op.want(arm.tip);
    op.arms().grip(m_hand, 0, 0.5);
    op.arms().move(m_hand, arm.tip + 0.01 * normalised(arm.port - arm.tip), pace::kCareful);
    if (m_in_phase < 1.5) return Progress::working;
    return has_clip(op) ? Progress::done : fail(m_lost);
  }

  void give_up(const char* why) {
    m_lost = why;
    go(kLeave);
  }

  static const sim::Bleeder& bleeder(Surgeon& op) { return op.model().vessels.bleeder; }
  static const interactions::VesselPath& path(Surgeon& op) {
    return op.model().vessels.list[size_t(bleeder(op).vessel)].path;
  }
  static interactions::VesselSpot spot(Surgeon& op, double s) { return op.vessel_spot(bleeder(op).vessel, s); }
  static Vec3d bleeding(Surgeon& op) { return spot(op, bleeder(op).s).place; }

  /// Arteries are written from the heart on. A little nearer or further off after each failure.
  double place(Surgeon& op) const {
    constexpr double kElsewhere[] = {0, -0.001, 0.001};  // [m]
    const double off = (m_beside + kElsewhere[m_tries % 3]) / path(op).length;
    return std::clamp(bleeder(op).s + (m_upstream ? -off : off), 0.0, 1.0);
  }

  bool has_clip(Surgeon& op) const { return bleeder_clipped(op.model(), op.state(), m_upstream, m_cover); }

  double inside(Surgeon& op) const {
    constexpr double kSpare = 0.0008;  // [m] between the carrier and the clip's bend
    const interactions::ToolModel& t = op.tool(m_hand);
    return m_inside >= 0 ? m_inside : t.jaw_length - t.clip_length + m_carrier.radius + kSpare;
  }

  VesselCarrier carrier(Surgeon& op) const { return carrier_at(op, bleeder(op).vessel, place(op)); }

  /// To where the carrier lay before the legs touched it: who follows tissue that they push drags it along.
  bool aim(Surgeon& op, double back, double speed) {
    return op.aim(m_hand, m_carrier.place + m_aside, m_carrier.along, inside(op), back, speed);
  }

  Vec3d in_jaws(Surgeon& op, const interactions::ToolShape& shape) const {
    return interactions::to_jaw(shape, carrier(op).place);
  }
  interactions::ToolShape shape(Surgeon& op) const { return sim::shape_of(op.model(), op.state(), size_t(m_hand)); }
  bool between_legs(Surgeon& op) const {
    constexpr double kShort = 0.002;  // [m]
    const interactions::ToolShape now = shape(op);
    const Vec3d local = in_jaws(op, now);
    return std::fabs(local.x) < now.half_gap && local.z < inside(op) + kShort;
  }
  void learn_from_a_miss(Surgeon& op) {
    constexpr double kMost = 0.0008, kFarthest = 0.003;  // [m]
    const interactions::ToolShape now = shape(op);
    const double aside = in_jaws(op, now).x;
    m_aside += std::clamp(0.5 * aside, -kMost, kMost) * interactions::direction_from_jaw(now, {1, 0, 0});
    if (length(m_aside) > kFarthest) m_aside = {0, 0, 0};
  }

  void look(Surgeon& op) const {
    // If the legs' tips stay hidden: from the midline, then from the side; one is seen past the artery's carrier.
    constexpr double kPatience = 1, kAside = 0.03;  // [s] [m]
    constexpr double kAsides[] = {0, kAside, -kAside, 1.6 * kAside, -1.6 * kAside};
    const Vec3d at = carrier(op).place;
    if (m_away) return op.want(at - Vec3d{2 * at.x, 0, 0});  // the other side of the patient
    const double x = kAsides[int(m_unseen / kPatience) % 5];
    op.want(at - Vec3d{at.x > 0 ? x : -x, 0, 0});
  }

  int m_hand;
  bool m_upstream;
  double m_beside, m_cover, m_closing, m_inside;
  bool m_careless, m_away;
  int m_tries = 0, m_clips_before = 0;
  VesselCarrier m_carrier;
  Vec3d m_aside{0, 0, 0};     ///< learnt from misses: where the legs must go instead [m]
  double m_unseen = 0;        ///< for how long no tip has been seen [s]
  double m_seen_from = 0.06;  ///< [m] where the camera saw the legs
  const char* m_lost = "";
};

std::string clip_vessel_lacks(const sim::Model& model, const SkillArgs& args) {
  if (model.vessels.bleeder.vessel < 0) return "the scene has no bleeder";
  return lacks_tool(model, args.hand(), &interactions::Abilities::set_clips);
}

}  // namespace

const SkillKind kClipVessel{
    "clip_vessel",
    "set a clip beside the bleeding point",
    {hand_parameter("the hand with the clip applier"),
     word_parameter("side", "side of the place: where the blood comes from, or beyond", {"heart", "beyond"}),
     number_parameter("beside_mm", "distance from the place; default 6", 0, 100),
     number_parameter("cover", "least share of the vessel between the legs; default 0.98", 0, 1),
     number_parameter("closing_s", "time to close the handle; default 2.6", 0.05, 60),
     number_parameter("inside_mm", "distance of the vessel from the hinge; default at the clip's bend", 0, 100),
     word_parameter("seen", "tips that must be in view with the vessel between them; default one", {"one", "whatever"}),
     word_parameter("look", "where the camera looks meanwhile; default at the place", {"there", "away"})},
    60,
    "Takes the bleeding artery between the clip applier's legs, looks, closes slowly, opens, withdraws.",
    clip_vessel_lacks,
    &making<ClipVessel>};

}  // namespace trocar::training
