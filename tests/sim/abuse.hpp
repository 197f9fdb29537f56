// Seeded random abuse of a scene: hands that grasp, tear and poke at every organ in turn, at tip speeds up to 0.4 m/s
// and with forces up to 10 N, change instruments while they hold, and let go. Where a scene has current or fluids, feet
// and fingers are as wild: pedals, valves and the wipe go on and off at random, in any combination.
//
//   abuse::Attack attack(model, 1);
//   while (attack.ticks() < 600'000) { const abuse::Round r = attack.round(); ... r.left ... }
//
// One round: some seconds on one organ with all hands, then everything lets go and withdraws, then five seconds of
// rest. After them every organ must be back where it was before anybody touched it (shape_left), as nothing was cut.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::abuse {

inline constexpr double kSpeed = 0.4;                        ///< [m/s]
inline constexpr double kForce = 10;                         ///< [N] a hand that feels more draws back
inline constexpr int kOutside = 750, kWithdrawTicks = 1200;  ///< from anywhere: 20 cm and more at kSpeed
inline constexpr int kRestTicks = 5000;

/// All deformable bodies as one list: solids, strands, membranes, what can be cut.
struct Body {
  enum Kind { solid, strand, membrane, cuttable } kind = solid;
  int index = 0;
  std::string name;
};
inline std::vector<Body> bodies_of(const sim::Model& m) {
  std::vector<Body> all;
  for (size_t i = 0; i < m.solids.size(); ++i) all.push_back({Body::solid, int(i), m.solids[i].name});
  for (size_t i = 0; i < m.strands.size(); ++i) all.push_back({Body::strand, int(i), m.strands[i].name});
  for (size_t i = 0; i < m.membranes.size(); ++i) all.push_back({Body::membrane, int(i), m.membranes[i].name});
  for (size_t i = 0; i < m.cuttables.size(); ++i) all.push_back({Body::cuttable, int(i), m.cuttables[i].name});
  return all;
}

/// Its number in that list.
inline size_t number_of(const sim::Model& m, const std::string& name) {
  const std::vector<Body> all = bodies_of(m);
  return size_t(std::find_if(all.begin(), all.end(), [&](const Body& b) { return b.name == name; }) - all.begin());
}

inline std::vector<Vec3d> places(const sim::Model& m, const sim::State& s, const Body& b) {
  std::vector<Vec3d> p;
  const auto network = [&p](const tissue::NetworkModel& model, const tissue::NetworkState& state) {
    for (int n = 0; n < model.nodes; ++n) p.push_back(tissue::position(model, state, n));
  };
  const size_t i = size_t(b.index);
  if (b.kind == Body::solid) network(m.solids[i].network, s.solids[i]);
  if (b.kind == Body::strand) p = s.strands[i].x;
  if (b.kind == Body::membrane) network(m.membranes[i].sheet.network, s.membranes[i].network);
  for (int n = 0; b.kind == Body::cuttable && n < m.cuttables[i].body.own_nodes; ++n)
    p.push_back(tissue::position(m.cuttables[i].body, s.cuttables[i], n));
  return p;
}

/// Of what can be cut: kinetic and gravity only.
inline double energy(const tissue::CuttableModel& m, const tissue::CuttableState& s) {
  std::vector<double> mass(size_t(s.tets.nodes), 0.0);
  for (const geometry::Tet& c : s.tets.cells) {
    const auto x = [&](size_t k) { return s.tets.rest[size_t(c[k])]; };
    for (const int node : c) mass[size_t(node)] += m.density / 24 * dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0)));
  }
  double sum = 0;
  for (int n = 0; n < s.tets.nodes; ++n) {
    const Vec3d v = tissue::velocity(m, s, n);
    sum += mass[size_t(n)] * (0.5 * dot(v, v) - dot(m.gravity, tissue::position(m, s, n)));
  }
  return sum;
}

