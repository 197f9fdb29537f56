// Waves in vessels: how fast they run, what comes back from where they branch, when they arrive; and in which order the
// errors fall as tick and cells are halved together. Small waves in blood without viscosity, as the formulas want them.
#include <algorithm>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

constexpr double kWidth = 0.015;  // of the pulse's flow: a bell of this standard deviation [s]
constexpr double kMiddle = 0.08;  // its time [s]

/// A bell of flow once in two seconds, so small that the wall law stays straight (u / c = 1e-6).
VesselSource bell(double area, double speed) {
  VesselSource pump{.node = 0, .kind = VesselSource::Kind::pump};
  const int n = 64000;
  for (int i = 0; i < n; ++i) {
    const double x = (2.0 * i / n - kMiddle) / kWidth;
    pump.wave.push_back(1e-6 * area * speed * std::exp(-0.5 * x * x));
  }
  return pump;
}

double area_of(const VesselSegment& s) { return kPi * s.radius * s.radius; }

VesselGraph line(std::vector<VesselSegment> segments) {
  VesselGraph g;
  g.nodes = int(segments.size()) + 1;
  g.segments = std::move(segments);
  g.blood.viscosity = 0;
  g.heart.rate = 30;
  const VesselSegment &first = g.segments.front(), &last = g.segments.back();
  g.sources = {bell(area_of(first), wave_speed(first, g.blood))};
  const double z = g.blood.density * wave_speed(last, g.blood) / area_of(last);
  g.ends = {{.node = last.to, .r_near = z, .pressure = last.reference_pressure}};
  return g;
}

struct Artery {
  const char* name;
  double diameter, modulus, thickness, speed;  // mm, MPa, mm, m/s
};
// Diameters, moduli and walls of textbooks and the speeds that Moens and Korteweg give for them.
const Artery kArteries[] = {{"aorta", 20, 0.4, 1.6, 5.5},
                            {"iliac", 5.4, 0.7, 0.5, 7.8},
                            {"uterine", 1.6, 1.0, 0.15, 9.4},
                            {"hepatic", 4.5, 0.8, 0.4, 7.8},
                            {"cystic", 1.4, 1.2, 0.15, 11}};

double pressure_at(const Simulation& sim, int segment, double s) {
  return read_wall(sim.model, sim.state, segment, s).pressure;
}

/// Speed of the bell's top between 0.3 and 0.7 of a tube.
double measured_speed(const VesselSegment& tube) {
  Simulation near(line({tube})), far(line({tube}));
  const double rest = tube.reference_pressure;
  const double time = kMiddle + 2 * tube.length / wave_speed(tube, near.model.blood);
  const double a = peak_time(trace(near, time, [&] { return pressure_at(near, 0, 0.3) - rest; }));
  const double b = peak_time(trace(far, time, [&] { return pressure_at(far, 0, 0.7) - rest; }));
  return 0.4 * tube.length / ((b - a) * near.model.settings.tick);
}

TEST(Pulse, RunsAtTheSpeedOfMoensAndKorteweg) {
  for (const Artery& a : kArteries) {
    const VesselSegment tube = artery(0, 1, 1.5, 1e-3 * a.diameter, 1e6 * a.modulus, 1e-3 * a.thickness);
    const double radius = 0.5e-3 * a.diameter;
    const double c = std::sqrt(1e6 * a.modulus * 1e-3 * a.thickness / (2 * 1060 * radius));
    EXPECT_NEAR(c, a.speed, 0.06 * c) << a.name;
    expect_within(std::string("row 18, wave speed, ") + a.name, measured_speed(tube) / c - 1, 0.005);
  }
}

TEST(Pulse, RunsFasterWhereTheWallCannotLengthen) {
  VesselSegment tube = artery(0, 1, 1.5, 2e-3, 1e6, 0.15e-3);
  const double free = measured_speed(tube);
  tube.wall.poisson = 0.5;
  expect_within("wave speed held lengthways, over free", measured_speed(tube) / free / std::sqrt(4.0 / 3) - 1, 0.005);
}

