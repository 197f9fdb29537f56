#include <fmt/format.h>

#include <trocar/sim/model/seen.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// An electrode from bond to bond of those that are drawn open most, each until it has parted; then back.
class PartBonds final : public Skill {
 public:
  PartBonds(const sim::Model& model, const Given& given)
      : m_hand(given.hand()),
        m_set(model.bonds_index(given("bonds").word)),
        m_left(given.number("left_share", 0)),
        m_raw(given.says("also", "raw")) {}

 private:
  enum Phase { kReach, kPress, kOff };

  struct Spot {
    Vec3d foot, node;
  };
  Spot spot(const Operator& op, const interactions::Bond& bond) const {
    const sim::Model& m = op.model();
    const sim::MembraneBody& wall = m.membranes[size_t(m.bonds[size_t(m_set)].membrane)];
    const Vec3d node = tissue::position(
        wall.sheet.network, op.state().membranes[size_t(m.bonds[size_t(m_set)].membrane)].network, bond.node);
    if (bond.hold.kind == interactions::BorderHold::strand)
      return {point_at(m.strand_bodies[size_t(bond.hold.index)], op.state().strands[size_t(bond.hold.index)],
                       bond.hold.place),
              node};
    return {tissue::skin_point(nodes_of(m, op.state(), bond.hold.index), m.skin(bond.hold.index), bond.hold.vertex),
            node};
  }
  /// Is there work for the electrode?
  bool wanted(const interactions::BondState& s) const { return s.holds() || (m_raw && s.raw()); }

  /// The one that is drawn open most; -1: there is none.
  int next(const Operator& op) const {
    const std::vector<interactions::Bond>& bonds = op.model().bonds[size_t(m_set)].bonds;
    int best = -1;
    double most = -1;
    for (size_t i = 0; i < bonds.size(); ++i) {
      if (!wanted(op.state().bonds[size_t(m_set)][i])) continue;
      const Spot at = spot(op, bonds[i]);
      const double open = length(at.node - at.foot - bonds[i].hold.offset);
      if (open > most) most = open, best = int(i);
    }
    return best;
  }
  bool enough(const Operator& op) const {
    const std::vector<interactions::BondState>& states = op.state().bonds[size_t(m_set)];
    if (m_raw)
      for (const interactions::BondState& s : states)
        if (s.raw()) return false;
    return interactions::holding_share(op.model().bonds[size_t(m_set)], states) <= m_left;
  }

  Progress work(Operator& op) override {
    constexpr double kFar = 5, kLongest = 2.5, kTouch = 0.4, kBack = 0.006, kDeeper = 0.0015;  // [s] [m]
    Arms::Arm& arm = op.arm(m_hand);
    if (m_phase != kOff && (enough(op) || (m_bond = m_phase == kPress ? m_bond : next(op)) < 0)) go(kOff);
    op.want(arm.tip);
    if (m_phase == kOff) {
      arm.coagulating = false;
      return op.arms().move_to_depth(m_hand, reach::kBroughtIn, pace::kTravel) ? Progress::done : Progress::working;
    }
    const Spot at = spot(op, op.model().bonds[size_t(m_set)].bonds[size_t(m_bond)]);
    const Vec3d along = normalised(at.foot - arm.port);
    op.want(at.foot);
    if (m_phase == kReach) {
      const bool there = op.arms().move(m_hand, at.foot + kDeeper * along, pace::kCareful);
      if (there || norm(op.tool_state(m_hand).contact_force) > 0.15 || m_in_phase > kFar) go(kPress);
    } else {
      const interactions::BondState& state = op.state().bonds[size_t(m_set)][size_t(m_bond)];
      arm.coagulating = m_in_phase > kTouch && wanted(state) && m_in_phase < kLongest;
      if (!arm.coagulating && m_in_phase > kTouch) {
        op.arms().move(m_hand, at.foot - kBack * along, pace::kCareful);
        if (m_in_phase > kLongest || !wanted(state)) go(kReach);
      }
    }
    return Progress::working;
  }

  int m_hand, m_set, m_bond = -1;
  double m_left;
  bool m_raw;
};

std::string lacks_bonds(const sim::Model& model, const Given& given) {
  if (model.bonds_index(given("bonds").word) < 0) return fmt::format("there are no bonds \"{}\"", given("bonds").word);
  if (!model.energy.there) return "there is no current";
  return lacks_tool(model, given.hand(), &interactions::Abilities::coagulate);
}

}  // namespace

const SkillKind kPartBonds{
    "part_bonds",
    "part what still holds",
    {hand_parameter("that has a hook"),
     {"bonds", ArgumentKind::word, "which, by their name"},
     number_parameter("left_share", "until no more of their area holds; 0", 0, 1),
     word_parameter("also", "whether raw surfaces are dried, too", {"raw"})},
    240,
    "Brings an electrode to the bond that is drawn open most, presses the blue pedal until it has "
    "parted, and goes on to the next; then draws back.",
    lacks_bonds,
    &making<PartBonds>};

}  // namespace trocar::training
