// What needles do and have done: facts of points in organs, of syringes, of what was injected and what it blanches.
#include <algorithm>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr double kPaleEnough = 0.5;  // blanched by so much counts

const sim::NeedleHand& needle_of_hand(const Snapshot& snapshot, const Arguments& a) {
  return snapshot.state.injection.hands[size_t(a[0].index)];
}

Value point_depth(const Snapshot& snapshot, const Arguments& a) {
  const sim::NeedleHand& n = needle_of_hand(snapshot, a);
  return n.in() ? Value(n.depth) : kUnknown;
}
Value point_in(const Snapshot& snapshot, const Arguments& a) {
  const sim::NeedleHand& n = needle_of_hand(snapshot, a);
  return n.in() && (!a[1].given || n.entry.body == a[1].body());
}
Value plunger_force(const Snapshot& snapshot, const Arguments& a) { return needle_of_hand(snapshot, a).plunger; }
Value syringe_left(const Snapshot& snapshot, const Arguments& a) {
  return fluids::kM3PerPicolitre * double(needle_of_hand(snapshot, a).left);
}
Value plunger_drawn(const Snapshot& snapshot, const Arguments& a) {
  const sim::NeedleHand& n = needle_of_hand(snapshot, a);
  return n.in() ? Value(n.drawn_for) : kUnknown;
}
Value blood_drawn(const Snapshot& snapshot, const Arguments& a) {
  return fluids::kM3PerPicolitre * double(needle_of_hand(snapshot, a).blood);
}

Value injected_into(const Snapshot& snapshot, const Arguments& a) {
  const BodyId body = a[0].body();
  if (!body.is(BodyKind::organ)) return 0.0;
  return fluids::kM3PerPicolitre * double(snapshot.state.injection.given[body.index()]);
}
Value injected_in_vessels(const Snapshot& snapshot, const Arguments&) {
  return fluids::kM3PerPicolitre * double(snapshot.state.injection.account.vessel);
}
Value spilled_by_needles(const Snapshot& snapshot, const Arguments&) {
  const sim::InjectionAccount& account = snapshot.state.injection.account;
  return fluids::kM3PerPicolitre * double(account.leaked + account.spilled);
}
Value units_injected(const Snapshot& snapshot, const Arguments&) {
  double most = 0;  // a scene's syringes hold the same drug
  for (const sim::HandModel& hand : snapshot.model.hands)
    for (const interactions::ToolModel& tool : hand.rack) most = std::max(most, tool.needle.units);
  return most * 1e6 * fluids::kM3PerPicolitre * double(snapshot.state.injection.account.drugged);
}

/// Twice a second: a sum over all of a skin.
class BlanchedSkin final : public Observer {
 public:
  BlanchedSkin(const sim::Model&, const Arguments& a) : m_body(a[0].body()) {}
  void sample(const Snapshot& snapshot, double) override {
    constexpr int kSkinTurns = 25;
    if (m_turn++ % kSkinTurns == 0) m_area = area(snapshot);
  }
  Value value(const Snapshot&) const override { return m_turn > 0 ? Value(m_area) : kUnknown; }

 private:
  double area(const Snapshot& snapshot) const {
    const size_t organ = m_body.index();
    if (!m_body.is(BodyKind::organ) || organ >= snapshot.model.solids.size()) return 0;
    if (snapshot.state.injection.account.drugged == 0) return 0;
    const tissue::Skin& skin = snapshot.model.solids[organ].skin;
    const tissue::NodeView nodes = sim::nodes_of(snapshot.model, snapshot.state, int(organ));
    double sum = 0;
    for (const std::array<int, 3>& t : skin.triangles) {
      double pale = 0;
      for (const int v : t) pale += sim::blanched_at(snapshot.state, organ, skin, v) / 3;
      if (pale < kPaleEnough) continue;
      const Vec3d a = tissue::skin_point(nodes, skin, t[0]);
      sum += 0.5 * length(cross(tissue::skin_point(nodes, skin, t[1]) - a, tissue::skin_point(nodes, skin, t[2]) - a));
    }
    return sum;
  }

  BodyId m_body;
  int m_turn = 0;
  double m_area = 0;
};

std::string takes_nothing_up(const sim::Model& model, const Arguments& a) {
  const BodyId body = a[0].body();
  const bool takes = body.is(BodyKind::organ) && body.index() < model.injection.organs.size() &&
                     model.injection.organs[body.index()].infusion.there();
  return takes ? "" : "expected an organ that absorbs an injection, got another body";
}

const Parameter kWhoseNeedle{"hand", ArgumentKind::hand, "whose needle"};
const Parameter kInfusedOrgan{"of", ArgumentKind::body, "which organ"};

}  // namespace

const Fact kNeedleDepth{
    "needle.depth_mm",
    {kWhoseNeedle},
    -30,
    60,
    "Depth of a needle's point below the nearest surface of the organ. Unknown while it is in no organ.",
    needs_syringe,
    &stateless<point_depth>};
const Fact kNeedleIn{"needle.in",
                     {kWhoseNeedle, {"of", ArgumentKind::body, "which organ; any", false}},
                     0,
                     1,
                     "The needle's point is in an organ.",
                     needs_syringe,
                     &stateless<point_in>,
                     true};
const Fact kNeedlePlunger{"needle.plunger_N",
                          {kWhoseNeedle},
                          -200,
                          200,
                          "Force on the plunger: positive when pressing, negative when drawing.",
                          needs_syringe,
                          &stateless<plunger_force>};
const Fact kNeedleLeft{"needle.left_mL", {kWhoseNeedle},          0, 100, "Volume left in the syringe.",
                       needs_syringe,    &stateless<syringe_left>};
const Fact kNeedleDrawn{"needle.drawn_s",
                        {kWhoseNeedle},
                        0,
                        3600,
                        "Time of aspiration at the needle's present point, within 3 mm. Unknown while it is "
                        "in no organ.",
                        needs_syringe,
                        &stateless<plunger_drawn>};
const Fact kNeedleBlood{
    "needle.blood_mL", {kWhoseNeedle},         0, 100, "Volume of blood drawn since the needle went in.",
    needs_syringe,     &stateless<blood_drawn>};
const Fact kInjectedVolume{"injected.volume_mL",
                           {kInfusedOrgan},
                           0,
                           1e3,
                           "Volume injected into an organ.",
                           needs_syringe,
                           &stateless<injected_into>,
                           false,
                           &takes_nothing_up};
const Fact kInjectedVessels{
    "injected.in_vessels_mL",       {}, 0, 1e3, "Volume injected straight into vessels.", needs_syringe,
    &stateless<injected_in_vessels>};
const Fact kInjectedSpilled{"injected.spilled_mL",
                            {},
                            0,
                            1e3,
                            "Volume lost into the cavity: spilled, or leaked back along needle tracks.",
                            needs_syringe,
                            &stateless<spilled_by_needles>};
const Fact kInjectedUnits{
    "injected.drug_IU",        {}, 0, 1e5, "Dose that has left the needles, wherever it went.", needs_syringe,
    &stateless<units_injected>};
const Fact kInjectedBlanched{"injected.blanched_mm2",
                             {kInfusedOrgan},
                             0,
                             1e6,
                             "The area of an organ's surface that has blanched by at least half.",
                             needs_syringe,
                             &remembering<BlanchedSkin>,
                             false,
                             &takes_nothing_up};

}  // namespace trocar::training
