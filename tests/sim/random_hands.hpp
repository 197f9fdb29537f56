// Seeded random hands in a whole scene, at the speed of a surgeon: they take hold of an organ, a membrane or a rod,
// carry it to another one, press it there and let go. Now and then a foot presses a pedal. Every 50 ticks an
// independent measure (interpenetration.hpp) looks how deep bodies are in each other and in themselves.
//
//   RandomHands hands(model, seed);
//   hands.resume("build/.../scene.keyframe");          // where there is one of this Model and program
//   while (hands.ticks() < 300'000) hands.run(20'000), hands.keep(file);
//   EXPECT_EQ(hands.findings(), "");
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "abuse.hpp"
#include "interpenetration.hpp"
#include "saved_state.hpp"

namespace trocar {

class RandomHands {
 public:
  static constexpr int kLook = 50;           ///< [ticks]
  static constexpr double kSpeed = 0.15;     ///< [m/s]
  static constexpr double kForce = 10;       ///< [N] a hand that feels more draws back
  static constexpr double kBetween = 0.001;  ///< [m] two bodies, for longer than kLook
  static constexpr double kWithin = 0.002;   ///< [m] one in itself
  static constexpr double kMostEnergy = 5;   ///< [J] as of all hands at random

  RandomHands(const sim::Model& model, std::uint64_t seed)
      : m_model(model),
        m_state(sim::initial_state(model)),
        m_work(sim::make_work(model)),
        m_bodies(abuse::bodies_of(model)),
        m_start(looked(m_state)),
        m_rest_energy(abuse::energy(model, m_state)) {
    m_plan.random = seed;
    m_plan.input = model.start;
    for (size_t h = 0; h < model.hands.size(); ++h)
      m_plan.hand[h].tip = m_plan.hand[h].way =
          kinematics::forward(model.hands[h].port, pose_of(model.start.tools[h])).tip;
  }

  std::uint64_t ticks() const { return m_state.tick; }
  const sim::State& state() const { return m_state; }
  /// What was found, a line each; empty: nothing.
  const std::string& findings() const { return m_findings; }
  int grasps() const { return m_plan.grasps; }
  std::uint32_t flags() const { return m_plan.flags; }
  double most_energy() const { return m_plan.most_energy; }
  /// Of a pair that was deeper than allowed, since this program began: how deep at most [m], and in how many looks.
  struct Worst {
    double depth = 0;
    int looks = 0;
  };
  const std::map<std::pair<std::string, std::string>, Worst>& worst() const { return m_worst; }

  void run(int ticks) {
    for (int t = 0; t < ticks && !m_plan.broken; ++t) {
      core::Random random(m_plan.random);
      for (size_t h = 0; h < m_model.hands.size(); ++h) control(random, h);
      tread(random);
      m_plan.random = random.state();
      tick();
    }
  }

  void keep(const std::string& file) const {
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream out(file + ".new", std::ios::binary);
    Saver saver(out);
    const std::uint64_t head[3] = {m_model.hash, sim::hash_of(m_state), m_findings.size()};
    saver.bytes(head, sizeof head);
    saver.bytes(m_findings.data(), m_findings.size());
    saver.bytes(&m_plan, sizeof m_plan);
    keep_deep(saver);
    sim::State::fields(m_state, saver);
    out.close();
    std::filesystem::rename(file + ".new", file);
  }
  /// @return was there one that fits?
  bool resume(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    Loader loader(in);
    std::uint64_t head[3] = {0, 0, 0};
    loader.bytes(head, sizeof head);
    if (!in || head[0] != m_model.hash || head[2] > kMostText * 400) return false;
    std::string findings(head[2], ' ');
    Plan plan;
    sim::State state = m_state;
    loader.bytes(findings.data(), findings.size());
    loader.bytes(&plan, sizeof plan);
    std::map<std::pair<int, int>, Deep> deep = deep_of(loader);
    sim::State::fields(state, loader);
    if (!in || sim::hash_of(state) != head[1]) return false;
    m_state = std::move(state), m_plan = plan, m_deep = std::move(deep), m_findings = std::move(findings);
    return true;
  }

 private:
  enum Stage : std::int32_t { approach, close, carry, press, open, back };
  static constexpr int kMostText = 40;  ///< lines

