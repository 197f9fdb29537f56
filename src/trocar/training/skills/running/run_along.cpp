#include <algorithm>
#include <optional>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>
#include <trocar/training/observe/stations.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A gut hand over hand: one hand holds and shows, the other takes the next place, lifts that, and only then the first
/// lets go. Between two steps the camera looks at either face of what lies between the hands. Loops lie against each
/// other: it goes in where nothing but the loop that is meant will be between the jaws, looks once more before it
/// closes them, and opens them again before it lifts anything else.
class RunAlong final : public Skill {
 public:
  RunAlong(const sim::Model& model, const SkillArgs& args)
      : m_side{args("stations").marks, args("others").marks},
        m_stations(model, m_side[0], args.number("spacing_mm", 0.01)),
        m_spacing(args.number("spacing_mm", 0.01)),
        m_hands{args.hand(), args("other_hand").index},
        m_first(args.number("from_mm", 0.02)),
        m_to(args.number("to_mm", 0.3)),
        m_step(args.number("step_mm", 0.06)),
        m_lift(args.number("lift_mm", 0.035)),
        m_most(args.number("pull_N", 2)),
        m_look(args.number("look_s", 0.3)),
        m_deep(args.number("deep_mm", 0.008)) {
    for (auto& looked : m_looked) looked.assign(m_side[0].size(), 0.0);
  }

 private:
  enum Phase { kReach, kEnter, kClose, kLift, kShow, kLetGo };

  /// A cross-section of the gut at a station, as it lies.
  struct Place {
    Vec3d middle, out, along;  ///< [m]; unit, away from its mesentery; unit, onwards
    double radius = 0;         ///< [m]
  };
  Vec3d side(const Surgeon& op, size_t which, int station) const {
    return place_of_mark(op.model(), op.state(), m_side[which][size_t(station)]);
  }
  Place place(const Surgeon& op, double s) const {
    const int last = int(m_side[0].size()) - 1;
    const int k = std::clamp(int(s / m_spacing + 0.5) - 1, 0, last);
    const Vec3d a = side(op, 0, k), b = side(op, 1, k);
    const int before = std::max(0, k - 1), after = std::min(last, k + 1);
    const Vec3d on = side(op, 0, after) + side(op, 1, after) - side(op, 0, before) - side(op, 1, before);
    constexpr double kSine = 0.866, kCosine = 0.5;  // the marks lie 60 degrees to either side
    Place p;
    p.along = normalised(on);
    p.radius = 0.5 * length(a - b) / kSine;
    const auto na = normal_of_mark(op.model(), op.state(), m_side[0][size_t(k)]);
    const auto nb = normal_of_mark(op.model(), op.state(), m_side[1][size_t(k)]);
    p.out = normalised(na.value_or(Vec3d{0, 0, 1}) + nb.value_or(Vec3d{0, 0, 1}), {0, 0, 1});
    p.middle = 0.5 * (a + b) - kCosine * p.radius * p.out;
    return p;
  }

  /// It continues from what is held: a run that was interrupted is taken up again.
  void start(Surgeon& op, int tries) override {
    m_offset = tries;
    const double held0 = m_stations.held_at(op.model(), op.state(), size_t(m_hands[0]));
    const double held1 = m_stations.held_at(op.model(), op.state(), size_t(m_hands[1]));
    if (held0 >= 0 || held1 >= 0) {
      m_taker = held0 > held1 ? 1 : 0;
      m_at = std::max(held0, held1);
      m_next = std::min(m_at + m_step, m_to);
    } else {
      m_taker = 0;
      m_next = m_at > 0 ? m_at : m_first;
    }
    m_attempt = 0;
    m_way_in = -1;
  }

  Progress work(Surgeon& op) override {
    note_looks(op);
    const int hand = m_hands[size_t(m_taker)], holder = m_hands[size_t(1 - m_taker)];
    if (m_phase != kLetGo) give_way(op, holder);
    if (m_phase == kShow || m_phase == kLetGo) give_way(op, hand);
    switch (m_phase) {
      case kReach:
        return reach(op, hand);
      case kEnter:
        return enter(op, hand);
      case kClose:
        return close(op, hand);
      case kLift:
        return lift(op, hand);
      case kShow:
        return show(op, hand, holder);
      default:
        return let_go(op, holder);
    }
  }

  static constexpr double kTooHard = 1.25;  // of what it may pull

