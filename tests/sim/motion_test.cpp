// Peristalsis and breathing in the step: a straight piece of bowel along x with waves, an organ, a cord and a fold that
// a breath carries, one of each kind that it does not.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/numerics/fft.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/breathing.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr double kSpeed = 0.020, kFrequency = 0.5, kWavelength = kSpeed / kFrequency;  // [m/s], [1/s], [m]
constexpr double kBowelY = -0.060, kBowelRadius = 0.010, kBowelLength = 0.240;

scene::Solid bowel() {
  scene::Solid s;
  s.name = "bowel";
  s.tissue = "soft";
  for (int i = 0; i <= 12; ++i)
    s.sections.push_back({{kBowelLength * i / 12, kBowelY, 0}, {0, kBowelRadius, 0}, {0, 0, kBowelRadius}, 2});
  s.cell = 0.005;
  s.skin_edge = 0.005;
  s.fine_edge = 0.004;
  // both ends rigidly; all of it in an even bed of springs, so that it does not sway
  s.anchors = {{{-0.006, kBowelY, 0}, 0.010, 0, {}},
               {{kBowelLength + 0.006, kBowelY, 0}, 0.010, 0, {}},
               {{0.5 * kBowelLength, kBowelY, 0}, 0.200, 200, {}}};
  return s;
}

scene::WaveSetting waves() {
  scene::WaveSetting w;
  w.solid = "bowel";
  w.stations = {{0, 2000, kSpeed, {}}};
  w.per_minute = 60 * kFrequency;
  w.width = 0.008;
  return w;
}

scene::BreathingSetting breathing() {
  scene::BreathingSetting b;
  b.per_minute = 15;
  b.amplitude = 0.010;
  b.direction = {0, -2, 0};
  b.carries = {{"organ", 1, {}}, {"pad", 0.5, {}}, {"cord", 1, {}}, {"tube", 1, {}}, {"fold", 1, {}}};
  return b;
}

scene::Description description() {
  scene::Description d = small::description();
  d.vessels.clear();
  d.fluids.reset();
  d.walls.clear();
  d.gravity = {0, 0, -1};
  d.tissues.push_back(small::tissue("soft", 5e3));
  return d;
}

const Model& peristaltic() {
  static const Model compiled = [] {
    scene::Description d = description();
    d.gravity = {0, 0, 0};
    d.solids = {bowel()};
    d.strands.clear();
    d.membranes.clear();
    d.peristalsis = {waves()};
    return scene::compile(d);
  }();
  return compiled;
}

const Model& breathed() {
  static const Model compiled = [] {
    scene::Description d = description();
    d.breathing = breathing();
    return scene::compile(d);
  }();
  return compiled;
}

/// Both at once, with pauses.
const Model& moving() {
  static const Model compiled = [] {
    scene::Description d = description();
    d.solids.push_back(bowel());
    d.peristalsis = {waves()};
    d.peristalsis[0].cycle = 3;
    d.peristalsis[0].active_share = 0.5;
    d.breathing = breathing();
    return scene::compile(d);
  }();
  return compiled;
}

/// Mean distance of the bowel's outer nodes from their middle, a row of nodes at a time.
struct Rows {
  std::vector<double> x;
  std::vector<std::vector<int>> nodes;

  explicit Rows(const tissue::NetworkModel& m) {
    std::map<int, std::vector<int>> by_place;
    for (int i = 0; i < m.nodes; ++i) {
      const Vec3d p = m.rest[size_t(i)] - Vec3d{0, kBowelY, 0};
      if (std::sqrt(p.y * p.y + p.z * p.z) > 0.6 * kBowelRadius) by_place[int(std::floor(p.x * 1e5))].push_back(i);
    }
    for (const auto& [place, row] : by_place) {
      x.push_back(place * 1e-5);
      nodes.push_back(row);
    }
  }
  double radius(const Model& m, const State& s, size_t row) const {
    const double n = double(nodes[row].size());
    const auto at = [&](int i) { return position(m.solids[0].network, s.solids[0], i); };
    Vec3d middle{0, 0, 0};
    for (const int i : nodes[row]) middle += at(i) / n;
    double sum = 0;
    for (const int i : nodes[row]) {
      const Vec3d p = at(i) - middle;
      sum += std::sqrt(p.y * p.y + p.z * p.z);
    }
    return sum / n;
  }
};

