// What a needle goes through beside a lattice: a cord, a fold, and a body that can be cut. Of the box trainer's scene
// with one of them where its pad was.
#include <gtest/gtest.h>

#include "needle_driver.hpp"
#include "shipped.hpp"

namespace trocar {
namespace {

using interactions::SutureBite;

constexpr double kPierced = 0.6, kHarmed = 1.0;  // [N]
const Vec3d kIn{0, 0.077, -0.070}, kOut{0, 0.063, -0.070};
constexpr double kLies = -0.074;  // [m] the needle's lowest
constexpr double kSlack = 0.98;   // of its length, a tail is laid

scene::Description bare() {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_suture/scene.json");
  d.solids.clear(), d.walls.clear(), d.marks.clear();
  d.variation = {};
  d.tissues[0].stitch_damage = kHarmed;
  return d;
}

scene::Strand cord(double half_length, double z, double radius) {
  scene::Strand s;
  s.name = "cord", s.tissue = "suture_pad";
  for (const double f : {-1.0, -0.3, 0.3, 1.0}) s.centreline.push_back({f * half_length, 0.070, z});
  s.stations = {{0, radius, 0}};
  s.start.fixed = s.end.fixed = true;
  s.foundation = 4000;
  return s;
}

scene::Description with_cord() {
  scene::Description d = bare();
  d.strands = {cord(0.012, kLies, 0.003)};
  return d;
}

/// Stands across the needle's way, between a cord below it and a border above.
scene::Description with_fold() {
  scene::Description d = bare();
  d.strands = {cord(0.030, kLies - 0.014, 0.0015)};
  scene::Membrane m;
  m.name = "fold", m.tissue = "suture_pad", m.strand = "cord";
  m.from = 0.010, m.to = 0.050;
  for (const double x : {-0.020, 0.0, 0.020}) m.base.push_back({x, 0.070, kLies + 0.006});
  m.thickness = 0.0005;
  d.membranes = {m};
  return d;
}

scene::Description with_cuttable() {
  constexpr double kMiddle = kLies + 0.0005;  // the bite is so much deeper
  scene::Description d = bare();
  scene::Solid s;
  s.name = "bar", s.tissue = "suture_pad";
  for (const double x : {-0.018, -0.006, 0.006, 0.018})
    s.sections.push_back({{x, 0.070, kMiddle}, {0, 0.003, 0}, {0, 0, 0.003}, 2});
  s.cell = 0.003;
  s.cuttable = true;
  for (const double x : {-0.021, 0.021}) s.anchors.push_back({{x, 0.070, kMiddle}, 0.009, 0, {}});
  d.solids = {s};
  return d;
}

struct Host {
  const char* name;
  scene::Description (*description)();
  BodyId body;
  bool thin;  ///< it has no inside
};
void PrintTo(const Host& host, std::ostream* out) { *out << host.name; }

/// A needle that was driven through, by its instrument, and is led on by the test.
class Sewn : public NeedleDriver {
 public:
  explicit Sewn(const sim::Model& model) : NeedleDriver(model, model.hand_index("right")), m(model) {
    rest(0.2);
    drive(kIn, kOut, 2.5, 3.2);
  }
  interactions::SutureState& own() { return state.objects.sutures.front(); }

  /// Out of the body with all of the needle, and 10 mm of thread after it.
  void draw_through() {
    input.tools[hand()].handle = 0;
    for (int i = 0; i <= 800; ++i) pose(kIn, kOut, 2.5 + i / 800.0 * 2.6, m_x, m_q), led();
    draw({0, 0, 0.010}, 200);
  }
  /// The needle goes on by `way` in so many ticks.
  void draw(Vec3d way, int ticks) {
    for (int i = 0; i < ticks; ++i) m_x += (1.0 / ticks) * way, led();
  }
  /// The tail is held straight between the other holder's open jaws and across them, until they have closed.
  void take_tail() {
    input.tools[left].handle = 0;
    for (int i = 0; i < 200; ++i) led();
    const interactions::ToolShape shape = sim::shape_of(m, state, size_t(left));
    const Vec3d grip = from_jaw(shape, {0, 0, 0.6 * m.tool(state, size_t(left)).jaw_length});
    const Vec3d across = direction_from_jaw(shape, {0, 1, 0});  // they open in x
    const double entry = last_hole();
    const Vec3d from = suture::point_at(model().thread, suture().thread, entry), before = grip - 0.008 * across;
    suture::ThreadState& t = own().thread;
    for (int i = 0; i < 300; ++i) {
      for (int n = suture::place_at(model().thread, entry).element + 1; i < 130 && n < model().thread.nodes; ++n) {
        const double s = kSlack * (n * model().thread.spacing - entry), way = length(before - from);
        t.x[size_t(n)] = s < way ? from + (s / way) * (before - from) : before + (s - way) * across;
        t.v[size_t(n)] = {};
      }
      input.tools[left].handle = float(std::min(1.0, i / 100.0));
      led();
    }
  }
  /// Of the thread's, the farthest from its needle [m].
  double last_hole() const {
    double most = 0;
    for (int i = 0; i < suture().hole_count; ++i)
      if (suture().holes[size_t(i)].slot >= 0) most = std::max(most, double(suture().holes[size_t(i)].arc));
    return most;
  }

