// Blunt dissection: what the jaws of a dissector spread apart comes apart, what a blunt tip wipes comes off, with the
// forces that hands use for it: 1 to 3 N for spreading, 0.1 to 0.7 N for wiping.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kHand = 1;

Model scene_with(const char* name, const char* instrument) {
  scene::Description d = scene::read_scene(std::string(TROCAR_SOURCE_DIR "/scenes/") + name + "/scene.json");
  d.placements[kHand].instrument = instrument;
  return scene::compile(d);
}

/// One instrument in one scene, led by its tip.
class Dissection {
 public:
  Dissection(const char* scene, const char* instrument)
      : m_model(scene_with(scene, instrument)),
        m_state(initial_state(m_model)),
        m_work(make_work(m_model)),
        m_port(m_model.hands[kHand].port) {}

  /// The tip before a place on its way from the trocar, jaws closed, their opening direction along `opens`.
  void aim(Vec3d place, Vec3d opens) {
    m_along = normalised(place - m_port);
    m_roll = kinematics::roll_towards(kinematics::inverse(m_port, place, 0), cross(m_along, opens));
    m_tip = place - 0.025 * m_along;
    for (int i = 0; i < 150; ++i) tick();
  }
  void go(Vec3d to, double speed) {
    const Vec3d from = m_tip;
    const int ticks = int(length(to - from) / speed / kTick);
    for (int i = 1; i <= ticks; ++i) m_tip = from + (double(i) / ticks) * (to - from), tick();
  }
  /// Opens as far as it goes with that force on the wall and on the organ.
  void spread(double most, int organ) {
    for (int i = 0; i < 1000; ++i) {
      if (std::max(press_on(BodyId::membrane(0)), press_on(BodyId::organ(std::size_t(organ)))) < most)
        m_handle = std::max(0.0, m_handle - 1.0 / 800);
      tick();
      m_on_wall = std::max(m_on_wall, press_on(BodyId::membrane(0)));
      m_on_organ = std::max(m_on_organ, press_on(BodyId::organ(std::size_t(organ))));
    }
  }
  void tick() {
    Input input = m_model.start;
    input.tools[kHand] = tool_input(kinematics::inverse(m_port, m_tip, m_roll), float(m_handle));
    ASSERT_TRUE(step(m_model, input, m_state, m_work).fine());
    const double* f = m_state.tools[kHand].contact_force;
    m_pressed = std::max(m_pressed, length(Vec3d{f[0], f[1], f[2]}));
  }
  /// Of the instrument on a body, along the contacts' normals [N].
  double press_on(BodyId body) const {
    Vec3d sum;
    const interactions::TouchBook& book = m_state.touches[kHand];
    for (int i = 0; i < book.count; ++i)
      if (book.touch[i].body == body) sum += interactions::press_of(book.touch[i]);
    return length(sum);
  }

  Model m_model;
  State m_state;
  Work m_work;
  Vec3d m_port, m_along, m_tip;
  double m_roll = 0, m_handle = 1;
  double m_pressed = 0, m_on_wall = 0, m_on_organ = 0;  ///< most so far [N]
};

}  // namespace

TEST(BluntDissection, SpreadJawsPushWallAndLiverApartAndTheBondsBetweenThemPart) {
  Dissection d("gallbladder_bed", "maryland");
  const interactions::BondSet& bed = d.m_model.bonds.at(0);
  const auto node = [&](const interactions::Bond& bond) {
    return place_of(bodies_of(d.m_model, d.m_state), bond.near);
  };
  constexpr Vec3d kInside{-0.072, 0.122, -0.075};
  const interactions::Bond& near = *std::min_element(bed.bonds.begin(), bed.bonds.end(), [&](auto& a, auto& b) {
    return length(node(a) - kInside) < length(node(b) - kInside);
  });
  const Vec3d across = node(near) - root_of(bodies_of(d.m_model, d.m_state), near);
  const Vec3d gap = node(near) - 0.5 * across;
  d.aim(gap, normalised(across));
  d.go(gap + 0.005 * d.m_along, 0.025);
  EXPECT_EQ(interactions::holding_share(bed, d.m_state.bonds[0]), 1) << "a closed tip goes between them";
  d.spread(2.5, d.m_model.organ_index("liver"));
  RecordProperty("wall_N", std::to_string(d.m_on_wall));
  RecordProperty("liver_N", std::to_string(d.m_on_organ));
  RecordProperty("share", std::to_string(interactions::holding_share(bed, d.m_state.bonds[0])));
  for (const double force : {d.m_on_wall, d.m_on_organ}) {
    EXPECT_GT(force, 1) << "both sides are pushed";
    EXPECT_LT(force, 3);
  }
  EXPECT_LT(interactions::holding_share(bed, d.m_state.bonds[0]), 0.95);
  EXPECT_TRUE(std::any_of(d.m_state.bonds[0].begin(), d.m_state.bonds[0].end(),
                          [](const auto& b) { return !b.holds() && b.cause == interactions::BondState::pulled; }));
}

TEST(BluntDissection, ABluntTipWipesFatOffTheCysticDuct) {
  Dissection d("calot", "suction_irrigator");
  const interactions::FatBody& fat = d.m_model.fat.front();
  const auto holding_roots = [&] {
    const auto& roots = d.m_state.bonds[size_t(fat.roots)];
    return std::count_if(roots.begin(), roots.end(), [](const auto& r) { return r.holds(); });
  };
  const auto septa = [&] {
    double sum = 0;
    for (int i = 0; i < fat.fat.septa(); ++i) sum += holding(fat.fat, d.m_state.fat.front(), i);
    return sum / fat.fat.septa();
  };
  constexpr Vec3d kOnDuct{-0.046, 0.1085, -0.0986}, kAlong{-0.012, 0.002, 0.001};
  d.aim(kOnDuct, {0, 1, 0});
  d.go(kOnDuct, 0.02);
  const auto before = holding_roots();
  for (int wipe = 0; wipe < 2; ++wipe) {
    d.go(d.m_tip + kAlong, 0.02);
    d.go(d.m_tip - kAlong, 0.02);
  }
  RecordProperty("pressed_N", std::to_string(d.m_pressed));
  RecordProperty("roots", std::to_string(before - holding_roots()));
  EXPECT_LT(holding_roots(), before) << "what held on the duct does not any more";
  EXPECT_LT(septa(), 0.995);
  EXPECT_GT(d.m_pressed, 0.1);
  EXPECT_LT(d.m_pressed, 1.04) << "blunt dissection takes 0.32 +- 0.36 N: two deviations above the mean";
}
