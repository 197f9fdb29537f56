// Friction between instruments and tissue: Coulomb's, and it only takes energy. Bodies lie on a shaft so thick that it
// is a plane, and gravity is tilted instead of the shaft.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/instrument/membrane_contact.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

using namespace trocar;
using namespace trocar::interactions;

namespace {

using core::kTick;
constexpr double kG = 9.81;
constexpr double kThick = 2.0;  ///< radius of the shaft that is a plane [m]

Vec3d tilted(double slope) { return {kG * std::sin(slope), 0, -kG * std::cos(slope)}; }

/// A shaft along x whose crest is at z = 0, and no jaws.
ToolShape plane(double shift) {
  ToolShape s;
  const Capsule away{{9, 9, 9}, {9, 9, 9.1}, 0.001};
  s.pivot = s.frame.tip = {shift + 1, 0, -kThick};
  s.part[kJawA] = s.part[kJawB] = away;
  s.part[kShaft] = {{shift - 1, 0, -kThick}, {shift + 1, 0, -kThick}, kThick};
  return s;
}

/// What instruments remember, and where they were.
struct Rubbing {
  double friction = 0;
  TouchBook book, next;
  ToolShape before = plane(0), now = plane(0);
  Vec3d on_tissue;  ///< force in the last tick [N]

  Touching touching() { return Touching(friction, before, now, 0, book, next); }
  void feel(const Tag& tag, Vec3d force) {
    if (tag.owner != Owner::tool_contact) return;
    press_on(next, tag.sub, force);
    on_tissue += force;
  }
  void done() {
    remember(ToolState{}, {}, next, book);
    before = now;
  }
};

/// A block of 4 x 4 x 3 nodes, 4 mm apart, its lowest layer on the plane.
struct Block {
  static constexpr double kEdge = 0.004;
  tissue::NetworkModel model;
  tissue::NetworkState state;
  tissue::NetworkWork work;
  tissue::Skin skin;
  tissue::SkinPose pose;
  NetworkLoads loads;
  Rubbing rubbing;

  static int node(int i, int j, int k) { return (k * 4 + j) * 4 + i; }

  /// @param held_from  the lowest layer that is held, with those above it; 3: none
  Block(Vec3d gravity, double friction, int held_from = 3) {
    rubbing.friction = friction;
    tissue::NetworkDescription d;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          d.positions.push_back({kEdge * (i - 1.5), kEdge * (j - 1.5), kEdge * k});
          d.mass.push_back(1e-4);
          d.fixed.push_back(k >= held_from ? tissue::kHeld : tissue::kFree);
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
    pose = make_pose(skin);
    loads.reserve(8192);
  }

  void step() {
    const tissue::NodeView nodes = view_of(model, state);
    pose_skin(nodes, skin, pose);
    loads.clear();
    Touching touching = rubbing.touching();
    tool_on_surface(touching, BodyId::organ(0), {&skin, &pose, nodes}, loads);
    loads.sort();
    ASSERT_TRUE(advance(model, loads.sorted, loads.reaction, state, work).fine());
    rubbing.on_tissue = {0, 0, 0};
    for (size_t i = 0; i < loads.sorted.size(); ++i) rubbing.feel(loads.owner[i], vec_cast<double>(loads.reaction[i]));
    rubbing.done();
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
  void throw_along(double v) {
    for (int n = 0; n < model.nodes; ++n) set_velocity(model, state, n, {v, 0, 0});
  }
  double energy() const {
    const tissue::NetworkEnergy e = tissue::energy(model, state);
    return e.kinetic + e.elastic;
  }
};

/// A chain of nodes without ends that are held, lying along the plane.
struct Cord {
  StrandBody body;
  tissue::StrandState state;
  tissue::StrandWork work;
  std::vector<Vec3f> side;
  std::vector<tissue::StrandEnd> ends;
  std::vector<tissue::StrandReaction> on_holders;
  StrandLoads loads;
  Rubbing rubbing;
  ToolModel tool;

