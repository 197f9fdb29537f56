// Bodies with masses at the control points of their NURBS surface: the cage closes, weighs what the body does, and
// resists strains as the tissue does.
#include <gtest/gtest.h>

#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/tets/control_cage.hpp>

namespace trocar::tissue {
namespace {

namespace nurbs = geometry::nurbs;

/// Bent, of elliptical sections, along z.
nurbs::Surface bent_egg(int columns = 10) {
  nurbs::Surface s{nurbs::periodic_uniform(3, columns), nurbs::clamped_uniform(3, 8), {}, {}};
  const double r[] = {0, 0.010, 0.020, 0.024, 0.022, 0.017, 0.009, 0};
  const double z[] = {-0.040, -0.039, -0.028, -0.010, 0.008, 0.024, 0.036, 0.037};
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < columns; ++i) {
      const double a = portable::two_pi * i / columns;
      s.points.push_back({r[j] * portable::cos(a) + 6 * z[j] * z[j], 0.7 * r[j] * portable::sin(a), z[j]});
    }
  return nurbs::outwards(s);
}

TetMaterial soft() {
  TetMaterial m;
  m.youngs_modulus = 8e3;
  m.density = 1060;
  return m;
}

geometry::TriMesh fine_mesh(const nurbs::Surface& s) { return nurbs::tessellate(s, nurbs::Steps{20, 20}).mesh; }

TEST(ControlCage, FillsTheNetWithCellsThatMeetFaceToFace) {
  const nurbs::Surface s = bent_egg();
  const ControlCage cage = control_cage(s);
  EXPECT_EQ(cage.nodes.count, 10 * 6 + 2) << "each pole once";
  EXPECT_EQ(int(cage.points.size()), 62 + 6 * 11) << "copies and a middle line below";
  geometry::TetMesh mesh;
  mesh.points = cage.points;
  mesh.cells = cage.cells;
  const geometry::TetFacts facts = geometry::inspect(mesh);
  EXPECT_TRUE(facts.sound());
  EXPECT_EQ(facts.odd_edges, 0);
  const geometry::TetSurface outside = geometry::surface_of(mesh);
  for (const int node : outside.node) EXPECT_LT(node, cage.nodes.count) << "the surface is the control points'";
  EXPECT_EQ(int(outside.node.size()), cage.nodes.count);
  EXPECT_NEAR(geometry::volume(outside.mesh) / cage.volume, 1, 1e-12);
}

TEST(ControlCage, WeighsWhatTheBodyDoesAboutItsCentre) {
  const nurbs::Surface s = bent_egg();
  const ControlCage cage = control_cage(s);
  const double volume = nurbs::volume(s);
  const Vec3d centre = geometry::centre_of_volume(fine_mesh(s));
  EXPECT_LT(volume, 0.9 * cage.volume);
  const TetNetwork body = cage_network(cage, soft(), volume, centre);
  double mass = 0;
  Vec3d at;
  for (std::size_t i = 0; i < body.network.mass.size(); ++i) {
    mass += body.network.mass[i], at += body.network.mass[i] * body.network.positions[i];
    EXPECT_GT(body.network.mass[i], 0);
  }
  EXPECT_NEAR(mass / (1060 * volume), 1, 1e-12);
  EXPECT_LT(length(at / mass - centre), 1e-12);
}

/// Level at its poles, as what is smooth there is, and hollow on one side.
nurbs::Surface bean() {
  nurbs::Surface s = bent_egg(12);
  for (int j = 1; j < 7; ++j)
    for (int i = 0; i < 12; ++i) {
      Vec3d& p = s.points[std::size_t(12 * j + i)];
      if (j == 1 || j == 6) p.z = s.points[std::size_t(12 * (j == 1 ? 0 : 7))].z;
      const double x = p.x - 6 * p.z * p.z;
      if (j > 1 && j < 6 && x < -0.010) p.x += 2.4 * (-0.010 - x);
    }
  return s;
}

TEST(ControlCage, TakesSmoothPolesAndHollowSides) {
  const nurbs::Surface s = bean();
  const ControlCage cage = control_cage(s);
  EXPECT_GT(cage.folded_volume, 0);
  EXPECT_LT(cage.folded_volume, 0.2 * cage.volume);
  const double volume = nurbs::volume(s);
  const TetNetwork body = cage_network(cage, soft(), volume, geometry::centre_of_volume(fine_mesh(s)));
  EXPECT_LT(body.network.tets.size(), cage.cells.size()) << "folded cells are not guarded";
  EXPECT_LE(build(body.network, 1e-3).substeps, 12);
}

class ControlCageStrains : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(OfAnEggAndABean, ControlCageStrains, testing::Bool());

TEST_P(ControlCageStrains, AreResistedAsTheTissueDoes) {
  const nurbs::Surface s = GetParam() ? bean() : bent_egg();
  const ControlCage cage = control_cage(s);
  const double volume = nurbs::volume(s), lame = 0.4 * soft().youngs_modulus;  // both constants at nu = 1/4
  const TetNetwork body = cage_network(cage, soft(), volume, geometry::centre_of_volume(fine_mesh(s)));
  for (const Mat3d& strain : {Mat3d{{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}}, Mat3d{{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
                              Mat3d{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, Mat3d{{{0, 0.5, 0}, {0.5, 0, 0}, {0, 0, 0}}}}) {
    double energy = 0, square = 0, trace = 0;
    for (const SpringDescription& e : body.network.springs) {
      const Vec3d along = body.network.positions[std::size_t(e.b)] - body.network.positions[std::size_t(e.a)];
      const double stretch = dot(along, strain * along) / length(along);
      energy += 0.5 * e.k * stretch * stretch;
    }
    for (int i = 0; i < 3; ++i) {
      trace += strain.m[i][i];
      for (int k = 0; k < 3; ++k) square += strain.m[i][k] * strain.m[i][k];
    }
    EXPECT_NEAR(energy / (volume * (0.5 * lame * trace * trace + lame * square)), 1, 1e-9);
  }
}

TEST(ControlCage, RefusesNetsThatAreNoBodies) {
  nurbs::Surface crossed = bent_egg();
  for (int i = 0; i < 10; ++i) std::swap(crossed.points[std::size_t(20 + i)], crossed.points[std::size_t(50 + i)]);
  EXPECT_THROW(control_cage(crossed), std::invalid_argument);
  nurbs::Surface open = bent_egg();
  for (int i = 0; i < 10; ++i) open.points[std::size_t(i)].x += 0.001 * i;
  EXPECT_THROW(control_cage(open), std::invalid_argument);
  const ControlCage cage = control_cage(bent_egg());
  EXPECT_THROW(cage_network(cage, soft(), 1e-5, {1, 0, 0}), std::invalid_argument) << "no masses have that centre";
}

}  // namespace
}  // namespace trocar::tissue
