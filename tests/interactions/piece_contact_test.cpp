// What is cut off lands on what it was cut from.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/interactions/contact/piece_contact.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable_skin.hpp>

namespace trocar::interactions {
namespace {

constexpr double kCell = 0.005;

/// A block of 4 x 4 x 6 cells that stands on its held bottom, and can be cut into a lower and an upper half.
struct Block {
  tissue::CuttableModel model;
  tissue::CuttableState state;
  tissue::CuttableWork work;
  tissue::CuttableSkin skin;
  tissue::SkinPose pose;
  NetworkLoads loads;
  std::vector<tissue::NodeLoad> squeeze;

  Block() {
    const tissue::BoxLattice box = tissue::box_lattice(4, 4, 6, kCell);
    tissue::CuttableDescription d;
    d.points = box.corners;
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    for (const auto& c : box.cells)
      for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
    d.material = {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.1, .damping_time = 3e-3};
    d.global_damping = 1;
    d.gravity = {0, 0, -9.81};
    d.spare_nodes = 200;
    d.fixed.assign(d.points.size(), tissue::kFree);
    for (size_t i = 0; i < d.points.size(); ++i)
      if (d.points[i].z < 1e-9) d.fixed[i] = tissue::kHeld;
    model = build(d, 1e-3);
    state = rest_state(model);
    work = make_work(model);
    skin = make_skin(model);
    pose = make_pose(skin.skin);
    loads.reserve(4096);
  }
  /// @param tilt  of the blade [-]
  void cut_through(double tilt) {
    geometry::Blade blade;
    blade.corners = 4;
    blade.corner = {Vec3d{-0.05, -0.05, 0.0151 - 0.05 * tilt}, Vec3d{0.07, -0.05, 0.0151 + 0.07 * tilt},
                    Vec3d{0.07, 0.07, 0.0151 + 0.07 * tilt}, Vec3d{-0.05, 0.07, 0.0151 - 0.05 * tilt}};
    ASSERT_GT(cut(model, blade, state, work).parted, 0);
    ASSERT_EQ(work.parts, 2);
  }
  /// A slit from the top, across x, two thirds of the way down; the leaves' outer sides are pressed together.
  void slit(double force) {
    geometry::Blade blade;
    blade.corners = 4;
    blade.corner = {Vec3d{0.0101, -0.05, 0.0101}, Vec3d{0.0101, 0.07, 0.0101}, Vec3d{0.0101, 0.07, 0.07},
                    Vec3d{0.0101, -0.05, 0.07}};
    ASSERT_GT(cut(model, blade, state, work).doubled, 0);
    ASSERT_EQ(work.parts, 1);
    for (int i = 0; i < model.own_nodes; ++i) {
      const Vec3d p = model.drawn.rest[size_t(i)];
      const bool left = p.x<1e-9, right = p.x> 4 * kCell - 1e-9;
      if (p.z < 5 * kCell || (!left && !right)) continue;
      tissue::NodeLoad load;
      load.node = i;
      load.f0 = {float(left ? force : -force), 0, 0};
      squeeze.push_back(load);
    }
  }
  /// How far doubled nodes have passed those that they were doubled from, along x [m].
  double crossed() const {
    double most = 0;
    for (int i = model.own_nodes; i < state.tets.nodes; ++i) {
      const int twin = state.tets.source[size_t(i)];
      const double side = center_x(i) - center_x(twin);  // on which side the cells of each are
      const double gap = position(model, state, i).x - position(model, state, twin).x;
      most = std::max(most, side > 0 ? -gap : gap);
    }
    return most;
  }
  double center_x(int node) const {
    double sum = 0;
    int n = 0;
    for (const geometry::Tet& c : state.tets.cells)
      if (std::count(c.begin(), c.end(), node) > 0)
        for (const std::int32_t corner : c) sum += state.tets.rest[size_t(corner)].x, ++n;
    return sum / n;
  }
  void tick(bool contact) {
    make_current(model, state, work);
    update(model, state, skin);
    pose_skin(view_of(model, state), skin.skin, pose);
    loads.clear();
    if (contact && work.parts > 1)
      piece_on_piece({&skin.skin, &pose, view_of(model, state)}, work.part, work.largest_part, loads);
    if (contact)
      lip_on_lip({&skin.skin, &pose, view_of(model, state)}, work.part, state.tets.source, model.own_nodes,
                 state.tets.nodes, loads);
    for (const tissue::NodeLoad& load : squeeze) loads.add(load, {Owner::anchor, 0, 0});
    loads.sort();
    ASSERT_TRUE(advance(model, loads.sorted, loads.reaction, state, work).fine());
  }
  /// Mean height of the piece that is not held.
  double upper() const {
    double sum = 0;
    int n = 0;
    const std::int32_t lower = work.part[0];
    for (int i = 0; i < state.tets.nodes; ++i)
      if (work.part[size_t(i)] != lower) sum += position(model, state, i).z, ++n;
    return sum / n;
  }
  double fastest() const {
    double most = 0;
    for (int i = 0; i < state.tets.nodes; ++i) most = std::max(most, length(velocity(model, state, i)));
    return most;
  }
};

TEST(PieceContact, APieceThatIsCutOffRestsOnTheOther) {
  Block b;
  b.cut_through(0);
  const double before = b.upper();
  for (int i = 0; i < 1500; ++i) b.tick(true);
  EXPECT_NEAR(b.upper(), before, 0.0015);
  EXPECT_LT(b.fastest(), 0.02) << "[m/s] it lies still";
  Block without;
  without.cut_through(0);
  for (int i = 0; i < 300; ++i) without.tick(false);
  EXPECT_LT(without.upper(), before - 0.1) << "and without contact it would have fallen through";
}

TEST(PieceContact, APieceThatFallsFromAboveIsCaught) {
  Block b;
  b.cut_through(0);
  for (int i = 0; i < b.state.tets.nodes; ++i)
    if (b.work.part[size_t(i)] != b.work.part[0])
      set_position(b.model, b.state, i, position(b.model, b.state, i) + Vec3d{0, 0, 0.02});
  const double before = b.upper() - 0.02;
  for (int i = 0; i < 1500; ++i) b.tick(true);
  EXPECT_NEAR(b.upper(), before, 0.0025) << "from 20 mm, 0.6 m/s";
}

TEST(PieceContact, TheLipsOfASlitDoNotPassThroughEachOther) {
  double crossed[2];
  for (const bool contact : {false, true}) {
    Block b;
    b.slit(0.004);
    for (int i = 0; i < 800; ++i) b.tick(contact);
    crossed[contact] = b.crossed();
  }
  EXPECT_GT(crossed[false], 0.001) << "[m] pressed together, they would";
  EXPECT_LT(crossed[true], 0.2 * crossed[false]);
  std::cout << "lips cross by " << 1e3 * crossed[true] << " mm, without contact by " << 1e3 * crossed[false] << " mm\n";
}

TEST(PieceContact, WhereNothingIsCutOffNothingIsPushed) {
  Block b;
  for (int i = 0; i < 20; ++i) b.tick(true);
  EXPECT_EQ(b.loads.gathered.size(), 0u);
}

TEST(PieceContact, PushAndAnswerNearlyCancel) {
  Block b;
  b.cut_through(0.1);
  for (int i = 0; i < 50; ++i) b.tick(true);
  Vec3d sum;
  double size = 0;
  for (size_t i = 0; i < b.loads.sorted.size(); ++i) {
    sum += vec_cast<double>(b.loads.reaction[i]);
    size += length(vec_cast<double>(b.loads.reaction[i]));
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(length(sum), 0.35 * size) << "implicit on each side by itself, so they differ while speeds do";
}

}  // namespace
}  // namespace trocar::interactions