  struct Hand {
    Vec3d tip{0, 0, 0}, way{0, 0, 0};  ///< where it is commanded to be, and where to [m]
    double speed = 0.05, handle = 0;
    Stage stage = back;
    std::int32_t left = 0;  ///< ticks of that stage
  };
  struct Plan {
    std::uint64_t random = 0;
    sim::Input input;
    Hand hand[sim::kMaxTools];
    double most_energy = 0;
    std::int32_t grasps = 0, lines = 0;
    std::uint32_t flags = 0;
    std::int32_t broken = 0;
  };
  static_assert(std::is_trivially_copyable_v<Plan>);
  /// Of a pair since it is deeper than allowed.
  struct Deep {
    double reported = 0;  ///< depth that has been reported [m]
  };

  // Hands

  static double norm(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
  Vec3d axis(size_t h) const { return normalised(m_plan.hand[h].tip - m_model.hands[h].port, Vec3d{0, 0, -1}); }

  /// Of some places on any bodies one that the trocar is not far from.
  Vec3d some_place(core::Random& random, size_t h) const {
    Vec3d best{0, 0, 0};
    double least = 1e9;
    for (int i = 0; i < 4; ++i) {
      const std::vector<Vec3d> p = abuse::places(m_model, m_state, m_bodies[random.next() % m_bodies.size()]);
      const Vec3d at = p[random.next() % p.size()];
      const double far = length(at - m_model.hands[h].port);
      if (far < least) least = far, best = at;
    }
    return best;
  }

  void next_stage(core::Random& random, size_t h) {
    Hand& hand = m_plan.hand[h];
    const auto begin = [&](Stage stage, int least, int most) {
      hand.stage = stage;
      hand.left = least + int(random.next() % std::uint64_t(most - least));
    };
    switch (hand.stage) {
      case approach:
        return begin(close, 250, 400);
      case close:
        hand.way = some_place(random, h);
        hand.speed = random.uniform(0.03, kSpeed);
        return begin(carry, 400, 1200);
      case carry:
        hand.way = hand.tip + Vec3d{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), -0.01};
        hand.speed = random.uniform(0.01, 0.05);
        return begin(press, 200, 800);
      case press:
        return begin(random.next() % 3 == 0 ? carry : open, 150, 400);
      case open:
        hand.way = m_model.hands[h].port + 0.6 * (hand.tip - m_model.hands[h].port);
        hand.speed = kSpeed;
        return begin(back, 200, 400);
      case back:
        hand.way = some_place(random, h) + 0.006 * axis(h);
        hand.speed = random.uniform(0.05, kSpeed);
        if (random.next() % 8 == 0)
          m_plan.input.tools[h].instrument = std::int32_t(random.next() % m_model.hands[h].rack.size());
        return begin(approach, 500, 1200);
    }
  }

  void control(core::Random& random, size_t h) {
    Hand& hand = m_plan.hand[h];
    if (--hand.left <= 0) next_stage(random, h);
    const bool closed = hand.stage == close || hand.stage == carry || hand.stage == press;
    const bool closes = m_model.tool(m_state, h).can().grip;
    hand.handle += std::clamp((closed && closes ? 1.0 : 0.0) - hand.handle, -0.008, 0.008);
    const interactions::ToolState& tool = m_state.tools[h];
    if (norm(tool.pull) + norm(tool.contact_force) > kForce) {
      const Vec3d borne{tool.pull[0] + tool.contact_force[0], tool.pull[1] + tool.contact_force[1],
                        tool.pull[2] + tool.contact_force[2]};
      hand.way = hand.tip = hand.tip + (kSpeed * sim::kTick) * normalised(borne, -axis(h));
    } else {
      const Vec3d way = hand.way - hand.tip;
      const double far = length(way), most = hand.speed * sim::kTick;
      hand.tip += (far <= most ? 1.0 : most / far) * way;
    }
    sim::ToolInput& in = m_plan.input.tools[h];
    in = sim::tool_input(kinematics::inverse(m_model.hands[h].port, hand.tip, double(in.roll)), float(hand.handle),
                         in.instrument);
  }

  /// Seldom a pedal goes down, for half a second on average.
  void tread(core::Random& random) {
    if (!m_model.energy.there) return;
    if (m_plan.input.pedals != 0) {
      if (random.next() % 500 == 0) m_plan.input.pedals = 0;
    } else if (random.next() % 10'000 == 0) {
      m_plan.input.pedals = random.next() % 2 == 0 ? sim::kBlue : sim::kYellow;
    }
  }

  // What is looked at

