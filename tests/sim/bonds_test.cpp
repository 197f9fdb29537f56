// A gallbladder that is tied to its bed by bonds: it hangs as drawn, parts where it is pulled or cut, and never grows
// together again. Under the laws of the step.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kGrasper = 0;

/// The shipped scene; what held the wall in its bed are bonds now.
Model bonded_gallbladder() {
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json");
  scene::Pouch& pouch = d.pouches.at(0);
  scene::BondSetting bed;
  bed.name = "bed";
  bed.on = {"liver"};
  bed.places.assign(pouch.held.begin(), pouch.held.end() - 1);
  pouch.held.erase(pouch.held.begin(), pouch.held.end() - 1);
  pouch.bonds = {bed};
  return scene::compile(d);
}
const Model& model() {
  static const Model made = bonded_gallbladder();
  return made;
}
double share(const State& s) { return interactions::holding_share(model().bonds[0], s.bonds[0]); }

/// A grasper takes the fundus and draws it away from the liver.
Input pulling(int tick) {
  const Model& m = model();
  const Vec3d centre{-0.021, 0.097, -0.108}, port = m.hands[kGrasper].port, along = normalised(centre - port);
  const Vec3d from = centre - 0.05 * along, to = centre - 0.0085 * along;
  Vec3d tip = from + std::min(1.0, tick / 350.0) * (to - from);
  tip += std::clamp(tick - 700, 0, 2000) * Vec3d{0, -8e-6, -8e-6};
  Input input = m.start;
  input.tools[kGrasper] = tool_input(kinematics::inverse(port, tip, double(input.tools[kGrasper].roll)),
                                     float(std::clamp((tick - 250) / 300.0, 0.0, 0.98)));
  return input;
}

