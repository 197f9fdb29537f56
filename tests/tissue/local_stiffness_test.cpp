// Tissue that differs from place to place: springs by a field, and lattices with fibres.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/spring_medium.hpp>
#include <trocar/tissue/network/stiffness_field.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

#include "closed_sheets.hpp"
#include "linear_solve.hpp"

namespace trocar::tissue {
namespace {

constexpr double kE = 20e3, kRho = 1050;

struct PulledLattice {
  int n = 8;
  double h = 0.005;
  BoxLattice box = box_lattice(n, n, n, h);

  /// Faces to which the stress pull * along along^T leaves its force, shared out evenly.
  std::vector<Vec3d> loads(Vec3d along, double pull) const {
    std::vector<Vec3d> load(box.corners.size());
    for (int axis = 0; axis < 3; ++axis)
      for (int u = 0; u <= n; ++u)
        for (int v = 0; v <= n; ++v) {
          const double share = (u == 0 || u == n ? 0.5 : 1) * (v == 0 || v == n ? 0.5 : 1);
          const Vec3d force = (pull * along[axis] * share * h * h) * along;
          load[size_t(corner(axis, u, v, n))] += force;
          load[size_t(corner(axis, u, v, 0))] -= force;
        }
    return load;
  }
  int corner(int axis, int u, int v, int w) const {
    int at[3];
    at[axis] = w, at[(axis + 1) % 3] = u, at[(axis + 2) % 3] = v;
    return box.corner(at[0], at[1], at[2]);
  }
  /// Young's modulus along a unit vector: of the mean stretch of the whole block [Pa].
  double modulus(const NetworkDescription& d, Vec3d along) const {
    std::vector<bool> held(d.positions.size(), false);
    held[size_t(box.corner(n / 2, n / 2, n / 2))] = held[size_t(box.corner(n / 2 + 1, n / 2, n / 2))] =
        held[size_t(box.corner(n / 2, n / 2 + 1, n / 2))] = true;
    const double pull = 1e-3 * kE;
    const std::vector<Vec3d> u = solve(d, loads(along, pull), held);
    double strain = 0;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d apart;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) apart += u[size_t(corner(axis, i, j, n))] - u[size_t(corner(axis, i, j, 0))];
      strain += along[axis] * dot(along, apart) / ((n + 1.0) * (n + 1.0) * n * h);
    }
    return pull / strain;
  }
  NetworkDescription network(Vec3d fibre = {}, double ratio = 1) const {
    LatticeMaterial m{.youngs_modulus = kE, .density = kRho};
    m.fibre = fibre, m.fibre_ratio = ratio;
    return lattice_network(box.corners, box.cells, {}, m).network;
  }
};

TEST(LatticeFibres, ABlockIsAboutAsMuchStifferAlongThemAsAsked) {
  // A cubic lattice has no isotropic sixth moments of directions: what comes out depends on how the fibres lie in it.
  const PulledLattice block;
  const Vec3d lie[][3] = {
      {{0, 0, 1}, {1, 0, 0}, {1, 1, 0}}, {{1, 1, 0}, {1, -1, 0}, {0, 0, 1}}, {{1, 1, 1}, {1, -1, 0}, {1, 1, -2}}};
  int pulled = 0;
  for (const auto& [ratio, within] : {std::pair{1.5, 0.14}, std::pair{2.0, 0.25}})
    for (const auto& [fibre, across, other] : lie) {
      const NetworkDescription d = block.network(fibre, ratio);
      const double along = block.modulus(d, normalised(fibre));
      for (const Vec3d& aside : {across, other}) {
        const double e = block.modulus(d, normalised(aside));
        EXPECT_NEAR(along / e, ratio, within * ratio) << fibre.x << fibre.y << fibre.z << " asked " << ratio;
        EXPECT_NEAR(e, kE, 0.22 * kE) << fibre.x << fibre.y << fibre.z << " asked " << ratio;
        RecordProperty("measured_" + std::to_string(++pulled), std::to_string(along / e));
      }
    }
}