  void tick() {
    const sim::StepReport report = sim::step(m_model, m_plan.input, m_state, m_work);
    m_plan.flags |= report.flags;
    for (int i = 0; i < report.event_count; ++i) m_plan.grasps += report.events[i].kind == sim::Event::grasped;
    if (!report.fine()) m_plan.broken = 1, find("not finite");
    if ((report.flags & sim::StepReport::kTooManyLoads) != 0) find("contacts found no room");
    if (m_state.tick % kLook == 0) look();
  }

  void look() {
    const double energy = abuse::energy(m_model, m_state) - m_rest_energy;
    m_plan.most_energy = std::max(m_plan.most_energy, energy);
    if (!(energy < kMostEnergy)) find("energy " + std::to_string(energy) + " J");
    if (const std::string wrong = abuse::broken(m_model, m_state); !wrong.empty()) m_plan.broken = 1, find(wrong);
    const Interpenetration now = looked(m_state);
    std::map<std::pair<int, int>, Deep> deep;
    for (const Growth& g : deeper_than(now, m_start, kBetween)) {
      const bool itself = g.now.a == g.now.b;
      const double by = g.now.depth - g.before;
      if (itself && !(by > kWithin)) continue;
      const auto before = m_deep.find({g.now.a, g.now.b});
      const double reported = before == m_deep.end() ? 0 : before->second.reported;
      Worst& worst = m_worst[{now.names[size_t(g.now.a)], now.names[size_t(g.now.b)]}];
      worst = {std::max(worst.depth, by), worst.looks + 1};
      const bool counts = (itself || before != m_deep.end()) && (reported == 0 || by > reported + kBetween);
      if (counts) find(text_of(now, g));
      deep[{g.now.a, g.now.b}] = {counts ? by : reported};
    }
    m_deep = std::move(deep);
  }

  /// Organs, membranes and rods that are whole.
  Interpenetration looked(const sim::State& s) const {
    std::vector<BodySurface> all = surfaces_of(m_model, s);
    for (BodySurface& b : all)
      if (!is_looked_at(s, b.body)) b.points.clear(), b.triangles.clear(), b.capsules.clear();
    return measure(all);
  }
  /// What is cut or torn meets itself by other rules, and a drawn triangle in a tear is nothing.
  bool is_looked_at(const sim::State& s, BodyId body) const {
    const size_t i = body.index();
    const auto whole = [](const std::vector<std::uint8_t>& parted) {
      return std::none_of(parted.begin(), parted.end(), [](std::uint8_t p) { return p != 0; });
    };
    if (body.is(BodyKind::organ) && i < s.parted.size()) return whole(s.parted[i]);
    if (body.is(BodyKind::organ)) {
      const size_t c = i - s.parted.size();
      return s.cuttables[c].tets.nodes == m_model.cuttables[c].body.own_nodes;
    }
    if (body.is(BodyKind::membrane)) return whole(s.torn[i]);
    return body.is(BodyKind::strand);
  }

  void find(const std::string& text) {
    if (m_plan.lines++ >= kMostText) return;
    m_findings += "tick " + std::to_string(m_state.tick) + ": " + text.substr(0, 300) + "\n";
    std::printf("    %s, tick %llu: %s\n", m_model.name.c_str(), (unsigned long long)m_state.tick, text.c_str());
    std::fflush(stdout);
  }

  void keep_deep(Saver& saver) const {
    const std::uint64_t count = m_deep.size();
    saver.bytes(&count, sizeof count);
    for (const auto& [pair, deep] : m_deep) {
      const int ab[2] = {pair.first, pair.second};
      saver.bytes(ab, sizeof ab), saver.bytes(&deep, sizeof deep);
    }
  }
  static std::map<std::pair<int, int>, Deep> deep_of(Loader& loader) {
    std::map<std::pair<int, int>, Deep> all;
    std::uint64_t count = 0;
    loader.bytes(&count, sizeof count);
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, 100'000); ++i) {
      int ab[2] = {0, 0};
      Deep deep;
      loader.bytes(ab, sizeof ab), loader.bytes(&deep, sizeof deep);
      all[{ab[0], ab[1]}] = deep;
    }
    return all;
  }

  const sim::Model& m_model;
  sim::State m_state;
  sim::Work m_work;
  Plan m_plan;
  std::vector<abuse::Body> m_bodies;
  Interpenetration m_start;
  double m_rest_energy = 0;
  std::map<std::pair<int, int>, Deep> m_deep;  ///< pairs that were deeper at the last look
  std::map<std::pair<std::string, std::string>, Worst> m_worst;
  std::string m_findings;
};

}  // namespace trocar
