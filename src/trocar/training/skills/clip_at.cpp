#include <algorithm>
#include <iterator>

#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A clip on a strand: the legs go around it, are looked at half closed, and close slowly. A hand that does not see
/// what it must see, or has not all of it between the legs, draws back and tries elsewhere.
class ClipAt final : public Skill {
 public:
  ClipAt(const sim::Model& model, const SkillArgs& args) : m_hand(args.hand()), m_strand(args("of").index) {
    m_within = args("within_mm");
    m_apart = args("apart_mm");
    m_fixed = args("at_mm").given ? args("at_mm").number() : -1;
    m_angle_low = args("angle_deg").given ? args("angle_deg").low : 0;
    m_angle_high = args("angle_deg").given ? args("angle_deg").high : 15 * portable::pi / 180;
    if (m_angle_low == m_angle_high) m_angle_low = 0;
    m_cover = args.number("cover", 0.98);
    m_closing = args.number("closing_s", 2.6);
    m_inside = args("inside_mm").given ? args("inside_mm").number() : -1;
    m_seen = args("seen").word.empty() ? "both" : args("seen").word;
    m_away = args.equals("look", "away");
    m_closely = args.equals("watch", "closely");
    m_length = model.strand_bodies[size_t(m_strand)].length();
  }

 private:
  enum Phase { kReach, kEnter, kInspect, kClose, kOpen, kLeave };

  void start(Surgeon& op, int tries) override {
    m_place = place(op, tries);
    m_spare = 0.001;
    m_unseen = 0;
    m_lost = nullptr;
    m_clips_before = op.state().clip_count;
  }

