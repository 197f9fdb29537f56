#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/geometry/volumes/embed.hpp>
#include <trocar/geometry/volumes/lattice.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/quat.hpp>

#include "shapes.hpp"

using namespace trocar;
using namespace trocar::geometry;

namespace {

Vec3d random_point(core::Random& random, double range) {
  const double x = random.uniform(-range, range), y = random.uniform(-range, range), z = random.uniform(-range, range);
  return {x, y, z};
}
double filled_volume(const Lattice& lattice) {
  double sum = 0;
  for (double fill : lattice.cell_fill) sum += fill * lattice.cell * lattice.cell * lattice.cell;
  return sum;
}
/// A tube 20 mm thick in a hairpin, its legs 1 mm from each other, and how far along it each vertex is.
struct Hairpin {
  TriMesh mesh;
  std::vector<double> along;

  Hairpin() {
    std::vector<Section> sections;
    const auto add = [&](Vec3d centre, Vec3d across) { sections.push_back({centre, across, {0, 0, 0.010}}); };
    for (int k = 0; k < 12; ++k) add({0.008 * k, 0, 0}, {0, 0.010, 0});
    for (int k = 1; k < 6; ++k) {
      const double turn = portable::pi * (k / 6.0 - 0.5), c = portable::cos(turn), s = portable::sin(turn);
      add({0.088 + 0.0105 * c, 0.0105 + 0.0105 * s, 0}, {-0.010 * c, -0.010 * s, 0});
    }
    for (int k = 11; k >= 0; --k) add({0.008 * k, 0.021, 0}, {0, -0.010, 0});
    double way = 0;
    for (std::size_t i = 1; i < sections.size(); ++i) way += length(sections[i].centre - sections[i - 1].centre);
    const Tessellation drawn = tessellate_with_parameters(loft(sections), 0.0025);
    mesh = drawn.mesh;
    for (const auto& uv : drawn.parameters) along.push_back(way * uv[1]);
  }
  /// The lattice whose parts hang together up to `apart` along it.
  Lattice filled(double apart) const {
    LatticeOptions options;
    options.along = along;
    options.apart = apart;
    return make_lattice(mesh, 0.006, options);
  }
};
/// Do cells of the two legs share a node, away from the bend?
bool welded(const Lattice& lattice) {
  std::vector<Vec3d> middle(lattice.cells.size());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for (const int n : lattice.cells[c]) middle[c] += 0.125 * lattice.nodes[n];
  const auto on_leg = [&](std::size_t c, bool second) {
    return middle[c].x > 0.01 && middle[c].x < 0.05 && (middle[c].y > 0.0105) == second;
  };
  std::set<int> first;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    if (on_leg(c, false)) first.insert(lattice.cells[c].begin(), lattice.cells[c].end());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    if (on_leg(c, true))
      for (const int n : lattice.cells[c])
        if (first.count(n)) return true;
  return false;
}

Mat3d some_turn() { return to_mat3(quat_from_axis_angle(Vec3d{1, 2, 3}, 0.7)); }

}  // namespace

TEST(Lattice, OfABoxThatCellsFitIsThatBox) {
  const Lattice lattice = make_lattice(box_mesh({0.04, 0.03, 0.02}), 0.01);
  EXPECT_EQ(lattice.dims, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(lattice.cells.size(), 24u);
  EXPECT_EQ(lattice.nodes.size(), 60u);
  for (double fill : lattice.cell_fill) EXPECT_EQ(fill, 1.0);
  EXPECT_EQ(pieces(lattice), 1);
}

TEST(Lattice, FillSumsToTheVolumeAlsoInATurnedFrame) {
  const TriMesh sphere = sphere_mesh(0.03, 4);
  for (const Mat3d& frame : {Mat3d::identity(), some_turn()}) {
    LatticeOptions options;
    options.least_fill = 0.0;
    options.frame = frame;
    const Lattice lattice = make_lattice(sphere, 0.004, options);
    EXPECT_NEAR(filled_volume(lattice) / volume(sphere), 1, 0.01);
  }
}

TEST(Lattice, FillIsTheShareInsideOfEachCell) {
  const double radius = 0.03;
  LatticeOptions options;
  options.samples = 8;
  options.frame = some_turn();
  const Lattice lattice = make_lattice(sphere_mesh(radius, 5), 0.007, options);
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    int inside = 0;
    constexpr int n = 20;
    for (int s = 0; s < n * n * n; ++s) {
      const Vec3d place{lattice.places[c][0] + (s % n + 0.5) / n, lattice.places[c][1] + (s / n % n + 0.5) / n,
                        lattice.places[c][2] + (s / (n * n) + 0.5) / n};
      inside += length(lattice.origin + lattice.frame * (lattice.cell * place)) < radius;
    }
    EXPECT_NEAR(lattice.cell_fill[c], double(inside) / (n * n * n), 0.05);
    EXPECT_GT(lattice.cell_fill[c], 0.05);
  }
}

