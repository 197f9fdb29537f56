// Against the analytical results that svOneDSolver's own test cases state (tests/data/svonedsolver, units of cm, g, s):
// a tube with a resistance, one with a Windkessel, a bifurcation with resistances, a stenosis; rigid walls, steady
// flow. The stenosis' separation loss is our segment's `loss` [Young & Tsai 1973].
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;
namespace fs = std::filesystem;

const fs::path kCases = fs::path(TROCAR_SOURCE_DIR) / "tests/data/svonedsolver";
constexpr double kBarye = 0.1, kResistance = 1e5, kFlow = 1e-6;  // of cgs in SI

/// The words of a case's lines, without comments.
std::vector<std::vector<std::string>> lines_of(const std::string& name) {
  std::ifstream in(kCases / name);
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> row;
    for (std::string word; words >> word;) row.push_back(word);
    if (!row.empty()) lines.push_back(row);
  }
  return lines;
}

/// A case as a graph: SEGMENT name id length elements in out area_in area_out flow material loss .. .. .. end table
VesselGraph read_case(const std::string& name) {
  const auto lines = lines_of(name);
  std::map<std::string, std::vector<double>> tables;  // second column
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i][0] == "DATATABLE")
      for (std::size_t k = i + 1; lines[k][0] != "ENDDATATABLE"; ++k)
        tables[lines[i][1]].push_back(std::stod(lines[k][1]));
  VesselGraph g;
  g.blood = {.density = 1060, .viscosity = 4e-3};
  for (const auto& w : lines) {
    if (w[0] == "NODE") ++g.nodes;
    if (w[0] == "SOLVEROPTIONS")
      g.sources = {
          {.node = 0, .kind = VesselSource::Kind::pump, .wave = std::vector<double>(2, kFlow * tables[w[5]][0])}};
    if (w[0] != "SEGMENT") continue;
    VesselSegment s{.from = std::stoi(w[5]), .to = std::stoi(w[6]), .length = 1e-2 * std::stod(w[3])};
    s.radius = std::sqrt(1e-4 * std::stod(w[7]) / kPi);
    s.wall.wave_speed = 1000;
    g.segments.push_back(s);
    const std::vector<double>& end = tables[w.back()];
    if (w[15] == "RESISTANCE") g.ends.push_back({.node = s.to, .r_near = kResistance * end[0], .pressure = 0});
    if (w[15] == "RCR")
      g.ends.push_back({.node = s.to,
                        .r_near = kResistance * end[0],
                        .r_far = kResistance * end[2],
                        .compliance = 1e-5 * end[1],
                        .pressure = 0});
  }
  return g;
}

struct Expected {
  int node;
  double pressure;  // [dyn/cm^2]
};

void expect_pressures(const VesselGraph& g, const std::string& name, const std::vector<Expected>& expected) {
  Simulation sim(g);
  sim.run(20);
  for (const Expected& e : expected)
    expect_within("svOneDSolver " + name + ", pressure at node " + std::to_string(e.node),
                  node_pressure(sim.model, sim.state, e.node) / (kBarye * e.pressure) - 1, 1e-3);
}

TEST(SvOneDSolver, TubeWithAResistance) {
  expect_pressures(read_case("tube_r.in"), "tube_r", {{0, 11005.30965}, {1, 10000}});
}

TEST(SvOneDSolver, TubeWithAWindkessel) {
  expect_pressures(read_case("tube_rcr.in"), "tube_rcr", {{0, 11005.30965}, {1, 10000}});
}

TEST(SvOneDSolver, BifurcationWithResistances) {
  const VesselGraph g = read_case("bifurcation_R.in");
  expect_pressures(g, "bifurcation", {{0, 3997.46433118937}, {1, 3984.67700709878}, {2, 3958.0048}, {3, 3958.0048}});
  Simulation sim(g);
  sim.run(20);
  for (const int daughter : {1, 2})
    expect_within("svOneDSolver bifurcation, flow of a daughter",
                  read_wall(sim.model, sim.state, daughter, 0.5).flow / (kFlow * 3.9925) - 1, 1e-3);
}

TEST(SvOneDSolver, StenosisWithItsSeparationLoss) {
  VesselGraph g = read_case("tube_stenosis_r.in");
  // Young & Tsai: viscous loss of a corrected length, and K_t / 2 (S0 / S1 - 1)^2 rho (Q / S0)^2; ours is
  // loss rho / 2 (Q / S1)^2.
  const double s0 = 10, s1 = 5, diameter = std::sqrt(4 * s1 / kPi), kt = 1.52;
  g.segments[1].length = 1e-2 * (0.83 * 10 + 1.64 * diameter);
  g.segments[1].loss = kt * (s0 / s1 - 1) * (s0 / s1 - 1) * (s1 / s0) * (s1 / s0);
  Simulation sim(g);
  sim.run(20);
  const double drop = node_pressure(sim.model, sim.state, 1) - node_pressure(sim.model, sim.state, 2);
  expect_within("svOneDSolver stenosis, its own drop", drop / (kBarye * 130.5759137) - 1, 1e-3);
  expect_pressures(g, "stenosis", {{0, 10150.68211}, {3, 10000}});
}

}  // namespace
}  // namespace trocar::vessels
