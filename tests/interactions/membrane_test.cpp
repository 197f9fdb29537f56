// Hands on a fold, in the small scene: it cannot be passed from either side, it can be held, and scissors part it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/interactions/instrument/needle.hpp>
#include <trocar/interactions/verbs/cut.hpp>

#include "../sim/small_scene.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

/// A square sheet in the plane z = 0, held all round or all but where x is greatest, and a rod that goes where a test
/// says.
struct Drum {
  tissue::MembraneModel sheet;
  tissue::MembraneState state;
  tissue::MembraneWork work;
  tissue::Skin skin;
  tissue::SkinPose pose;
  std::vector<std::uint8_t> torn;
  std::vector<Vec3f> side;
  NetworkLoads loads;
  Vec3d felt{0, 0, 0};  ///< by the rod, last tick [N]
  ToolShape before;
  TouchBook book, next;
  bool moved = false;
  SheetBond bond = SheetBond::none;

  explicit Drum(bool open = false) {
    tissue::MembraneDescription d;
    d.columns = d.rows = 13;
    for (int r = 0; r < 13; ++r)
      for (int c = 0; c < 13; ++c) {
        d.positions.push_back({0.0028 * (c - 6), 0.0028 * (r - 6), 0});
        d.held.push_back(r == 0 || c == 0 || r == 12 || (c == 12 && !open));
      }
    d.thickness = 0.0005;
    d.youngs_modulus = 17e3;
    d.law = {0, 0.15, 2.5};
    d.density = 1000;
    d.damping_time = 4e-4;
    d.bending_damping_time = 5e-4;
    d.global_damping = 8;
    sheet = build(d, sim::kTick);
    state = rest_state(sheet);
    work = make_work(sheet, 4096);
    skin.triangles = sheet.triangles;
    for (int i = 0; i < sheet.nodes(); ++i) {
      tissue::SkinWeights w;
      w.node.fill(i);
      w.row.fill(sheet.network.row_of_node[size_t(i)]);
      w.weight[0] = 1;
      skin.weights.push_back(w);
      skin.rest.push_back(vec_cast<float>(sheet.network.rest[size_t(i)]));
      skin.rest_normal.push_back({0, 0, 1});
    }
    index_skin(skin);
    pose = make_pose(skin);
    torn.assign(sheet.triangles.size(), 0);
    side.resize(sheet.triangles.size() * size_t(kSheetParts));
    loads.reserve(4096);
  }
  bool step(Capsule rod) {
    ToolShape shape;
    shape.pivot = shape.frame.tip = {1, 1, 1};
    const Capsule away{{1, 1, 1}, {1, 1, 1.01}, 0.001};
    shape.part[kShaft] = rod;
    shape.part[kJawA] = shape.part[kJawB] = away;
    return step_with(shape);
  }
  bool step_with(const ToolShape& shape) {
    pose_skin(view_of(sheet.network, state.network), skin, pose);
    loads.clear();
    const SheetView view{{&skin, &pose, view_of(sheet.network, state.network)}, torn, sheet.network.fixed, 0.00025};
    Touching touching(0, moved ? before : shape, shape, 0, book, next);
    double gap = 0;
    tool_on_sheet(touching, ToolState{}, BodyId::membrane(0), view, side, bond, loads, gap);
    before = shape;
    moved = true;
    loads.sort();
    const bool fine = advance(sheet, {}, loads.sorted, loads.reaction, state, work).fine() && !loads.overflowed;
    felt = {0, 0, 0};
    for (const Vec3f& f : loads.reaction) felt -= vec_cast<double>(f);
    return fine;
  }
  double height(int column, int row) const { return position(sheet.network, state.network, row * 13 + column).z; }
  /// The middle of the sheet; the rod's end comes down on it at `speed` and stops 8 mm below.
  bool driven(double from, double to, double speed, Vec3d along, double radius) {
    const int ticks = int(std::fabs(to - from) / (speed * sim::kTick));
    bool fine = true;
    for (int i = 0; i < ticks + 200; ++i) {
      const double z = from + (to - from) * std::min(1.0, double(i) / ticks);
      const Vec3d tip{0.0003, 0.0004, z};
      fine = step({tip - 0.08 * along, tip, radius}) && fine;
    }
    return fine;
  }
};