/// Frequency of the strongest line [cycles per sample] of what is left when the mean is taken away.
double strongest(std::vector<double> values) {
  constexpr size_t kPadded = size_t(1) << 16;
  double mean = 0;
  for (const double v : values) mean += v / double(values.size());
  for (size_t i = 0; i < values.size(); ++i)
    values[i] =
        (values[i] - mean) * (0.5 - 0.5 * std::cos(2 * portable::pi * (double(i) + 0.5) / double(values.size())));
  const std::vector<double> lines = numerics::magnitude_spectrum(values, kPadded);
  const size_t first = 2 * kPadded / values.size();  // beyond what the window makes of a drift
  return double(std::max_element(lines.begin() + std::ptrdiff_t(first), lines.end()) - lines.begin()) / double(kPadded);
}

/// Phase of the line at `frequency` [cycles per sample], in cycles.
double phase(const std::vector<double>& values, double frequency) {
  double re = 0, im = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double window = 0.5 - 0.5 * std::cos(2 * portable::pi * (double(i) + 0.5) / double(values.size()));
    re += window * values[i] * std::cos(2 * portable::pi * frequency * double(i));
    im -= window * values[i] * std::sin(2 * portable::pi * frequency * double(i));
  }
  return std::atan2(im, re) / (2 * portable::pi);
}

/// Least squares slope.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = double(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < x.size(); ++i) sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i];
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// The bowel's rows from 40 to 200 mm, every 10 ms from the fourth second for twelve.
struct Course {
  std::vector<double> x;
  std::vector<std::vector<double>> radius;  ///< (rows)(samples) [m]
  double depth = 0;                         ///< largest less smallest radius in the middle, over the largest
};
const Course& course() {
  static const Course run = [] {
    const Model& m = peristaltic();
    State s = initial_state(m);
    Work w = make_work(m);
    const Rows rows(m.solids[0].network);
    Course c;
    std::vector<size_t> used;
    for (size_t r = 0; r < rows.x.size(); ++r)
      if (rows.x[r] > 0.040 && rows.x[r] < 0.200) used.push_back(r), c.x.push_back(rows.x[r]);
    c.radius.resize(used.size());
    while (s.tick < 16000) {
      step(m, m.start, s, w);
      if (s.tick < 4000 || s.tick % 10 != 0) continue;
      for (size_t r = 0; r < used.size(); ++r) c.radius[r].push_back(rows.radius(m, s, used[r]));
    }
    const auto [least, most] = std::minmax_element(c.radius[used.size() / 2].begin(), c.radius[used.size() / 2].end());
    c.depth = 1 - *least / *most;
    return c;
  }();
  return run;
}

TEST(Peristalsis, TheWallsFrequencyIsTheWaves) {
  double worst = 0;
  for (const auto& r : course().radius) worst = std::max(worst, std::fabs(strongest(r) / 0.010 / kFrequency - 1));
  RecordProperty("frequency_off", std::to_string(worst));
  EXPECT_LT(worst, 0.02);
  RecordProperty("depth", std::to_string(course().depth));
  EXPECT_GT(course().depth, 0.1);
}

TEST(Peristalsis, TheWallsWavelengthIsSpeedOverFrequency) {
  const Course& c = course();
  const double apart = c.x[1] - c.x[0];
  double sum = 0;
  const int moments = 16;
  for (int k = 0; k < moments; ++k) {
    std::vector<double> along;
    for (const auto& r : c.radius) along.push_back(r[size_t(40 + 67 * k)]);
    sum += apart / strongest(along) / moments;
  }
  RecordProperty("wavelength_mm", std::to_string(1000 * sum));
  EXPECT_NEAR(sum, kWavelength, 0.02 * kWavelength);
}

TEST(Peristalsis, TheWallsPhaseRunsWithTheWavesSpeed) {
  const Course& c = course();
  std::vector<double> cycles;
  for (const auto& r : c.radius) {
    double p = phase(r, 0.010 * kFrequency);
    while (!cycles.empty() && p > cycles.back() + 0.5) p -= 1;
    while (!cycles.empty() && p < cycles.back() - 0.5) p += 1;
    cycles.push_back(p);
  }
  const double speed = -kFrequency / slope(c.x, cycles);
  RecordProperty("speed_mm_s", std::to_string(1000 * speed));
  EXPECT_NEAR(speed, kSpeed, 0.02 * kSpeed);
}

