// A wider check than blocks and beams: the liver of the SOFA framework (181 nodes, 596 tetrahedra, cells of any shape),
// hanging from its upper third. Nobody has published where it comes to rest, so finite elements of our own, cut finer
// twice and extrapolated, say so. The network is made from the cells as they stand in the file.
//
// What is seen: the network on the file's cells sags a tenth too little, elements on the same cells a quarter (such
// elements are stiff where they are coarse). Cut finer once, the network sags as the limit does; pointwise some tens of
// per cent remain, since on cells of any shape the fit of tet_springs.hpp leaves a misfit of a quarter to a third.
// Springs along edges alone are far too soft, and the softer the finer the cells.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/tissue/network/network_reference.hpp>
#include <trocar/tissue/network/prestress.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

#include "linear_solve.hpp"
#include "tet_fem.hpp"
#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_within;

constexpr double kUnit = 0.0345;           // the file's unit, so that the liver has 1.5 litres [m]
constexpr double kE = 5.4e3, kRho = 1060;  // [Pa] [kg/m^3]
constexpr double kSmall = 0.5;             // weight for small displacements [m/s^2]
constexpr double kHangs = 0.3;             // share of its height by which it is held
const TetMaterial kLiver{.youngs_modulus = kE, .density = kRho, .p1 = 2, .p2 = 100, .cap = 0.35};

class SofaLiver : public testing::Test {
 protected:
  test::TetFem fem;
  std::vector<std::uint8_t> held;

  void SetUp() override {
    const std::filesystem::path path =
        std::filesystem::path(TROCAR_SOURCE_DIR) / "../shared/data/anatomy/sofa/liver.msh";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    std::stringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    const geometry::TetMesh mesh = geometry::repair(geometry::read_tets(bytes.str(), "liver.msh", kUnit).mesh).mesh;
    fem = {mesh.points, mesh.cells, kE, kRho};
    const geometry::Bounds box = geometry::inspect(mesh).box;
    for (const Vec3d& p : fem.points)
      held.push_back(p.y > box.high.y - kHangs * (box.high.y - box.low.y) ? std::uint8_t(kHeld) : std::uint8_t(kFree));
  }
};

std::vector<Vec3d> weight(const std::vector<double>& mass) {
  std::vector<Vec3d> load;
  for (const double m : mass) load.push_back({0, -kSmall * m, 0});
  return load;
}
double mean_sag(const std::vector<double>& mass, const std::vector<Vec3d>& u) {
  double moment = 0, sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) moment -= mass[i] * u[i].y, sum += mass[i];
  return moment / sum;
}
std::vector<Vec3d> network_solved(const test::TetFem& fem, const std::vector<std::uint8_t>& held, bool across_faces) {
  TetMaterial material = kLiver;
  material.across_faces = across_faces;
  return solve(tet_network(fem.points, fem.cells, material).network, weight(fem.masses()), held);
}
/// Root mean square of a - b over that of b, at the nodes that both have.
double rms_off(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double off = 0, size = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    off += dot(a[i] - b[i], a[i] - b[i]);
    size += dot(b[i], b[i]);
  }
  return std::sqrt(off / size);
}

TEST_F(SofaLiver, SagsAsItsFiniteElementsInTheLimit) {
  std::vector<test::TetFem> level{fem};
  std::vector<std::vector<std::uint8_t>> held_at{held};
  std::vector<std::vector<Vec3d>> u;
  std::vector<double> sag;
  for (int i = 0; i < 3; ++i) {
    if (i > 0) {
      held_at.push_back(held_at.back());
      level.push_back(test::refined(level.back(), held_at.back()));
    }
    const std::vector<double> mass = level.back().masses();
    u.push_back(test::solve(level.back(), weight(mass), held_at.back()));
    sag.push_back(mean_sag(mass, u.back()));
  }
  const double ratio = (sag[1] - sag[0]) / (sag[2] - sag[1]);
  const double limit = sag[2] + (sag[2] - sag[1]) / (ratio - 1);
  std::vector<Vec3d> at_limit = u[0];
  for (std::size_t i = 0; i < at_limit.size(); ++i) at_limit[i] = u[2][i] + (1 / (ratio - 1)) * (u[2][i] - u[1][i]);
  test::record("SOFA liver, elements' mean sag beside their limit, as in the file and finest, f64", "%.3f %.3f",
               sag[0] / limit, sag[2] / limit);
  test::expect_order("SOFA liver, elements' steps as cells are cut", "f64", {sag[1] - sag[0], sag[2] - sag[1]}, 1, 0.3);

  const auto off = [&](std::size_t i, bool across) {
    const std::vector<Vec3d> v = network_solved(level[i], held_at[i], across);
    test::record(std::string("SOFA liver, network ") + (across ? "" : "of edges alone ") +
                     (i == 0 ? "as in the file" : "cut finer") + ", rms off the limit; mean sag off, f64",
                 "%.3f %+.3f", rms_off(v, at_limit), mean_sag(level[i].masses(), v) / limit - 1);
    return mean_sag(level[i].masses(), v) / limit - 1;
  };
  expect_within("SOFA liver, mean sag of the network as in the file", "f64", off(0, true), 0.15);
  expect_within("SOFA liver, mean sag of the network cut finer", "f64", off(1, true), 0.05);
  EXPECT_GT(off(1, false), 0.5) << "why there are springs across faces";
}

