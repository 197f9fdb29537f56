// Seeded hands that work on needle and thread as nobody should: they take either where it lies, drag it about, drive it
// into what is there, let it fall, draw it out through the trocar, and close scissors on it.
//
//   SutureAbuse abuse(model, 1);
//   while (abuse.ticks() < 600'000) abuse.tick();
//   abuse.deepest_long(), abuse.bad_tick(), abuse.lost(), ...
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar {

class SutureAbuse {
 public:
  static constexpr int kLookEvery = 10;  ///< ticks
  static constexpr int kLong = 50;       ///< ticks in a row that a node may be where it should not
  static constexpr double kDeep =
      0.5e-3;  ///< below an organ's skin, which gives way where a thread is pulled on it [m]

  SutureAbuse(const sim::Model& model, std::uint64_t seed)
      : m_model(model),
        m_state(sim::initial_state(model)),
        m_work(sim::make_work(model)),
        m_random(seed),
        m_input(model.start),
        m_hands(model.hands.size()) {
    for (size_t h = 0; h < m_hands.size(); ++h)
      m_hands[h].tip = kinematics::forward(model.hands[h].port, pose_of(model.start.tools[h])).tip;
    for (const interactions::SutureModel& m : model.objects.sutures.list)
      m_in_steel.emplace_back(size_t(m.thread.nodes), 0), m_in_organ.emplace_back(size_t(m.thread.nodes), 0);
  }

  std::uint64_t ticks() const { return m_state.tick; }
  const sim::State& state() const { return m_state; }
  int most_in_steel = 0, most_in_organ = 0;  ///< ticks in a row that some node was
  std::uint64_t bad_tick = 0;                ///< 0: none
  std::uint32_t flags = 0;
  int takes = 0, needle_takes = 0, cuts = 0, bites = 0, drawn_out = 0;
  double most_force = 0;               ///< on any instrument [N]
  int looks = 0, looks_at_organs = 0;  ///< the latter while the first solid is whole
  std::string lost;                    ///< what is not there any more

  void tick() {
    for (size_t h = 0; h < m_hands.size(); ++h) act(h);
    const sim::StepReport report = sim::step(m_model, m_input, m_state, m_work);
    flags |= report.flags;
    if (!report.fine() && bad_tick == 0) bad_tick = m_state.tick;
    if (m_state.tick % kLookEvery == 0) look();
  }

 private:
  enum Deed { take, close, drag, drive, out, let_go, kDeeds };
  struct Hand {
    Vec3d tip, way;
    double speed = 0.05, handle = 0, roll_speed = 0;
    int deed = let_go, left = 0;
  };

  double any(double low, double high) { return m_random.uniform(low, high); }
  int any_of(int n) { return int(m_random.next() % std::uint64_t(n)); }
  size_t some_suture() { return size_t(any_of(int(m_model.objects.sutures.list.size()))); }
  Vec3d axis(size_t h) const { return normalised(m_hands[h].tip - m_model.hands[h].port, Vec3d{0, 0, -1}); }

  /// Of needle or thread, between jaws that come along their shaft.
  Vec3d some_place(size_t h) {
    const size_t i = some_suture();
    const interactions::SutureModel& m = m_model.objects.sutures.list[i];
    const int place = m.grips > 0 && any_of(2) == 0 ? any_of(m.grips) : any_of(m.grip_point_count());
    const Vec3d p = interactions::suture_place(m, m_state.objects.sutures[i], place);
    return p + any(0.001, 0.005) * normalised(p - m_model.hands[h].port);
  }
  /// On or below some organ's skin.
  Vec3d some_skin() {
    const sim::SolidModel& m = m_model.solids[size_t(any_of(int(m_model.solids.size())))];
    const Vec3f p = m.skin.rest[size_t(any_of(m.skin.size()))];
    return Vec3d{double(p.x), double(p.y), double(p.z)} + Vec3d{0, 0, any(-0.004, 0.010)};
  }
  bool holds(size_t h) const { return m_state.tools[h].holds > 0; }

  void next(size_t h) {
    Hand& hand = m_hands[h];
    hand.roll_speed = any(-2, 2);
    hand.speed = any(0.02, 0.2);
    switch (hand.deed) {
      case take:
        hand.deed = close, hand.left = 250;
        return;
      case close:
        hand.deed = any_of(2) == 0 ? drag : drive;
        hand.left = 300 + any_of(1200);
        hand.way = hand.deed == drive ? some_skin() : hand.tip + Vec3d{any(-1, 1), any(-1, 1), any(-0.3, 1)} * 0.03;
        return;
      case drag:
      case drive: {
        const int then = any_of(4);
        hand.deed = then == 0 ? out : then == 1 ? drag : let_go;
        hand.left = then == 0 ? 900 : 200 + any_of(400);
        hand.way = then == 0 ? m_model.hands[h].port + 0.03 * axis(h) : hand.tip + Vec3d{0, 0, 0.01};
        if (then == 0) hand.speed = 0.2;
        return;
      }
      default:
        if (any_of(3) == 0) m_input.tools[h].instrument = std::int32_t(m_random.next() % m_model.hands[h].rack.size());
        hand.deed = take, hand.left = 700 + any_of(500);
        hand.speed = any(0.08, 0.2);
        hand.way = some_place(h);
    }
  }

  void act(size_t h) {
    Hand& hand = m_hands[h];
    if (--hand.left <= 0) next(h);
    const double wanted = hand.deed == take || hand.deed == let_go ? 0 : 1;
    hand.handle += std::clamp(wanted - hand.handle, -0.008, 0.008);
    const interactions::ToolState& tool = m_state.tools[h];
    const Vec3d force = Vec3d{tool.pull[0], tool.pull[1], tool.pull[2]} +
                        Vec3d{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]};
    most_force = std::max(most_force, length(force));
    const double most = hand.speed * sim::kTick;
    if (length(force) > 10) {  // a hand that feels more gives way
      hand.way = hand.tip += (0.2 * sim::kTick / length(force)) * force;
    } else {
      const Vec3d left = hand.way - hand.tip;
      hand.tip += std::min(1.0, most / std::max(1e-12, length(left))) * left;
    }
    sim::ToolInput& in = m_input.tools[h];
    const double roll = double(in.roll) + hand.roll_speed * sim::kTick;
    in = sim::tool_input(kinematics::inverse(m_model.hands[h].port, hand.tip, roll), float(hand.handle), in.instrument);
  }

  void look() {
    ++looks, looks_at_organs += !is_open(0);
    for (size_t i = 0; i < m_model.objects.sutures.list.size(); ++i) {
      const interactions::SutureModel& m = m_model.objects.sutures.list[i];
      const interactions::SutureState& s = m_state.objects.sutures[i];
      bites = std::max(bites, s.bite_count);
      cuts = std::max(cuts, int(std::count(s.thread.alive.begin(), s.thread.alive.end(), 0)));
      if (m.has_needle() && !(length(s.needle.x) < 0.4)) lost = m.name + "'s needle";
      for (int n = 0; n < m.thread.nodes; ++n) {
        const Vec3d x = s.thread.x[size_t(n)];
        if (!(length(x) < 0.6)) lost = m.name + "'s thread";
        note(is_thread(s, n) && in_steel(i, n, x), m_in_steel[i][size_t(n)], most_in_steel);
        note(!in_passage(m, s, n) && in_organ(x), m_in_organ[i][size_t(n)], most_in_organ);
      }
    }
    for (size_t h = 0; h < m_hands.size(); ++h) {
      const bool now = holds(h) && m_state.tools[h].hold[0].at.body.is(BodyKind::suture);
      if (now && !m_hands_held[h]) {
        const interactions::Hold& hold = m_state.tools[h].hold[0];
        ++takes;
        needle_takes += interactions::on_needle(m_model.objects.sutures.list[hold.at.body.index()], hold.at.element);
      }
      m_hands_held[h] = now;
      drawn_out += now && m_state.tools[h].depth < 0.035;
    }
  }
  static void note(bool there, int& ticks, int& most) {
    ticks = there ? ticks + kLookEvery : 0;
    most = std::max(most, ticks);
  }

  /// With its axis below the surface of a rod; not where jaws hold it.
  bool in_steel(size_t i, int n, Vec3d x) const {
    const interactions::SutureModel& m = m_model.objects.sutures.list[i];
    for (size_t h = 0; h < m_hands.size(); ++h) {
      const interactions::ToolShape shape = sim::shape_of(m_model, m_state, h);
      bool held = false;
      for (int k = 0; k < m_state.tools[h].holds; ++k) {
        const auto& hold = m_state.tools[h].hold[k];
        held = held || (hold.at.body == BodyId{BodyKind::suture, std::uint32_t(i)} && hold.at.element >= m.grips &&
                        std::abs(hold.at.element - m.grips - n) * m.thread.spacing < 0.006);
      }
      if (held) continue;
      for (int part = interactions::kShaft; part < end_of(shape); part = interactions::next(part)) {
        if (interactions::is_jaw(part) && is_gathered(i, n)) continue;
        const collision::Capsule& rod = shape.rod(part);
        const Vec3d along = rod.b - rod.a;
        const double t = std::clamp(dot(x - rod.a, along) / std::max(1e-12, dot(along, along)), 0.0, 1.0);
        if (length(x - rod.a - t * along) < rod.radius - 0.25 * m.thread.stuff.diameter) return true;
      }
    }
    return false;
  }
  /// Between the legs of an applier that has closed on it.
  bool is_gathered(size_t i, int n) const {
    const std::vector<std::uint8_t>& gathered = m_work.objects.sutures.list[i].gathered;
    return (n > 0 && gathered[size_t(n) - 1]) || (size_t(n) < gathered.size() && gathered[size_t(n)]);
  }
  /// Not a crumb between two cuts.
  static bool is_thread(const interactions::SutureState& s, int n) {
    const std::vector<std::uint8_t>& alive = s.thread.alive;
    return (n > 0 && alive[size_t(n) - 1]) || (size_t(n) < alive.size() && alive[size_t(n)]);
  }
  bool in_passage(const interactions::SutureModel& m, const interactions::SutureState& s, int n) const {
    const double arc = n * m.thread.spacing;
    double low = 1e9, high = -1e9;
    for (int k = 0; k < s.hole_count; ++k)
      if (s.holes[size_t(k)].slot >= 0)
        low = std::min(low, double(s.holes[size_t(k)].arc)), high = std::max(high, double(s.holes[size_t(k)].arc));
      else
        low = 0;  // the swage is in tissue
    return arc > low - 0.002 && arc < high + 0.002;
  }
  /// Scissors have cut it: what lies in the cut is in nothing, though skin is still drawn over it.
  bool is_open(size_t solid) const {
    for (int k = 0; k < m_state.cut_count; ++k)
      if (m_state.cuts[size_t(k)].solid == std::int32_t(solid)) return true;
    return false;
  }
  /// Deeper than kDeep below the skin of a solid: by rays along z, and the nearest triangle.
  bool in_organ(Vec3d x) const {
    for (size_t b = 0; b < m_model.solids.size(); ++b) {
      if (is_open(b)) continue;
      const tissue::Skin& skin = m_model.solids[b].skin;
      const std::vector<Vec3d>& p = skin_now(b);
      bool inside = false;
      for (const auto& t : skin.triangles) {
        const Vec3d u = p[size_t(t[0])] - x, v = p[size_t(t[1])] - x, w = p[size_t(t[2])] - x;
        const double uv = u.x * v.y - u.y * v.x, vw = v.x * w.y - v.y * w.x, wu = w.x * u.y - w.y * u.x;
        if ((uv > 0) != (vw > 0) || (uv > 0) != (wu > 0)) continue;
        const double z = (vw * u.z + wu * v.z + uv * w.z) / (uv + vw + wu);
        if (z > 0) inside = !inside;
      }
      if (!inside) continue;
      double nearest = 1e9;
      for (const auto& t : skin.triangles)
        nearest = std::min(
            nearest,
            length(geometry::closest_on_triangle(x, p[size_t(t[0])], p[size_t(t[1])], p[size_t(t[2])]).point - x));
      if (nearest > kDeep) return true;
    }
    return false;
  }
  const std::vector<Vec3d>& skin_now(size_t b) const {
    if (m_skins.size() != m_model.solids.size()) m_skins.resize(m_model.solids.size());
    if (m_skin_tick != m_state.tick) {
      m_skin_tick = m_state.tick;
      for (size_t i = 0; i < m_skins.size(); ++i) {
        const sim::SolidModel& m = m_model.solids[i];
        m_skins[i].assign(size_t(m.skin.size()), Vec3d{});
        for (int v = 0; v < m.skin.size(); ++v)
          m.skin.each_carrier(v, [&](int node, int, auto weight) {
            m_skins[i][size_t(v)] += double(weight) * tissue::position(m.network, m_state.solids[i], node);
          });
      }
    }
    return m_skins[b];
  }

  const sim::Model& m_model;
  sim::State m_state;
  sim::Work m_work;
  core::Random m_random;
  sim::Input m_input;
  std::vector<Hand> m_hands;
  std::array<bool, sim::kMaxTools> m_hands_held{};
  std::vector<std::vector<int>> m_in_steel, m_in_organ;  ///< ticks in a row
  mutable std::vector<std::vector<Vec3d>> m_skins;
  mutable std::uint64_t m_skin_tick = ~std::uint64_t{0};
};

}  // namespace trocar