TEST(Pulse, ReflectsAtABranchByTheAdmittancesThatMeet) {
  struct Case {
    double parent, daughters;  // diameters [mm]
    int count;
  };
  for (const Case& c : {Case{10, 7, 2}, Case{10, 5, 2}, Case{6, 6, 2}, Case{10, 3, 3}, Case{4, 8, 1}}) {
    VesselGraph g = line({artery(0, 1, 2.0, 1e-3 * c.parent, 0.6e6, 0.6e-3)});
    g.ends.clear();
    const double speed = wave_speed(g.segments[0], g.blood);
    double sum = 0;
    for (int i = 0; i < c.count; ++i) {
      g.segments.push_back(artery(1, 2 + i, 0.5, 1e-3 * c.daughters, 0.8e6, 0.4e-3));
      const VesselSegment& d = g.segments.back();
      const double y = area_of(d) / (g.blood.density * wave_speed(d, g.blood));
      g.ends.push_back({.node = 2 + i, .r_near = 1 / y, .pressure = d.reference_pressure});
      sum += y;
    }
    g.nodes = 2 + c.count;
    const double y0 = area_of(g.segments[0]) / (g.blood.density * speed);
    const double expected = (y0 - sum) / (y0 + sum);
    Simulation sim(g);
    const double rest = g.segments[0].reference_pressure;
    const std::vector<double> p = trace(sim, kMiddle + 3.5 / speed, [&] { return pressure_at(sim, 0, 0.8) - rest; });
    const std::size_t passing = std::size_t((kMiddle + 2.0 / speed) / sim.model.settings.tick);
    double there = 0, back = 0;  // areas under the bells, and not their tops, which dispersion lowers
    for (std::size_t i = 0; i < p.size(); ++i) (i < passing ? there : back) += p[i];
    expect_within("row 18, reflection expected " + std::to_string(expected), back / there - expected, 0.005);
    const double top_back = p[std::size_t(std::lround(peak_time(p, passing))) - 1];
    const double top_there = p[std::size_t(std::lround(peak_time(p, 0, passing))) - 1];
    expect_within("row 18, the same by the tops", top_back / top_there - expected, 0.02);
  }
}

TEST(Pulse, ArrivesAfterTheSumOfLengthsOverSpeeds) {
  // Aorta, iliac and uterine artery one after the other; as wide as lets no wave turn back where they meet.
  const double speeds[] = {5.5, 7.8, 9.4}, lengths[] = {0.15, 0.1, 0.12};
  std::vector<VesselSegment> chain;
  double delay = 0;
  for (int i = 0; i < 3; ++i) {
    VesselSegment s{.from = i, .to = i + 1, .length = lengths[i], .radius = 4e-3 * std::sqrt(speeds[i] / speeds[0])};
    s.wall.wave_speed = speeds[i];
    chain.push_back(s);
    delay += lengths[i] / speeds[i];
  }
  EXPECT_NEAR(delay, 0.053, 0.001);
  Simulation heart(line(chain)), uterus(line(chain));
  const double rest = chain[0].reference_pressure;
  const double a = peak_time(trace(heart, 0.3, [&] { return node_pressure(heart.model, heart.state, 0) - rest; }));
  const double b = peak_time(trace(uterus, 0.3, [&] { return node_pressure(uterus.model, uterus.state, 3) - rest; }));
  expect_within("row 18, delay of 53 ms", (b - a) * 1e-3 / delay - 1, 0.02);
}

/// How much the wave at 0.9 of a tube differs from the one that left, shifted by the time it takes.
double waveform_error(double tick, double implicitness) {
  VesselSegment tube = artery(0, 1, 1.0, 5e-3, 0.7e6, 0.5e-3);
  VesselGraph g = line({tube});
  g.settings.tick = tick;
  g.settings.implicitness = implicitness;
  Simulation sim(g);
  const double c = wave_speed(tube, g.blood), z = g.blood.density * c / area_of(tube);
  const double top = 1e-6 * area_of(tube) * c * z;
  double error = 0, size = 0, t = 0;
  trace(sim, 0.3, [&] {
    t += tick;
    const double x = (t - 0.9 / c - kMiddle) / kWidth, exact = top * std::exp(-0.5 * x * x);
    const double e = pressure_at(sim, 0, 0.9) - tube.reference_pressure - exact;
    error += e * e, size += exact * exact;
    return 0.0;
  });
  return std::sqrt(error / size);
}

TEST(Pulse, WaveformConvergesWithTheSquareOfTickAndCells) {
  std::vector<double> errors, damped;
  for (const double tick : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    errors.push_back(waveform_error(tick, 0.5));
    damped.push_back(waveform_error(tick, 0.5 + 50 * tick));
  }
  expect_order("row 18, waveform, implicitness 1/2", errors, 2, 0.1);
  expect_order("row 18, waveform, implicitness 1/2 + 50 tick", damped, 2, 0.15);
}

