// The gallbladder's scene: a closed wall with bile inside hangs still, is held, squeezed, cut and torn; and folds of
// the gynaecology scene tear where they are weak. Under the laws of the step.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kGrasper = 0, kScissors = 1;

Model gallbladder(double failure_strain) {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json");
  for (scene::Tissue& t : d.tissues)
    if (t.name == "gallbladder_wall") t.failure_strain = failure_strain;
  return scene::compile(d);
}
const Model& strong() {
  static const Model made = gallbladder(0);
  return made;
}
const Model& weak() {
  static const Model made = gallbladder(0.15);
  return made;
}

/// Where a hand's tip shall be, and how far its handle is closed, at a tick.
struct Way {
  int hand;
  Vec3d from, to;
  int arrive, close, lift_from;
  Vec3d lift;  ///< a tick
  double close_to = 0.98;
};

Input at_tick(const Model& m, const Way& way, int tick) {
  Input input = m.start;
  const double there = std::min(1.0, double(tick) / way.arrive);
  const Vec3d tip = way.from + there * (way.to - way.from) + double(std::max(0, tick - way.lift_from)) * way.lift;
  const Vec3d port = m.hands[size_t(way.hand)].port;
  const kinematics::FulcrumPose pose = kinematics::inverse(port, tip, double(input.tools[size_t(way.hand)].roll));
  input.tools[size_t(way.hand)] = tool_input(pose, float(std::clamp((tick - way.close) / 300.0, 0.0, way.close_to)));
  return input;
}

struct Story {
  std::vector<Event> events;
  std::vector<std::uint64_t> hashes;  ///< every 50 ticks
  std::vector<double> pressure, volume;
  int most_held = 0;
  State end;
};
Story told(const Model& m, const Way& way, int ticks, bool hard = false, int threads = 1) {
  core::ThreadPool pool(threads);
  Story story;
  State s = initial_state(m);
  Work w = make_work(m, &pool);
  for (int tick = 0; tick < ticks; ++tick) {
    const StepReport report = step(m, at_tick(m, way, tick), s, w);
    EXPECT_TRUE(report.fine()) << tick;
    for (int e = 0; e < report.event_count; ++e) story.events.push_back(report.events[e]);
    story.most_held = std::max(story.most_held, int(s.tools[size_t(way.hand)].holds));
    story.pressure.push_back(s.membranes[0].enclosure.pressure);
    story.volume.push_back(s.membranes[0].enclosure.volume);
    if (tick % 50 == 0) story.hashes.push_back(hash_of(s));
    if (!hard) continue;
    if (tick % 10 == 0) poison(w);
    if (tick % 97 == 0) {
      const State copy = s;
      s = copy;
      w = make_work(m, &pool);
    }
  }
  story.end = s;
  return story;
}

/// To the fundus and some way into it, along the grasper's shaft; later back.
Way to_fundus(double depth, int close, double back) {
  const Vec3d centre{-0.021, 0.097, -0.108}, port = strong().hands[kGrasper].port, along = normalised(centre - port);
  return {kGrasper, centre - 0.05 * along, centre - (0.0125 - depth) * along, 350, close, 700, -back * along};
}
Way hold_and_pull() { return to_fundus(0.004, 250, 4e-5); }
Way poke() { return {kGrasper, {-0.030, 0.070, -0.070}, {-0.022, 0.112, -0.110}, 1000, 5000, 5000, {0, 0, 0}}; }

bool told_of(const Story& story, Event::Kind kind, BodyId body) {
  return std::any_of(story.events.begin(), story.events.end(),
                     [&](const Event& e) { return e.kind == kind && (!body.exists() || e.body == body); });
}
std::ptrdiff_t torn_triangles(const State& s, size_t membrane) {
  return std::count(s.torn[membrane].begin(), s.torn[membrane].end(), 1);
}

const Story& pulled() {
  static const Story made = told(weak(), hold_and_pull(), 2000);
  return made;
}

}  // namespace

