#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Out of a skin around a vertex, as long as it likes.
Vec3d out_of_skin(const tissue::NodeView& nodes, const tissue::Skin& skin, int vertex) {
  Vec3d sum;
  for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k) {
    const std::array<int, 3>& t = skin.triangles[size_t(skin.face[size_t(k)])];
    const Vec3d a = tissue::skin_point(nodes, skin, t[0]);
    sum += cross(tissue::skin_point(nodes, skin, t[1]) - a, tissue::skin_point(nodes, skin, t[2]) - a);
  }
  return sum;
}

/// An electrode from bond to bond of those that are drawn open most, each until it has parted; then back. A hook's foot
/// lies along what the bonds are rooted in: it neither digs into that nor catches what is drawn off it.
class PartBonds final : public Skill {
 public:
  PartBonds(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_set(model.bonds_index(args("bonds").word)),
        m_left(args.number("left_share", 0)),
        m_raw(args.equals("also", "raw")) {}

 private:
  enum Phase { kAbove, kReach, kPress, kAway, kOff };

  struct Spot {
    Vec3d foot, node;
    Vec3d up;  ///< off what it is rooted in
  };
  Spot spot(const Surgeon& op, const interactions::Bond& bond) const {
    const interactions::Bodies bodies = bodies_of(op.model(), op.state());
    const Vec3d foot = root_of(bodies, bond), node = place_of(bodies, bond.near);
    if (bond.vertex < 0) return {foot, node, node - foot};
    const size_t organ = bond.far.body.index();
    return {foot, node, out_of_skin(organ_nodes(bodies, organ), op.model().skin(int(organ)), bond.vertex)};
  }
  /// Is there work for the electrode?
  bool wanted(const interactions::BondState& s) const { return s.holds() || (m_raw && s.raw()); }

  /// The one that is drawn open most, of those that have not been tried since all were; -1: there is none.
  int next(const Surgeon& op) {
    const std::vector<interactions::Bond>& bonds = op.model().bonds[size_t(m_set)].bonds;
    int best = -1;
    double most = -1;
    for (size_t i = 0; i < bonds.size(); ++i) {
      if (m_tried[i] || !wanted(op.state().bonds[size_t(m_set)][i])) continue;
      const double open = length(opening_of(bodies_of(op.model(), op.state()), bonds[i]));
      if (open > most) most = open, best = int(i);
    }
    if (best < 0)
      std::fill(m_tried.begin(), m_tried.end(), std::uint8_t(0));
    else
      m_tried[size_t(best)] = 1;
    return best;
  }
  bool enough(const Surgeon& op) const {
    const std::vector<interactions::BondState>& states = op.state().bonds[size_t(m_set)];
    if (m_raw)
      for (const interactions::BondState& s : states)
        if (s.raw()) return false;
    return interactions::holding_share(op.model().bonds[size_t(m_set)], states) <= m_left;
  }

  void start(Surgeon& op, int) override {
    m_tried.assign(op.model().bonds[size_t(m_set)].bonds.size(), 0);
    m_bond = -1;
  }
  Progress work(Surgeon& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    op.want(arm.tip);
    if (m_bond < 0 && m_phase != kOff && (enough(op) || (m_bond = next(op)) < 0)) {
      if (enough(op)) go(kOff);
      return Progress::working;
    }
    if (m_phase == kOff)
      return op.arms().move_to_depth(m_hand, reach::kBroughtIn, pace::kTravel) ? Progress::done : Progress::working;
    work_at(op, arm, spot(op, op.model().bonds[size_t(m_set)].bonds[size_t(m_bond)]));
    return Progress::working;
  }
  /// Where the tip has to be for what is bare of it to lie on a place: half of the foot reaches beyond it.
  Vec3d tip_for(Surgeon& op, const Arms::Arm& arm, Vec3d place) const {
    const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, place, arm.roll);
    return place - 0.5 * op.tool(m_hand).foot * kinematics::forward(arm.port, pose).opening();
  }
  void work_at(Surgeon& op, Arms::Arm& arm, const Spot& at) {
    constexpr double kTouches = 0.25;                    // [N] tissue that is pushed gives way
    constexpr double kBefore = 0.010, kDeeper = 0.0015;  // [m]
    constexpr double kFar = 4, kTouch = 0.15, kLongest = 1.2, kEvery = 0.4, kOffIt = 0.1;  // [s]
    const interactions::BondState& state = op.state().bonds[size_t(m_set)][size_t(m_bond)];
    const Vec3d along = normalised(at.foot - arm.port), goal = tip_for(op, arm, at.foot);
    const bool turned = !(op.tool(m_hand).foot > 0) || op.arms().turn_across(m_hand, at.up);
    op.want(at.foot);
    switch (m_phase) {
      case kAbove:
        if ((op.arms().move(m_hand, goal - kBefore * along, pace::kCareful) && turned) || m_in_phase > kFar) go(kReach);
        break;
      case kReach:
        if (op.arms().move(m_hand, goal + kDeeper * along, pace::kCareful) || m_in_phase > kFar ||
            norm(op.tool_state(m_hand).contact_force) > kTouches)
          go(kPress);
        break;
      case kPress:
        m_steady = norm(op.tool_state(m_hand).contact_force) > 0 ? 0 : m_steady + sim::kTick;  // off the tissue
        arm.coagulating = m_in_phase > kTouch && m_in_phase < kLongest && m_steady < kOffIt && wanted(state);
        if (m_in_phase > kLongest || (m_in_phase > kEvery && !wanted(state))) go(kAway);
        break;
      default:
        if (!op.arms().move(m_hand, goal - kBefore * along, pace::kCareful) && m_in_phase < kFar) break;
        m_bond = -1;
        go(kAbove);
    }
  }

  int m_hand, m_set, m_bond = -1;
  double m_left;
  bool m_raw;
  std::vector<std::uint8_t> m_tried;  ///< (bonds)
};

std::string lacks_bonds(const sim::Model& model, const SkillArgs& args) {
  if (model.bonds_index(args("bonds").word) < 0) return tr("there are no bonds \"{}\"", args("bonds").word);
  if (!model.energy.there) return "the scene has no current";
  return lacks_tool(model, args.hand(), &interactions::Abilities::coagulate);
}

}  // namespace

const SkillKind kPartBonds{
    "part_bonds",
    "divide the remaining bonds",
    {hand_parameter("the hand with a hook"),
     {"bonds", ArgumentKind::word, "name of the bonds"},
     number_parameter("left_share", "ends when at most this share of their area holds; default 0", 0, 1),
     word_parameter("also", "whether raw surfaces are coagulated as well", {"raw"})},
    240,
    "Brings an electrode to the most open bond, presses the blue pedal until it parts, and moves to the next; then "
    "withdraws.",
    lacks_bonds,
    &making<PartBonds>};

}  // namespace trocar::training