 private:
  const sim::Model& m;
  int left = m.hand_index("left");
  Vec3d m_x;
  Quatd m_q;

  void led() {
    suture::NeedleState& n = own().needle;
    n.x = m_x, n.q = m_q, n.v = {}, n.w = {};
    step();
  }
};

class StitchHost : public testing::TestWithParam<Host> {};

TEST_P(StitchHost, IsPiercedAtItsForceAndGoneThroughAndTheThreadFollows) {
  const sim::Model model = scene::compile(GetParam().description());
  Sewn d(model);
  ASSERT_EQ(d.suture().bite_count, 1);
  const SutureBite& bite = d.suture().bites[0];
  EXPECT_EQ(bite.stage, SutureBite::through);
  EXPECT_EQ(bite.body, GetParam().body);
  EXPECT_GT(d.before_entry, 0.9 * kPierced);
  EXPECT_LT(d.before_entry, 1.2 * kPierced);
  d.draw_through();
  int in_thread = 0;
  for (int i = 0; i < d.suture().hole_count; ++i) in_thread += d.suture().holes[size_t(i)].slot >= 0;
  EXPECT_GE(in_thread, GetParam().thin ? 1 : 2);
  EXPECT_EQ(in_thread, d.suture().hole_count);
  std::printf("%s: pierced at %.2f N, %d holes of the thread, peak %.2f N\n", GetParam().name, d.before_entry,
              in_thread, double(bite.peak));
}

TEST_P(StitchHost, IsHarmedAndThenCutThroughByAThreadThatIsPulledAtHarderThanItBears) {
  const sim::Model model = scene::compile(GetParam().description());
  Sewn d(model);
  d.draw_through();
  d.take_tail();
  ASSERT_GT(d.state.tools[size_t(model.hand_index("left"))].holds, 0);
  const SutureBite& bite = d.suture().bites[0];
  double harmed_at = 0, way = 0;
  for (int i = 0; i < 150 && bite.stage != SutureBite::torn; ++i) {
    d.draw({0, -0.0005, 0.0005}, 10);
    for (int k = 0; k < d.suture().hole_count; ++k) way = std::max(way, double(d.suture().holes[size_t(k)].way));
    if (bite.harmed && harmed_at == 0) harmed_at = double(bite.peak);
  }
  EXPECT_EQ(bite.stage, SutureBite::torn);
  EXPECT_GT(double(bite.peak), 3 * kHarmed);
  EXPECT_LT(double(bite.peak), 5 * kHarmed);
  EXPECT_GT(way, 0.001);
  EXPECT_EQ(d.suture().torn, 1);
  EXPECT_EQ(d.suture().hole_count, 0);
  int torn = 0;
  for (const sim::Event& e : d.events) {
    if (e.kind != sim::Event::torn) continue;
    ++torn;
    EXPECT_EQ(e.hand, model.hand_index("left")) << "it holds the tail; the right hand has let go";
    EXPECT_EQ(e.body, GetParam().body);
  }
  EXPECT_EQ(torn, 1);
  std::printf("%s: harmed at %.2f N, cut through at %.2f N, %.1f mm\n", GetParam().name, harmed_at, double(bite.peak),
              1e3 * way);
}

TEST(StitchHosts, WhatNoneGetsThroughIsNotPierced) {
  scene::Description d = with_cuttable();
  d.tissues[0].puncture = 0;
  const sim::Model model = scene::compile(d);
  const Sewn sewn(model);
  EXPECT_EQ(sewn.suture().bite_count, 0);
  EXPECT_GT(sewn.suture().peak, kPierced);
}

INSTANTIATE_TEST_SUITE_P(Bodies, StitchHost,
                         testing::Values(Host{"cord", with_cord, BodyId(BodyKind::strand, 0), false},
                                         Host{"fold", with_fold, BodyId(BodyKind::membrane, 0), true},
                                         Host{"cuttable", with_cuttable, BodyId::organ(0), false}));

}  // namespace
}  // namespace trocar