TEST(Pouch, TheGallbladderHangsStillAndKeepsItsPressure) {
  const Model& m = strong();
  ASSERT_EQ(m.membranes.size(), 1u);
  const tissue::MembraneModel& wall = m.membranes[0].sheet;
  EXPECT_TRUE(wall.closed());
  EXPECT_GT(wall.enclosure.volume, 20e-6);
  EXPECT_LT(wall.enclosure.volume, 50e-6);
  State s = initial_state(m);
  Work w = make_work(m);
  double worst = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(step(m, m.start, s, w).fine());
    for (int i = 0; i < wall.nodes(); ++i)
      worst = std::max(worst, length(position(wall.network, s.membranes[0].network, i) - wall.network.rest[size_t(i)]));
  }
  RecordProperty("moved_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.0004);
  EXPECT_NEAR(s.membranes[0].enclosure.pressure, 1000, 50);
}

TEST(Pouch, PressedInByAnInstrumentItKeepsItsVolumeAndPressesBack) {
  const Story story = told(strong(), poke(), 1600);
  const double v0 = strong().membranes[0].sheet.enclosure.volume, p0 = 1000;
  const auto [low, high] = std::minmax_element(story.volume.begin(), story.volume.end());
  EXPECT_GT(*low, 0.97 * v0);
  EXPECT_LT(*high, 1.03 * v0);
  EXPECT_GT(story.pressure.back(), p0 + 50) << "it is squeezed";
  EXPECT_EQ(story.end.membranes[0].enclosure.leaking, 0u);
  const double(&force)[3] = story.end.tools[kGrasper].contact_force;
  EXPECT_GT(length(Vec3d{force[0], force[1], force[2]}), 0.05);
}

TEST(Pouch, ABladeThroughItsWallOpensItAndItRunsOut) {
  const Model& m = strong();
  State s = initial_state(m);
  Work w = make_work(m);
  const geometry::Blade blade = geometry::square_blade({-0.021, 0.090, -0.105}, {1, 0, 0}, 0.008);  // the fundus
  const interactions::FoldCut cut =
      interactions::cut_membrane(blade, m.membranes[0].sheet, m.membranes[0].depth, s.membranes[0], s.torn[0], w.parts);
  EXPECT_GT(cut.severed, 2);
  EXPECT_GT(torn_triangles(s, 0), 2);
  EXPECT_EQ(s.membranes[0].enclosure.leaking, 1u);
  double last = s.membranes[0].enclosure.left;
  for (int tick = 0; tick < 1500; ++tick) {
    ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
    EXPECT_LE(s.membranes[0].enclosure.left, last);
    last = s.membranes[0].enclosure.left;
  }
  EXPECT_LT(s.membranes[0].enclosure.pressure, 100);
  EXPECT_LT(last, 0.9) << "the hole is large";
  EXPECT_GT(s.membranes[0].enclosure.volume, 0.3 * m.membranes[0].sheet.enclosure.volume) << "the wall stands";
}