  Progress work(Surgeon& op) override {
    struct Row {
      double patience;  ///< [s]
      Phase otherwise;
      const char* why;
    };
    static constexpr Row kRows[] = {{15, kLeave, "the instrument did not reach the target"},
                                    {8, kLeave, "the legs did not go around it"},
                                    {13, kLeave, nullptr},  // what was amiss last
                                    {8, kOpen, "the clip did not close"},
                                    {4, kLeave, nullptr},
                                    {6, kLeave, nullptr}};
    const Row& row = kRows[m_phase];
    constexpr double kLonger = 7;  // [s] that who watches closely looks around for
    if (m_in_phase > row.patience + (m_closely && m_phase == kInspect ? kLonger : 0)) {
      if (m_phase == kLeave) return leave_taken(op);
      m_lost = row.why ? row.why : m_phase == kInspect ? m_bad : m_lost;
      go(row.otherwise);
    }
    op.across(m_hand);
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
        return open(op);
      default:
        return leave(op);
    }
  }

  Vec3d at(Surgeon& op) const { return op.point(m_strand, m_place); }
  bool aim(Surgeon& op, double back, double speed) const {
    return op.aim_at(m_hand, m_strand, m_place, inside(op), back, speed);
  }

  Progress reach(Surgeon& op) {
    if (!op.still_presented(m_strand)) return fail("the tissue is no longer held");
    op.keep_postures(m_strand, m_place);
    op.make_room(m_hand);
    op.want(at(op));
    const bool is_open = op.arms().grip(m_hand, 0, 0.5);
    if (op.approach(m_hand, m_strand, m_place, inside(op), m_in_phase) && is_open) go(kEnter);
    return Progress::working;
  }

  Progress enter(Surgeon& op) {
    if (slipped(op)) return Progress::working;
    op.keep_postures(m_strand, m_place);
    op.want(at(op));
    op.want(op.arm(m_hand).tip);
    if (aim(op, 0, pace::kCareful)) go(kInspect);
    return Progress::working;
  }

  Progress inspect(Surgeon& op) {
    if (slipped(op)) return Progress::working;
    op.keep_postures(m_strand, m_place);
    look(op);
    // Where a jaw's tip is hidden, another distance or side may show it, and a strand deeper between the legs.
    m_unseen += op.sees_jaws(m_hand) ? 0 : sim::kTick;
    m_seen_from = 0.052 + 0.008 * double(int(m_in_phase / 1.5) % 4);
    op.from(m_seen_from);
    if (m_in_phase > 0.5 && !op.sees_jaws(m_hand)) m_spare = std::max(0.0007, m_spare - 0.0003 * sim::kTick);
    aim(op, 0, pace::kTrack);
    // Half closed, the legs' tips show beyond the strand; a little further, if not.
    const bool hidden = m_in_phase > 2 && !op.sees_jaws(m_hand);
    const double wanted = kHalfClosed + (hidden ? std::min(0.24, 0.06 * (m_in_phase - 2)) : 0);
    if (!op.arms().grip(m_hand, std::max(wanted, op.arm(m_hand).handle), 1.6)) return Progress::working;
    m_bad = misfit(op);
    m_steady = m_bad ? 0 : m_steady + sim::kTick;
    if (m_steady >= 0.15) go(kClose);
    return Progress::working;
  }

  Progress close(Surgeon& op) {
    const double too_late = m_closely ? 0.95 : 0.9;  // of the handle: the clip is being pressed flat
    const double unsure = m_closely ? 0.04 : 0.1;    // [s]
    look(op);
    op.from(m_seen_from);
    aim(op, 0, pace::kTrack);
    if (op.arm(m_hand).handle < too_late) {
      m_bad = misfit(op);
      m_steady = m_bad ? m_steady + sim::kTick : 0;
      if (m_steady > unsure) {
        m_lost = m_bad;
        go(kOpen);
        return Progress::working;
      }
    }
    if (op.arms().grip(m_hand, 1, m_closing) && op.state().clip_count != m_clips_before) go(kOpen);
    return Progress::working;
  }

  Progress open(Surgeon& op) {
    op.want(at(op));
    if (op.arms().grip(m_hand, 0, 0.5)) go(kLeave);
    return Progress::working;
  }

  Progress leave(Surgeon& op) {
    op.want(at(op));
    op.want(op.arm(m_hand).tip);
    op.arms().grip(m_hand, 0, 0.5);
    return aim(op, reach::kBefore, pace::kCareful) ? leave_taken(op) : Progress::working;
  }

  Progress leave_taken(Surgeon& op) {
    if (op.state().clip_count != m_clips_before) return Progress::done;
    return fail(m_lost ? m_lost : "no clip was set");
  }

  bool slipped(Surgeon& op) {
    if (op.still_presented(m_strand)) return false;
    m_lost = "the tissue is no longer held";
    go(kLeave);
    return true;
  }

  /// Where the clip belongs: given, or in the middle of its range; a little nearer or further after each failure, where
  /// the lower leg may be seen behind the strand. With a sound clip on the strand already, as far from it as they
  /// should be apart.
  double place(Surgeon& op, int tries) const {
    return m_fixed >= 0 ? m_fixed : clear_of_clips(op, wanted_place(op, tries));
  }
  double wanted_place(Surgeon& op, int tries) const {
    constexpr double kElsewhere[] = {0, 0.7, -0.7};  // of what the ranges leave
    const double shift = 0.5 * kElsewhere[tries % 3];
    if (m_within.given && m_apart.given)
      if (const double other = sound_clip(op); other >= 0) {
        const double apart = 0.5 * (m_apart.low + m_apart.high) + shift * (m_apart.high - m_apart.low);
        const bool outwards = other < 0.5 * (m_within.low + m_within.high);
        return std::clamp(other + (outwards ? apart : -apart), m_within.low, m_within.high);
      }
    if (m_within.given) return 0.5 * (m_within.low + m_within.high) + shift * (m_within.high - m_within.low);
    return 0.5 * m_length;
  }

  /// The nearest place where the legs cross none that are there, good or bad.
  double clear_of_clips(Surgeon& op, double wanted) const {
    constexpr double kClear = 0.0024, kStride = 0.0002, kFarthest = 0.005;  // [m]
    const auto is_clear = [&](double s) {
      const auto crosses = [&](const interactions::Clip& c) {
        return c.strand == m_strand && std::fabs(c.s - s) < kClear;
      };
      const auto& clips = op.state().clips;
      return s > 0 && s < m_length && std::none_of(clips.begin(), clips.begin() + op.state().clip_count, crosses);
    };
    for (double off = 0; off < kFarthest; off += kStride)
      for (const double s : {wanted + off, wanted - off})
        if (is_clear(s)) return s;
    return wanted;
  }

  double sound_clip(Surgeon& op) const {
    for (int i = 0; i < op.state().clip_count; ++i) {
      const interactions::Clip& c = op.state().clips[size_t(i)];
      if (c.strand == m_strand && c.tips_visible == 2 && c.cover >= m_cover && c.theta <= m_angle_high) return c.s;
    }
    return -1;
  }

  double inside(Surgeon& op) const {
    // The strand next to the clip's bend, so that both legs' tips come into view beyond it; nearer while they do not.
    const interactions::ToolModel& t = op.tool(m_hand);
    return m_inside >= 0 ? m_inside : t.jaw_length - t.clip_length + op.radius(m_strand, m_place) + m_spare;
  }

  void look(Surgeon& op) const {
    if (m_away) {  // where the eye sees nothing of it
      const Vec3d begin = op.point(m_strand, 0);
      return op.want({-3 * begin.x, begin.y, begin.z});
    }
    // If the legs' tips stay hidden: from the midline, where they are seen past the strand beside the picture's middle;
    // then past what hangs before it: from above, from the patient's left, from the right, straight from in front.
    constexpr double kPatience = 3, kAside = 0.03, kLonger = 5, kEach = 3;  // [s] [m] [s] [s]
    constexpr Vec3d kFrom[] = {
        {0.16, -0.56, 0.81}, {0.55, -0.45, 0.70}, {-0.30, -0.45, 0.84}, {0.10, -0.25, 0.96}};  // unit vectors
    const Vec3d there = at(op);
    if (m_unseen > kLonger)
      return op.camera().view(there, kFrom[size_t((m_unseen - kLonger) / kEach) % std::size(kFrom)], m_seen_from);
    op.want(m_unseen > kPatience ? there - Vec3d{there.x > 0 ? kAside : -kAside, 0, 0} : there);
  }

  bool sees_enough(Surgeon& op) const {
    if (m_seen == "whatever") return true;
    if (m_seen == "not_both") return !op.sees_jaws(m_hand);
    return m_seen == "one" ? op.sees_tip(m_hand) : op.sees_jaws(m_hand);
  }

  /// Null where the whole strand lies between the legs, across, in view; else what is amiss.
  const char* misfit(Surgeon& op) const {
    constexpr double kSurer = 0.035, kMore = 0.01;  // [rad] and share that are kept from the limits
    const interactions::ToolModel& t = op.tool(m_hand);
    const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    const Vec3d local = interactions::to_jaw(shape, at(op));
    const double cover =
        interactions::leg_cover(local.z - (t.jaw_length - t.clip_length), op.radius(m_strand, m_place), t.clip_length);
    const double square = std::fabs(dot(shape.frame.normal(), op.tangent(m_strand, m_place)));
    const bool enclosed = m_cover <= 0 || (cover >= m_cover + kMore && std::fabs(local.x) < shape.half_gap);
    const double askew = portable::acos(std::min(1.0, square));
    const bool across = askew < m_angle_high - kSurer && (m_angle_low <= 0 || askew > m_angle_low + kSurer);
    if (!enclosed) return "the legs did not enclose all of it";
    if (!across) return "it was not perpendicular to the legs";
    return sees_enough(op) ? nullptr : "too few of the legs' tips were in view";
  }

  int m_hand, m_strand;
  Argument m_within, m_apart;
  double m_fixed = -1, m_angle_low = 0, m_angle_high = 0, m_cover = 0.98, m_closing = 2.6, m_inside = -1, m_length = 0;
  std::string m_seen;
  bool m_away = false, m_closely = false;
  double m_place = 0;      ///< [m]
  double m_spare = 0.001;  ///< between the strand and the clip's bend [m]
  double m_unseen = 0;     ///< for how long the legs' tips have not been seen [s]
  double m_seen_from = 0.06;
  int m_clips_before = 0;
  const char* m_lost = nullptr;  ///< why it drew back
  const char* m_bad = nullptr;   ///< what is amiss with how the strand lies
};