  /// A hand that pulls too hard follows what it holds, at once where that is near to what tears it.
  void give_way(Surgeon& op, int hand) const {
    constexpr double kAhead = 0.01, kMuchTooHard = 1.6;  // [m], of what it may pull
    const interactions::ToolState& tool = op.tool_state(hand);
    const double pull = norm(tool.pull);
    if (tool.holds == 0 || pull < kTooHard * m_most) return;
    const Vec3d drawn = normalised(Vec3d{tool.pull[0], tool.pull[1], tool.pull[2]});
    op.arms().move(hand, op.arm(hand).tip + kAhead * drawn,
                   pull < kMuchTooHard * m_most ? pace::kCareful : pace::kTravel);
  }
  /// From a tip of this hand's to the other instrument [m].
  double way_from_other(const Surgeon& op, int hand, Vec3d tip) const {
    const Arms::Arm& other = op.arm(m_hands[0] == hand ? m_hands[1] : m_hands[0]);
    const Vec3d shaft = other.tip - other.port;
    const double along = std::clamp(dot(tip - other.port, shaft) / dot(shaft, shaft), 0.0, 1.0);
    return length(tip - other.port - along * shaft);
  }
  /// Slower beside the other instrument: they shall not strike each other.
  double pace_beside(const Surgeon& op, int hand) const {
    constexpr double kBeside = 0.030, kGently = 0.012;  // [m] [m/s]
    return way_from_other(op, hand, op.arm(hand).tip) < kBeside ? kGently : pace::kTravel;
  }
  /// An instrument in the body is looked for before it moves.
  bool blind(const Surgeon& op, int hand) const {
    constexpr double kUnseen = 3;  // [s] to wait for the camera
    return op.tool_state(hand).depth > reach::kIdle && !op.sees_tip(hand) && m_in_phase < kUnseen;
  }

  /// A way in: beside the place that is wanted, and from which side of the gut.
  struct Way {
    double beside;  ///< [m]
    double side;    ///< 1: between the side that faces the trocar and the border in front; 0: at the border
  };
  static constexpr Way kWays[] = {{0, 1},      {0, 0},      {0.006, 1},  {-0.006, 1}, {0.006, 0},
                                  {-0.006, 0}, {0.012, 1},  {0.012, 0},  {-0.012, 1}, {-0.012, 0},
                                  {0, -0.7},   {0.006, -1}, {-0.006, -1}};

  /// Where the jaws come down on the gut: on that side of it, and away from its mesentery.
  Vec3d entrance(const Surgeon& op, int hand, const Place& p, double side) const {
    const Vec3d back = normalised(op.arm(hand).port - p.middle);
    const Vec3d across = back - dot(back, p.along) * p.along;
    return p.middle + p.radius * normalised(side * across + p.out, p.out);
  }
  Vec3d inwards(const Surgeon& op, int hand, const Place& p) const { return normalised(p.middle - op.arm(hand).port); }
  double deep() const {
    constexpr double kDeeper = 0.002;  // [m]
    return m_deep + kDeeper * std::min(m_attempt, 3);
  }
  Place wanted(const Surgeon& op) const { return place(op, m_next + kWays[size_t(std::max(m_way_in, 0))].beside); }
  double side_in() const { return kWays[size_t(std::max(m_way_in, 0))].side; }

