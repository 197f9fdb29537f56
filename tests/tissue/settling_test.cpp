// Speeds below what a float can add to a position in a sub-step are lost: at 0.1 m and 0.2 ms a node slower than 2e-5
// m/s does not move. Does that keep a settling organ from its place? Prestress makes the drawn shape the equilibrium,
// in double to 1e-11 N, so how far a body stays from it after it was pulled and let go is what float costs.
//
// It is little: a node that does not move gathers speed until it does, because its force stays. Only drag against space
// holds it back, by that speed times gamma over the square of the slowest mode's frequency; solids have gamma = 1 1/s.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/network_reference.hpp>
#include <trocar/tissue/network/prestress.hpp>

#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_within;

struct Organ {
  const char* name;
  double modulus, p1, p2, cap, cell;  ///< [Pa] .. [m]
  int nx, ny, nz;
  double gamma = 1;  ///< [1/s]
};
constexpr Organ kUterus{"uterus, 96 mm long", 30e3, 5, 100, 0.3, 0.008, 12, 6, 5};
constexpr Organ kLiver{"liver, 192 mm wide", 5.4e3, 2, 100, 0.35, 0.012, 16, 10, 6};
constexpr Organ kOvary{"ovary, 24 mm long", 8e3, 3, 50, 0.5, 0.004, 6, 4, 4};

/// As scenes compile solids: damping along springs a seventh of the undamped limit. The liver hangs from its upper
/// face, the others stand out from the face x = 0.
NetworkDescription description(const Organ& o) {
  const BoxLattice box = box_lattice(o.nx, o.ny, o.nz, o.cell);
  NetworkDescription d =
      lattice_network(box.corners, box.cells, {},
                      {.youngs_modulus = o.modulus, .density = 1050, .p1 = o.p1, .p2 = o.p2, .cap = o.cap})
          .network;
  const double damping_time = build(d, 1e-3).dt_limit / 7;
  for (SpringDescription& s : d.springs) s.damping = damping_time * s.k;
  const bool hangs = o.name == kLiver.name;
  for (std::size_t i = 0; i < d.positions.size(); ++i) {
    const Vec3d x = d.positions[i];
    if (hangs ? x.z > o.nz * o.cell - 1e-9 : x.x < 1e-9) d.fixed[i] = kHeld;
  }
  d.gravity = {0, 0, -9.81};
  d.global_damping = o.gamma;
  const PrestressReport report = prestress(d);
  EXPECT_TRUE(report.converged && report.failed_springs == 0);
  EXPECT_LT(report.residual, 1e-11);
  return d;
}

double farthest(const NetworkModel& m, const NetworkState& s) {
  double most = 0;
  for (int i = 0; i < m.nodes; ++i) most = std::max(most, length(position(m, s, i) - m.rest[size_t(i)]));
  return most;
}

/// Where the kernel leaves the organ, its free corner pulled up or down by about a cell for a second, then let go.
NetworkState settled(const NetworkModel& m, const Organ& o, double way, int seconds) {
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  const int corner = o.nx + (o.nx + 1) * o.ny;  // of the lower face, far from x = 0
  const Vec3d goal = m.rest[size_t(corner)] + Vec3d{0, 0.002, way * o.cell};
  const NodeLoad pull{.node = corner, .k = 50, .x0 = vec_cast<float>(goal)};
  for (int t = 0; t < 1000; ++t) advance(m, {&pull, 1}, {}, s, w);
  EXPECT_GT(farthest(m, s), 1e-3);
  for (int t = 0; t < 1000 * seconds; ++t) advance(m, {}, {}, s, w);
  return s;
}

void expect_settled(const Organ& o, int seconds, double within) {
  const NetworkModel m = build(description(o), 1e-3);
  const NetworkState above = settled(m, o, 1, seconds), below = settled(m, o, -1, seconds);
  const std::string what = std::string("settling, ") + o.name + ", " + std::to_string(seconds) + " s";
  expect_within(what + ", m from the drawn shape", "f32", std::max(farthest(m, above), farthest(m, below)), within);
  double gap = 0;
  for (int i = 0; i < m.nodes; ++i) gap = std::max(gap, length(position(m, above, i) - position(m, below, i)));
  expect_within(what + ", m between coming from above and from below", "f32", gap, 2 * within);
}

TEST(Settling, AUterusDoesNotFreezeATenthOfAMicrometreAway) { expect_settled(kUterus, 20, 1e-7); }
TEST(Settling, ALiverDoesNotFreezeATenthOfAMicrometreAway) { expect_settled(kLiver, 20, 1e-7); }
TEST(Settling, AnOvaryDoesNotFreezeATenthOfAMicrometreAway) { expect_settled(kOvary, 20, 1e-7); }

/// How far the plain reference is from the drawn shape after a push and so many sub-steps.
template <class Real>
double reference_settled(const NetworkDescription& d, const NetworkModel& m, int steps) {
  ReferenceNetwork<Real> network(d, m);
  for (int i = 0; i < m.nodes; ++i)
    if (d.fixed[size_t(i)] == kFree) network.node(i).v = {0, Real(0.02), Real(0.05)};
  for (int n = 0; n < steps; ++n) network.step(m.dt);
  double most = 0;
  for (int i = 0; i < m.nodes; ++i)
    most = std::max(most, length(vec_cast<double>(network.node(i).x) - (m.rest[size_t(i)] - m.origin)));
  return most;
}

TEST(Settling, InDoubleItReachesTheDrawnShape) {
  // With much drag, so that it is soon at rest: what float leaves in the same time is float's.
  Organ ovary = kOvary;
  ovary.gamma = 30;
  const NetworkDescription d = description(ovary);
  const NetworkModel m = build(d, 1e-3);
  expect_within("settling, ovary with drag 30 1/s, 1.5 s, m from the drawn shape", "f64",
                reference_settled<double>(d, m, 1500 * m.substeps), 1e-9);
  expect_within("settling, ovary with drag 30 1/s, 1.5 s, m from the drawn shape", "f32",
                reference_settled<float>(d, m, 1500 * m.substeps), 1e-7);
}

TEST(Settling, WithDragThatNoTissueHasItWouldFreeze) {
  // The measure can tell: a thousand times the drag, and the same uterus stops where it is too slow for float.
  Organ uterus = kUterus;
  uterus.gamma = 1000;
  const NetworkModel m = build(description(uterus), 1e-3);
  NetworkState s = settled(m, uterus, 1, 10);
  const double stuck = farthest(m, s);
  NetworkWork w = make_work(m);
  for (int t = 0; t < 2000; ++t) advance(m, {}, {}, s, w);
  test::record("settling, uterus with drag 1000 1/s, 10 s, m from the drawn shape, f32", "%.2e (more than %.2g)", stuck,
               1e-6);
  EXPECT_GT(stuck, 1e-6);
  EXPECT_NEAR(farthest(m, s), stuck, 0.01 * stuck) << "it is stuck, not slow";
}

}  // namespace
}  // namespace trocar::tissue