TEST(Lattice, NodesAreNumberedInOrderUsedAndSharedByNeighbours) {
  LatticeOptions options;
  options.frame = some_turn();
  const Lattice lattice = make_lattice(sphere_mesh(0.03, 4), 0.005, options);
  std::set<int> used;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for (int k = 0; k < 8; ++k) {
      const int n = lattice.cells[c][k];
      used.insert(n);
      const Vec3d q = lattice.in_cells(lattice.nodes[n]);
      const Vec3d expected{double(lattice.places[c][0] + (k & 1)), double(lattice.places[c][1] + (k >> 1 & 1)),
                           double(lattice.places[c][2] + (k >> 2))};
      EXPECT_LT(length(q - expected), 1e-12);
    }
  EXPECT_EQ(used.size(), lattice.nodes.size());
  EXPECT_EQ(*used.rbegin(), int(lattice.nodes.size()) - 1);
  for (std::size_t n = 1; n < lattice.nodes.size(); ++n) {
    const Vec3d a = lattice.in_cells(lattice.nodes[n - 1]), b = lattice.in_cells(lattice.nodes[n]);
    EXPECT_TRUE(b.z > a.z + 0.5 || (b.z > a.z - 0.5 && (b.y > a.y + 0.5 || (b.y > a.y - 0.5 && b.x > a.x + 0.5))));
  }
  EXPECT_EQ(pieces(lattice), 1);
}

TEST(Lattice, TwoBodiesAreTwoPiecesAndAHollowOneKeepsItsHole) {
  TriMesh two = sphere_mesh(0.01, 3);
  const TriMesh other = two;
  const int n = int(two.positions.size());
  for (Vec3d p : other.positions) two.positions.push_back(p + Vec3d{0.05, 0, 0});
  for (auto t : other.triangles) two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  EXPECT_EQ(pieces(make_lattice(two, 0.004)), 2);

  TriMesh hollow = sphere_mesh(0.03, 4);
  const int m = int(hollow.positions.size());
  for (Vec3d p : sphere_mesh(0.02, 4).positions) hollow.positions.push_back(p);
  for (auto t : sphere_mesh(0.02, 4).triangles) hollow.triangles.push_back({t[0] + m, t[2] + m, t[1] + m});
  LatticeOptions options;
  options.least_fill = 0.0;
  const Lattice lattice = make_lattice(hollow, 0.003, options);
  EXPECT_NEAR(filled_volume(lattice) / volume(hollow), 1, 0.01);
}

TEST(Lattice, LoopsBesideEachOtherDoNotHangTogether) {
  const Hairpin hairpin;
  const Lattice plain = make_lattice(hairpin.mesh, 0.006), looped = hairpin.filled(0.045);
  EXPECT_TRUE(welded(plain)) << "a gap of 1 mm between cells of 6 mm";
  EXPECT_GT(looped.nodes.size(), plain.nodes.size() + 20);
  EXPECT_EQ(pieces(looped), 1) << "by way of the bend";
  EXPECT_NEAR(filled_volume(looped) / volume(hairpin.mesh), 1, 0.03);
  for (std::size_t c = 0; c < looped.cells.size(); ++c) {
    std::set<int> nodes(looped.cells[c].begin(), looped.cells[c].end());
    EXPECT_EQ(nodes.size(), 8u);
    const Vec3d place{double(looped.places[c][0]), double(looped.places[c][1]), double(looped.places[c][2])};
    EXPECT_LT(length(looped.in_cells(looped.nodes[looped.cells[c][0]]) - place), 1e-9);
  }
  // what shares a node is near along the body, too
  std::vector<double> low(looped.nodes.size(), 1), high(looped.nodes.size(), 0);
  for (std::size_t c = 0; c < looped.cells.size(); ++c)
    for (const int n : looped.cells[c]) {
      low[n] = std::min(low[n], looped.cell_along[c]);
      high[n] = std::max(high[n], looped.cell_along[c]);
    }
  for (std::size_t n = 0; n < looped.nodes.size(); ++n) EXPECT_LT(high[n] - low[n], 0.06) << n;
  // and the skin follows its own loop
  const Embedding skin = embed(looped, hairpin.mesh.positions, hairpin.along);
  for (std::size_t i = 0; i < skin.cells.size(); ++i)
    EXPECT_LE(std::fabs(looped.cell_along[skin.cells[i]] - hairpin.along[i]), 0.045);
  EXPECT_LT(skin.farthest, 0.006);
}

