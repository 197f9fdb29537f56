// The pelvis of the bleeding scene with all of it on at once: an artery that bleeds, 200 vessels, thousands of drops
// that fly and run over the organs, a pool with blood and water in it and a probe that stirs it, a hook that coagulates
// and smokes, water and suction. For tests of what all of it together does, and for benchmarks of what it costs.
//
//   const sim::Model model = scene::compile(everything::description());
//   sim::State state = everything::laden(model, 5000);       // drops and pool from the first tick on
//   everything::Hands hands(model);
//   step(model, hands.at(state.tick), state, work);
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/fluids/fluids.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::everything {

inline constexpr int kIrrigator = 0, kHook = 1, kProbe = 2;  ///< hands
inline constexpr int kSegments = 200;

/// The bleeding scene without vessels, fluids and energy: the tissue beside which all of it is computed.
inline scene::Description tissue_alone() {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json");
  d.vessels.clear();
  d.fluids.reset();
  d.energy.reset();
  d.placements[kIrrigator].instrument = "suction_irrigator";
  d.placements[kHook].instrument = "hook";
  d.placements[kProbe].instrument = "probe";
  return d;
}

/// `count` twigs of 6 to 16 mm on an organ's skin, each from the end of an older one.
class Twigs {
 public:
  Twigs(const sim::Model& drawn, const std::string& organ, int count, core::Random& random)
      : m_skin(drawn.skin(drawn.organ_index(organ))), m_organ(organ), m_random(random) {
    m_tree.name = organ + "_twigs";
    m_tree.pulse_gain = 0;  // of such small ones nothing is seen or felt
    m_at = {any_vertex()};
    m_children = {0};
    while (int(m_tree.vessels.size()) < count) grow();
    finish();
  }
  const scene::VesselTree& tree() const { return m_tree; }

 private:
  Vec3d vertex(int v) const { return vec_cast<double>(m_skin.rest[size_t(v)]); }
  int any_vertex() {
    for (;;)
      if (const int v = int(m_random.next() % size_t(m_skin.size())); m_skin.at_surface(v)) return v;
  }
  /// Of some places the first that is as far away as a twig is long; -1: none was.
  int reachable(Vec3d from) {
    for (int i = 0; i < 400; ++i) {
      const int v = any_vertex();
      const double far = length(vertex(v) - from);
      if (far > 0.006 && far < 0.016) return v;
    }
    return -1;
  }
  void grow() {
    const size_t parent = m_random.next() % m_at.size();
    const int to = m_children[parent] < 2 ? reachable(vertex(m_at[parent])) : -1;
    if (to < 0) return;
    ++m_children[parent];
    const int child = int(m_at.size());
    m_at.push_back(to);
    m_children.push_back(0);
    scene::Vessel v;
    v.name = m_organ + "_twig_" + std::to_string(child);
    v.path = {vertex(m_at[parent]), vertex(to)};
    v.rides_on = {m_organ};
    v.rides_at.resize(1);
    vessels::VesselSegment s;
    s.from = int(parent), s.to = child;
    s.length = length(v.path[1] - v.path[0]);
    s.radius = 0.0004;
    s.wall.wave_speed = 9;
    m_tree.graph.segments.push_back(s);
    m_tree.vessels.push_back(std::move(v));
  }
  void finish() {
    m_tree.graph.nodes = int(m_at.size());
    for (size_t n = 0; n < m_at.size(); ++n) m_tree.nodes.push_back(m_organ + "_node_" + std::to_string(n));
    m_tree.graph.sources = {{.node = 0}};
    for (size_t i = 0; i < m_tree.vessels.size(); ++i)
      if (m_children[size_t(m_tree.graph.segments[i].to)] == 0)
        m_tree.graph.ends.push_back(
            vessels::matched_end(m_tree.graph, int(i), 88 * vessels::kPascalPerMmHg, 5e-6 / 60, 1));
  }

  const tissue::Skin& m_skin;
  std::string m_organ;
  core::Random& m_random;
  scene::VesselTree m_tree;
  std::vector<int> m_at, m_children;  // (nodes) skin vertex; twigs that begin there
};

/// @param drops  room for so many at a time
inline scene::Description description(int drops = 8192) {
  scene::Description d = tissue_alone();
  const sim::Model drawn = scene::compile(d);
  const scene::Description whole = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json");
  d.vessels = whole.vessels;
  d.fluids = whole.fluids;
  d.energy = whole.energy;
  d.fluids->drops = drops;
  core::Random random(7);
  int left = kSegments;
  for (const scene::VesselTree& tree : d.vessels) left -= int(tree.vessels.size());
  int organs = 3;
  for (const char* organ : {"uterus", "bladder", "rectosigmoid"}) {
    const int share = left / organs--;
    d.vessels.push_back(Twigs(drawn, organ, share, random).tree());
    left -= share;
  }
  d.bleeder = scene::BleederSetting{};
  d.bleeder->opens = 0.1;
  d.bleeder->holes = {{"uterine_upper_left", 0.5, 1.0e-3, {}}};
  return d;
}

/// Compiled once for all tests of a folder.
inline const sim::Model& model() {
  static const sim::Model compiled = scene::compile(description());
  return compiled;
}

/// Drops at `wanted` of which about a third fly, above and on the organs.
class Rain {
 public:
  Rain(const sim::Model& model, int wanted) : m_model(model), m_wanted(wanted) {}

  void top_up(sim::State& s) {
    while (s.fluids.droplets.count < m_wanted && add(s)) {
    }
  }

 private:
  bool add(sim::State& s) {
    const int organ = int(m_random.next() % size_t(m_model.organs()));
    const tissue::Skin& skin = m_model.skin(organ);
    const Vec3f on = skin.rest[m_random.next() % size_t(skin.size())];
    const auto within = [&](double reach) { return float(m_random.uniform(-reach, reach)); };
    const bool flies = m_random.uniform() < 0.5;
    const Vec3f at = on + Vec3f{within(0.01), within(0.01), flies ? 0.04f + within(0.03) : 0.002f};
    const fluids::Mix drop{.blood = 300'000 + std::int64_t(m_random.uniform() * 2e6), .saline = 100'000};
    if (!add_drop(m_model.wet.model.droplets, at, {within(0.1), within(0.1), within(0.1)}, drop, s.fluids.droplets))
      return false;
    receive(s.fluids.ledger, fluids::Source::kBled, fluids::Place::kDroplets, drop);
    return true;
  }
  const sim::Model& m_model;
  int m_wanted;
  core::Random m_random{42};
};

/// Blood and water up to a level [m] above the lowest place of the pool's floor, organs on it included: what would
/// stand on an organ that is under the level would fall off it as a dam breaks.
inline void fill_pool(const sim::Model& model, double level, sim::State& s) {
  const fluids::PoolModel& pool = model.wet.model.pool;
  const std::vector<float>& floor = s.pool_floor;
  const double top = double(*std::min_element(floor.begin(), floor.end())) + level;
  for (int j = 0; j < pool.ny; ++j)
    for (int i = 0; i < pool.nx; ++i) {
      const double deep = top - double(floor[size_t(j) * size_t(pool.nx) + size_t(i)]);
      if (deep <= 0) continue;
      const auto part = std::int64_t(0.5 * deep / double(pool.height_per_pl));
      const fluids::Mix fills{.blood = part, .saline = part};
      receive(s.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, fills);
      pour(pool, i, j, fills, s.fluids.pool);
    }
}

inline sim::State laden(const sim::Model& model, int drops, double level = 0.05) {
  sim::State s = sim::initial_state(model);
  fill_pool(model, level, s);
  Rain(model, drops).top_up(s);
  return s;
}

/// What the hands do at a tick: the irrigator washes over the uterus and sucks, the hook coagulates along it, the probe
/// stirs, the lens is wiped now and then.
class Hands {
 public:
  explicit Hands(const sim::Model& model) : m_model(model) {
    for (size_t h = 0; h < 3; ++h) m_start[h] = forward(model.hands[h].port, pose_of(model.start.tools[h])).tip;
    m_hooked = nearest("uterus", kHook);
    m_washed = nearest("uterus", kIrrigator);
    m_stirred = {0, -0.150, -0.150};
    if (model.wet.there) m_stirred = stirred();
  }

  sim::Input at(std::uint64_t tick) const {
    const double t = double(tick) * sim::kTick, in = std::min(t / 0.6, 1.0);
    sim::Input input = m_model.start;
    put(input, kIrrigator, in, beyond(m_washed, kIrrigator, -0.015) + Vec3d{0.004 * std::sin(2 * t), 0, 0});
    put(input, kHook, in, beyond(m_hooked, kHook, 0.001) + Vec3d{0.003 * std::sin(0.7 * t), 0, 0});
    put(input, kProbe, in, m_stirred + Vec3d{0.008 * std::sin(6 * t), 0.008 * std::cos(6 * t), 0});
    if (tick >= 700) input.pedals |= sim::kBlue;
    if (tick >= 600 && tick % 1000 < 800) input.pedals |= sim::irrigates(kIrrigator);
    if (tick % 500 < 250) input.pedals |= sim::sucks(kIrrigator);
    if (tick % 1000 >= 900) input.pedals |= sim::kWipe;
    return input;
  }

 private:
  Vec3d nearest(const char* organ, int hand) const {
    const Vec3d port = m_model.hands[size_t(hand)].port;
    Vec3d best;
    double least = 1;
    for (const Vec3f& p : m_model.skin(m_model.organ_index(organ)).rest)
      if (const double d = length(vec_cast<double>(p) - port); d < least) least = d, best = vec_cast<double>(p);
    return best;
  }
  /// The lowest place of the pool's floor that the probe comes to, and a little above it.
  Vec3d stirred() const {
    const std::vector<float>& floor = m_model.wet.floor;
    const auto low = std::min_element(floor.begin(), floor.end());
    const int k = int(low - floor.begin());
    const fluids::PoolModel& pool = m_model.wet.model.pool;
    return world(pool, (k % pool.nx + 0.5) * pool.cell, (k / pool.nx + 0.5) * pool.cell, double(*low) + 0.02);
  }
  Vec3d beyond(Vec3d p, int hand, double by) const { return p + by * normalised(p - m_model.hands[size_t(hand)].port); }
  void put(sim::Input& input, int hand, double share, Vec3d tip) const {
    const size_t h = size_t(hand);
    const Vec3d at = m_start[h] + share * (tip - m_start[h]);
    input.tools[h] = sim::tool_input(kinematics::inverse(m_model.hands[h].port, at, 0), 0);
  }

  const sim::Model& m_model;
  Vec3d m_start[3], m_hooked, m_washed, m_stirred;
};

}  // namespace trocar::everything
