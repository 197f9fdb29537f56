// Friction between bodies and at walls: Coulomb's with a creep, and it only takes energy. Gravity is tilted instead of
// what the bodies lie on.
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/contact/body_contact.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/piece_contact.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable_skin.hpp>

namespace trocar::interactions {
namespace {

using core::kTick;
constexpr double kG = 9.81;

Vec3d tilted(double slope) { return {kG * std::sin(slope), 0, -kG * std::cos(slope)}; }

/// A plane at z = 0, in triangles of 5 mm that are no multiple of the block's cells.
struct Floor {
  static constexpr int kColumns = 61, kRows = 13;
  tissue::Skin skin;
  tissue::SkinPose pose;

  Floor() {
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c) {
        skin.rest.push_back({float(0.005 * (c - 12) + 0.0011), float(0.005 * (r - 6) + 0.0007), 0});
        skin.rest_normal.push_back({0, 0, 1});
      }
    skin.weights.resize(skin.rest.size());
    for (int r = 0; r + 1 < kRows; ++r)
      for (int c = 0; c + 1 < kColumns; ++c) {
        const int v = r * kColumns + c;
        skin.triangles.push_back({v, v + 1, v + kColumns});
        skin.triangles.push_back({v + 1, v + kColumns + 1, v + kColumns});
      }
    index_skin(skin);
    pose = tissue::make_pose(skin);
    pose.position = skin.rest;
    for (const Vec3f p : skin.rest) pose.bounds.add(p);
  }
  Surface surface() const { return {&skin, &pose, {}}; }
};

/// A block of 4 x 4 x 3 nodes, 4 mm apart, its lowest layer on the plane.
struct Block {
  static constexpr double kEdge = 0.004;
  Floor floor;
  tissue::NetworkModel model;
  tissue::NetworkState state;
  tissue::NetworkWork work;
  tissue::Skin skin;
  tissue::SkinPose pose;
  NetworkLoads loads;
  SurfacePair pair;
  std::vector<std::int32_t> nearest;
  std::uint64_t tick = 0;
  bool rubs = true;

  static int node(int i, int j, int k) { return (k * 4 + j) * 4 + i; }

  explicit Block(Vec3d gravity) {
    tissue::NetworkDescription d;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          d.positions.push_back({kEdge * (i - 1.5), kEdge * (j - 1.5), kEdge * k});
          d.mass.push_back(1e-4);
        }
    for (size_t a = 0; a < d.positions.size(); ++a)
      for (size_t b = a + 1; b < d.positions.size(); ++b) {
        const double far = length(d.positions[b] - d.positions[a]);
        if (far < 1.8 * kEdge) d.springs.push_back({int(a), int(b), far, 40, 0, 0, 1, 0.005});
      }
    d.gravity = gravity;
    model = build(d, kTick);
    state = rest_state(model);
    work = make_work(model);
    for (int i = 0; i < model.nodes; ++i) {
      skin.weights.push_back(tissue::SkinWeights::at(i, model.row_of_node[size_t(i)]));
      skin.rest.push_back(vec_cast<float>(d.positions[size_t(i)]));
      skin.rest_normal.push_back({0, 0, -1});
    }
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {  // the bottom, seen from below
        skin.triangles.push_back({node(i, j, 0), node(i, j + 1, 0), node(i + 1, j, 0)});
        skin.triangles.push_back({node(i + 1, j, 0), node(i, j + 1, 0), node(i + 1, j + 1, 0)});
      }
    index_skin(skin);
    pose = tissue::make_pose(skin);
    loads.reserve(8192);
    pair.solid = 0;
    for (int i = 0; i < 16; ++i) {
      pair.sample.push_back(i);
      pair.radius.push_back(0);
      pair.overlap.push_back(0);
      nearest.push_back(0);
    }
  }
  void step() {
    const tissue::NodeView nodes = view_of(model, state);
    pose_skin(nodes, skin, pose);
    loads.clear();
    solid_on_surface(pair, {&skin, &pose, nodes}, floor.surface(), tick++, nearest, loads, nullptr);
    loads.sort();
    ASSERT_TRUE(advance(model, loads.sorted, loads.reaction, state, work).fine());
  }
  double place() const {
    double x = 0;
    for (int n = 0; n < model.nodes; ++n) x += position(model, state, n).x / model.nodes;
    return x;
  }
  double speed() const {
    double v = 0;
    for (int n = 0; n < model.nodes; ++n) v += velocity(model, state, n).x / model.nodes;
    return v;
  }
  double energy() const {
    const tissue::NetworkEnergy e = tissue::energy(model, state);
    return e.kinetic + e.elastic;
  }
};

TEST(BodyFriction, ABlockSlidesDownAWallAsCoulombSays) {
  for (const double slope : {0.08, 0.12, 0.2}) {
    Block b(tilted(slope));
    for (int i = 0; i < 200; ++i) b.step();
    const double v = b.speed();
    for (int i = 0; i < 200; ++i) b.step();
    const double found = (b.speed() - v) / 0.2, expected = kG * (std::sin(slope) - kBodyFriction * std::cos(slope));
    EXPECT_NEAR(found, expected, 0.05 * kG * kBodyFriction) << slope;
    std::cout << "slope " << slope << ": " << found << " m/s^2, Coulomb " << expected << "\n";
  }
}

