// Bodies of shipped scenes that hands carry to each other rest on each other. None is deeper than 1 mm in another one
// for longer than 50 ms, beyond what the scene was drawn with.
#include <gtest/gtest.h>

#include <trocar/sim/stages/step.hpp>

#include "shipped.hpp"
#include "watch.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

struct Scene {
  const Model& m;
  State s = initial_state(m);
  Work w = make_work(m);
  Input in = m.start;
  Watch watch;
  std::vector<Vec3d> tip;  ///< that hands are commanded to

  Scene(const std::string& name, std::string carried, std::vector<std::string> watched)
      : m(shipped(name)), watch(m, initial_state(m), std::move(carried), std::move(watched)) {
    for (size_t h = 0; h < m.hands.size(); ++h)
      tip.push_back(kinematics::forward(m.hands[h].port, pose_of(m.start.tools[h])).tip);
  }
  void tick() {
    for (size_t h = 0; h < m.hands.size(); ++h)
      in.tools[h] = tool_input(kinematics::inverse(m.hands[h].port, tip[h], double(in.tools[h].roll)),
                               in.tools[h].handle, in.tools[h].instrument);
    step(m, in, s, w);
    if (s.tick % Watch::kEvery == 0) watch.look(s);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void go(size_t hand, Vec3d to, double speed = 0.06) {
    const Vec3d from = tip[hand];
    const int n = int(length(to - from) / (speed * kTick)) + 1;
    for (int i = 1; i <= n; ++i) tip[hand] = from + double(i) / n * (to - from), tick();
  }
  void handle(size_t hand, double to, int n = 300) {
    const double from = double(in.tools[hand].handle);
    for (int i = 1; i <= n; ++i) in.tools[hand].handle = float(from + (to - from) * i / n), tick();
  }
  /// How many samples of both are next to each other: what contact knows.
  int near(BodyId a, BodyId b) const {
    int count = 0;
    for (size_t i = 0; i < m.carried_pairs.size(); ++i) {
      const interactions::CarriedPair& p = m.carried_pairs[i];
      if ((p.body == a && p.on == b) || (p.body == b && p.on == a))
        count += int(std::count_if(s.carried[i].begin(), s.carried[i].end(), [](int n) { return n >= 0; }));
    }
    return count;
  }
  Vec3d vertex(int organ, int v) const { return skin_point(nodes_of(m, s, organ), m.skin(organ), v); }
  /// The vertex of an organ nearest to p.
  int vertex_at(int organ, Vec3d p) const {
    int best = 0;
    for (int v = 0; v < m.skin(organ).size(); ++v)
      if (length(vertex(organ, v) - p) < length(vertex(organ, best) - p)) best = v;
    return best;
  }
  /// A hand takes what is there and holds it.
  void take(size_t hand, Vec3d at, double inside = 0.006) {
    const Vec3d axis = normalised(at - m.hands[hand].port);
    go(hand, at - 0.02 * axis, 0.15);
    go(hand, at + inside * axis);
    handle(hand, 1);
  }
  void let_go(size_t hand) {
    handle(hand, 0);
    go(hand, m.hands[hand].port + 0.03 * normalised(tip[hand] - m.hands[hand].port), 0.15);
  }
};

TEST(MetBodies, ABowelLoopThatIsCarriedOntoTheLiverStaysOutsideOfIt) {
  Scene scene("bowel", "jejunum", {"jejunum", "liver", "omentum", "stomach", "colon"});
  const int jejunum = scene.m.organ_index("jejunum"), liver = scene.m.organ_index("liver");
  const size_t hand = 0;
  const int v = scene.vertex_at(jejunum, {-0.020, 0.050, -0.100});
  scene.ticks(200);
  const Vec3d from = scene.vertex(jejunum, v);
  scene.take(hand, from);
  ASSERT_GT(scene.s.tools[hand].holds, 0);
  const Vec3d tip = scene.tip[hand];
  scene.go(hand, tip + Vec3d{0, 0, 0.055});
  scene.go(hand, tip + Vec3d{0.004, 0.072, 0.062});
  scene.go(hand, tip + Vec3d{0.004, 0.072, 0.046});
  scene.ticks(300);
  EXPECT_GT(length(scene.vertex(jejunum, v) - from), 0.060);
  EXPECT_GT(scene.near(BodyId::organ(size_t(jejunum)), BodyId::organ(size_t(liver))), 3) << "it lies on the liver";
  scene.let_go(hand);
  scene.ticks(500);
  EXPECT_EQ(scene.watch.found(), "");
}

// Held by a hand, then let go: it rolls off.
TEST(MetBodies, AFreedGallbladderLaidOnTheColonStaysOutsideOfIt) {
  Scene scene("cholecystectomy_extract", "gallbladder", {"gallbladder", "colon", "duodenum", "liver"});
  const size_t g = size_t(scene.m.membrane_index("gallbladder")), hand = 0;
  const tissue::NetworkModel& wall = scene.m.membranes[g].sheet.network;
  const auto place = [&](int n) { return position(wall, scene.s.membranes[g].network, n); };
  const Vec3d top{-0.085, 0.094, -0.106};
  int held = 0;
  for (int n = 0; n < wall.nodes; ++n)
    if (length(wall.rest[size_t(n)] - top) < length(wall.rest[size_t(held)] - top)) held = n;
  scene.ticks(1000);
  scene.take(hand, place(held), 0.001);
  ASSERT_GT(scene.s.tools[hand].holds, 0);
  const Vec3d tip = scene.tip[hand];
  scene.go(hand, tip + Vec3d{0, 0, 0.095});
  scene.go(hand, tip + Vec3d{0, -0.036, 0.095});
  scene.go(hand, tip + Vec3d{0, -0.036, 0.076});
  scene.ticks(500);
  EXPECT_GT(scene.near(BodyId::membrane(g), BodyId::organ(size_t(scene.m.organ_index("colon")))), 3)
      << "it lies on the colon";
  scene.let_go(hand);
  EXPECT_EQ(scene.watch.found(), "");
}

}  // namespace
