// What a gallbladder loses otherwise than by its wall alone: bile by a duct that was parted without a clip, and stones
// by a hole that is wide enough for them.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;
using interactions::Rigid;

namespace {

scene::Description described() { return scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy/scene.json"); }

/// With three stones in the gallbladder: 3, 5 and 12 mm wide.
const Model& stony() {
  static const Model made = [] {
    scene::Description d = described();
    for (const double width : {3.0, 5.0, 12.0}) {
      scene::RigidSetting s;
      s.name = "stone_" + std::to_string(int(width));
      s.look = "gallstone";
      s.pebble = 1e-3 * Vec3d{1.2 * width, width, 0.9 * width};
      s.thick = s.pebble.z;
      s.mass = 1.1e3 * 4 / 3 * portable::pi * s.pebble.x * s.pebble.y * s.pebble.z / 8;
      s.pouch = "gallbladder";
      settings_of(scene::RigidScene{}, d.objects).push_back(s);
    }
    return scene::compile(d);
  }();
  return made;
}

struct Spilling {
  explicit Spilling(const Model& m)
      : model(m),
        state(initial_state(m)),
        work(make_work(m)),
        duct(m.strand_index("cystic_duct")),
        pouch(size_t(m.membrane_index("gallbladder"))) {}

  void go(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) ASSERT_TRUE(step(model, model.start, state, work).fine()) << tick;
  }
  void part_duct(double s) {
    const int element = interactions::place_at(body(), s).element;
    state.strands[size_t(duct)].alive[size_t(element)] = 0;
    interactions::Cut& cut = state.cuts[size_t(state.cut_count++)];
    cut = {};
    cut.s = s;
    cut.fraction = 1;
    cut.strand = duct;
  }
  void clip_duct(double s, double cover) {
    interactions::Clip& clip = state.clips[size_t(state.clip_count++)];
    clip = {};
    clip.s = s;
    clip.cover = cover;
    clip.strand = duct;
    clip.length = 0.008;
  }
  /// A slit through the wall where it lies lowest, held open as wide as this share of it.
  void open_wall(double half) {
    const MembraneBody& m = model.membranes[pouch];
    const Vec3d g = normalised(model.gravity);
    const auto& rest = m.sheet.network.rest;
    const Vec3d at =
        *std::max_element(rest.begin(), rest.end(), [&](Vec3d a, Vec3d b) { return dot(a, g) < dot(b, g); });
    const geometry::Blade blade = geometry::square_blade(at, {1, 0, 0}, half);
    interactions::cut_membrane(blade, m.sheet, m.depth, state.membranes[pouch], state.torn[pouch], work.parts);
  }
  const interactions::StrandBody& body() const { return model.strand_bodies[size_t(duct)]; }
  const tissue::EnclosureState& inside() const { return state.membranes[pouch].enclosure; }
  double lost() const { return (1 - inside().left) * model.membranes[pouch].sheet.enclosure.volume; }
  std::int64_t booked() const { return state.fluids.ledger.in[size_t(fluids::Source::kBled)].bile; }
  const Rigid::States& stones() const { return interactions::part_of<Rigid>(state); }
  int inside_still() const {
    return int(std::count_if(stones().begin(), stones().end(), [](const auto& s) { return s.inside(); }));
  }

  const Model& model;
  State state;
  Work work;
  int duct;
  size_t pouch;
};

const Model& plain() {
  static const Model made = scene::compile(described());
  return made;
}

TEST(Duct, OfTheGallbladderOpensIntoItWithItsEnd) {
  const Spilling run(plain());
  EXPECT_EQ(plain().membranes[run.pouch].duct, run.duct);
  EXPECT_FALSE(plain().membranes[run.pouch].duct_at_start) << "it begins at the common duct";
}

TEST(Duct, PartedWithoutAClipItLetsBileOutByItsLumenToThePicolitre) {
  Spilling run(plain());
  run.go(20);
  const double pressure = run.inside().pressure;
  EXPECT_EQ(run.lost(), 0);
  run.part_duct(0.014);
  run.go(1);
  // c A sqrt(2 p / rho) of the lumen at the stump; the stump lies a centimetre below the pouch's middle at most
  const double radius = run.body().model.lumen[size_t(interactions::place_at(run.body(), 0.014).element)];
  const double flow = 0.61 * portable::pi * radius * radius * std::sqrt(2 * pressure / 1010);
  EXPECT_GT(run.lost(), 0.5e-3 * flow);
  EXPECT_LT(run.lost(), 1.5e-3 * flow);
  run.go(500);
  EXPECT_GT(run.lost(), 0.1e-6);
  EXPECT_NEAR(double(run.booked()), run.lost() / fluids::kM3PerPicolitre, 1);
  EXPECT_TRUE(fluids::audit(run.model.wet.model, run.state.fluids));
  EXPECT_EQ(run.inside().leaking, 0u) << "its wall is whole";
}

TEST(Duct, AClipOnTheGallbladdersSideHoldsTheBileAndOneOnTheOtherSideDoesNot) {
  Spilling held(plain()), not_held(plain()), half(plain()), open(plain());
  held.clip_duct(0.018, 1);
  not_held.clip_duct(0.010, 1);
  half.clip_duct(0.018, 0.5);
  for (Spilling* run : {&held, &not_held, &half, &open}) {
    run->part_duct(0.014);
    run->go(200);
  }
  EXPECT_EQ(held.lost(), 0);
  EXPECT_GT(open.lost(), 0.05e-6);
  EXPECT_NEAR(not_held.lost(), open.lost(), 0.02 * open.lost());
  EXPECT_LT(half.lost(), 0.8 * open.lost()) << "half of the lumen is left";
  EXPECT_GT(half.lost(), 0.3 * open.lost());
  open.clip_duct(0.020, 1);  // too late, and not too late
  const double before = open.lost();
  open.go(100);
  EXPECT_EQ(open.lost(), before);
}

TEST(Stones, StayInAWholeGallbladderAndMeetNothing) {
  Spilling run(stony());
  run.go(300);
  ASSERT_EQ(run.stones().size(), 3u);
  EXPECT_EQ(run.inside_still(), 3);
  EXPECT_EQ(run.lost(), 0);
  const tissue::MembraneModel& sheet = run.model.membranes[run.pouch].sheet;
  const Vec3d middle = tissue::enclosed_volume(sheet.triangles, sheet.network.rest, {}).centre;
  for (const auto& s : run.stones()) EXPECT_LT(length(s.x - middle), 0.002);
}

TEST(Stones, FallOutOfAHoleThatIsWideEnoughAndNoLargerOnesDo) {
  Spilling run(stony());
  run.open_wall(0.010);
  std::array<double, 3> hole_when_out{};
  double widest = 0;
  for (int tick = 0; tick < 2500; ++tick) {
    const Rigid::States before = run.stones();
    const double lost = run.lost();
    ASSERT_TRUE(step(run.model, run.model.start, run.state, run.work).fine()) << tick;
    const tissue::Leak& hole = run.work.membranes[run.pouch].by_wall;
    widest = std::max(widest, hole.area);
    double volume = 1e-15 * double(hole.picolitres);
    for (size_t i = 0; i < before.size(); ++i) {
      if (!before[i].inside() || run.stones()[i].inside()) continue;
      hole_when_out[i] = hole.area;
      const auto& stone = interactions::part_of<Rigid>(run.model).list[i];
      volume += 4.0 / 3 * portable::pi * stone.pebble.x * stone.pebble.y * stone.pebble.z;
      EXPECT_LT(length(run.stones()[i].x - hole.place), 0.01) << "at the hole";
    }
    EXPECT_NEAR(run.lost() - lost, volume, 1e-14) << tick;
  }
  RecordProperty("hole_mm2", std::to_string(1e6 * widest));
  const auto needs = [](double width) { return portable::pi * width * width / 4; };
  EXPECT_GE(hole_when_out[0], needs(0.003)) << "the small one is out";
  EXPECT_GT(widest, needs(0.003));
  EXPECT_LT(widest, needs(0.012));
  if (hole_when_out[1] > 0) {
    EXPECT_GE(hole_when_out[1], needs(0.005));
  }
  EXPECT_TRUE(run.stones()[2].inside()) << "twelve millimetres wide";
}

TEST(Stones, FallTheSameWayWithPoisonedScratch) {
  std::uint64_t hashes[2];
  for (const bool poisoned : {false, true}) {
    Spilling run(stony());
    run.open_wall(0.010);
    for (int tick = 0; tick < 600; ++tick) {
      if (poisoned) poison(run.work);
      step(run.model, run.model.start, run.state, run.work);
    }
    hashes[poisoned] = hash_of(run.state);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