TEST(Fold, NoRodPassesFromAboveOrBelowAtTheFastestHandsSpeed) {
  for (double sign : {1.0, -1.0})
    for (double speed : {0.05, 0.6})
      for (double radius : {0.0006, 0.0025}) {
        Drum drum;
        ASSERT_TRUE(drum.driven(sign * 0.006, -sign * 0.008, speed, {0, 0, -sign}, radius));
        // The sheet's middle lies before the tip, on the side from which the rod does not come.
        EXPECT_LT(sign * drum.height(6, 6), -0.0075) << sign << " " << speed << " " << radius;
        EXPECT_GT(sign * drum.felt.z, 1e-3);  // and pushes back
      }
}

TEST(Fold, ARodAcrossItDoesNotPassBetweenItsNodes) {
  // A thin rod along a column's middle: no node is within its radius, only edges are.
  for (double sign : {1.0, -1.0}) {
    Drum drum;
    for (int i = 0; i <= 60; ++i) {
      const double z = sign * (0.003 - 0.0002 * i);
      ASSERT_TRUE(drum.step({{0.0014, -0.05, z}, {0.0014, 0.05, z}, 0.0006}));
    }
    for (int row : {4, 6, 8}) {
      EXPECT_LT(sign * drum.height(6, row), -0.004) << row;
      EXPECT_LT(sign * drum.height(7, row), -0.004) << row;
    }
  }
}

/// Jaws hold two corners of a triangle beside a hole, and their axis comes upright over the side between these, `deep`
/// beyond the fold.
struct Astride {
  Vec3d way;         ///< of the third corner in that tick, beside what it goes along with the jaws [m]
  double share = 0;  ///< of that corner in the place where the axis meets the triangle, once the corner has gone along
};
Astride come_astride(double deep) {
  Drum drum;
  pose_skin(view_of(drum.sheet.network, drum.state.network), drum.skin, drum.pose);
  const std::array<int, 3> t = drum.skin.triangles[drum.skin.triangles.size() / 2];
  const auto at = [&](int v) { return position(drum.sheet.network, drum.state.network, v); };
  const Vec3d first = at(t[0]), second = at(t[1]), third = at(t[2]), side = 0.5 * (first + second);
  const auto with = [&](int v, const std::array<int, 3>& of) { return std::find(of.begin(), of.end(), v) != of.end(); };
  std::vector<std::uint8_t> open;
  for (const auto& other : drum.skin.triangles)
    open.push_back(with(t[0], other) && with(t[1], other) && !with(t[2], other));
  const Vec3d down{0, 0, -1}, from = side - 0.1 * (third - side), to = side + 0.2 * (third - side);
  Needles jaws;
  jaws.needle[0] = {{1, 1, 1}, down, {1, 1, 1}, down, 0.02};
  jaws.needle[1] = {from + deep * down, down, to + deep * down, down, 0.02};
  jaws.count = 2;
  const std::int32_t between[2] = {t[0], t[1]};
  CarriedExtent extent;
  const auto& network = drum.sheet.network;
  EXPECT_EQ(
      carry_along(jaws, {drum.skin, drum.pose, open, network.fixed, between, network.origin, drum.state.network.nodes},
                  0, sim::kTick, extent),
      1);
  return {at(t[2]) - third - (to - from), 0.2 / 1.3};
}

TEST(Fold, ACornerIsDrivenBeforeJawsThatHoldTheRestOnlyIfTheirEndIsNear) {
  // The triangle is pierced by 0.3 mm: its free corner goes as far before the end as lets the triangle come off it.
  const Astride near = come_astride(0.0003);
  EXPECT_LT(near.way.z, -0.0003 / near.share);
  EXPECT_GT(near.way.z, -0.0004 / near.share);
  // By 10 mm: it would have to go 65 mm in a tick. That put 28 J into a gallbladder's wall.
  const Astride far = come_astride(0.010);
  EXPECT_LT(length(far.way), 1e-6);
}

TEST(Fold, WhatGoesAroundItsEdgeIsForgotten) {
  Drum drum;
  for (int i = 0; i <= 40; ++i) ASSERT_TRUE(drum.step({{0, 0, 0.05}, {0, 0, 0.004 - 1e-4 * i}, 0.001}));
  bool known = false;
  for (const Vec3f& s : drum.side) known = known || dot(s, s) > 0;
  EXPECT_TRUE(known);
  ASSERT_TRUE(drum.step({{0, 0, 0.05}, {0, 0, 0.02}, 0.001}));
  for (const Vec3f& s : drum.side) EXPECT_EQ(dot(s, s), 0);
}

