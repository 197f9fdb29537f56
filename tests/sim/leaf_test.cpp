// Leaves in scenes: peritoneum over an organ and over fat hangs as drawn, is peeled off and cut; gauze between clips is
// cut out. All that a scene file says of them is in the settings below.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kGrasper = 0, kScissors = 1;

/// Where it is spanned: a rectangle before what it lies on, seen against `normal`.
struct Frame {
  Vec3d middle, along, across, normal;
  double wide = 0.02, high = 0.02, step = 0.004;
};

/// Lines that lie by `over` before the farthest of the places that are near each of their points; in the plane where
/// none is.
std::vector<std::vector<Vec3d>> draped(const Frame& f, const std::vector<Vec3d>& places, double over) {
  std::vector<std::vector<Vec3d>> lines;
  for (double v = -f.high / 2; v <= f.high / 2 + 1e-9; v += f.step) {
    std::vector<Vec3d>& line = lines.emplace_back();
    for (double u = -f.wide / 2; u <= f.wide / 2 + 1e-9; u += f.step) {
      const Vec3d at = f.middle + u * f.along + v * f.across;
      double highest = -1;
      for (const Vec3d& p : places) {
        const Vec3d off = p - at;
        const double h = dot(off, f.normal);
        if (length(off - h * f.normal) < 0.004 && std::fabs(h) < 0.02) highest = std::max(highest, h);
      }
      line.push_back(at + (highest > -1 ? highest + over : 0) * f.normal);
    }
  }
  return lines;
}

scene::LeafSetting leaf_over(std::vector<std::vector<Vec3d>> lines, const std::vector<std::string>& on) {
  scene::LeafSetting leaf;
  leaf.name = "leaf", leaf.tissue = "peritoneal_fold", leaf.look = "peritoneum";
  leaf.lines = std::move(lines);
  leaf.thickness = 0.0003;
  leaf.spacing = 0.003;
  scene::BondSetting bonds;
  bonds.name = "areolar", bonds.on = on, bonds.reach = 0.006, bonds.toughness = 10, bonds.opens = 0.004;
  for (const std::vector<Vec3d>& line : leaf.lines)
    for (const Vec3d& p : line) bonds.places.push_back({p, 0.004, 0, {}});
  leaf.bonds = {bonds};
  return leaf;
}

/// The liver's edge, with a leaf over its front from `y` on [m].
Model over_liver_from(double y) {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json");
  const Model bare = scene::compile(d);
  std::vector<Vec3d> skin;
  for (const Vec3f p : bare.skin(bare.organ_index("liver")).rest) skin.push_back(vec_cast<double>(p));
  const Frame front{{0, 0.5 * (y + 0.128), -0.085}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.028, 0.128 - y};
  settings_of(scene::LeafScene{}, d.objects) = {leaf_over(draped(front, skin, 0.0008), {"liver"})};
  return scene::compile(d);
}
const Model& over_liver() {
  static const Model made = over_liver_from(0.108);
  return made;
}

/// Calot's triangle, with a leaf over its fat.
const Model& over_fat() {
  static const Model made = [] {
    scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json");
    const Model bare = scene::compile(d);
    const std::vector<Vec3d>& lobules = bare.fat.front().fat.network.rest;
    const Frame front{{-0.046, 0.116, -0.094}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.016, 0.012};
    settings_of(scene::LeafScene{}, d.objects) = {
        leaf_over(draped(front, lobules, 0.0025), {bare.fat.front().name, "liver", "gallbladder"})};
    return scene::compile(d);
  }();
  return made;
}

std::size_t leaf_of(const Model& m) { return std::size_t(m.membrane_index("leaf")); }
std::size_t bonds_of_leaf(const Model& m) { return std::size_t(m.bonds_index("areolar")); }
double share(const Model& m, const State& s) {
  return interactions::holding_share(m.bonds[bonds_of_leaf(m)], s.bonds[bonds_of_leaf(m)]);
}
Vec3d node(const Model& m, const State& s, int i) {
  return tissue::position(m.membranes[leaf_of(m)].sheet.network, s.membranes[leaf_of(m)].network, i);
}

/// How far it has gone from where it was drawn in a second [m].
double strayed(const Model& m, State& s) {
  Work w = make_work(m);
  const tissue::MembraneModel& sheet = m.membranes[leaf_of(m)].sheet;
  double worst = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    EXPECT_TRUE(step(m, m.start, s, w).fine()) << tick;
    for (int i = 0; i < sheet.nodes(); ++i)
      worst = std::max(worst, length(node(m, s, i) - sheet.network.rest[size_t(i)]));
  }
  return worst;
}

Input with_tool(const Model& m, int hand, Vec3d tip, double handle) {
  Input input = m.start;
  kinematics::FulcrumPose pose = kinematics::inverse(m.hands[size_t(hand)].port, tip, 0);
  pose.roll = kinematics::roll_towards(pose, {0, 1, 0});  // the jaws open across the leaf
  input.tools[hand] = tool_input(pose, float(handle));
  return input;
}
Vec3d before(const Model& m, int hand, Vec3d place, double by) {
  return place - by * normalised(place - m.hands[size_t(hand)].port);
}