  /// What is between jaws that are open so far: vertices of the gut's skin of the loop that is meant; those of others,
  /// and strands.
  struct Between {
    int own = 0, others = 0;
  };
  Between between(const Surgeon& op, const interactions::ToolModel& tool, const interactions::ToolShape& shape) const {
    constexpr double kOwn = 0.035, kBeside = 0.0015;  // [m]
    const int gut = int(m_stations.body().index());
    const tissue::Skin& skin = op.model().skin(gut);
    const tissue::NodeView nodes = nodes_of(op.model(), op.state(), gut);
    Between found;
    for (int v = 0; v < skin.size(); ++v) {
      if (!skin.at_surface(v)) continue;
      const Vec3d local = interactions::to_jaw(shape, tissue::skin_point(nodes, skin, v));
      if (std::abs(local.y) > 0.5 * tool.jaw_width + kBeside || local.z < 0.25 * tool.jaw_length ||
          local.z > tool.jaw_length || std::abs(local.x) > shape.half_opening(local.z) + kBeside)
        continue;
      ++(std::abs(m_stations.of_vertex(size_t(v)) - m_next) < kOwn ? found.own : found.others);
    }
    found.others += strands_between(op, tool, shape);
    return found;
  }
  /// Of bands and their stumps: jaws close on what stands up between them before they close on the wall.
  static int strands_between(const Surgeon& op, const interactions::ToolModel& tool,
                             const interactions::ToolShape& shape) {
    int elements = 0;
    for (size_t s = 0; s < op.model().strand_bodies.size(); ++s) {
      const interactions::StrandBody& body = op.model().strand_bodies[s];
      const tissue::StrandState& state = op.state().strands[s];
      for (int e = 0; e + 1 < body.nodes(); ++e)
        elements += state.alive[size_t(e)] && interactions::between_jaws(tool, shape, body, state, e).inside;
    }
    return elements;
  }
  /// How good a way in is: something of the own loop where the jaws will close, nothing of others between them as they
  /// come, and not beside the other instrument.
  double worth(const Surgeon& op, int hand, const Way& way) const {
    constexpr double kClosing = 0.12, kComing = 0.5, kApart = 0.012;  // apertures; [m]
    constexpr int kEnough = 4;
    const Place p = place(op, m_next + way.beside);
    const interactions::ToolModel& tool = op.tool(hand);
    const Vec3d port = op.arm(hand).port, tip = entrance(op, hand, p, way.side) + deep() * inwards(op, hand, p);
    const double roll = kinematics::roll_towards(kinematics::inverse(port, tip, 0), p.along);
    const kinematics::FulcrumPose pose = kinematics::inverse(port, tip, roll);
    const Between closing = between(op, tool, interactions::shape_of(tool, pose, kClosing));
    const Between coming = between(op, tool, interactions::shape_of(tool, pose, kComing));
    const double beside = way_from_other(op, hand, tip);
    return std::min(closing.own, kEnough) - 2.0 * closing.others - coming.others - (beside < kApart ? 3 : 0) -
           std::abs(way.beside) / 0.012;
  }
  /// The best way in that was not tried yet at this place.
  void choose_perturbation(const Surgeon& op, int hand) {
    constexpr int kCount = int(std::size(kWays));
    if (m_attempt == 0) m_tried.fill(false);
    double best = -1e9;
    int chosen = -1;
    for (int i = 0; i < kCount; ++i) {
      const int k = (i + m_offset) % kCount;
      if (m_tried[size_t(k)]) continue;
      const double value = worth(op, hand, kWays[k]);
      if (value > best) best = value, chosen = k;
    }
    if (chosen < 0) m_tried.fill(false);
    m_way_in = std::max(chosen, 0);
    m_tried[size_t(m_way_in)] = true;
  }
  Progress try_elsewhere() {
    constexpr int kMost = 9;
    if (++m_attempt >= kMost) return fail("the jaws did not grasp the bowel");
    m_way_in = -1;
    go(kReach);
    return Progress::working;
  }