struct Story {
  std::vector<std::uint64_t> hashes;
  std::vector<double> shares;
  State end;
};
Story told(bool hard = false, int threads = 1) {
  const Model& m = model();
  core::ThreadPool pool(threads);
  Story story;
  State s = initial_state(m);
  Work w = make_work(m, &pool);
  for (int tick = 0; tick < 2700; ++tick) {
    EXPECT_TRUE(step(m, pulling(tick), s, w).fine()) << tick;
    story.shares.push_back(share(s));
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
const Story& pulled() {
  static const Story made = told();
  return made;
}

}  // namespace

TEST(BondedPouch, ItHangsAsDrawnAndNoBondGivesWay) {
  const Model& m = model();
  ASSERT_EQ(m.bonds.size(), 1u);
  EXPECT_GT(m.bonds[0].bonds.size(), 15u);
  State s = initial_state(m);
  Work w = make_work(m);
  double worst = 0;
  const tissue::MembraneModel& wall = m.membranes[0].sheet;
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
    for (int i = 0; i < wall.nodes(); ++i)
      worst = std::max(worst, length(position(wall.network, s.membranes[0].network, i) - wall.network.rest[size_t(i)]));
  }
  RecordProperty("moved_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.0006);
  EXPECT_EQ(share(s), 1);
  EXPECT_NEAR(s.membranes[0].enclosure.pressure, 1000, 60);
}

TEST(BondedPouch, PulledAtItsFundusItPeelsOffItsBedAndNothingHeals) {
  const Story& story = pulled();
  EXPECT_EQ(story.shares[600], 1) << "being grasped opens nothing";
  EXPECT_LT(story.shares.back(), 0.8);
  EXPECT_TRUE(std::is_sorted(story.shares.rbegin(), story.shares.rend()));
  const std::vector<interactions::BondState>& bonds = story.end.bonds[0];
  EXPECT_TRUE(std::any_of(bonds.begin(), bonds.end(), [](const auto& b) { return !b.holds(); }));
  for (const interactions::BondState& bond : bonds)
    EXPECT_EQ(bond.cause, bond.damage > 0 ? interactions::BondState::pulled : interactions::BondState::whole);
}

TEST(BondedPouch, ABladeBetweenWallAndLiverPartsWhatItCrosses) {
  const Model& m = model();
  State s = initial_state(m);
  Work w = make_work(m);
  StepReport report = step(m, m.start, s, w);
  StepContext context{m, m.start, s, w, report};
  const interactions::Bond& bond = m.bonds[0].bonds[m.bonds[0].bonds.size() / 2];
  const Vec3d node = place_of(bodies_of(context), bond.near), across = node - root_of(bodies_of(context), bond);
  const int severed = sever_bonds(context, geometry::square_blade(node - 0.5 * across, normalised(across), 0.006));
  EXPECT_GE(severed, 1);
  EXPECT_LT(size_t(severed), m.bonds[0].bonds.size());
  EXPECT_LT(share(s), 1);
  EXPECT_EQ(sever_bonds(context, geometry::square_blade({0, 0, 0.05}, {0, 0, 1}, 0.006)), 0);
  for (int tick = 0; tick < 300; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
}

// Hydrodissection: 5 mL take most of a bond's strength where they come in.
TEST(BondedPouch, FluidInItsPlaneLoosensBondsByAtMostEightyFivePercentAndPartsNone) {
  const Model& m = model();
  State s = initial_state(m);
  Work w = make_work(m);
  StepReport report = step(m, m.start, s, w);
  StepContext context{m, m.start, s, w, report};
  const interactions::Bodies bodies = bodies_of(context);
  const std::vector<interactions::Bond>& bonds = m.bonds[0].bonds;
  std::vector<Vec3d> feet;
  for (const interactions::Bond& bond : bonds) feet.push_back(root_of(bodies, bond));
  const size_t middle = bonds.size() / 2;
  constexpr double kSpread = 0.004;
  loosen_bonds(context, feet[middle], 2e-6, kSpread);
  EXPECT_NEAR(s.bonds[0][middle].damage, 0.4, 1e-6);
  int untouched = 0;
  for (size_t b = 0; b < bonds.size(); ++b) {
    EXPECT_LE(s.bonds[0][b].damage, 0.4f + 1e-6f);
    untouched += s.bonds[0][b].damage == 0;
  }
  EXPECT_GT(untouched, 0) << "of bonds far away";
  for (const Vec3d& foot : feet) loosen_bonds(context, foot, 50e-6, kSpread);
  for (const interactions::BondState& bond : s.bonds[0]) {
    EXPECT_EQ(bond.damage, 0.85f);
    EXPECT_TRUE(bond.holds());
  }
  EXPECT_GT(share(s), 0);

  // The same pull takes off more of it.
  const auto holding = [](const State& state) {
    return std::count_if(state.bonds[0].begin(), state.bonds[0].end(), [](const auto& b) { return b.holds(); });
  };
  for (int tick = 0; tick < 2700; ++tick) ASSERT_TRUE(step(m, pulling(tick), s, w).fine()) << tick;
  std::printf("of %d bonds %d hold after the pull; with fluid in their plane %d\n", int(bonds.size()),
              int(holding(pulled().end)), int(holding(s)));
  EXPECT_LT(holding(s), holding(pulled().end));
}

TEST(BondedPouch, KeyframesShowWhatHasParted) {
  State shown = initial_state(model());
  const std::vector<std::uint8_t> bytes = display_bytes(model(), pulled().end);
  ASSERT_TRUE(restore_display(model(), bytes, shown));
  EXPECT_EQ(share(shown), share(pulled().end));
  std::vector<std::uint8_t> hostile = bytes;
  std::fill(hostile.end() - 8, hostile.end(), std::uint8_t(0xff));
  EXPECT_FALSE(restore_display(model(), hostile, shown)) << "a damage that is no number";
}

TEST(BondedPouch, PoisonedScratchAndCopiesChangeNoBit) { EXPECT_EQ(told(true).hashes, pulled().hashes); }

TEST(BondedPouch, TwoThreadsGiveTheSameBits) { EXPECT_EQ(told(false, 2).hashes, pulled().hashes); }

TEST(BondedPouch, BondsDoNotDriveAnOrganThatIsLighterThanTheirStiffness) {
  const Model m = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json"));
  ASSERT_EQ(m.bonds.size(), 1u);
  const int liver = m.organ_index("liver");
  State s = initial_state(m);
  Work w = make_work(m);
  for (int tick = 0; tick < 1500; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
  double worst = 0;
  const tissue::NodeView nodes = nodes_of(m, s, liver);
  for (int i = 0; i < m.solids[size_t(liver)].network.nodes; ++i)
    worst = std::max(worst, length(nodes.position(i) - m.solids[size_t(liver)].network.rest[size_t(i)]));
  RecordProperty("moved_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.0006);
  EXPECT_EQ(interactions::holding_share(m.bonds[0], s.bonds[0]), 1);
}

TEST(BondedPouch, WhereItWasTornOffBloodOozesUntilThatIsCoagulated) {
  const Model m = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed/scene.json"));
  const interactions::BondSet& bed = m.bonds.at(0);
  State s = initial_state(m);
  Work w = make_work(m);
  const auto bled = [&] { return s.fluids.ledger.in[size_t(fluids::Source::kBled)].blood; };
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  EXPECT_EQ(bled(), 0);

  for (interactions::BondState& bond : s.bonds[0]) bond = {1, interactions::BondState::pulled};
  const int ticks = int(bed.bonds.size()) * 20;
  for (int tick = 0; tick < ticks; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  const double expected = bed.oozes * bed.area() * ticks * kTick;
  EXPECT_NEAR(fluids::kM3PerPicolitre * double(bled()) / expected, 1, 0.001);
  EXPECT_EQ(bled(), s.flow.bled);
  EXPECT_TRUE(audit(m.wet.model, s.fluids));

  StepReport report;
  StepContext context{m, m.start, s, w, report};
  const interactions::Bodies bodies = bodies_of(context);
  for (const interactions::Bond& bond : bed.bonds) burn_bonds(context, root_of(bodies, bond), 0.001);
  for (const interactions::BondState& bond : s.bonds[0]) EXPECT_FALSE(bond.raw());
  const std::int64_t before = bled();
  for (int tick = 0; tick < 200; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  EXPECT_EQ(bled(), before);
}

namespace {

Model bed_of(const char* scene) {
  return scene::compile(scene::read_scene(std::string(TROCAR_SOURCE_DIR "/scenes/") + scene + "/scene.json"));
}
const Model& scarred() {
  static const Model made = bed_of("gallbladder_bed_scarred");
  return made;
}
double breached(const Model& m, const State& s) { return interactions::breached_area(m.bonds[0], s.bonds[0]); }

/// An electrode at every bond's root, for that long.
void burn_all(const Model& m, State& s, Work& w, double seconds) {
  StepReport report;
  StepContext context{m, m.start, s, w, report};
  const interactions::Bodies bodies = bodies_of(context);
  for (const interactions::Bond& bond : m.bonds[0].bonds) burn_bonds(context, root_of(bodies, bond), seconds);
}

}  // namespace

TEST(ScarredBed, IsTougherThanTheLiverAndTheOthersAreNot) {
  EXPECT_TRUE(scarred().bonds.at(0).breaches);
  EXPECT_NEAR(scarred().bonds.at(0).law.toughness(), 164, 1e-9) << "what the liver takes";
  EXPECT_FALSE(bed_of("gallbladder_bed").bonds.at(0).breaches);
  const Model inflamed = bed_of("gallbladder_bed_inflamed");
  EXPECT_FALSE(inflamed.bonds.at(0).breaches);
  EXPECT_NEAR(inflamed.bonds.at(0).law.toughness(), 120, 1e-9);
}

TEST(ScarredBed, TornOffItBreachesTheLiverWhichBleedsUntilItIsCoagulated) {
  const Model& m = scarred();
  const interactions::BondSet& bed = m.bonds[0];
  State s = initial_state(m);
  Work w = make_work(m);
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  for (interactions::BondState& bond : s.bonds[0]) bond = {1, interactions::BondState::pulled};
  EXPECT_DOUBLE_EQ(breached(m, s), bed.area());
  const auto bled = [&] { return s.fluids.ledger.in[size_t(fluids::Source::kBled)].blood; };
  const int ticks = int(bed.bonds.size()) * 20;
  for (int tick = 0; tick < ticks; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  const double expected = bed.bleeds * bed.area() * ticks * kTick;
  EXPECT_NEAR(fluids::kM3PerPicolitre * double(bled()) / expected, 1, 0.001);
  EXPECT_GE(bed.bleeds * 60 * 1e6 * 1e-4, 0.5) << "mL/min/cm2 of a breached bed";

  burn_all(m, s, w, 0.001);
  const std::int64_t before = bled();
  for (int tick = 0; tick < 200; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
  EXPECT_EQ(bled(), before);
  EXPECT_DOUBLE_EQ(breached(m, s), bed.area()) << "it stays torn";
}

TEST(ScarredBed, CoagulatedOrCutTheScarPartsAndTheLiverStaysWhole) {
  const Model& m = scarred();
  for (const bool cut : {false, true}) {
    State s = initial_state(m);
    Work w = make_work(m);
    ASSERT_TRUE(step(m, m.start, s, w).fine());
    if (cut)
      for (interactions::BondState& bond : s.bonds[0]) bond = {1, interactions::BondState::cut};
    else
      burn_all(m, s, w, 0.2);
    EXPECT_EQ(interactions::holding_share(m.bonds[0], s.bonds[0]), 0);
    EXPECT_EQ(breached(m, s), 0);
  }
}