std::string clip_at_lacks(const sim::Model& model, const SkillArgs& args) {
  if (std::string lack = lacks_tool(model, args.hand(), &interactions::Abilities::set_clips); !lack.empty())
    return lack;
  return Place::lacks(model, args);
}

}  // namespace

const SkillKind kClipAt{
    "clip_at",
    "set a clip",
    {hand_parameter("the hand with the clip applier"),
     {"of", ArgumentKind::strand, "the rod to clip"},
     range_parameter("within_mm",
                     "stretch for the clip, from the rod's beginning: its middle, another place after each failure", 0,
                     1000),
     range_parameter("apart_mm", "distance from a sound clip", 0, 1000),
     number_parameter("at_mm", "or: exactly this place", 0, 1000),
     range_parameter("angle_deg", "largest angle to the cross-section; default 15", 0, 90),
     number_parameter("cover", "least share of the cross-section between the legs; 0 for any; default 0.98", 0, 1),
     number_parameter("closing_s", "time to close the handle; default 2.6", 0.05, 60),
     number_parameter("inside_mm", "distance of the rod from the hinge; default at the clip's bend", 0, 100),
     word_parameter("seen", "tips of the legs that must be in view before it closes; default both",
                    {"both", "one", "not_both", "whatever"}),
     word_parameter("look", "where the camera looks meanwhile; default at the place", {"there", "away"}),
     word_parameter("watch", "closely: looks longer, and opens sooner while it closes; default as_usual",
                    {"as_usual", "closely"})},
    60,
    "Approaches a rod with the clip applier, takes it between the legs, checks both tips half closed, closes slowly, "
    "opens, and withdraws.",
    clip_at_lacks,
    &making<ClipAt>};

}  // namespace trocar::training