/// A shaft along z, and before its end `tip` a head that is wider.
ToolShape with_head(Vec3d tip) {
  ToolShape shape;
  const Vec3d pivot = tip + Vec3d{0, 0, 0.008}, half{0.0025, 0, 0};
  shape.pivot = pivot;
  shape.frame.tip = tip;
  shape.part[kShaft] = {pivot + Vec3d{0, 0, 0.08}, pivot, 0.0025};
  shape.part[kJawA] = {pivot + half, tip + half, 0.0025};
  shape.part[kJawB] = {pivot - half, tip - half, 0.0025};
  return shape;
}

TEST(Fold, AShaftThatIsThroughComesOutWithItsHeadAndTakesNothingAlong) {
  Drum drum;
  double highest = 0;
  for (int i = 0; i < 110; ++i) {  // at 0.4 m/s
    ASSERT_TRUE(drum.step_with(with_head({0.0003, 0.0004, -0.03 + 0.0004 * i})));
    highest = std::max(highest, drum.height(6, 6));
    if (i < 20) {
      EXPECT_EQ(drum.bond, SheetBond::through) << i;
    }
  }
  EXPECT_LT(highest, 0.0005);
  EXPECT_EQ(length(drum.felt), 0);
  EXPECT_EQ(drum.bond, SheetBond::none);
  // From now on it is an instrument like any other.
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(drum.step_with(with_head({0.0003, 0.0004, 0.0136 - 0.0004 * i})));
  EXPECT_LT(drum.height(6, 6), -0.007);
}

/// A hook that points down, its foot to where x grows or to the other side.
ToolShape hook(Vec3d tip, bool turned) {
  ToolModel model;
  model.kind = ToolKind::hook;
  model.jaw_length = 0.012;
  model.jaw_thickness = 0.0012;
  model.foot = 0.0026;
  model.port = tip + Vec3d{0, 0, 0.1};
  return shape_of(model, {0, 0, turned ? std::numbers::pi : 0.0, 0.1}, 0);
}

TEST(Fold, AHooksFootLiftsItsEdgeUnlessItLooksAway) {
  for (const bool below : {true, false}) {
    Drum drum(true);
    const double edge = 0.0168, beside = edge + 0.0006 + 0.00025 + 0.0002;
    for (int i = 0; i <= 100; ++i) ASSERT_TRUE(drum.step_with(hook({beside + 5e-5 * (100 - i), 0, -0.003}, below)));
    EXPECT_LT(std::fabs(drum.height(12, 6)), 2e-4) << "nothing has been touched so far";
    for (int i = 0; i <= 200; ++i) ASSERT_TRUE(drum.step_with(hook({beside, 0, -0.003 + 2.5e-5 * i}, below)));
    const double lying_on_it = 0.002 + 0.0012 + 0.00025;
    if (below) {
      EXPECT_NEAR(drum.height(12, 6), lying_on_it, 3e-4);
      EXPECT_LT(drum.felt.z, -2e-4) << "it holds the hook back";
    } else {
      EXPECT_LT(std::fabs(drum.height(12, 6)), 2e-4);
    }
  }
}

/// An instrument of the small scene through a port of the test's own.
struct Tool {
  ToolModel model;
  kinematics::FulcrumPose pose;
  Tool(int hand, Vec3d port, Vec3d tip, double roll) : model(small::model().hands[size_t(hand)].rack.front()) {
    model.port = port;
    pose = kinematics::inverse(port, tip, roll);
  }
  ToolShape shape(double aperture) const { return shape_of(model, pose, aperture); }
};