/// Kinetic, elastic and gravity energy of everything [J].
inline double energy(const sim::Model& m, const sim::State& s) {
  double sum = 0;
  for (size_t i = 0; i < m.solids.size(); ++i) {
    const tissue::NetworkEnergy e = tissue::energy(m.solids[i].network, s.solids[i]);
    sum += e.kinetic + e.elastic + e.gravity;
  }
  for (size_t i = 0; i < m.strand_bodies.size(); ++i)
    sum += tissue::energy(m.strand_bodies[i].model, s.strands[i]).total();
  for (size_t i = 0; i < m.membranes.size(); ++i) sum += tissue::energy(m.membranes[i].sheet, s.membranes[i]).total();
  for (size_t i = 0; i < m.cuttables.size(); ++i) sum += energy(m.cuttables[i].body, s.cuttables[i]);
  return sum;
}

inline double size_of(const std::vector<Vec3d>& p) {
  Vec3d low = p.front(), high = p.front();
  for (Vec3d x : p)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  return length(high - low);
}

/// How far a body's farthest point is from where it was, in units of the body's size.
struct Left {
  std::string name;
  double share = 0, distance = 0;  ///< [-], [m]
};

struct Round {
  std::string organ;
  std::uint32_t flags = 0;
  std::uint64_t first_bad_tick = 0;  ///< 0: none
  double most_energy = 0;            ///< above that of rest [J]
  double energy_left = 0;            ///< after the rest [J]
  double most_speed = 0;             ///< of an instrument's tip [m/s]
  double most_force = 0;             ///< on any instrument, one tick [N]
  int grasps = 0, exchanges = 0, slips = 0, tears = 0;
  bool let_go = true;      ///< no instrument held or touched anything during the rest's second half
  bool held = false;       ///< jaws held something then
  std::vector<Left> left;  ///< of every body, after the rest
  const Left& worst() const {
    return *std::max_element(left.begin(), left.end(), [](const Left& a, const Left& b) { return a.share < b.share; });
  }
};

/// The same scene with tissue that never tears: what is torn does not come back, all else must.
inline sim::Model untearable(sim::Model model) {
  for (sim::SolidModel& m : model.solids) m.failure_strain = 0;
  for (sim::CuttableOrgan& m : model.cuttables) m.failure_strain = 0;
  for (sim::StrandAnatomy& m : model.strands) m.failure_strain = 0;
  for (sim::MembraneBody& m : model.membranes) m.failure_strain = 0;
  sim::seal(model);
  return model;
}

/// What must hold of blood, water, smoke and heat whatever hands and feet do; empty: all of it does.
inline std::string broken(const sim::Model& m, const sim::State& s) {
  if (m.wet.there && !audit(m.wet.model, s.fluids)) return "the account does not balance";
  const std::int64_t out = s.fluids.ledger.in[size_t(fluids::Source::kBled)].blood;
  if (m.wet.there && out - m.wet.pool_at_start.blood > s.flow.bled)  // what lay there had run out before
    return "more blood than the vessels let out";
  const auto sound = [](float x) { return std::fabs(x) < 1e3f; };  // not a number is not
  const fluids::DropletState& d = s.fluids.droplets;
  for (size_t i = 0; i < size_t(d.count); ++i)
    for (const float x : {d.x[i], d.y[i], d.z[i], d.vx[i], d.vy[i], d.vz[i]})
      if (!sound(x)) return "a drop is nowhere";
  for (const float u : s.fluids.pool.u)
    if (!sound(u)) return "the pool's speed";
  for (const float v : s.fluids.pool.v)
    if (!sound(v)) return "the pool's speed";
  for (const float density : s.fluids.smoke.density)
    if (!(density >= 0) || !std::isfinite(density)) return "the smoke's density";
  if (!(s.fluids.smoke.fog >= 0 && s.fluids.smoke.fog <= 1)) return "fog on the lens";
  for (const double p : s.flow.p)
    if (!(std::fabs(p) < 1e6)) return "pressure in a vessel";
  for (const sim::ElectrodeHand& e : s.electrodes)
    if (!(e.current.tip > -100 && e.current.tip < 1000)) return "an electrode's temperature";
  return "";
}

