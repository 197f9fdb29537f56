// Graphs that several tests use, one of them simulated, and how a measured figure is told and held to its tolerance.
#pragma once

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/vessels/flow.hpp>

namespace trocar::vessels::test {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kMmHg = kPascalPerMmHg;
inline constexpr double kMlPerMinute = 1e-6 / 60;

inline void record(const std::string& what, const char* format, double a, double b) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b);
  testing::Test::RecordProperty(what, text);
  std::printf("    %-66s %s\n", what.c_str(), text);
}
/// Prints and records how far a result is off, and holds it to the tolerance.
inline void expect_within(const std::string& what, double off, double tolerance) {
  record(what, "%.2e (allowed %.2g)", std::fabs(off), tolerance);
  EXPECT_LE(std::fabs(off), tolerance) << what;
}
/// For errors each of which belongs to half the step of the one before.
inline void expect_order(const std::string& what, const std::vector<double>& errors, double order, double slack) {
  std::string all = what + ":";
  char text[24];
  for (const double e : errors) std::snprintf(text, sizeof text, " %.2e", std::fabs(e)), all += text;
  const double measured = std::log2(std::fabs(errors[errors.size() - 2] / errors.back()));
  record(all, "order %.2f (expected %.1f)", measured, order);
  EXPECT_NEAR(measured, order, slack) << all;
}

struct Simulation {
  FlowModel model;
  FlowState state;
  FlowWork work;
  std::vector<Opening> openings;
  std::vector<Occlusion> clips;
  std::vector<OpeningFlow> flows;
  explicit Simulation(const VesselGraph& graph, double settle = 0)
      : model(build(graph)), state(settled_state(model, settle)), work(make_work(model)) {}
  FlowReport tick() {
    flows.resize(openings.size());
    return advance(model, {.openings = openings, .clips = clips}, flows, state, work);
  }
  void run(double seconds) {
    for (double t = 0.5 * model.settings.tick; t < seconds; t += model.settings.tick) tick();
  }
  double time_of_ticks(int ticks) const { return ticks * model.settings.tick; }
};

/// A vessel with a stiff wall (its lumen does not change, waves take no time to speak of).
inline VesselSegment pipe(int from, int to, double length, double diameter) {
  VesselSegment s{.from = from, .to = to, .length = length, .radius = diameter / 2};
  s.wall.wave_speed = 1000;
  return s;
}

inline VesselSegment artery(int from, int to, double length, double diameter, double modulus, double thickness) {
  VesselSegment s{.from = from, .to = to, .length = length, .radius = diameter / 2};
  s.wall.modulus = modulus, s.wall.thickness = thickness;
  return s;
}

inline VesselSource constant_pressure(int node, double pressure, double resistance = 0) {
  return {.node = node, .kind = VesselSource::Kind::steady, .pressure = pressure, .resistance = resistance};
}

/// Calls probe() after every tick for a time; its values.
inline std::vector<double> trace(Simulation& sim, double seconds, const std::function<double()>& probe) {
  std::vector<double> values;
  for (double t = 0.5 * sim.model.settings.tick; t < seconds; t += sim.model.settings.tick) {
    sim.tick();
    values.push_back(probe());
  }
  return values;
}

/// When a trace is highest, by the parabola through its highest three [ticks; the first value is tick 1's].
inline double peak_time(const std::vector<double>& trace, std::size_t from = 0, std::size_t to = SIZE_MAX) {
  std::size_t best = from + 1;
  for (std::size_t i = from + 1; i + 1 < std::min(to, trace.size()); ++i)
    if (std::fabs(trace[i]) > std::fabs(trace[best])) best = i;
  const double a = trace[best - 1], b = trace[best], c = trace[best + 1];
  return double(best) + 1 + 0.5 * (a - c) / (a - 2 * b + c);
}

}  // namespace trocar::vessels::test