  Progress reach(Surgeon& op, int hand) {
    constexpr double kLongest = 12;
    op.want(op.arm(hand).tip);
    op.from(0.06);
    if (blind(op, hand)) return Progress::working;
    if (op.tool_state(hand).holds > 0) {  // of another loop
      op.arms().grip(hand, 0, 0.8);
      return Progress::working;
    }
    if (m_way_in < 0) choose_perturbation(op, hand);
    const Place p = wanted(op);
    const Vec3d at = entrance(op, hand, p, side_in()), in = inwards(op, hand, p);
    op.want(at);
    const bool open = op.arms().grip(hand, 0, 0.8);
    const bool turned = op.arms().turn_across(hand, p.along);
    const bool there = op.arms().move(hand, at - reach::kBefore * in, pace_beside(op, hand));
    if ((open && turned && there) || m_in_phase > kLongest) go(kEnter);
    return Progress::working;
  }
  Progress enter(Surgeon& op, int hand) {
    constexpr double kPressed = 0.9, kLongest = 4;  // [N] [s]
    const Place p = wanted(op);
    const Vec3d in = inwards(op, hand, p);
    op.want(op.arm(hand).tip);
    op.want(p.middle);
    op.from(0.06);
    op.arms().turn_across(hand, p.along);
    const bool there = op.arms().move(hand, entrance(op, hand, p, side_in()) + deep() * in, pace::kCareful);
    if (!there && norm(op.tool_state(hand).contact_force) < kPressed && m_in_phase < kLongest) return Progress::working;
    if (takes_another(op, hand)) return try_elsewhere();
    go(kClose);
    return Progress::working;
  }
  /// Would jaws that close here take more of other loops than of the one that is meant?
  bool takes_another(const Surgeon& op, int hand) const {
    constexpr double kClosing = 0.2;  // aperture
    const interactions::ToolModel& tool = op.tool(hand);
    const Between found = between(op, tool, interactions::shape_of(tool, op.tool_state(hand).pose(), kClosing));
    return found.others > found.own;
  }
  Progress close(Surgeon& op, int hand) {
    constexpr double kFeels = 0.9;
    op.want(op.arm(hand).tip);
    op.from(0.06);
    if (!op.arms().grip(hand, 0.95, 0.6) || m_in_phase < kFeels) return Progress::working;
    const std::optional<Stations::Span> held = m_stations.held_span(op.model(), op.state(), size_t(hand));
    constexpr double kBeside = 0.035;   // [m] what is further from where it was wanted is of another loop
    constexpr double kOnwards = 0.015;  // [m] further along than the last hold, though not as far as meant: it will do
    constexpr int kAtLast = 2;
    double least = m_next - kBeside;
    if (m_attempt >= kAtLast && m_at > 0) least = std::min(least, m_at + kOnwards);
    if (!held || held->from < least || held->to > m_next + kBeside || held->to - held->from > kBeside)
      return try_elsewhere();
    m_from = op.arm(hand).tip;
    m_way = 0;
    m_between = std::max(0.0, 0.5 * (held->from + held->to) - m_at);
    go(kLift);
    return Progress::working;
  }
  /// How far a hold is lifted: one beside the other hand's no further than there is gut between them, which they would
  /// tear apart.
  double rise_beside(const Surgeon& op, int hand) const {
    constexpr double kOfGut = 0.5;
    const int other = m_hands[0] == hand ? m_hands[1] : m_hands[0];
    if (op.tool_state(other).holds == 0 || m_between > m_lift) return m_lift;
    return kOfGut * m_between;
  }
  Progress lift(Surgeon& op, int hand) {
    constexpr double kSpeed = 0.025, kLongest = 4;  // [m/s] [s]
    op.want(op.arm(hand).tip);
    op.from(0.06);
    if (op.tool_state(hand).holds == 0) return again();
    const double pull = norm(op.tool_state(hand).pull);
    const double rise = rise_beside(op, hand);
    if (pull < m_most) m_way = std::min(m_way + kSpeed * sim::kTick, rise);
    if (pull > kTooHard * m_most) m_way = std::max(m_way - kSpeed * sim::kTick, 0.0);
    const bool there = op.arms().move(hand, m_from + m_way * Vec3d{0, 0, 1}, pace::kTravel);
    if ((there && m_way >= rise) || m_in_phase > kLongest) {
      m_shown = -1;
      go(kShow);
    }
    return Progress::working;
  }
  Progress again() {
    m_way_in = -1;
    go(kReach);
    return Progress::working;
  }

