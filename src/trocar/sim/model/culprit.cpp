#include <algorithm>
#include <array>

#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/interactions/verbs/held.hpp>
#include <trocar/sim/model/attached.hpp>
#include <trocar/sim/model/culprit.hpp>

namespace trocar::sim {
namespace {

using interactions::Owner;
using interactions::Suture;

constexpr double kReach = 0.020;      // [m] a load so far from the torn place counts half.              Our estimate
constexpr double kBeside = 0.025;     // [m] from it, a load on another body may pass on to it.          Our estimate
constexpr double kLeastForce = 0.1;   // [N] below it an instrument only lies there.                     Our estimate
constexpr double kLeastShare = 0.25;  // of what a thread without a hand does there: less of a hand is none.  Our choice
constexpr double kFilled = 1e-4;      // [m^2] of tissue that the pressure of an injection parts.        Our estimate

Vec3d vector_of(const double (&f)[3]) noexcept { return {f[0], f[1], f[2]}; }
Vec3d vector_of(const float (&f)[3]) noexcept { return {double(f[0]), double(f[1]), double(f[2])}; }

/// What each hand does to a place. Pulls of one hand's jaws add up as vectors; presses do not: jaws that spread tissue
/// press it to both sides.
class LoadSums {
 public:
  explicit LoadSums(const TornPlace& place) noexcept : m_at(place.at) {}

  void pull(std::int32_t hand, Vec3d at, Vec3d force) noexcept {
    if (!is_hand(hand)) return;
    m_pull[std::size_t(hand)] += force;
    m_near_pull[std::size_t(hand)] += weight(at) * force;
  }
  void press(std::int32_t hand, Vec3d at, double force) noexcept {
    if (!is_hand(hand)) return;
    m_press[std::size_t(hand)] += force;
    m_near_press[std::size_t(hand)] += weight(at) * force;
  }
  /// @param hand  -1: a thread that no hand pulls
  void pull_by_thread(std::int32_t hand, Vec3d at, double force) noexcept {
    if (is_hand(hand)) return press(hand, at, force);
    m_nobody += weight(at) * force;
  }

  double nobody() const noexcept { return m_nobody; }
  double near(std::size_t hand) const noexcept { return length(m_near_pull[hand]) + m_near_press[hand]; }
  /// -1: none does more than lie there.
  int most() const noexcept {
    int best = -1;
    for (std::size_t h = 0; h < kMaxTools; ++h) {
      if (length(m_pull[h]) + m_press[h] < kLeastForce) continue;
      if (best < 0 || near(h) > near(std::size_t(best))) best = int(h);
    }
    return best;
  }

 private:
  static bool is_hand(std::int32_t hand) noexcept { return hand >= 0 && hand < kMaxTools; }
  /// Beside its sum, what a load does to a body dies away with the distance from it [Saint-Venant's principle].
  double weight(Vec3d at) const noexcept {
    const Vec3d off = at - m_at;
    return 1 / (1 + dot(off, off) / (kReach * kReach));
  }

  Vec3d m_at;
  std::array<Vec3d, kMaxTools> m_pull{}, m_near_pull{};     ///< [N]
  std::array<double, kMaxTools> m_press{}, m_near_press{};  ///< [N]
  double m_nobody = 0;                                      ///< [N]
};

void add(const interactions::Tag& tag, Vec3d at, Vec3d force, LoadSums& sums) noexcept {
  if (tag.owner == Owner::tool_hold) sums.pull(tag.index, at, force);
  if (tag.owner == Owner::tool_contact) sums.press(tag.index, at, length(force));
}

void add_network(const StepContext& c, BodyId body, LoadSums& sums) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  const interactions::NetworkLoads& loads = interactions::loads_on(bodies, body);
  const tissue::NodeView nodes = interactions::nodes_of(bodies, body);
  for (std::size_t i = 0; i < loads.sorted.size() && i < loads.reaction.size(); ++i)
    add(loads.owner[i], nodes.position(loads.sorted[i].node), vec_cast<double>(loads.reaction[i]), sums);
}

Vec3d on_strand(const StepContext& c, std::size_t strand, int element, double w) noexcept {
  const std::vector<Vec3d>& x = c.state.strands[strand].x;
  return (1 - w) * x[std::size_t(element)] + w * x[std::size_t(element) + 1];
}

void add_strand(const StepContext& c, std::size_t strand, LoadSums& sums) noexcept {
  const interactions::StrandLoads& loads = c.work.strands[strand].loads;
  for (std::size_t i = 0; i < loads.list.size() && i < loads.reaction.size(); ++i)
    add(loads.tag[i], on_strand(c, strand, loads.list[i].element, loads.list[i].w), loads.reaction[i], sums);
}

/// What threads do to the body, at their holes and where loops lie around it.
void add_threads(const StepContext& c, BodyId body, LoadSums& sums) noexcept {
  const Suture::States& states = interactions::part_of<Suture>(c.state);
  const interactions::Bodies bodies = bodies_of(c);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const interactions::SutureState& s = states[i];
    const int puller = puller_of(c, BodyId(BodyKind::suture, i));
    for (int k = 0; k < s.hole_count; ++k) {
      const interactions::SutureHole& h = s.holes[std::size_t(k)];
      if (h.at.body != body) continue;
      sums.pull_by_thread(puller, place_of(bodies, h.at), length(interactions::vector_of(h.force)));
    }
    for (int k = 0; k < s.sling.around_count; ++k) {
      const interactions::SlingAround& a = s.sling.around[std::size_t(k)];
      if (a.at.body == body) sums.pull_by_thread(puller, place_of(bodies, a.at), length(a.pull));
    }
  }
}