TEST(LatticeFibres, EveryCellMayHaveItsOwn) {
  const PulledLattice block;
  const LatticeMaterial m{.youngs_modulus = kE, .density = kRho, .fibre_ratio = 1.5};
  std::vector<Vec3d> fibres(block.box.cells.size(), Vec3d{0, 2, 0});
  const NetworkDescription same = block.network({0, 1, 0}, 1.5);
  const NetworkDescription each = lattice_network(block.box.corners, block.box.cells, {}, m, fibres).network;
  for (std::size_t i = 0; i < same.springs.size(); ++i) EXPECT_EQ(each.springs[i].k, same.springs[i].k);
  fibres.pop_back();
  EXPECT_THROW(lattice_network(block.box.corners, block.box.cells, {}, m, fibres), std::invalid_argument);
}

TEST(LatticeFibres, NoneLeaveTheVerySameBits) {
  const PulledLattice block;
  const NetworkDescription plain = block.network(), ratio_alone = block.network({}, 2), one = block.network({1, 0, 0});
  for (std::size_t i = 0; i < plain.springs.size(); ++i) {
    EXPECT_EQ(ratio_alone.springs[i].k, plain.springs[i].k);
    EXPECT_EQ(one.springs[i].k, plain.springs[i].k);
  }
}

TEST(StiffnessField, TwiceEverywhereMakesABlockTwiceAsStiff) {
  const PulledLattice block;
  NetworkDescription d = block.network();
  const double before = block.modulus(d, {1, 0, 0});
  stiffen(d, [](Vec3d) { return 2.0; });
  EXPECT_NEAR(block.modulus(d, {1, 0, 0}), 2 * before, 0.01 * before);
}

TEST(StiffnessField, ASoftPatchGivesWayMore) {
  const PulledLattice block;
  const Vec3d patch{0.005, 0.005, 0.04};
  NetworkDescription d = block.network();
  stiffen(d, [&](Vec3d p) { return length(p - patch) < 0.01 ? 0.2 : 1.0; });
  std::vector<bool> held(d.positions.size(), false);
  for (int i = 0; i <= block.n; ++i)
    for (int j = 0; j <= block.n; ++j) held[size_t(block.box.corner(i, j, 0))] = true;
  const auto dent = [&](int node) {
    std::vector<Vec3d> load(d.positions.size());
    load[size_t(node)].z = -0.01;
    return -solve(d, load, held)[size_t(node)].z;
  };
  EXPECT_GT(dent(block.box.corner(1, 1, block.n)), 2.5 * dent(block.box.corner(block.n - 1, block.n - 1, block.n)));
}

TEST(StiffnessField, ABodyThatCanBeCutCarriesItInItsCells) {
  CuttableDescription d;
  d.points = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}, {0, 0, -0.01}};
  d.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  d.material = {.youngs_modulus = kE, .density = kRho};
  const CuttableModel plain = build(d, 1e-3);
  d.stiffness = [](Vec3d p) { return p.z > 0 ? 3.0 : 1.0; };
  const CuttableModel stiff = build(d, 1e-3);
  EXPECT_FLOAT_EQ(stiff.brings[0].edge[5], 3 * plain.brings[0].edge[5]) << "the edge of the corners 2 and 3 is above";
  EXPECT_FLOAT_EQ(stiff.brings[1].edge[5], plain.brings[1].edge[5]) << "that of 1 and 4 below";
}

TEST(StiffnessField, AWallStretchesAndBendsByIt) {
  MembraneDescription d = test::wall(test::sphere(2));
  const NetworkDescription plain = network_of(d);
  const MembraneModel soft = build(d, 1e-3);
  d.stiffness = [](Vec3d) { return 2.0; };
  const NetworkDescription stiff = network_of(d);
  const MembraneModel model = build(d, 1e-3);
  for (std::size_t i = 0; i < plain.springs.size(); ++i) EXPECT_DOUBLE_EQ(stiff.springs[i].k, 2 * plain.springs[i].k);
  ASSERT_EQ(model.bends.size(), soft.bends.size());
  for (std::size_t i = 0; i < model.bends.size(); ++i) EXPECT_FLOAT_EQ(model.bends[i].k, 2 * soft.bends[i].k);
}

}  // namespace
}  // namespace trocar::tissue
