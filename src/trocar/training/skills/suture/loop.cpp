// A sling's loop: opened, put over the free end of a strand, drawn closed, left, and its tail cut.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/loops.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

using interactions::SlingState;

const SlingState* sling_in(const Surgeon& op, int hand) {
  const int i = sling_of_hand(op.state(), hand);
  if (i < 0 || op.state().objects.sutures[std::size_t(i)].sling.stage == SlingState::left) return nullptr;
  return &op.state().objects.sutures[std::size_t(i)].sling;
}
double loop_of(const Surgeon& op, int hand) {
  const int i = sling_of_hand(op.state(), hand);
  return i < 0 ? 0 : op.model().objects.sutures.list[std::size_t(i)].sling.loop;
}

/// Turns the plane of the loop to stand across `along`, as far as it can. True when it does.
bool face(Surgeon& op, int hand, Vec3d along) {
  constexpr double kTurns = 1.2, kNear = 0.03;  // [rad/s] [rad]
  Arms::Arm& arm = op.arm(hand);
  const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, arm.tip, arm.roll);
  const Vec3d out = normalised(arm.tip - arm.port, {0, 0, -1});
  double left = kinematics::roll_towards(pose, cross(along, out)) - arm.roll;
  while (left > 0.5 * portable::pi) left -= portable::pi;
  while (left < -0.5 * portable::pi) left += portable::pi;
  arm.roll += std::clamp(left, -kTurns * sim::kTick, kTurns * sim::kTick);
  return std::fabs(left) < kNear;
}

/// Where a strand lies that a loop with so much thread is put around, and where the mouth has to be for that.
struct Around {
  Vec3d at, along{0, 0, 1};

  static constexpr double kCentre = 0.265;    ///< of the thread: how far in front of the mouth a loop's middle is
  static constexpr double kNearest = 0.0058;  ///< [m] of the mouth to the strand's middle line
  static constexpr double kTouches = 0.045;   ///< [m] of thread: from here on the strand gives way

  void look(const Surgeon& op, int strand, double s) {
    at = op.point(strand, s);
    along = op.tangent(strand, s);
  }
  /// The less thread there is, the more the knot stands level with the place.
  Vec3d mouth(Vec3d port, double thread) const {
    const double back = std::max(kNearest, kCentre * thread), slants = std::clamp((back - 0.006) / 0.01, 0.0, 1.0);
    const Vec3d out = normalised(at - port), level = normalised(out - dot(out, along) * along, out);
    return at - back * normalised(slants * out + (1 - slants) * level, out);
  }
};

