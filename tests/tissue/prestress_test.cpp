#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/prestress.hpp>

namespace trocar::tissue {
namespace {

/// An organ of the given stiffness: a rounded block of 8 x 5 x 5 cells, held as `hold` says.
template <class Hold>
NetworkDescription organ(double modulus, double p1, double p2, double cap, double h, Hold&& hold) {
  const BoxLattice box = box_lattice(8, 5, 5, h, {-0.03, 0.02, 0.05});
  std::vector<double> fill;
  for (std::size_t c = 0; c < box.cells.size(); ++c) fill.push_back(c % 8 == 0 || c % 8 == 7 ? 0.4 : 1.0);
  NetworkDescription d =
      lattice_network(
          box.corners, box.cells, fill,
          {.youngs_modulus = modulus, .density = 1050, .p1 = p1, .p2 = p2, .cap = cap, .damping_time = 2e-4})
          .network;
  for (int k = 0; k <= 5; ++k)
    for (int j = 0; j <= 5; ++j)
      for (int i = 0; i <= 8; ++i)
        if (hold(i, j, k)) d.fixed[box.corner(i, j, k)] = kHeld;
  d.gravity = {0, 0, -9.81};
  d.global_damping = 1;
  return d;
}

struct Settled {
  double moved = 0, speed = 0;
  bool fine = true;
};
Settled settle(const NetworkDescription& d, std::span<const Anchor> anchors = {}) {
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  std::vector<NodeLoad> loads;
  for (const Anchor& a : anchors) loads.push_back({.node = a.node, .k = float(a.k), .x0 = vec_cast<float>(a.x0)});
  Settled out;
  for (int t = 0; t < 5000; ++t) {
    out.fine = advance(m, loads, {}, s, w).fine() && out.fine;
    for (int i = 0; t % 100 == 99 && i < m.nodes; ++i)
      out.moved = std::max(out.moved, length(position(m, s, i) - m.rest[i]));
  }
  for (int i = 0; i < m.nodes; ++i) out.speed = std::max(out.speed, length(velocity(m, s, i)));
  return out;
}

TEST(Prestress, DrawnShapeHangsStillForFiveSeconds) {
  struct Case {
    const char* name;
    double modulus, p1, p2, cap, h;
  };
  for (const Case& c : {Case{"uterus", 30e3, 5, 100, 0.3, 0.01}, Case{"liver", 5.4e3, 2, 100, 0.35, 0.012},
                        Case{"ovary", 8e3, 3, 50, 0.5, 0.004}}) {
    NetworkDescription d = organ(c.modulus, c.p1, c.p2, c.cap, c.h, [](int i, int, int) { return i == 0; });
    const double before = largest_imbalance(d);
    const PrestressReport report = prestress(d);
    ASSERT_TRUE(report.converged) << c.name;
    EXPECT_EQ(report.failed_springs, 0) << c.name;
    EXPECT_LT(report.residual, 1e-7 * before) << c.name;
    const Settled end = settle(d);
    EXPECT_TRUE(end.fine);
    EXPECT_LT(end.moved, 1e-4) << c.name << ", largest strain " << report.largest_strain;
    EXPECT_LT(end.speed, 1e-3) << c.name;
    RecordProperty(std::string(c.name) + "_residual_N", std::to_string(report.residual));
    RecordProperty(std::string(c.name) + "_moved_um", std::to_string(1e6 * end.moved));
    RecordProperty(std::string(c.name) + "_largest_strain", std::to_string(report.largest_strain));
  }
}

TEST(Prestress, WithoutItTheSameOrganSags) {
  const NetworkDescription d = organ(30e3, 5, 100, 0.3, 0.01, [](int i, int, int) { return i == 0; });
  EXPECT_GT(settle(d).moved, 1e-3);
}

TEST(Prestress, AnchorsTakeTheirShareOfTheWeight) {
  NetworkDescription d = organ(30e3, 5, 100, 0.3, 0.01, [](int, int, int) { return false; });
  std::vector<Anchor> anchors;
  for (int i = 0; i < int(d.positions.size()); i += 7) anchors.push_back({.node = i, .k = 20});
  const PrestressReport report = prestress(d, anchors);
  ASSERT_TRUE(report.converged);
  double lifted = 0, weight = 0;
  for (const Anchor& a : anchors) lifted += a.k * (a.x0.z - d.positions[a.node].z);
  for (double m : d.mass) weight += 9.81 * m;
  EXPECT_NEAR(lifted, weight, 1e-6 * weight);
  EXPECT_LT(settle(d, anchors).moved, 1e-4);
}

TEST(Prestress, ABodyThatNothingHoldsIsNotTouched) {
  NetworkDescription d = organ(30e3, 5, 100, 0.3, 0.01, [](int, int, int) { return false; });
  const NetworkDescription before = d;
  EXPECT_FALSE(prestress(d).converged);
  for (std::size_t s = 0; s < d.springs.size(); ++s) EXPECT_EQ(d.springs[s].rest_length, before.springs[s].rest_length);
}

TEST(Prestress, IsTheSameEveryTime) {
  const auto make = [] {
    NetworkDescription d = organ(30e3, 5, 100, 0.3, 0.01, [](int i, int, int) { return i == 0; });
    prestress(d);
    return d;
  };
  const NetworkDescription a = make(), b = make();
  for (std::size_t s = 0; s < a.springs.size(); ++s) EXPECT_EQ(a.springs[s].rest_length, b.springs[s].rest_length);
}

}  // namespace
}  // namespace trocar::tissue