TEST(Pouch, WhatRunsOutOfAnOpenGallbladderIsInTheAccountToThePicolitre) {
  const Model m = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy/scene.json"));
  const size_t wall = size_t(
      std::find_if(m.membranes.begin(), m.membranes.end(), [](const MembraneBody& b) { return b.sheet.closed(); }) -
      m.membranes.begin());
  ASSERT_LT(wall, m.membranes.size());
  const MembraneBody& gallbladder = m.membranes[wall];
  State s = initial_state(m);
  Work w = make_work(m);
  const tissue::NetworkModel& net = gallbladder.sheet.network;
  const Vec3d at = *std::min_element(net.rest.begin(), net.rest.end(), [](Vec3d a, Vec3d b) { return a.z > b.z; });
  const geometry::Blade blade = geometry::square_blade(at, {1, 0, 0}, 0.008);
  interactions::cut_membrane(blade, gallbladder.sheet, gallbladder.depth, s.membranes[wall], s.torn[wall], w.parts);
  for (int tick = 0; tick < 800; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
  const double lost = (1 - s.membranes[wall].enclosure.left) * gallbladder.sheet.enclosure.volume;
  const std::int64_t booked = s.fluids.ledger.in[size_t(fluids::Source::kBled)].bile;
  EXPECT_GT(lost, 0.2e-6);
  EXPECT_NEAR(double(booked), lost / fluids::kM3PerPicolitre, 1);
  EXPECT_TRUE(audit(m.wet.model, s.fluids));
}

TEST(Pouch, ScissorsThatCloseOnItsTautWallOpenItAndItRunsOut) {
  const Vec3d centre{-0.021, 0.097, -0.108}, port = strong().hands[kScissors].port, along = normalised(centre - port);
  for (const double depth : {0.004, 0.007, 0.010}) {
    const Way way{kScissors, centre - 0.05 * along, centre - (0.0125 - depth) * along, 350, 450, 5000, {0, 0, 0}, 1.0};
    const Story story = told(strong(), way, 1600);
    EXPECT_TRUE(told_of(story, Event::cut, {})) << depth;
    EXPECT_EQ(story.end.membranes[0].enclosure.leaking, 1u) << depth;
    EXPECT_LT(story.end.membranes[0].enclosure.pressure, 900) << depth;
    EXPECT_LT(story.end.membranes[0].enclosure.left, 1) << depth;
  }
}

TEST(Pouch, GraspedAtItsFundusAndPulledItHoldsAndGivesBack) {
  const Story story = told(strong(), to_fundus(0.004, 250, 1e-5), 1500);
  EXPECT_GE(story.end.tools[kGrasper].holds, 1);
  EXPECT_GT(length(Vec3d{story.end.tools[kGrasper].pull[0], story.end.tools[kGrasper].pull[1],
                         story.end.tools[kGrasper].pull[2]}),
            0.05);
  const auto grasped =
      std::count_if(story.events.begin(), story.events.end(), [](const Event& e) { return e.kind == Event::grasped; });
  EXPECT_LE(grasped, 3) << "no grip that comes and goes";
  EXPECT_EQ(story.end.membranes[0].enclosure.leaking, 0u);
}

TEST(Pouch, GraspedAtItsFundusAndPulledTooFarItTearsAndRunsOut) {
  const Story& story = pulled();
  EXPECT_GE(story.most_held, 1);
  EXPECT_TRUE(told_of(story, Event::torn, BodyId::membrane(0)));
  EXPECT_GT(torn_triangles(story.end, 0), 0);
  EXPECT_EQ(story.end.membranes[0].enclosure.leaking, 1u);
  EXPECT_LT(story.end.membranes[0].enclosure.left, 0.95);
}

TEST(Pouch, PoisonedScratchAndCopiesChangeNoBit) {
  EXPECT_EQ(told(weak(), hold_and_pull(), 2000, true).hashes, pulled().hashes);
}

TEST(Pouch, TwoThreadsGiveTheSameBits) {
  EXPECT_EQ(told(weak(), hold_and_pull(), 2000, false, 2).hashes, pulled().hashes);
}

TEST(Pouch, AFoldOfTheGynaecologySceneTearsWhereItIsWeak) {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  for (scene::Tissue& t : d.tissues)
    if (t.name == "peritoneal_fold") t.failure_strain = 0.5;
  const Model m = scene::compile(d);
  const int tube = m.strand_index("tube_left");
  ASSERT_GE(tube, 0);
  int fold = -1;
  for (size_t i = 0; i < m.membranes.size(); ++i)
    if (m.membranes[i].strand == tube) fold = int(i);
  ASSERT_GE(fold, 0);
  const interactions::StrandBody& body = m.strand_bodies[size_t(tube)];
  const Vec3d middle = body.model.rest[size_t(body.nodes() * 6 / 10)];
  const Vec3d start = m.hands[kGrasper].port + 0.5 * (middle - m.hands[kGrasper].port);
  const Story story = told(m, {kGrasper, start, middle, 500, 600, 1000, {0, 0, 3e-5}, 0.98}, 3500);
  EXPECT_GT(story.most_held, 0);
  EXPECT_TRUE(told_of(story, Event::torn, BodyId::membrane(size_t(fold))));
  EXPECT_GT(torn_triangles(story.end, size_t(fold)), 0);
  EXPECT_EQ(story.end.membranes[size_t(fold)].enclosure.leaking, 0u) << "nothing is enclosed";
}