  Cord(Vec3d gravity, double friction, bool held = false) {
    rubbing.friction = friction;
    tool.shaft_radius = kThick;
    tissue::StrandDescription d;
    for (int i = 0; i < 12; ++i) d.positions.push_back({0.003 * (i - 5.5), 0, 0.002});
    d.radius.assign(11, 0.002);
    d.youngs_modulus = 60e3;
    d.density = 1000;
    d.damping_time = 1e-3;
    d.gravity = gravity;
    d.prestress = false;
    if (held) {
      d.prescribed.assign(12, 1);
      for (Vec3d p : d.positions) ends.push_back({p});
    }
    on_holders.resize(ends.size());
    body.model = build(d, kTick);
    state = rest_state(body.model);
    work = make_work(body.model);
    side.resize(11 * size_t(kToolParts));
    loads.reserve(1024);
  }
  void step() {
    loads.clear();
    Touching touching = rubbing.touching();
    tool_on_strand(tool, touching, ToolState{}, body, BodyId::strand(0), state, side, loads);
    loads.reaction.assign(loads.list.size(), Vec3d{});
    ASSERT_TRUE(advance(body.model, ends, loads.list, on_holders, loads.reaction, state, work).fine());
    rubbing.on_tissue = {0, 0, 0};
    for (size_t i = 0; i < loads.list.size(); ++i) rubbing.feel(loads.tag[i], loads.reaction[i]);
    rubbing.done();
  }
  double speed() const {
    double v = 0;
    for (Vec3d u : state.v) v += u.x / double(state.v.size());
    return v;
  }
  double place() const {
    double x = 0;
    for (Vec3d p : state.x) x += p.x / double(state.x.size());
    return x;
  }
};

/// A square of a fold that lies on the plane.
struct Cloth {
  tissue::MembraneModel sheet;
  tissue::MembraneState state;
  tissue::MembraneWork work;
  tissue::Skin skin;
  tissue::SkinPose pose;
  std::vector<std::uint8_t> torn;
  std::vector<Vec3f> side;
  NetworkLoads loads;
  Rubbing rubbing;