/// What needles have injected into the body presses it apart, after the plunger has stopped, too.
void add_injections(const StepContext& c, BodyId body, LoadSums& sums) noexcept {
  const std::vector<NeedleHand>& hands = c.state.injection.hands;
  for (std::size_t t = 0; t < hands.size(); ++t) {
    const NeedleHand& n = hands[t];
    if (n.entry.body == body && n.here > 0) sums.press(int(t), n.at, kLeastForce + kFilled * n.tip_pressure);
  }
}

/// Loads on the torn body itself.
LoadSums on_torn_body(const StepContext& c, const TornPlace& place) noexcept {
  LoadSums sums(place);
  if (place.body.is(BodyKind::strand)) add_strand(c, place.body.index(), sums);
  if (place.body.is(BodyKind::organ) || place.body.is(BodyKind::membrane)) add_network(c, place.body, sums);
  add_threads(c, place.body, sums);
  add_injections(c, place.body, sums);
  if (place.thread.exists()) sums.pull_by_thread(puller_of(c, place.thread), place.at, place.pull);
  return sums;
}

/// Does a load on another body there pass on to the torn place?
bool passes_on(const StepContext& c, const TornPlace& place, BodyId body, Vec3d at) noexcept {
  if (!body.exists() || body == place.body || body == place.thread) return false;
  return length(at - place.at) < kBeside || is_attached(c.model, body, place.body) ||
         is_attached(c.model, place.body, body);
}

/// Loads of hands on what is attached to the torn body, or lies beside the torn place.
LoadSums beside_torn_body(const StepContext& c, const TornPlace& place) noexcept {
  LoadSums sums(place);
  const interactions::Bodies bodies = bodies_of(c);
  for (std::size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolState& tool = c.state.tools[t];
    for (int i = 0; i < tool.holds; ++i) {
      const Vec3d at = interactions::held_point(bodies, tool.hold[i].at);
      if (passes_on(c, place, tool.hold[i].at.body, at)) sums.pull(int(t), at, vector_of(tool.hold[i].force));
    }
    const interactions::TouchBook& touches = c.state.touches[t];
    for (int i = 0; i < touches.count; ++i) {
      const interactions::Touch& touch = touches.touch[i];
      if (!touch.anchored) continue;
      const Vec3d at = interactions::place_of(c.work.shapes[t], touch);
      if (passes_on(c, place, touch.body, at)) sums.press(int(t), at, double(touch.force));
    }
  }
  return sums;
}

/// The hand that pulls a loop's thread through its tube, and with what [N]; none: the loop is packed, or was left.
struct LoopPull {
  int hand = -1;
  double force = 0;
};
LoopPull pull_of_loop(const interactions::SlingState& g) noexcept {
  const bool has_it = g.stage > interactions::SlingState::packed && g.stage < interactions::SlingState::left;
  if (!has_it) return {};
  return {g.hand, std::max(g.tension, g.tail)};
}

}  // namespace

int puller_of(const StepContext& c, BodyId suture) noexcept {
  const LoopPull loop = pull_of_loop(interactions::part_of<Suture>(c.state)[suture.index()].sling);
  int best = -1;
  double most = kLeastForce;
  const auto consider = [&](int hand, double force) {
    if (force > most) most = force, best = hand;
  };
  if (loop.hand >= 0) consider(loop.hand, loop.force);
  for (std::size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolState& tool = c.state.tools[t];
    if (tool.holds > 0 && tool.hold[0].at.body == suture) consider(int(t), length(vector_of(tool.pull)));
  }
  return best;
}

int culprit(const StepContext& c, const TornPlace& place) noexcept {
  const LoadSums direct = on_torn_body(c, place);
  const int hand = direct.most();
  if (hand >= 0 && direct.near(std::size_t(hand)) >= kLeastShare * direct.nobody()) return hand;
  if (direct.nobody() > kLeastForce) return -1;
  return beside_torn_body(c, place).most();
}

int breaker_of(const StepContext& c, BodyId suture) noexcept {
  if (const int puller = puller_of(c, suture); puller >= 0) return puller;
  const interactions::SutureState& s = interactions::part_of<Suture>(c.state)[suture.index()];
  const interactions::Bodies bodies = bodies_of(c);
  int best = -1;
  double most = 0;
  for (int k = 0; k < s.hole_count; ++k) {
    const interactions::SutureHole& h = s.holes[std::size_t(k)];
    const LoadSums sums = on_torn_body(c, {h.at.body, place_of(bodies, h.at)});
    const int hand = sums.most();
    if (hand >= 0 && sums.near(std::size_t(hand)) > most) most = sums.near(std::size_t(hand)), best = hand;
  }
  return best;
}

}  // namespace trocar::sim