/// Opens the loop above the free end and leads it down over the strand.
class PutLoopOver final : public Skill {
 public:
  PutLoopOver(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_strand(args("of").index),
        m_at(args.number("at_mm", 0.01)),
        m_thread(args.number("thread_mm", 1)),
        m_end(model.strand_bodies[std::size_t(m_strand)].length() - 0.001) {}

 private:
  enum Phase { kAbove, kOpen, kOver, kDown };
  static constexpr double kHigh = 0.024, kOnto = 0.012, kLongest = 6, kTakes = 0.5;  // [m], [s]

  void start(Surgeon&, int) override { m_s = m_end; }
  Progress work(Surgeon& op) override {
    const SlingState* g = sling_in(op, m_hand);
    if (!g) return m_in_phase > kTakes ? fail("there is no loop in the tube") : Progress::working;
    Around end, here;
    end.look(op, m_strand, m_end);
    here.look(op, m_strand, m_s);
    const Vec3d port = op.arm(m_hand).port, over = end.mouth(port, loop_of(op, m_hand));
    op.want(end.at);
    op.want(op.arm(m_hand).tip);
    if (m_phase == kAbove) {
      op.arms().grip(m_hand, 1, 0.5);
      const bool faced = face(op, m_hand, end.along);
      if (op.arms().move(m_hand, over + kHigh * end.along, pace::kTravel) && faced) go(kOpen);
    } else if (m_phase == kOpen) {
      op.arms().grip(m_hand, 0, 0.4);
      if (g->stage == SlingState::open && m_in_phase > 1) go(kOver);
      if (m_in_phase > kLongest) return fail("the loop does not open");
    } else if (m_phase == kOver) {
      face(op, m_hand, end.along);
      if (op.arms().move(m_hand, over + kOnto * end.along, pace::kTravel)) go(kDown);
    } else {
      face(op, m_hand, here.along);
      narrow(op, *g);
      const bool there = op.arms().move(m_hand, here.mouth(port, g->fed), pace::kTravel);
      m_s = std::max(m_at, m_s - pace::kCareful * sim::kTick);
      if (there && m_s <= m_at)
        return g->lies_around(BodyId::strand(std::size_t(m_strand))) ? Progress::done
                                                                     : fail("the loop does not lie around it");
    }
    return Progress::working;
  }

  /// Draws it to as much thread as it shall have when it comes down; then the hand only holds it.
  void narrow(Surgeon& op, const SlingState& g) const {
    constexpr double kDrawn = 0.2, kHeld = 0.06, kWithin = 0.02;  // of the handle; [m] of the end: still being put over
    if (m_thread >= loop_of(op, m_hand) || !g.lies_around(BodyId::strand(std::size_t(m_strand))) ||
        m_s > m_end - kWithin)
      return;
    op.arms().grip(m_hand, g.fed > m_thread ? kDrawn : kHeld, 1.5);
  }

  int m_hand, m_strand;
  double m_at, m_thread, m_end, m_s = 0;
};

/// Draws it closed; the mouth comes after it, so that the knot stands at the place.
class CloseLoop final : public Skill {
 public:
  CloseLoop(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_strand(args("of").index),
        m_at(args.number("at_mm", 0.01)),
        m_to(args.number("close_to", 0.4)),
        m_leads(args.equals("lead_back", "yes")) {}

 private:
  static constexpr double kDraws = 0.25, kLies = 0.4, kSettles = 0.8, kLongest = 12;  // of the handle, [N], [s]

  void start(Surgeon& op, int) override {
    m_around.look(op, m_strand, m_at);
    m_ended = m_shift = 0;
  }
  /// Where the loop slides off the place while it closes, the knot is controlled the other way.
  void lead_back(const Surgeon& op, const SlingState& g) {
    constexpr double kGain = 2, kMost = 0.004;  // [1/s] [m]
    for (std::int32_t i = 0; i < g.around_count; ++i) {
      const interactions::SlingAround& a = g.around[std::size_t(i)];
      if (a.at.body != BodyId::strand(std::size_t(m_strand))) continue;
      const double lies = arc_of(op.model(), a.at);
      m_shift = std::clamp(m_shift + kGain * (m_at - lies) * sim::kTick, -kMost, kMost);
    }
  }
  Progress work(Surgeon& op) override {
    const SlingState* g = sling_in(op, m_hand);
    if (!g) return fail("there is no loop in the tube");
    if (!g->lies_around(BodyId::strand(std::size_t(m_strand)))) return fail("the loop does not lie around it");
    if (g->fed > Around::kTouches)
      m_around.look(op, m_strand, m_at);
    else if (m_leads)
      lead_back(op, *g);
    op.want(m_around.at);
    op.want(op.arm(m_hand).tip);
    const Vec3d mouth = m_around.mouth(op.arm(m_hand).port, g->fed) + m_shift * m_around.along;
    op.arms().move(m_hand, mouth, pace::kTravel);
    const bool lies = g->tension > kLies;
    op.arms().grip(m_hand, lies ? m_to : std::min(m_to, kDraws), lies ? 2.0 : 0.8);
    const auto loop = loop_on(op.model(), op.state(), m_strand, m_at);
    const bool closed = loop && loop->closes() && op.arm(m_hand).handle > m_to - 0.01;
    m_ended = closed ? m_ended + sim::kTick : 0;
    if (m_ended > kSettles) return Progress::done;
    return m_in_phase > kLongest ? fail("the loop does not close the lumen") : Progress::working;
  }

  int m_hand, m_strand;
  double m_at, m_to, m_ended = 0, m_shift = 0;
  bool m_leads;
  Around m_around;
};

/// Opens the handle and draws the tube back: the loop stays with its knot, thread comes out behind it.
class LeaveLoop final : public Skill {
 public:
  LeaveLoop(const sim::Model&, const SkillArgs& args) : m_hand(args.hand()), m_back(args.number("back_mm", 0.03)) {}

 private:
  void start(Surgeon& op, int) override { m_from = op.arm(m_hand).tip; }
  Progress work(Surgeon& op) override {
    const SlingState* g = sling_in(op, m_hand);
    if (!g) return fail("there is no loop in the tube");
    Arms::Arm& arm = op.arm(m_hand);
    op.want(m_from);
    op.want(arm.tip);
    if (!op.arms().grip(m_hand, 0, 0.8) || m_in_phase < 1.5) return Progress::working;
    const Vec3d to = m_from + m_back * normalised(arm.port - m_from);
    if (!op.arms().move(m_hand, to, pace::kCareful)) return Progress::working;
    if (m_in_phase < 3) return Progress::working;
    return g->stage == SlingState::off ? Progress::done : fail("the knot has not left the tube");
  }

  int m_hand;
  double m_back;
  Vec3d m_from;
};

/// Scissors around the thread between knot and tube.
class CutTail final : public Skill {
 public:
  CutTail(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()), m_at(args.number("at_mm", 0.01)), m_share(args.number("inside_share", 0.7)) {}

 private:
  enum Phase { kReach, kEnter, kClose, kOpen, kLeave };
  static constexpr double kSteady = 0.15, kLongest = 10;  // [s]

