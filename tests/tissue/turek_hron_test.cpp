// A wider check than the beam formulas: the swinging bar of the benchmark CSM3 [Turek & Hron 2006], large deflections
// and all. The bar is 350 x 20 mm, clamped on the left, rho 1000, let go under 2 m/s^2 in plane strain. Its material
// has nu = 0.4, springs have 1/4; what bends a thin bar in plane strain is E / (1 - nu^2), so that is made equal.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/tissue/lattice_springs.hpp>

namespace trocar::tissue {
namespace {

struct Swing {
  double period = 0, low = 0, high = 0;  // [s] [m]
};

/// From a history of the tip's height: extremes, and the mean time between the first and the last trough.
Swing swing_of(const std::vector<double>& time, const std::vector<double>& height) {
  Swing s;
  std::vector<double> troughs;
  double middle = 0;
  for (const double h : height) middle += h / double(height.size());
  for (std::size_t i = 1; i + 1 < height.size(); ++i) {
    s.low = std::min(s.low, height[i]);
    s.high = std::max(s.high, height[i]);
    if (height[i] >= middle || height[i] > height[i - 1] || height[i] >= height[i + 1]) continue;
    const double a = height[i - 1], b = height[i], c = height[i + 1];  // the parabola's lowest point
    const double t = time[i] + 0.5 * (a - c) / (a - 2 * b + c) * (time[i + 1] - time[i]);
    if (troughs.empty() || t - troughs.back() > 0.5) troughs.push_back(t);
  }
  if (troughs.size() > 1) s.period = (troughs.back() - troughs.front()) / double(troughs.size() - 1);
  return s;
}

Swing simulated(int cells_deep, double seconds) {
  const double deep = 0.02, h = deep / cells_deep;
  const int nx = 35 * cells_deep / 2;
  const BoxLattice box = box_lattice(nx, cells_deep, 1, h);
  const double young = 1.4e6 * (1 - 0.25 * 0.25) / (1 - 0.4 * 0.4);
  NetworkDescription d =
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = young, .density = 1000}).network;
  d.gravity = {0, -2, 0};
  for (int k = 0; k <= 1; ++k)
    for (int j = 0; j <= cells_deep; ++j)
      for (int i = 0; i <= nx; ++i) d.fixed[size_t(box.corner(i, j, k))] = i == 0 ? kHeld : kHeldZ;
  const NetworkModel model = build(d, 1e-3);
  NetworkState s = rest_state(model);
  NetworkWork w = make_work(model);
  const int tip = box.corner(nx, cells_deep / 2, 0);
  std::vector<double> time, height;
  for (int tick = 1; tick <= int(seconds * 1000); ++tick) {
    EXPECT_TRUE(advance(model, {}, {}, s, w).fine());
    if (tick % 5 != 0) continue;
    time.push_back(tick * 1e-3);
    height.push_back(position(model, s, tip).y - deep / 2);
  }
  return swing_of(time, height);
}

Swing published() {
  std::ifstream in(std::filesystem::path(TROCAR_SOURCE_DIR) /
                   "../shared/data/physics/turek_hron_beam/reference_turek.csv");
  std::vector<double> time, height;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream row(line);
    double t = 0, x = 0, y = 0;
    char comma = 0;
    if (row >> t >> comma >> x >> comma >> y) time.push_back(t), height.push_back(y);
  }
  return swing_of(time, height);
}

TEST(TurekHron, TheSwingingBarKeepsPeriodAndAmplitude) {
  const Swing reference = published();
  if (reference.period == 0) GTEST_SKIP() << "../shared/data/physics/turek_hron_beam is not there";
  const Swing coarse = simulated(4, 3.5), fine = simulated(8, 3.5);
  EXPECT_NEAR(fine.period, reference.period, 0.02 * reference.period);
  EXPECT_NEAR(fine.low, reference.low, 0.03 * std::fabs(reference.low));
  EXPECT_NEAR(fine.high, reference.high, 0.02 * std::fabs(reference.low));
  const auto error = [&](const Swing& s) { return std::fabs(s.period - reference.period) / reference.period; };
  EXPECT_LT(error(fine), 0.5 * error(coarse)) << "halved cells, less than half the error";
  RecordProperty("period_error_4_cells", std::to_string(error(coarse)));
  RecordProperty("period_error_8_cells", std::to_string(error(fine)));
}

}  // namespace
}  // namespace trocar::tissue