TEST(Pulse, SegmentsShorterThanATicksTravelAreLumpedWithoutHarm) {
  // The same tube in one piece and in 200 of 5 mm (a wave runs 8 mm in a tick).
  std::vector<VesselSegment> pieces;
  for (int i = 0; i < 200; ++i) pieces.push_back(artery(i, i + 1, 0.005, 5e-3, 0.7e6, 0.5e-3));
  const VesselSegment tube = artery(0, 1, 1.0, 5e-3, 0.7e6, 0.5e-3);
  Simulation whole(line({tube})), cut_up(line(pieces));
  const double rest = tube.reference_pressure;
  const double a = peak_time(trace(whole, 0.4, [&] { return node_pressure(whole.model, whole.state, 1) - rest; }));
  const double b = peak_time(trace(cut_up, 0.4, [&] { return node_pressure(cut_up.model, cut_up.state, 200) - rest; }));
  expect_within("arrival in 200 pieces and in one", b / a - 1, 0.005);
}

TEST(Pulse, RunsFasterWithTheFlowThanAgainstIt) {
  // A steady flow of a tenth of the wave's speed: u + c one way, c - u the other [Hughes & Lubliner 1973].
  const VesselSegment tube = artery(0, 1, 1.5, 5e-3, 0.7e6, 0.5e-3);
  const double rest = tube.reference_pressure;
  double arrival[2];
  for (int way = 0; way < 2; ++way) {
    VesselGraph g = line({tube});
    const double c = wave_speed(tube, g.blood), u = (way ? -0.1 : 0.1) * c;
    VesselSource steady{.node = way ? 1 : 0, .kind = VesselSource::Kind::pump};
    for (double& q : g.sources[0].wave) q += u * area_of(tube);
    Simulation sim(g);
    for (double& q : sim.state.q) q = u * area_of(tube);
    for (double& p : sim.state.p) p = rest + u * area_of(tube) * g.ends[0].r_near;
    const double base = rest + u * area_of(tube) * g.ends[0].r_near;
    Simulation again = sim;
    const std::vector<double> far = trace(sim, 0.5, [&] { return pressure_at(sim, 0, 0.7) - base; });
    const std::vector<double> near = trace(again, 0.5, [&] { return pressure_at(again, 0, 0.3) - base; });
    arrival[way] = 0.4 * 1.5 / ((peak_time(far) - peak_time(near)) * 1e-3);
    // The base pressure widens the tube to x times its radius: faster waves, slower flow.
    const double x = 1 + (base - rest) / wall_stiffness(tube, g.blood);
    const double expected = c * std::sqrt(x) + u / (x * x);
    expect_within(way ? "wave against a flow of c / 10" : "wave with a flow of c / 10", arrival[way] / expected - 1,
                  0.005);
  }
  EXPECT_GT(arrival[0], 1.15 * arrival[1]);
}

TEST(Pulse, MovesTheWallByItsPressureOverItsStiffness) {
  // Held lengthways: dr = 0.75 dp r^2 / (E h); 17 um for the uterine artery, 83 um for the iliac, 0.6 mm for the aorta.
  const double expected[] = {0.62e-3, 83e-6, 17e-6};
  for (int i = 0; i < 3; ++i) {
    const Artery& a = kArteries[i];
    VesselGraph g = line({artery(0, 1, 0.1, 1e-3 * a.diameter, 1e6 * a.modulus, 1e-3 * a.thickness)});
    g.segments[0].wall.poisson = 0.5;
    g.sources = {constant_pressure(0, 93 * kMmHg)};
    g.ends.clear();
    Simulation low(g, 1);
    g.sources = {constant_pressure(0, 133 * kMmHg)};
    Simulation high(g, 1);
    const WallReading lower = read_wall(low.model, low.state, 0, 0.5);
    const WallReading upper = read_wall(high.model, high.state, 0, 0.5);
    const double r = 0.5e-3 * a.diameter;
    const double formula = 0.75 * 40 * kMmHg * r * r / (1e6 * a.modulus * 1e-3 * a.thickness);
    expect_within(std::string("wall motion, ") + a.name, (upper.radius - lower.radius) / formula - 1, 1e-3);
    EXPECT_NEAR(upper.radius - lower.radius, expected[i], 0.03 * expected[i]) << a.name;
    const WallReading teaching = read_wall(high.model, high.state, 0, 0.5, 10);
    EXPECT_DOUBLE_EQ(teaching.shift, 10 * upper.shift);
    EXPECT_DOUBLE_EQ(teaching.push, 10 * upper.push);
    EXPECT_NEAR(upper.push, 40 * kMmHg, 1);
    EXPECT_DOUBLE_EQ(teaching.radius, upper.radius);
  }
}

}  // namespace
}  // namespace trocar::vessels