/// A grasper takes the leaf's free edge and draws it off.
Input peeling(const Model& m, Vec3d edge, int tick) {
  const Vec3d from = before(m, kGrasper, edge, 0.03), to = before(m, kGrasper, edge, -0.005);
  Vec3d tip = from + std::min(1.0, tick / 300.0) * (to - from);
  tip += std::clamp(tick - 600, 0, 2000) * Vec3d{0, 1.2e-5, 1.6e-5};
  return with_tool(m, kGrasper, tip, std::clamp((tick - 300) / 200.0, 0.0, 1.0));
}

TEST(Leaf, OverAnOrganItHangsAsDrawn) {
  const Model& m = over_liver();
  EXPECT_GT(m.bonds[bonds_of_leaf(m)].bonds.size(), 30u);
  State s = initial_state(m);
  const double worst = strayed(m, s);
  RecordProperty("strayed_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.0006);
  EXPECT_EQ(share(m, s), 1);
}

TEST(Leaf, OverFatItHangsAsDrawn) {
  const Model& m = over_fat();
  int on_fat = 0;
  for (const interactions::Bond& bond : m.bonds[bonds_of_leaf(m)].bonds) on_fat += bond.far.body.is(BodyKind::fat);
  EXPECT_GT(on_fat, 10);
  State s = initial_state(m);
  const double worst = strayed(m, s);
  RecordProperty("strayed_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.0015);
  EXPECT_EQ(share(m, s), 1);
}

TEST(Leaf, DrawnAtItsEdgeItPeelsOffAndNothingHeals) {
  const Model m = over_liver_from(0.092);  // beyond the liver's edge it hangs free: a flap
  State s = initial_state(m);
  Work w = make_work(m);
  const tissue::MembraneModel& sheet = m.membranes[leaf_of(m)].sheet;
  const int in_second_row = sheet.columns + sheet.columns / 2;
  Vec3d edge;
  std::vector<double> shares;
  double pulled = 0;
  for (int tick = 0; tick < 2600; ++tick) {
    if (tick < 450) edge = node(m, s, in_second_row);  // it sways
    ASSERT_TRUE(step(m, peeling(m, edge, tick), s, w).fine()) << tick;
    shares.push_back(share(m, s));
    const double* pull = s.tools[kGrasper].pull;
    if (tick > 1000) pulled += length(Vec3d{pull[0], pull[1], pull[2]}) / 1600;
  }
  RecordProperty("pulled_N", std::to_string(pulled));
  EXPECT_GT(pulled, 0.05) << "on the average";
  EXPECT_LT(pulled, 0.28) << "that of all its width at once: 10 J/m^2 times 28 mm";
  EXPECT_GT(shares[600], 0.95) << "being grasped opens little";
  EXPECT_LT(shares.back(), 0.9);
  EXPECT_TRUE(std::is_sorted(shares.rbegin(), shares.rend()));
  RecordProperty("share_left", std::to_string(shares.back()));
}

/// Gauze in a frame: it is held by clips at its corners and at the middles of its sides, and by nothing else.
scene::LeafSetting gauze() {
  constexpr double kHalf = 0.02;
  const Vec3d middle{0, 0.075, -0.06};
  scene::LeafSetting leaf;
  leaf.name = "leaf", leaf.tissue = "peritoneal_fold", leaf.look = "gauze";
  for (const double v : {-kHalf, 0.0, kHalf})
    leaf.lines.push_back({middle + Vec3d{-kHalf, v, 0}, middle + Vec3d{0, v, 0}, middle + Vec3d{kHalf, v, 0}});
  leaf.thickness = 0.0005;
  leaf.spacing = 0.0025;
  for (const double u : {-kHalf, 0.0, kHalf})
    for (const double v : {-kHalf, 0.0, kHalf})
      if (u != 0 || v != 0) leaf.held.push_back({middle + Vec3d{u, v, 0}, 0.002, 0, {}});
  return leaf;
}

TEST(Leaf, GauzeHangsBetweenClipsAndIsCutFromItsEdge) {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json");
  settings_of(scene::LeafScene{}, d.objects) = {gauze()};
  const Model m = scene::compile(d);
  State s = initial_state(m);
  EXPECT_LT(strayed(m, s), 0.0006);
  Work w = make_work(m);
  const auto torn = [&] { return std::count(s.torn[leaf_of(m)].begin(), s.torn[leaf_of(m)].end(), 1); };
  ASSERT_EQ(torn(), 0);
  const Vec3d edge{0.01, 0.055, -0.06};
  for (int tick = 0; tick < 1500; ++tick) {  // three snips, each deeper
    const int snip = tick / 500, t = tick % 500;
    const Vec3d at = edge + Vec3d{0, 0.004 * (snip + 1), 0};
    const Vec3d from = before(m, kScissors, at, 0.02), to = before(m, kScissors, at, -0.002);
    const double way = std::clamp(t / 150.0, 0.0, 1.0) - std::clamp((t - 350) / 150.0, 0.0, 1.0);
    const double handle = std::clamp((t - 150) / 100.0, 0.0, 1.0) - std::clamp((t - 280) / 70.0, 0.0, 1.0);
    ASSERT_TRUE(step(m, with_tool(m, kScissors, from + way * (to - from), handle), s, w).fine()) << tick;
  }
  RecordProperty("torn", std::to_string(torn()));
  EXPECT_GT(torn(), 2);
}

}  // namespace