TEST(Peristalsis, ItsLoadsOnTheOrganSumToZero) {
  const Model& m = peristaltic();
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 4000; ++i) step(m, m.start, s, w);
  StepReport report;
  StepContext c{m, m.start, s, w, report};
  for (const Stage& stage : stages()) {
    if (std::string(stage.name) == "apply peristalsis") w.organs[0].loads.clear();  // without the bed's
    if (std::string(stage.name) == "actuate jaws") break;
    stage.run(c);
  }
  Vec3d force{0, 0, 0}, moment{0, 0, 0};
  double size = 0, lever = 0;
  for (const tissue::NodeLoad& l : w.organs[0].loads.gathered) {
    const Vec3d f = vec_cast<double>(l.f0), x = w.organs[0].nodes.position(l.node);
    EXPECT_EQ(l.k, 0);
    force += f;
    moment += cross(x, f);
    size += length(f);
    lever += length(x) * length(f);
  }
  EXPECT_GT(size, 0.1);
  EXPECT_LT(length(force), 1e-6 * size);
  EXPECT_LT(length(moment), 1e-6 * lever);
}

/// Mean displacement of an organ's nodes.
Vec3d shift(const Model& m, const State& s, size_t organ) {
  const tissue::NetworkModel& n = m.solids[organ].network;
  Vec3d sum{0, 0, 0};
  for (int i = 0; i < n.nodes; ++i) sum += position(n, s.solids[organ], i) - n.rest[size_t(i)];
  return sum / double(n.nodes);
}

struct Breath {
  std::vector<double> organ, pad, cord;  ///< along the breath [m], every tick
  double across = 0, bar = 0, tube_end = 0;
};
const Breath& breath() {
  static const Breath run = [] {
    const Model& m = breathed();
    State s = initial_state(m);
    Work w = make_work(m);
    Breath b;
    const size_t middle = m.strand_bodies[small::kCord].model.rest.size() / 2;
    while (s.tick < 14000) {
      step(m, m.start, s, w);
      const Vec3d organ = shift(m, s, 0);
      b.organ.push_back(-organ.y);
      b.pad.push_back(-shift(m, s, 1).y);
      b.cord.push_back(-(s.strands[small::kCord].x[middle] - m.strand_bodies[small::kCord].model.rest[middle]).y);
      b.across = std::max({b.across, std::fabs(organ.x), std::fabs(organ.z)});
      b.bar =
          std::max(b.bar, length(position(m.cuttables[0].body, s.cuttables[0], 0) - m.cuttables[0].body.drawn.rest[0]));
    }
    return b;
  }();
  return run;
}
double highest(const std::vector<double>& v) { return *std::max_element(v.begin() + 2000, v.end()); }

TEST(Breathing, CarriesWhatHangsRigidlyInSpringsAndOnAFoundationByItsAmplitude) {
  EXPECT_NEAR(highest(breath().organ), 0.010, 0.0003);
  EXPECT_NEAR(highest(breath().pad), 0.005, 0.0003);
  EXPECT_NEAR(highest(breath().cord), 0.010, 0.0005);
  EXPECT_LT(breath().across, 0.0015);
}

TEST(Breathing, LeavesWhatItDoesNotCarry) { EXPECT_LT(breath().bar, 1e-4); }

TEST(Breathing, KeepsItsRate) {
  const std::vector<double>& v = breath().organ;
  std::vector<double> falls;  // when it passes the middle on its way back
  for (size_t i = 1; i < v.size(); ++i)
    if (v[i - 1] >= 0.005 && v[i] < 0.005) falls.push_back(double(i) * kTick);
  ASSERT_EQ(falls.size(), 3u);
  EXPECT_NEAR(falls[1] - falls[0], 4, 0.02);
  EXPECT_NEAR(falls[2] - falls[1], 4, 0.02);
}

TEST(Breathing, BeginsAtRestAndReturnsToWhereItBegan) {
  EXPECT_LT(breath().organ[20], 1e-8);
  for (const size_t tick : {4000u, 8000u, 12000u}) EXPECT_NEAR(breath().organ[tick], 0, 0.0003);
}