TEST(BodyFriction, BelowTheAngleOfFrictionABlockOnlyCreeps) {
  for (const double share : {0.5, 0.9}) {
    Block b(tilted(std::atan(share * kBodyFriction)));
    for (int i = 0; i < 600; ++i) b.step();
    const double x = b.place();
    for (int i = 0; i < 1000; ++i) b.step();
    EXPECT_NEAR(b.place() - x, share * kCreep, 0.1 * kCreep) << "[m] in a second";
  }
}

TEST(BodyFriction, AThrownBlockStopsWhereCoulombSaysAndOnlyLosesEnergy) {
  Block b(tilted(0));
  for (int i = 0; i < 200; ++i) b.step();
  for (int n = 0; n < b.model.nodes; ++n) set_velocity(b.model, b.state, n, {0.1, 0, 0});
  const double from = b.place(), way = 0.1 * 0.1 / (2 * kBodyFriction * kG), thrown = b.energy();
  double before = thrown;
  for (int i = 0; i < 400; ++i) {
    b.step();
    EXPECT_LT(b.energy(), before + 0.002 * thrown) << i;
    before = b.energy();
  }
  EXPECT_NEAR(b.place() - from, way, 0.1 * way);
  EXPECT_LT(b.speed(), 2 * kCreep);
}

/// A block of cells that stands on its held bottom, cut through in its middle: the upper half lies loose on the lower.
struct Halves {
  tissue::CuttableModel model;
  tissue::CuttableState state;
  tissue::CuttableWork work;
  tissue::CuttableSkin skin;
  tissue::SkinPose pose;
  NetworkLoads loads;

  explicit Halves(Vec3d gravity) {
    const tissue::BoxLattice box = tissue::box_lattice(6, 4, 4, 0.005);
    tissue::CuttableDescription d;
    d.points = box.corners;
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    for (const auto& c : box.cells)
      for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
    d.material = {.youngs_modulus = 20e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.1, .damping_time = 3e-3};
    d.gravity = gravity;
    d.spare_nodes = 200;
    d.fixed.assign(d.points.size(), tissue::kFree);
    for (size_t i = 0; i < d.points.size(); ++i)
      if (d.points[i].z < 1e-9) d.fixed[i] = tissue::kHeld;
    model = build(d, kTick);
    state = rest_state(model);
    work = make_work(model);
    skin = make_skin(model);
    pose = make_pose(skin.skin);
    loads.reserve(8192);
    geometry::Blade blade;
    blade.corners = 4;
    blade.corner = {Vec3d{-0.05, -0.05, 0.0101}, Vec3d{0.07, -0.05, 0.0101}, Vec3d{0.07, 0.07, 0.0101},
                    Vec3d{-0.05, 0.07, 0.0101}};
    EXPECT_GT(cut(model, blade, state, work).parted, 0);
    EXPECT_EQ(work.parts, 2);
  }
  void step() {
    make_current(model, state, work);
    update(model, state, skin);
    pose_skin(view_of(model, state), skin.skin, pose);
    loads.clear();
    piece_on_piece({&skin.skin, &pose, view_of(model, state)}, work.part, work.largest_part, loads);
    loads.sort();
    ASSERT_TRUE(advance(model, loads.sorted, loads.reaction, state, work).fine());
  }
  /// Of the upper half, along the slope [m/s].
  double speed() const {
    double sum = 0;
    int n = 0;
    for (int i = 0; i < state.tets.nodes; ++i)
      if (work.part[size_t(i)] != work.part[0]) sum += velocity(model, state, i).x, ++n;
    return sum / n;
  }
};

TEST(BodyFriction, APieceRubsOnWhatItWasCutFrom) {
  const double slope = 0.12, coulomb = kG * (std::sin(slope) - kBodyFriction * std::cos(slope));
  Halves steep(tilted(slope));
  for (int i = 0; i < 30; ++i) steep.step();
  const double v = steep.speed();
  for (int i = 0; i < 80; ++i) steep.step();  // 4 mm; then it leans over the edge
  const double found = (steep.speed() - v) / 0.08;
  std::cout << "piece: " << found << " m/s^2, Coulomb " << coulomb << ", without " << kG * std::sin(slope) << "\n";
  EXPECT_NEAR(found, coulomb, 0.2 * kG * kBodyFriction);
  Halves flat(tilted(0.5 * kBodyFriction));
  for (int i = 0; i < 1000; ++i) flat.step();
  EXPECT_LT(std::fabs(flat.speed()), 1.5 * kCreep) << "[m/s]";
}

TEST(BodyFriction, NothingRubsWhereNothingPressesOrNothingMoves) {
  EXPECT_EQ(body_rub(0, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}).damping, 0);
  EXPECT_EQ(body_rub(1, {0, 0, 1}, {0, 0, 3}, {0, 0, 0}).damping, 0);
  const BodyRub fast = body_rub(2, {0, 0, 1}, {0, 0.5, 1}, {0, 0.1, 0});
  EXPECT_NEAR(fast.damping * 0.4, 2 * kBodyFriction, 1e-12) << "Coulomb's force";
  EXPECT_NEAR(fast.dir.y, 1, 1e-12);
}

}  // namespace
}  // namespace trocar::interactions