class Attack {
 public:
  /// @param destroy  scissors and clip appliers close as well: shapes will not come back
  Attack(const sim::Model& model, std::uint64_t seed, bool destroy = false)
      : m_model(model),
        m_state(sim::initial_state(model)),
        m_work(sim::make_work(model)),
        m_random(seed),
        m_feet(seed ^ 0x5eed),
        m_input(model.start),
        m_bodies(bodies_of(model)),
        m_destroy(destroy) {
    for (size_t h = 0; h < model.hands.size(); ++h)
      m_hands.push_back({kinematics::forward(model.hands[h].port, pose_of(model.start.tools[h])).tip});
    for (int t = 0; t < 1000; ++t) sim::step(model, m_input, m_state, m_work);
    for (const Body& b : m_bodies) m_settled.push_back(places(model, m_state, b));
    m_rest_energy = energy(model, m_state);
  }

  std::uint64_t ticks() const { return m_state.tick; }
  const sim::State& state() const { return m_state; }
  std::uint32_t pressed() const { return m_pressed; }  ///< bits of Input::pedals that have been on
  size_t organs() const { return m_bodies.size(); }

  /// @param seconds  of abuse before everything lets go  @param rest  ticks after that
  Round round(size_t organ, double seconds, int rest = kRestTicks) {
    Round r;
    m_target = organ % m_bodies.size();
    r.organ = m_bodies[m_target].name;
    for (Hand& hand : m_hands) hand.left = 0;
    const int ticks = int(seconds * 1000);
    for (int t = 0; t < ticks; ++t) {
      for (size_t h = 0; h < m_hands.size(); ++h) attack(h);
      wander();
      tread();
      tick(r);
    }
    m_input.pedals = 0;
    for (int t = 0; t < kWithdrawTicks; ++t) {
      for (size_t h = 0; h < m_hands.size(); ++h) withdraw(h, t);
      tick(r);
    }
    for (int t = 0; t < rest; ++t) {
      tick(r);
      if (t > rest / 2)
        for (const interactions::ToolState& tool : m_state.tools) {
          r.let_go = r.let_go && free_of_tissue(tool);
          r.held = r.held || tool.holds > 0;
        }
    }
    r.energy_left = energy(m_model, m_state) - m_rest_energy;
    for (size_t b = 0; b < m_bodies.size(); ++b) r.left.push_back(shape_left(b));
    return r;
  }

 private:
  struct Hand {
    Vec3d tip;                // where it is commanded to be
    Vec3d way{0, 0, 0};       // where to
    double speed = 0.1;       // [m/s]
    int stage = 0, left = 0;  // what it is doing, and for how many ticks more
    double handle = 0;
  };
  enum { approach, close, shake, open, poke };