TEST(Lattice, ABodyThatDoesNotComeNearItselfIsFilledAsWithoutWaysAlong) {
  const Hairpin hairpin;
  const Lattice plain = make_lattice(hairpin.mesh, 0.006), one = hairpin.filled(1.0);
  EXPECT_EQ(one.cells, plain.cells);
  EXPECT_EQ(one.nodes.size(), plain.nodes.size());
  EXPECT_EQ(one.cell_fill, plain.cell_fill);
  EXPECT_TRUE(one.cell_along.empty());
  LatticeOptions options;
  options.along = std::span<const double>(hairpin.along).first(3);
  EXPECT_THROW(make_lattice(hairpin.mesh, 0.006, options), std::invalid_argument);
}

TEST(Lattice, OpenMeshesAndNonsenseCellsAreRefused) {
  TriMesh open = sphere_mesh(0.03, 2);
  open.triangles.pop_back();
  EXPECT_THROW(make_lattice(open, 0.01), std::invalid_argument);
  EXPECT_THROW(make_lattice(sphere_mesh(0.03, 2), 0.0), std::invalid_argument);
  EXPECT_THROW(make_lattice(sphere_mesh(0.03, 2), 1e-6), std::invalid_argument);
}

TEST(Embedding, ReproducesEveryAffineMapExactlyAlsoOutside) {
  core::Random random(3);
  LatticeOptions options;
  options.frame = some_turn();
  const TriMesh sphere = sphere_mesh(0.03, 4);
  const Lattice lattice = make_lattice(sphere, 0.006, options);
  std::vector<Vec3d> points = sphere.positions;
  for (int i = 0; i < 500; ++i) points.push_back(random_point(random, 0.05));  // inside, outside, far off
  const Embedding skin = embed(lattice, points);

  Mat3d map;
  for (auto& row : map.m)
    for (double& value : row) value = random.uniform(-2, 2);
  const Vec3d shift = random_point(random, 1);
  std::vector<Vec3d> nodes, moved(points.size());
  for (Vec3d p : lattice.nodes) nodes.push_back(map * p + shift);
  interpolate<double>(skin, nodes, moved);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT(length(moved[i] - (map * points[i] + shift)), 1e-12);
    double sum = 0;
    for (double w : skin.weights[i]) sum += w;
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(Embedding, TakesTheNearestCellAsBruteForceFindsIt) {
  core::Random random(4);
  const Lattice lattice = make_lattice(sphere_mesh(0.03, 4), 0.006);
  std::vector<Vec3d> points;
  for (int i = 0; i < 400; ++i) points.push_back(random_point(random, i % 2 ? 0.03 : 0.08));
  const Embedding skin = embed(lattice, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d q = lattice.in_cells(points[i]);
    const auto distance = [&](int cell) {
      Vec3d out;
      for (int k = 0; k < 3; ++k)
        out[k] = std::max({lattice.places[cell][k] - q[k], q[k] - lattice.places[cell][k] - 1.0, 0.0});
      return length(out);
    };
    double best = 1e9;
    for (int c = 0; c < int(lattice.cells.size()); ++c) best = std::min(best, distance(c));
    EXPECT_NEAR(distance(skin.cells[i]), best, 1e-12);
  }
}

TEST(Embedding, OfASurfaceStaysWithinHalfACellOfTheLattice) {
  const TriMesh sphere = sphere_mesh(0.03, 5);
  const Lattice lattice = make_lattice(sphere, 0.006);
  const Embedding skin = embed(lattice, sphere.positions);
  EXPECT_LT(skin.farthest, 0.5 * lattice.cell);
}

// The value was printed once by gcc 12 on x86-64; every other compiler and machine must find the same.
TEST(Lattice, GivesTheSameBitsOnEveryCompiler) {
  LatticeOptions options;
  options.frame = some_turn();
  const TriMesh sphere = sphere_mesh(0.03, 3);
  const Lattice lattice = make_lattice(sphere, 0.006, options);
  const Embedding skin = embed(lattice, sphere.positions);
  core::Hasher hasher;
  hasher.add(lattice.nodes);
  hasher.add(lattice.cells);
  hasher.add(lattice.cell_fill);
  hasher.add(skin.nodes);
  hasher.add(skin.weights);
  EXPECT_EQ(hasher.value(), 0x78eb83a75251a824ull) << std::hex << hasher.value();
}