  void note_looks(const Surgeon& op) {
    for (size_t which = 0; which < 2; ++which)
      for (size_t i = 0; i < m_side[which].size(); ++i) {
        double& looked = m_looked[which][i];
        if (looked >= m_look) continue;
        looked = sim::visible(op.model(), op.state(), m_side[which][i]) ? looked + sim::kTick : 0;
      }
  }
  /// The next mark up to what is held that has not been looked at, after the one that was tried last; -1: none.
  int unseen(double from, double to) const {
    const int count = int(m_side[0].size());
    for (int i = m_shown + 1; i < 2 * count; ++i) {
      const double s = (i % count + 1) * m_spacing;
      if (s >= from && s <= to && m_looked[size_t(i / count)][size_t(i % count)] < m_look) return i;
    }
    return -1;
  }
  Progress show(Surgeon& op, int hand, int holder) {
    constexpr double kLongest = 2.2, kBack = 0.04;  // [s] at a mark; [m] what lies before is looked at again
    const double held = m_stations.held_at(op.model(), op.state(), size_t(hand));
    if (held < 0) return again();
    const double from = std::max(0.0, m_at - kBack), to = held + 0.5 * m_spacing;
    if (m_in_phase > kLongest && m_target >= 0) {
      m_shown = m_target;
      m_target = -1;
      m_in_phase = 0;
    }
    const int count = int(m_side[0].size());
    if (m_target < 0 || m_looked[size_t(m_target / count)][size_t(m_target % count)] >= m_look) {
      m_target = unseen(from, to);
      m_in_phase = 0;
    }
    if (m_target >= 0) {
      const int mark = m_side[size_t(m_target / count)][size_t(m_target % count)];
      op.camera().view(place_of_mark(op.model(), op.state(), mark), normal_of_mark(op.model(), op.state(), mark), 0.07);
      return Progress::working;
    }
    m_at = held;
    if (m_at >= m_to - 0.5 * m_spacing) return Progress::done;
    if (op.tool_state(holder).holds == 0) {
      swap();
      return Progress::working;
    }
    go(kLetGo);
    return Progress::working;
  }
  Progress let_go(Surgeon& op, int holder) {
    constexpr double kAway = 0.025, kLongest = 6;
    op.want(op.arm(holder).tip);
    op.from(0.06);
    if (op.tool_state(holder).holds > 0 && blind(op, holder)) return Progress::working;
    const Vec3d out = normalised(op.arm(holder).port - op.arm(holder).tip);
    if (op.tool_state(holder).holds > 0) m_from = op.arm(holder).tip;
    const bool open = op.arms().grip(holder, 0, 0.4);
    const bool off = open && op.arms().move(holder, m_from + kAway * out, pace_beside(op, holder));
    if (off || m_in_phase > kLongest) swap();
    return Progress::working;
  }
  void swap() {
    m_taker = 1 - m_taker;
    m_next = std::min(m_at + m_step, m_to);
    m_attempt = 0;
    m_way_in = -1;
    go(kReach);
  }

  std::array<std::vector<std::int32_t>, 2> m_side;
  Stations m_stations;
  double m_spacing;
  std::array<int, 2> m_hands;
  double m_first, m_to, m_step, m_lift, m_most, m_look, m_deep;  ///< [m] [m] [m] [m] [N] [s] [m]
  std::array<std::vector<double>, 2> m_looked;                   ///< (stations) [s]
  size_t m_taker = 0;
  int m_attempt = 0, m_offset = 0, m_shown = -1, m_target = -1;
  int m_way_in = -1;                             ///< of kWays; -1: to be chosen
  std::array<bool, std::size(kWays)> m_tried{};  ///< at this place
  double m_at = -1, m_next = 0, m_way = 0;       ///< [m] how far it has been run; the next hold; of a lift
  double m_between = 0;                          ///< [m] of gut, from the last hold to this one
  Vec3d m_from;
};

std::string lacks_run(const sim::Model& model, const SkillArgs& args) {
  const Argument &a = args("stations"), &b = args("others");
  if (const std::string why = no_stations(model, a.marks); !why.empty()) return why;
  if (const std::string why = no_stations(model, b.marks); !why.empty()) return why;
  if (a.marks.size() != b.marks.size()) return "as many stations on one side as on the other";
  const std::string first = lacks_tool(model, args.hand(), &interactions::Abilities::grip);
  return first.empty() ? lacks_tool(model, args("other_hand").index, &interactions::Abilities::grip) : first;
}

}  // namespace

const SkillKind kRunAlong{
    "run_along",
    "run the gut",
    {hand_parameter("the hand that grasps first"),
     {"other_hand", ArgumentKind::hand, "the hand that grasps next"},
     {"stations", ArgumentKind::marks, "marks on its wall, in order, 60 degrees to one side"},
     {"others", ArgumentKind::marks, "the same on the other side"},
     number_parameter("spacing_mm", "distance of the stations; default 10", 1, 100),
     number_parameter("from_mm", "first place to grasp; default 20", 0, 5000),
     number_parameter("to_mm", "last place; default 300", 0, 100'000),
     number_parameter("step_mm", "distance from grasp to grasp; default 60", 10, 100),
     number_parameter("lift_mm", "height of each lift; default 35", 0, 100),
     number_parameter("pull_N", "lifts no further while the pull is above this; default 2", 0.1, 10),
     number_parameter("look_s", "time to look at each face of a station; default 0.3", 0, 10),
     number_parameter("deep_mm", "distance that the open jaws move beyond the wall; default 8", 0, 30)},
    900,
    "Runs a gut hand over hand: one hand holds while the other grasps the next place and lifts it; then the camera "
    "looks at both faces between them, and the first hand releases. Continues where it was interrupted.",
    lacks_run,
    &making<RunAlong>};

}  // namespace trocar::training