  /// The sling whose tail is to be cut.
  const interactions::SutureState* tail(const Surgeon& op) const {
    const auto& list = op.state().objects.sutures;
    const auto off = [](const interactions::SutureState& s) { return s.sling.stage == SlingState::off; };
    const auto found = std::find_if(list.begin(), list.end(), off);
    return found == list.end() ? nullptr : &*found;
  }
  void start(Surgeon&, int) override { m_was = false; }
  Progress work(Surgeon& op) override {
    if (const interactions::SutureState* s = tail(op)) {
      const std::size_t i = std::size_t(s - op.state().objects.sutures.data());
      const suture::ThreadModel& m = op.model().objects.sutures.list[i].thread;
      const double arc = s->sling.knot + std::min(m_at, 0.7 * (s->sling.fed - s->sling.knot));
      m_place = suture::point_at(m, s->thread, arc);
      m_along = normalised(suture::point_at(m, s->thread, arc + 0.002) - suture::point_at(m, s->thread, arc - 0.002));
      m_was = true;
    } else if (!m_was) {
      return fail("there is no tail to cut");
    }
    op.want(m_place);
    op.want(op.arm(m_hand).tip);
    const double inside = m_share * op.tool(m_hand).jaw_length;
    if (m_phase == kReach) {
      const bool open = op.arms().grip(m_hand, 0, 0.5);
      if (op.aim(m_hand, m_place, m_along, inside, reach::kBefore, pace::kTravel) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      const bool there = op.aim(m_hand, m_place, m_along, inside, 0, pace::kCareful);
      m_steady = there ? m_steady + sim::kTick : 0;
      if (m_steady > kSteady || m_in_phase > kLongest) go(kClose);
    } else if (m_phase == kClose) {
      if (op.arms().grip(m_hand, 1, 0.5)) go(kOpen);
    } else if (m_phase == kOpen) {
      if (op.arms().grip(m_hand, 0, 0.4)) go(kLeave);
    } else {
      Arms::Arm& arm = op.arm(m_hand);
      const bool back = op.arms().move(m_hand, m_place + 0.03 * normalised(arm.port - m_place), pace::kTravel);
      if (!back && m_in_phase < 4) return Progress::working;
      return tail(op) ? fail("the tail was not cut") : Progress::done;
    }
    return m_in_phase > kLongest + 5 ? fail("the instrument did not reach the target") : Progress::working;
  }

  int m_hand;
  double m_at, m_share;
  Vec3d m_place, m_along{1, 0, 0};
  bool m_was = false;
};

std::string lacks_sling(const sim::Model& model, const SkillArgs& args) {
  return lacks_tool(model, args.hand(), &interactions::Abilities::sling);
}
std::string lacks_scissors(const sim::Model& model, const SkillArgs& args) {
  return lacks_tool(model, args.hand(), &interactions::Abilities::cut);
}

}  // namespace

const SkillKind kPutLoopOver{"put_loop_over",
                             "put the loop over",
                             {hand_parameter("the hand with the loop"),
                              {"of", ArgumentKind::strand, "a rod with a free end"},
                              number_parameter("at_mm", "place along it, from its beginning; default 10", 0, 1000),
                              number_parameter("thread_mm", "length of thread in the loop then; default all", 30, 300)},
                             25,
                             "Opens the loop above the free end of a rod and moves it down over it.",
                             lacks_sling,
                             &making<PutLoopOver>};
const SkillKind kCloseLoop{
    "close_loop",
    "close the loop",
    {hand_parameter("the hand with the loop"),
     {"of", ArgumentKind::strand, "the rod inside the loop"},
     number_parameter("at_mm", "place, from its beginning; default 10", 0, 1000),
     number_parameter("close_to", "closing of the handle; default 0.4", 0.1, 1),
     word_parameter("lead_back", "whether the knot is held against sliding; default no", {"yes", "no"})},
    25,
    "Closes the loop, with the knot at the target, until it closes the lumen.",
    lacks_sling,
    &making<CloseLoop>};
const SkillKind kLeaveLoop{"leave_loop",
                           "leave the loop",
                           {hand_parameter("the hand with the loop"),
                            number_parameter("back_mm", "distance that the tube draws back; default 30", 5, 100)},
                           15,
                           "Opens the handle and withdraws the tube, which leaves the thread behind.",
                           lacks_sling,
                           &making<LeaveLoop>};
const SkillKind kCutTail{
    "cut_tail",
    "cut the loop's tail",
    {hand_parameter("the hand with the scissors"),
     number_parameter("at_mm", "length of thread beyond the knot; default 10", 1, 100),
     number_parameter("inside_share", "distance from the hinge, as a share of the blades; default 0.7", 0, 1)},
    30,
    "Encloses the thread between the knot and the tube with open scissors, and closes them.",
    lacks_scissors,
    &making<CutTail>};

}  // namespace trocar::training