  Cloth(Vec3d gravity, double friction) {
    rubbing.friction = friction;
    tissue::MembraneDescription d;
    d.columns = d.rows = 5;
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c < 5; ++c) d.positions.push_back({0.003 * (c - 2), 0.003 * (r - 2), 0.00025});
    d.thickness = 0.0005;
    d.youngs_modulus = 17e3;
    d.density = 1000;
    d.damping_time = 4e-4;
    d.bending_damping_time = 5e-4;
    d.gravity = gravity;
    d.settle = false;
    sheet = build(d, kTick);
    state = rest_state(sheet);
    work = make_work(sheet, 4096);
    skin.triangles = sheet.triangles;
    for (int i = 0; i < sheet.nodes(); ++i) {
      skin.weights.push_back(tissue::SkinWeights::at(i, sheet.network.row_of_node[size_t(i)]));
      skin.rest.push_back(vec_cast<float>(sheet.network.rest[size_t(i)]));
      skin.rest_normal.push_back({0, 0, 1});
    }
    index_skin(skin);
    pose = make_pose(skin);
    torn.assign(sheet.triangles.size(), 0);
    side.resize(sheet.triangles.size() * size_t(kSheetParts));
    loads.reserve(4096);
  }
  void step() {
    const tissue::NodeView nodes = view_of(sheet.network, state.network);
    pose_skin(nodes, skin, pose);
    loads.clear();
    Touching touching = rubbing.touching();
    const SheetView view{{&skin, &pose, nodes}, torn, sheet.network.fixed, 0.00025};
    SheetBond bond = SheetBond::none;
    double gap = 0;
    tool_on_sheet(touching, ToolState{}, BodyId::membrane(0), view, side, bond, loads, gap);
    loads.sort();
    ASSERT_TRUE(advance(sheet, {}, loads.sorted, loads.reaction, state, work).fine());
    rubbing.on_tissue = {0, 0, 0};
    for (size_t i = 0; i < loads.sorted.size(); ++i) rubbing.feel(loads.owner[i], vec_cast<double>(loads.reaction[i]));
    rubbing.done();
  }
  double place() const {
    double x = 0;
    for (int n = 0; n < sheet.nodes(); ++n) x += position(sheet.network, state.network, n).x / sheet.nodes();
    return x;
  }
  double speed() const {
    double v = 0;
    for (int n = 0; n < sheet.nodes(); ++n) v += velocity(sheet.network, state.network, n).x / sheet.nodes();
    return v;
  }
};

struct Slide {
  double crept = 0;         ///< between 0.3 and 0.5 s [m]
  double acceleration = 0;  ///< then [m/s^2]
};
template <class Body>
Slide on_slope(double slope, double friction) {
  Body body(tilted(slope), friction);
  for (int i = 0; i < 300; ++i) body.step();
  const double x = body.place(), v = body.speed();
  for (int i = 0; i < 200; ++i) body.step();
  return {body.place() - x, (body.speed() - v) / 0.2};
}

template <class Body>
void expect_coulomb(double tolerance) {
  for (double friction : {0.1, 0.3}) {
    const double limit = std::atan(friction);
    const Slide below = on_slope<Body>(0.85 * limit, friction), above = on_slope<Body>(1.3 * limit, friction);
    const double expected = kG * (std::sin(1.3 * limit) - friction * std::cos(1.3 * limit));
    EXPECT_LT(std::fabs(below.crept), 5e-5) << "[m] in 0.2 s, " << friction;
    EXPECT_NEAR(above.acceleration, expected, tolerance * kG * friction) << friction;
  }
}

TEST(Friction, ABlockOnASlopeSticksBelowTheAngleOfFrictionAndSlidesAboveIt) { expect_coulomb<Block>(0.05); }
TEST(Friction, AStrandOnASlopeSticksBelowTheAngleOfFrictionAndSlidesAboveIt) { expect_coulomb<Cord>(0.05); }
TEST(Friction, AFoldOnASlopeSticksBelowTheAngleOfFrictionAndSlidesAboveIt) { expect_coulomb<Cloth>(0.15); }

TEST(Friction, WithoutACoefficientNothingHoldsTheBlock) {
  const Slide s = on_slope<Block>(0.1, 0);
  EXPECT_NEAR(s.acceleration, kG * std::sin(0.1), 0.01 * kG * std::sin(0.1));
}

TEST(Friction, AThrownBlockLosesItsEnergyAndStopsWhereCoulombSays) {
  Block b(tilted(0), 0.3);
  for (int i = 0; i < 200; ++i) b.step();
  b.throw_along(0.2);
  const double from = b.place(), way = 0.2 * 0.2 / (2 * 0.3 * kG);
  double before = b.energy();
  const double thrown = before;
  for (int i = 0; i < 300; ++i) {
    b.step();
    EXPECT_LT(b.energy(), before + 0.002 * thrown) << i;
    before = b.energy();
  }
  EXPECT_NEAR(b.place() - from, way, 0.1 * way);
  EXPECT_LT(b.energy(), 0.01 * thrown);
}

TEST(Friction, ARubbingRodBringsInNoMoreThanItsWork) {
  // The block hangs by its upper layer; the plane is pressed into it and rubs to and fro.
  Block b({0, 0, 0}, 0.3, 2);
  double work = 0, x = 0, z = 0, most_above = 0, most = 0;
  for (int i = 0; i < 2000; ++i) {
    const double to_x = i < 100 ? 0 : 0.003 * std::sin(0.03 * (i - 100)), to_z = 0.0005 * std::min(1.0, i / 100.0);
    b.rubbing.now = plane(to_x);
    for (Vec3d* p : {&b.rubbing.now.part[kShaft].a, &b.rubbing.now.part[kShaft].b}) p->z += to_z;
    b.step();
    work += dot(b.rubbing.on_tissue, Vec3d{to_x - x, 0, to_z - z});
    x = to_x;
    z = to_z;
    most_above = std::max(most_above, b.energy() - work);
    most = std::max(most, b.energy());
  }
  EXPECT_LT(most_above, 0.05 * most);
  EXPECT_GT(work, 2 * most) << "what rubbed took far more than what stayed";
}

TEST(Friction, ARodThatMovesAwayForgets) {
  Block b(tilted(0), 0.3);
  for (int i = 0; i < 50; ++i) b.step();
  EXPECT_GT(b.rubbing.book.count, 0);
  b.rubbing.now = plane(0);
  for (Vec3d* p : {&b.rubbing.now.part[kShaft].a, &b.rubbing.now.part[kShaft].b}) p->z -= 0.1;
  b.step();
  EXPECT_EQ(b.rubbing.book.count, 0);
}

/// The force on a body that cannot give way, a plane pressed 2 mm into it, after it was rubbed for a second.
template <class Body>
double pressed_in_vain(Body& b) {
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    b.rubbing.now = plane(0.0001 * std::sin(0.05 * i));
    for (Vec3d* p : {&b.rubbing.now.part[kShaft].a, &b.rubbing.now.part[kShaft].b}) p->z += 0.002;
    b.step();
    most = std::max(most, length(b.rubbing.on_tissue));
  }
  return most;
}

TEST(Friction, DoesNotFeedOnItselfWhereAStrandCannotGiveWay) {
  Cord cord({0, 0, 0}, 0.5, true);
  const double springs = 11 * 1500 * 0.0031;  // [N] eleven elements, pushed by no more than 3 mm and the rod's way
  EXPECT_LT(pressed_in_vain(cord), 1.2 * springs);
}

TEST(Friction, DoesNotFeedOnItselfWhereAnOrganCannotGiveWay) {
  Block block({0, 0, 0}, 0.5, 0);
  const double a_vertex = 1500 * 0.0013 + 0.5 * 6 / 0.0002 * 0.0013;  // [N] both springs, friction's at its bound
  EXPECT_LT(pressed_in_vain(block), 16 * a_vertex);
}

}  // namespace