  static double norm(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
  static double force_on(const interactions::ToolState& t) { return norm(t.pull) + norm(t.contact_force); }
  static bool free_of_tissue(const interactions::ToolState& t) { return t.holds == 0 && force_on(t) < 1e-6; }

  Vec3d somewhere(double radius) {
    return {m_random.uniform(-radius, radius), m_random.uniform(-radius, radius), m_random.uniform(-radius, radius)};
  }
  /// Of some places on the organ the one nearest to the hand's trocar: what is behind it is hard to take hold of.
  Vec3d some_place(size_t h) {
    const std::vector<Vec3d> p = places(m_model, m_state, m_bodies[m_target]);
    Vec3d best = p[size_t(m_random.next() % p.size())];
    for (int i = 0; i < 6; ++i) {
      const Vec3d other = p[size_t(m_random.next() % p.size())];
      if (length(other - m_model.hands[h].port) < length(best - m_model.hands[h].port)) best = other;
    }
    return best;
  }
  std::int32_t any_instrument(size_t h) { return std::int32_t(m_random.next() % m_model.hands[h].rack.size()); }
  /// What this hand has to grasp with; destroying hands take anything.
  std::int32_t grasper(size_t h) {
    const auto& rack = m_model.hands[h].rack;
    for (size_t i = 0; i < rack.size() && !m_destroy; ++i)
      if (rack[i].kind == interactions::ToolKind::grasper) return std::int32_t(i);
    return any_instrument(h);
  }
  Vec3d axis(size_t h) const { return normalised(m_hands[h].tip - m_model.hands[h].port, Vec3d{0, 0, -1}); }

  void next_stage(size_t h) {
    Hand& hand = m_hands[h];
    const auto begin = [&](int stage, int least, int most) {
      hand.stage = stage;
      hand.left = least + int(m_random.next() % std::uint64_t(most - least));
    };
    switch (hand.stage) {
      case approach:
        begin(close, 250, 400);
        break;
      case close:
        begin(shake, 400, 1500);
        break;
      case shake:
        begin(open, 150, 300);
        break;
      default:
        begin(m_random.next() % 3 == 0 ? int(poke) : int(approach), 500, 900);
        hand.way = some_place(h) + 0.006 * axis(h) + somewhere(0.003);
        hand.speed = m_random.uniform(0.15, kSpeed);
        m_input.tools[h].instrument = m_random.next() % 4 == 0 ? any_instrument(h) : grasper(h);
    }
  }

  /// One tick of one hand's abuse.
  void attack(size_t h) {
    Hand& hand = m_hands[h];
    if (--hand.left <= 0) next_stage(h);
    const interactions::ToolKind kind = m_model.tool(m_state, h).kind;
    const bool closes = m_destroy || kind == interactions::ToolKind::grasper || kind == interactions::ToolKind::probe ||
                        kind == interactions::ToolKind::suction_irrigator;
    const bool closed = hand.stage == close || hand.stage == shake || hand.stage == poke;
    const double wanted = closed && closes ? 1 : 0;
    hand.handle += std::clamp(wanted - hand.handle, -0.008, 0.008);
    if ((hand.stage == shake || hand.stage == poke) && m_random.next() % 150 == 0) {
      hand.way = hand.tip + somewhere(0.045);
      hand.speed = m_random.uniform(0.05, kSpeed);
      if (hand.stage == shake && m_random.next() % 8 == 0)  // changes while it holds
        m_input.tools[h].instrument = any_instrument(h);
    }
    if (force_on(m_state.tools[h]) > kForce) {  // gives way, towards where the held tissue pulls
      const double* pull = m_state.tools[h].pull;
      const double* touch = m_state.tools[h].contact_force;
      const Vec3d back = normalised(Vec3d{pull[0] + touch[0], pull[1] + touch[1], pull[2] + touch[2]}, -axis(h));
      hand.way = hand.tip = hand.tip + (kSpeed * sim::kTick) * back;
    } else {
      go(hand, hand.way, hand.speed);
    }
    roll(h, m_random.uniform(-0.004, 0.004));
    put(h);
  }

  /// Opens, draws back along its shaft, and returns to where it began.
  void withdraw(size_t h, int t) {
    Hand& hand = m_hands[h];
    hand.handle += std::clamp(0 - hand.handle, -0.008, 0.008);
    if (t >= 200 && t < kOutside) go(hand, m_model.hands[h].port + 0.03 * axis(h), kSpeed);
    if (t >= kOutside)
      go(hand, kinematics::forward(m_model.hands[h].port, pose_of(m_model.start.tools[h])).tip, kSpeed);
    m_input.tools[h].instrument = m_state.tools[h].instrument;
    put(h);
  }

  static void go(Hand& hand, Vec3d to, double speed) {
    const Vec3d way = to - hand.tip;
    const double far = length(way), most = speed * sim::kTick;
    hand.tip += (far <= most ? 1.0 : most / far) * way;
  }
  void roll(size_t h, double by) { m_input.tools[h].roll += float(by); }
  void put(size_t h) {
    sim::ToolInput& in = m_input.tools[h];
    const kinematics::FulcrumPose pose = kinematics::inverse(m_model.hands[h].port, m_hands[h].tip, double(in.roll));
    in = sim::tool_input(pose, float(m_hands[h].handle), in.instrument);
  }
  void wander() {
    m_input.scope.yaw += float(m_random.uniform(-0.002, 0.002));
    m_input.scope.pitch += float(m_random.uniform(-0.002, 0.002));
    m_input.scope.depth += float(m_random.uniform(-0.0005, 0.0005));
    m_input.scope.roll += float(m_random.uniform(-0.01, 0.01));
  }

  /// Every now and then one of all pedals, valves, keys of the panel and the wipe changes.
  void tread() {
    if ((!m_model.energy.there && !m_model.wet.there) || m_feet.next() % 100 != 0) return;
    const std::uint32_t which = std::uint32_t(m_feet.next() % (3 + 2 * m_hands.size() + 7));
    const std::uint32_t key = which - 3 - std::uint32_t(2 * m_hands.size());
    const bool valve = which >= 3 && which < 3 + 2 * m_hands.size();
    m_input.pedals ^= which < 3 ? 1u << which : valve ? 1u << (8 + which - 3) : 1u << (sim::kPanelBit + int(key));
    m_pressed |= m_input.pedals;
  }

  void tick(Round& r) {
    std::array<Vec3d, sim::kMaxTools> before;
    for (size_t h = 0; h < m_hands.size(); ++h) before[h] = tip(h);
    const sim::StepReport report = sim::step(m_model, m_input, m_state, m_work);
    r.flags |= report.flags;
    if (!report.fine() && r.first_bad_tick == 0) r.first_bad_tick = m_state.tick;
    for (int i = 0; i < report.event_count; ++i) {
      r.grasps += report.events[i].kind == sim::Event::grasped;
      r.slips += report.events[i].kind == sim::Event::slipped;
      r.exchanges += report.events[i].kind == sim::Event::exchanged;
      r.tears += report.events[i].kind == sim::Event::torn;
    }
    for (size_t h = 0; h < m_hands.size(); ++h) {
      r.most_speed = std::max(r.most_speed, length(tip(h) - before[h]) / sim::kTick);
      r.most_force = std::max(r.most_force, force_on(m_state.tools[h]));
    }
    if (m_state.tick % 10 == 0) r.most_energy = std::max(r.most_energy, energy(m_model, m_state) - m_rest_energy);
  }
  Vec3d tip(size_t h) const { return kinematics::forward(m_model.hands[h].port, m_state.tools[h].pose()).tip; }

  Left shape_left(size_t b) const {
    const std::vector<Vec3d> now = places(m_model, m_state, m_bodies[b]);
    Left left{m_bodies[b].name, 0, 0};
    for (size_t i = 0; i < now.size(); ++i) {
      const double d = length(now[i] - m_settled[b][i]);
      if (!(d <= left.distance)) left.distance = d;  // not a number counts as far
    }
    left.share = left.distance / size_of(m_settled[b]);
    return left;
  }

  const sim::Model& m_model;
  sim::State m_state;
  sim::Work m_work;
  core::Random m_random, m_feet;
  sim::Input m_input;
  std::vector<Body> m_bodies;
  std::vector<std::vector<Vec3d>> m_settled;
  std::vector<Hand> m_hands;
  double m_rest_energy = 0;
  size_t m_target = 0;
  std::uint32_t m_pressed = 0;
  bool m_destroy = false;
};

}  // namespace trocar::abuse