/// The network under gravity, prestressed, damped as scenes damp; its cells not guarded against collapse, see below.
NetworkDescription hanging(const test::TetFem& fem, const std::vector<std::uint8_t>& held, double gravity) {
  NetworkDescription d = tet_network(fem.points, fem.cells, kLiver).network;
  d.fixed = held;
  const double damping_time = build(d, 1e-3).dt_limit / 7;
  for (SpringDescription& s : d.springs) s.damping = damping_time * s.k;
  d.tets.clear();
  d.gravity = {0, -gravity, 0};
  d.global_damping = 1;
  const PrestressReport report = prestress(d);
  EXPECT_TRUE(report.converged && report.failed_springs == 0);
  test::record("SOFA liver, largest strain and unbalanced force of prestress, f64", "%.3f %.1e N",
               report.largest_strain, report.residual);
  return d;
}

TEST_F(SofaLiver, HasTheMassOfItsVolume) {
  double mass = 0, volume = 0;
  for (const double m : tet_network(fem.points, fem.cells, kLiver).network.mass) mass += m;
  for (std::size_t t = 0; t < fem.cells.size(); ++t) volume += fem.shape(t).second;
  expect_within("SOFA liver, mass over density times volume", "f64", mass / (kRho * volume) - 1, 1e-6);
}

/// The kernel's liver.
struct Hung {
  NetworkModel model;
  NetworkState state;
  NetworkWork work;
  explicit Hung(const NetworkDescription& d)
      : model(build(d, 1e-3)), state(rest_state(model)), work(make_work(model)) {}
  void seconds(int n, std::span<const NodeLoad> loads = {}) {
    for (int t = 0; t < 1000 * n; ++t) ASSERT_TRUE(advance(model, loads, {}, state, work).fine());
  }
  double farthest() const {
    double most = 0;
    for (int i = 0; i < model.nodes; ++i)
      most = std::max(most, length(position(model, state, i) - model.rest[size_t(i)]));
    return most;
  }
};

TEST_F(SofaLiver, PulledAndLetGoItReturnsToItsDrawnShape) {
  Hung liver(hanging(fem, held, kSmall));
  liver.seconds(5);
  expect_within("SOFA liver, 0.5 m/s^2, 5 s as drawn, m from the drawn shape", "f32", liver.farthest(), 1e-7);
  int low = 0;
  const std::vector<Vec3d>& rest = liver.model.rest;
  for (int i = 0; i < liver.model.nodes; ++i)
    if (rest[size_t(i)].y < rest[size_t(low)].y) low = i;
  const NodeLoad pull{.node = low, .k = 5, .x0 = vec_cast<float>(rest[size_t(low)] + Vec3d{0.005, 0, 0.005})};
  liver.seconds(1, {&pull, 1});
  EXPECT_GT(liver.farthest(), 1e-3);
  liver.seconds(25);
  expect_within("SOFA liver, 0.5 m/s^2, 25 s after a pull, m from the drawn shape", "f32", liver.farthest(), 1e-7);
}

TEST_F(SofaLiver, UnderItsFullWeightASurfaceNodeGivesWay) {
  // Not as it should be, and kept in sight: the drawn shape is an equilibrium that does not last. A node of the surface
  // whose stiff springs lie nearly in a plane, pressed from the sides, buckles out of it by millimetres.
  Hung liver(hanging(fem, held, 9.81));
  liver.seconds(10);
  expect_within("SOFA liver, 9.81 m/s^2, 10 s as drawn, m from the drawn shape", "f32", liver.farthest(), 0.01);
}

TEST_F(SofaLiver, WithItsCellsGuardedItStaysCalm) {
  // Driven open within 1 ms, as small cells are, collapsed ones threw nodes to 10 to 80 m/s within a second: they are
  // driven no faster than twice a wave's time across a cell (TetNetwork's opening_time).
  NetworkDescription d = hanging(fem, held, kSmall);
  d.tets = fem.cells;
  Hung liver(d);
  for (int i = 0; i < liver.model.nodes; ++i)
    if (!held[size_t(i)]) set_velocity(liver.model, liver.state, i, {0.01, 0, 0.01});
  double fastest = 0;
  for (int t = 0; t < 2000; ++t) {
    advance(liver.model, {}, {}, liver.state, liver.work);
    for (int i = 0; i < liver.model.nodes; ++i)
      fastest = std::max(fastest, length(velocity(liver.model, liver.state, i)));
  }
  expect_within("SOFA liver, cells guarded, m/s within 2 s of 1 cm/s", "f32", fastest, 0.5);
}

TEST_F(SofaLiver, FloatFollowsDoubleAsItSwings) {
  const NetworkDescription d = hanging(fem, held, kSmall);
  Hung liver(d);
  const NetworkModel& m = liver.model;
  ReferenceNetwork<double> reference(d, m);
  for (int i = 0; i < m.nodes; ++i) {
    if (held[size_t(i)]) continue;
    set_velocity(m, liver.state, i, {0.003, 0, 0.003});
    reference.node(i).v = {0.003, 0, 0.003};
  }
  double moved = 0, worst = 0;
  for (int t = 0; t < 1000; ++t) {
    ASSERT_TRUE(advance(m, {}, {}, liver.state, liver.work).fine());
    for (int i = 0; i < m.substeps; ++i) reference.step(m.dt);
    for (int i = 0; i < m.nodes; ++i) {
      const Vec3d x = position(m, liver.state, i);
      moved = std::max(moved, length(x - m.rest[size_t(i)]));
      worst = std::max(worst, length(x - m.origin - reference.node(i).x));
    }
  }
  EXPECT_GT(moved, 5e-4);
  expect_within("SOFA liver, f32 beside f64 within 1 s, over the farthest move", "f32", worst / moved, 1e-3);
}

}  // namespace
}  // namespace trocar::tissue