TEST(Breathing, HeldNodesAreWhereTheBreathHasCarriedThem) {
  const Model& m = breathed();
  State s = initial_state(m);
  Work w = make_work(m);
  while (s.tick < 1777) step(m, m.start, s, w);
  const Vec3d way = breath_after(m.motion.breathing, s.tick);
  EXPECT_GT(length(way), 0.008);
  ASSERT_FALSE(m.motion.breathing.held[0].empty());
  for (const int i : m.motion.breathing.held[0])
    EXPECT_LT(length(position(m.solids[0].network, s.solids[0], i) - m.solids[0].network.rest[size_t(i)] - way), 1e-8);
}

TEST(Breathing, MovesTheArteriesPressureWithTheSameBreath) {
  scene::Description d = small::description();
  d.walls.clear();
  d.breathing = breathing();
  d.breathing->per_minute = 21;
  d.breathing->carries = {{"organ", 1, {}}};
  const Model m = scene::compile(d);
  State s = initial_state(m);
  Work w = make_work(m);
  ASSERT_TRUE(m.vessels.there());
  for (int i = 0; i <= 4000; ++i) {
    const double breaths = double(s.tick) * kTick / m.motion.breathing.period;
    if (i % 500 == 0) {
      EXPECT_NEAR(s.flow.breath, breaths - std::floor(breaths), 1e-9) << "tick " << s.tick;
    }
    step(m, m.start, s, w);
  }
}

TEST(Breathing, CarriesAlsoBodiesThatCanBeCut) {
  scene::Description d = description();
  d.breathing = breathing();
  d.breathing->carries = {{"bar", 1, {}}};
  const Model m = scene::compile(d);
  State s = initial_state(m);
  Work w = make_work(m);
  const tissue::CuttableModel& body = m.cuttables[0].body;
  double most = 0, away = 0;
  while (s.tick < 4000) {
    step(m, m.start, s, w);
    const Vec3d way = breath_after(m.motion.breathing, s.tick);
    for (int i = 0; i < body.own_nodes; ++i) {
      const Vec3d moved = position(body, s.cuttables[0], i) - body.drawn.rest[size_t(i)];
      if (body.fixed[size_t(i)] == tissue::kHeld) away = std::max(away, length(moved - way));
      most = std::max(most, -moved.y);
    }
  }
  EXPECT_LT(away, 1e-8);
  EXPECT_NEAR(most, 0.010, 0.002);
}

/// Hash after `ticks`; `before` runs before every one.
template <class Before>
std::uint64_t hash_after(const Model& m, State s, Work w, std::uint64_t ticks, Before&& before) {
  while (s.tick < ticks) {
    before(s, w);
    step(m, m.start, s, w);
  }
  return hash_of(s);
}

TEST(Motion, TheSameInputsGiveTheSameBitsWithPoisonedWorkAndAnyNumberOfThreads) {
  const Model& m = moving();
  const auto leave = [](State&, Work&) {};
  const std::uint64_t hash = hash_after(m, initial_state(m), make_work(m), 1200, leave);
  EXPECT_EQ(hash_after(m, initial_state(m), make_work(m), 1200, [](State&, Work& w) { poison(w); }), hash);
  for (const int threads : {2, 3}) {
    core::ThreadPool pool(threads);
    EXPECT_EQ(hash_after(m, initial_state(m), make_work(m, &pool), 1200, leave), hash) << threads;
  }
}

TEST(Motion, SavedInTheMiddleOfABreathItGoesOnWithTheSameBits) {
  const Model& m = moving();
  State s = initial_state(m);
  Work w = make_work(m);
  while (s.tick < 700) step(m, m.start, s, w);
  const State saved = s;
  const auto leave = [](State&, Work&) {};
  EXPECT_EQ(hash_after(m, saved, make_work(m), 1200, leave), hash_after(m, s, std::move(w), 1200, leave));
}

TEST(Motion, ChangesTheModelsHash) {
  scene::Description d = description();
  d.solids.push_back(bowel());
  std::vector<std::uint64_t> hashes;
  const auto compiled = [&] { hashes.push_back(scene::compile(d).hash); };
  compiled();
  d.peristalsis = {waves()};
  compiled();
  d.peristalsis[0].stations[0].speed *= 1.001;
  compiled();
  d.breathing = breathing();
  compiled();
  d.breathing->carries[1].share = 0.51;
  compiled();
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

}  // namespace