TEST(Fold, IsGraspedBesideTheTubeAndFollowsTheJaws) {
  small::Table t(small::model());
  t.step();
  Tool grasper(small::kGrasper, {0.017, 0.060, -0.008}, {0.017, -0.004, -0.008}, 0);
  const Bodies bodies{t.model, t.state, &t.work, {&t.model.objects, &t.state.objects, &t.work.objects}};
  ToolState tool;
  for (int i = 0; i <= 400; ++i) {
    tool.handle = std::min(1.0, i / 300.0);
    update_grip(grasper.model, grasper.shape(tool.aperture), bodies, tool);
  }
  ASSERT_GE(tool.holds, 2);
  EXPECT_GT(tool.pinch, 0.5 * grasper.model.pinch_max);
  for (int h = 0; h < tool.holds; ++h) {
    ASSERT_EQ(tool.hold[h].at.body, BodyId::membrane(0));
    EXPECT_NE(t.model.membranes[0].sheet.network.fixed[size_t(tool.hold[h].at.node[0])], tissue::kHeld);
  }
  // The jaws draw it 4 mm aside; it comes along and pulls back.
  Vec3d pull{0, 0, 0};
  for (int i = 0; i < 400; ++i) {
    grasper.pose = kinematics::inverse(grasper.model.port, {0.017, -0.004 - 1e-5 * i, -0.008}, 0);
    NetworkLoads& loads = t.work.membranes[0].loads;
    loads.clear();
    hold_loads(grasper.shape(tool.aperture), 0, bodies, tool);
    loads.sort();
    const tissue::MembraneModel& sheet = t.model.membranes[0].sheet;
    ASSERT_TRUE(
        advance(sheet, {}, loads.sorted, loads.reaction, t.state.membranes[0], t.work.membranes[0].body).fine());
    pose_skin(view_of(sheet.network, t.state.membranes[0].network), t.model.membranes[0].skin,
              t.work.membranes[0].pose);
    pull = {0, 0, 0};
    for (const Vec3f& f : loads.reaction) pull -= vec_cast<double>(f);
  }
  EXPECT_NEAR(held_point(bodies, tool.hold[0].at).y -
                  small::model().membranes[0].sheet.network.rest[size_t(tool.hold[0].at.node[0])].y,
              -0.004, 0.0015);
  EXPECT_GT(pull.y, 1e-3);
}

TEST(Fold, ScissorsPartItAsDeepAsTheyReachAndSayHowDeep) {
  for (double reach : {0.004, 0.008}) {
    small::Table t(small::model());
    const sim::MembraneBody& fold = t.model.membranes[0];
    const Tool scissors(small::kScissors, {0.017, 0, 0.1}, {0.017, 0, -reach}, 1.57079632679489662);
    const FoldCut cut = cut_membrane(closed_blades(scissors.model, scissors.shape(0.1)), fold.sheet, fold.depth,
                                     t.state.membranes[0], t.state.torn[0], t.work.parts);
    EXPECT_GT(cut.severed, 3);
    EXPECT_NEAR(cut.depth, reach - small::kTubeRadius, 0.0012);
    int open = 0;
    for (size_t i = 0; i < fold.sheet.triangles.size(); ++i) {
      if (!t.state.torn[0][i]) continue;
      ++open;
      for (int v : fold.sheet.triangles[i])
        EXPECT_NEAR(fold.sheet.network.rest[size_t(v)].x, 0.017, 0.0035) << "only where the blades were";
    }
    EXPECT_GT(open, 1);
    // The same blades find nothing more and change nothing, and what is left is calm.
    const std::vector<std::uint8_t> torn = t.state.torn[0];
    EXPECT_EQ(cut_membrane(closed_blades(scissors.model, scissors.shape(0.1)), fold.sheet, fold.depth,
                           t.state.membranes[0], t.state.torn[0], t.work.parts)
                  .severed,
              0);
    EXPECT_EQ(t.state.torn[0], torn);
    t.steps(500);
    EXPECT_EQ(t.flags & ~std::uint32_t(tissue::StepReport::kInverted), 0u);
  }
}

TEST(Fold, ACutThroughItLetsTheTubeRiseFartherThere) {
  // Whole, the fold holds the tube down; cut all through it holds it less.
  const auto lifted = [](bool cut) {
    small::Table t(small::model());
    const sim::MembraneBody& fold = t.model.membranes[0];
    if (cut)
      for (int s = 0; s < fold.sheet.network.springs; ++s)
        cut_spring(fold.sheet.network, t.state.membranes[0].network, s);
    for (int i = 0; i < 600; ++i) {
      sim::StepReport report;
      sim::StepContext context{t.model, t.input, t.state, t.work, report};
      for (const sim::Stage& stage : sim::stages()) {
        if (std::string(stage.name) == "advance strands") {
          tissue::StrandLoad pull;
          pull.element = 8;
          pull.f0 = {0, 0, 0.1};
          t.work.strands[small::kTube].loads.add(pull, {});
        }
        stage.run(context);
      }
    }
    return t.state.strands[small::kTube].x[8].z;
  };
  EXPECT_GT(lifted(true), 1.1 * lifted(false));
}

}  // namespace
