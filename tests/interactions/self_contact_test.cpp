// An organ that is folded rests on itself.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/interactions/contact/self_contact.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/work.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable_skin.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::interactions {
namespace {

constexpr double kCell = 0.005;

/// Cells of a box that are there, as a body of tetrahedra.
struct Body {
  std::vector<Vec3d> drawn;
  tissue::CuttableModel model;
  tissue::CuttableState state;
  tissue::CuttableWork work;
  tissue::CuttableSkin skin;
  tissue::SkinPose pose;
  NetworkLoads loads;
  SelfPair pair;
  std::vector<std::int32_t> nearest;
  std::uint64_t tick = 0;
  std::vector<tissue::NodeLoad> hands;

  Body(int nx, int ny, int nz, const std::function<bool(Vec3d)>& there, const std::function<bool(Vec3d)>& held) {
    const tissue::BoxLattice box = tissue::box_lattice(nx, ny, nz, kCell);
    tissue::CuttableDescription d;
    std::vector<int> number(box.corners.size(), -1);
    const auto node = [&](int corner) {
      int& n = number[size_t(corner)];
      if (n < 0) n = int(d.points.size()), d.points.push_back(box.corners[size_t(corner)]);
      return n;
    };
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    for (const auto& c : box.cells) {
      Vec3d middle;
      for (const int corner : c) middle += 0.125 * box.corners[size_t(corner)];
      if (!there(middle)) continue;
      for (const auto& p : kPaths)
        d.cells.push_back({node(c[0]), node(c[size_t(p[0])]), node(c[size_t(p[1])]), node(c[7])});
    }
    d.material = {.youngs_modulus = 5e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.1, .damping_time = 3e-3};
    d.global_damping = 8;
    d.spare_nodes = 10;
    for (const Vec3d p : d.points) d.fixed.push_back(held(p) ? tissue::kHeld : tissue::kFree);
    drawn = d.points;
    model = build(d, 1e-3);
    state = rest_state(model);
    work = make_work(model);
    skin = make_skin(model);
    pose = make_pose(skin.skin);
    loads.reserve(8192);
    show();
    std::vector<int> samples;
    for (int v = 0; v < skin.skin.size(); ++v)
      if (skin.skin.at_surface(v) && v % 2 == 0) samples.push_back(v);
    pair = make_self_pair(0, surface(), samples, 4 * kCell);
    nearest.assign(samples.size(), -1);
  }
  Surface surface() const { return {&skin.skin, &pose, view_of(model, state)}; }
  void show() {
    make_current(model, state, work);
    update(model, state, skin);
    pose_skin(view_of(model, state), skin.skin, pose);
  }
  void step(bool contact) {
    show();
    loads.clear();
    if (contact) self_contact(pair, surface(), {}, {}, tick, nearest, loads);
    ++tick;
    for (const tissue::NodeLoad& load : hands) loads.add(load, {Owner::anchor, 0, 0});
    loads.sort();
    const tissue::StepReport report = advance(model, loads.sorted, loads.reaction, state, work, tissue::Hands::on);
    ASSERT_TRUE(report.fine()) << report.flags;
  }
  Vec3d at(size_t node) const { return position(model, state, int(node)); }
  /// The node that was drawn there.
  size_t drawn_at(Vec3d p) const {
    size_t best = 0;
    for (size_t i = 0; i < drawn.size(); ++i)
      if (length(drawn[i] - p) < length(drawn[best] - p)) best = i;
    return best;
  }
  size_t known() const {
    return size_t(std::count_if(nearest.begin(), nearest.end(), [](int v) { return v >= 0; }));
  }
};

/// Two limbs of 15 mm, 15 mm apart, joined at their held foot.
Body fork() {
  return Body(
      9, 3, 14, [](Vec3d p) { return p.x < 3 * kCell || p.x > 6 * kCell || p.z < 3 * kCell; },
      [](Vec3d p) { return p.z < 1e-9; });
}

/// Hands that push the limbs' ends together.
void press_limbs(Body& b) {
  for (size_t i = 0; i < b.drawn.size(); ++i) {
    if (b.drawn[i].z < 10 * kCell) continue;
    tissue::NodeLoad load;
    load.node = int(i);
    load.f0 = {b.drawn[i].x < 4 * kCell ? 0.00012f : -0.00012f, 0, 0};
    b.hands.push_back(load);
  }
}

/// How far the inner sides have passed each other [m]; negative: the gap that is left.
double crossed(const Body& b) {
  double most = -1;
  for (int j = 0; j <= 3; ++j)
    for (int k = 6; k <= 14; ++k) {
      const Vec3d left{3 * kCell, j * kCell, k * kCell}, right{6 * kCell, j * kCell, k * kCell};
      most = std::max(most, b.at(b.drawn_at(left)).x - b.at(b.drawn_at(right)).x);
    }
  return most;
}

TEST(SelfContact, LimbsThatArePressedTogetherTouchAndDoNotPass) {
  double found[2];
  for (const bool contact : {false, true}) {
    Body b = fork();
    press_limbs(b);
    for (int i = 0; i < 1500; ++i) b.step(contact);
    found[contact] = crossed(b);
    if (contact) {
      EXPECT_GT(b.known(), 5u);
    }
  }
  std::cout << "limbs cross by " << 1e3 * found[true] << " mm, without contact by " << 1e3 * found[false] << " mm\n";
  EXPECT_GT(found[false], 0.010) << "[m] or the test says nothing";
  EXPECT_LT(found[true], 0.5 * kCell) << "[m] vertices that are no samples sink in between those that are";
  EXPECT_GT(found[true], -0.001) << "[m] they touch";
}

/// A bar, folded back by hands that draw every node of one half to where the other half lies.
double folded(bool contact) {
  Body b(
      28, 3, 2, [](Vec3d) { return true; }, [](Vec3d p) { return p.x < 11 * kCell && p.z < 1e-9; });
  const double middle = 14 * kCell, top = 2 * kCell, pi = std::numbers::pi;
  for (int t = 0; t < 3000; ++t) {
    const double angle = pi * std::min(1.0, t / 1500.0), down = 0.018 * std::clamp((t - 1500) / 1000.0, 0.0, 1.0);
    b.hands.clear();
    for (size_t i = 0; i < b.drawn.size(); ++i) {
      const Vec3d p = b.drawn[i];
      if (p.x < 18 * kCell) continue;
      const double x = p.x - middle, z = p.z - top - 0.006;  // about an axis above the bar
      tissue::NodeLoad load;
      load.node = int(i);
      load.k = 0.5f;
      load.d = 0.01f;
      const Vec3d to{middle + x * std::cos(angle) - z * std::sin(angle), p.y,
                     top + 0.006 + x * std::sin(angle) + z * std::cos(angle) - down};
      load.x0 = vec_cast<float>(to);
      b.hands.push_back(load);
    }
    b.step(contact);
  }
  // What was the upper side of the folded half, against the upper side of the other half.
  double least = 1;
  for (int i = 20; i <= 28; ++i)
    for (int j = 0; j <= 3; ++j) {
      const Vec3d over = b.at(b.drawn_at({i * kCell, j * kCell, top}));
      if (over.x < 0.5 * kCell || over.x > 10.5 * kCell) continue;
      const int below = int(over.x / kCell + 0.5);
      least = std::min(least, over.z - b.at(b.drawn_at({below * kCell, j * kCell, top})).z);
    }
  return least;
}

TEST(SelfContact, ABarThatIsFoldedBackLiesOnItself) {
  const double with = folded(true), without = folded(false);
  std::cout << "gap " << 1e3 * with << " mm, without contact " << 1e3 * without << " mm\n";
  EXPECT_LT(without, -0.004) << "[m] or the test says nothing";
  EXPECT_GT(with, -0.5 * kCell) << "[m]";
  EXPECT_LT(with, 0.002) << "[m] it lies on itself";
}

TEST(SelfContact, ThePartsOfAForkComeApartAgain) {
  Body b = fork();
  press_limbs(b);
  for (int i = 0; i < 1000; ++i) b.step(true);
  b.hands.clear();
  for (int i = 0; i < 2000; ++i) b.step(true);
  EXPECT_NEAR(crossed(b), -3 * kCell, 0.0005) << "[m] as drawn";
}

TEST(SelfContact, WhatIsFoldedIntoItselfIsNotHeldOff) {
  Body b = fork();
  press_limbs(b);
  for (int i = 0; i < 1500; ++i) b.step(true);
  ASSERT_GT(b.known(), 5u);
  std::vector<std::uint8_t> folded(b.state.nodes.size(), 0);
  for (size_t i = 0; i < b.drawn.size(); ++i)  // one limb; the other's samples meet nothing else
    if (b.drawn[i].x < 4 * kCell) folded[size_t(b.model.row_of_node[i])] = 1;
  b.loads.clear();
  for (std::uint64_t t = 0; t < 64; ++t) self_contact(b.pair, b.surface(), {}, folded, t, b.nearest, b.loads);
  EXPECT_EQ(b.known(), 0u);
  EXPECT_EQ(b.loads.gathered.size(), 0u);
}

TEST(SelfContact, AThinSlabIsNotTakenForTwoParts) {
  Body b(
      12, 12, 1, [](Vec3d) { return true; }, [](Vec3d p) { return p.x < 1e-9; });
  for (const double squeezed : {1.0, 0.3, 0.05}) {
    for (size_t i = 0; i < b.drawn.size(); ++i)
      set_position(b.model, b.state, int(i), {b.drawn[i].x, b.drawn[i].y, squeezed * b.drawn[i].z});
    b.show();
    b.loads.clear();
    for (std::uint64_t t = 0; t < 64; ++t) self_contact(b.pair, b.surface(), {}, {}, t, b.nearest, b.loads);
    EXPECT_EQ(b.known(), 0u) << squeezed;
    EXPECT_EQ(b.loads.gathered.size(), 0u) << squeezed;
  }
}

TEST(SelfContact, WhatIsDrawnTouchingOrOverlappingIsNotPushedApart) {
  for (const double gap : {0.0003, 0.00005, -0.0003, -0.003}) {  // [m]
    Body b = fork();
    for (size_t i = 0; i < b.drawn.size(); ++i)
      if (b.drawn[i].x > 5.9 * kCell && b.drawn[i].z > 3.1 * kCell)
        set_position(b.model, b.state, int(i), b.drawn[i] - Vec3d{3 * kCell - gap, 0, 0});
    b.show();
    b.pair = make_self_pair(0, b.surface(), b.pair.sample, 4 * kCell);
    b.loads.clear();
    for (std::uint64_t t = 0; t < 64; ++t) self_contact(b.pair, b.surface(), {}, {}, t, b.nearest, b.loads);
    EXPECT_EQ(b.loads.gathered.size(), 0u) << gap;
    if (gap > 0) {
      EXPECT_GT(b.known(), 10u) << "they know each other all the same";
    }
  }
}

TEST(SelfContact, TheOwnNeighbourhoodIsNeverAnotherPart) {
  const Body b = fork();
  for (size_t i = 0; i < b.pair.sample.size(); ++i) {
    const Vec3d p = b.drawn[size_t(b.pair.sample[i])];
    for (int v = 0; v < int(b.drawn.size()); ++v) {
      if (length(b.drawn[size_t(v)] - p) < 1.5 * kCell && std::fabs(p.x - b.drawn[size_t(v)].x) < 1.5 * kCell) {
        EXPECT_FALSE(b.pair.other(i, v));
      }
    }
  }
}

TEST(SelfContact, StoutBodiesAreToldFromSlenderOnes) {
  const auto all = [](Vec3d) { return true; };
  const auto none = [](Vec3d) { return false; };
  EXPECT_LT(slenderness(Body(6, 6, 6, all, none).skin.skin), 16);
  EXPECT_GT(slenderness(Body(15, 3, 3, all, none).skin.skin), 16);
  EXPECT_GT(slenderness(Body(12, 12, 1, all, none).skin.skin), 16);
}

/// A horseshoe of a lattice, as scene files draw bowel: two limbs of 12 mm, 24 mm apart, round a bend.
scene::Description horseshoe() {
  scene::Description d = small::description();
  d.vessels.clear();
  d.strands.clear();
  d.membranes.clear();
  scene::Solid s;
  s.name = "horseshoe";
  s.tissue = "flesh";
  const auto section = [&s](Vec3d centre, Vec3d across) {
    s.sections.push_back({centre, 0.006 * across, {0, 0, 0.006}, 2});
  };
  for (double y : {0.060, 0.045, 0.030, 0.015}) section({-0.012, y, 0}, {-1, 0, 0});
  for (int i = 1; i < 8; ++i) {
    const double a = std::numbers::pi * i / 8, c = std::cos(a), q = std::sin(a);
    section({-0.012 * c, -0.012 * q, 0}, {-c, -q, 0});
  }
  for (double y : {0.015, 0.030, 0.045, 0.060}) section({0.012, y, 0}, {1, 0, 0});
  s.cell = 0.004;
  s.skin_edge = 0.004;
  s.fine_edge = 0.003;
  s.anchors.push_back({{0, -0.014, 0}, 0.008, 0, {}});
  d.solids = {s};
  return d;
}

/// How far apart the limbs' ends are, middle to middle, after hands have pressed them together [m].
double ends_apart(const sim::Model& model, bool contact) {
  const sim::SolidModel& solid = model.solids[0];
  tissue::NetworkState state = rest_state(solid.network);
  tissue::NetworkWork work = make_work(solid.network);
  tissue::SkinPose pose = make_pose(solid.skin);
  std::vector<std::int32_t> nearest(model.self_pairs[0].sample.size(), -1);
  NetworkLoads loads;
  loads.reserve(8192);
  double apart = 0;
  for (int t = 0; t < 2000; ++t) {
    const Surface surface{&solid.skin, &pose, view_of(solid.network, state)};
    pose_skin(surface.nodes, solid.skin, pose);
    loads.clear();
    if (contact) self_contact(model.self_pairs[0], surface, {}, {}, std::uint64_t(t), nearest, loads);
    double left = 0, right = 0, count = 0;
    for (int n = 0; n < solid.network.nodes; ++n) {
      const Vec3d p = solid.network.rest[size_t(n)];
      if (p.y < 0.040) continue;
      tissue::NodeLoad load;
      load.node = n;
      load.f0 = {p.x < 0 ? 0.0003f : -0.0003f, 0, 0};
      load.k = 1;  // kept in their plane: round on round, they would slip past each other
      load.dir = {0, 0, 1};
      load.x0 = vec_cast<float>(p);
      loads.add(load, {Owner::anchor, 0, 0});
      (p.x < 0 ? left : right) += position(solid.network, state, n).x;
      count += 0.5;
    }
    apart = (right - left) / count;
    loads.sort();
    EXPECT_TRUE(advance(solid.network, loads.sorted, loads.reaction, state, work, nullptr, tissue::Hands::on).fine());
  }
  return apart;
}

TEST(SelfContact, TheLimbsOfAHorseshoeOfALatticeDoNotPassEither) {
  const sim::Model model = scene::compile(horseshoe());
  ASSERT_EQ(model.self_pairs.size(), 1u);
  const double with = ends_apart(model, true), without = ends_apart(model, false);
  std::cout << "limbs of 12 mm " << 1e3 * with << " mm apart, without contact " << 1e3 * without << " mm\n";
  EXPECT_LT(without, 0.004) << "[m] or the test says nothing";
  EXPECT_GT(with, 0.009) << "[m]";
  EXPECT_LT(with, 0.014) << "[m] they touch";
}

/// All organs of a shipped scene as drawn, stout ones too, every skin vertex a sample.
void expect_no_load_as_drawn(const std::string& file) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/" + file));
  const sim::State state = sim::initial_state(model);
  for (const SelfPair& p : model.self_pairs) std::cout << model.organ_name(p.organ) << " may touch itself\n";
  for (int organ = 0; organ < model.organs(); ++organ) {
    const tissue::Skin& skin = model.skin(organ);
    tissue::SkinPose pose = make_pose(skin);
    const Surface surface{&skin, &pose, nodes_of(model, state, organ)};
    pose_skin(surface.nodes, skin, pose);
    std::vector<int> samples;
    for (int v = 0; v < skin.size(); ++v)
      if (skin.at_surface(v)) samples.push_back(v);
    const SelfPair pair = make_self_pair(organ, surface, samples, 0.018);
    std::vector<std::int32_t> nearest(samples.size(), -1);
    NetworkLoads loads;
    loads.reserve(8192);
    for (std::uint64_t t = 0; t < 40; ++t) self_contact(pair, surface, {}, {}, t, nearest, loads);
    EXPECT_EQ(loads.gathered.size(), 0u) << model.organ_name(organ);
    std::cout << model.organ_name(organ) << ": slenderness " << slenderness(skin) << ", "
              << std::count_if(nearest.begin(), nearest.end(), [](int v) { return v >= 0; }) << " of " << samples.size()
              << " vertices face another part\n";
  }
}
TEST(SelfContact, NoOrganOfTheGynaecologySceneLoadsItselfAsDrawn) { expect_no_load_as_drawn("gynaecology/scene.json"); }
TEST(SelfContact, NoOrganOfTheCuttingSceneLoadsItselfAsDrawn) { expect_no_load_as_drawn("cutting/scene.json"); }
TEST(SelfContact, NoOrganOfTheGallbladderSceneLoadsItselfAsDrawn) { expect_no_load_as_drawn("gallbladder/scene.json"); }

}  // namespace
}  // namespace trocar::interactions
