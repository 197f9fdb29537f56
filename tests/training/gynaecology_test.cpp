// The scene that is shipped: it compiles, rests as drawn, yields and comes back, and bears any hands.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "wild_hands.hpp"

using namespace trocar;
using namespace trocar::sim;
using namespace trocar::wild;

namespace {

const Model& gynaecology() {
  static const Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  return model;
}

int solid_index(const std::string& name) {
  const Model& m = gynaecology();
  for (size_t i = 0; i < m.solids.size(); ++i)
    if (m.solids[i].name == name) return int(i);
  return -1;
}

TEST(Gynaecology, HasAtLeastSixThousandFreeNodes) { EXPECT_GE(gynaecology().free_nodes(), 6000); }

TEST(Gynaecology, TheDrawnShapeIsTheEquilibrium) {
  // Nothing moves more than 0.1 mm in the first five seconds.
  const Model& m = gynaecology();
  State s = initial_state(m);
  Work w = make_work(m);
  Moved worst;
  for (int t = 0; t < 5000; ++t) {
    const StepReport report = step(m, m.start, s, w);
    ASSERT_EQ(report.flags, 0u) << "tick " << t;
    if (t % 100 != 99) continue;
    const Moved now = moved(m, s);
    if (now.most > worst.most) worst = now;
  }
  RecordProperty("moved_um", int(worst.most * 1e6));
  EXPECT_LT(worst.most, 1e-4) << worst.body;
  EXPECT_LT(kinetic_energy(m, s), 1e-9) << "[J] it has come to rest";
}

TEST(Gynaecology, TheStartPoseShowsTheJawTipsAndTheTube) {
  const Model& m = gynaecology();
  State s = initial_state(m);
  Work w = make_work(m);
  for (size_t i = 0; i <= m.samples.size() / size_t(kLooksPerTick) + 1; ++i) step(m, m.start, s, w);
  for (const HandModel& tool : m.hands)
    for (const char* jaw : {".jaw_a", ".jaw_b"})
      EXPECT_TRUE(visible(m, s, m.target_index(tool.name + jaw))) << tool.name << jaw;
  EXPECT_TRUE(visible(m, s, m.target_index("tube_left.isthmus")));
  EXPECT_TRUE(visible(m, s, m.target_index("uterus")) || visible_share(m, s, m.target_index("uterus")) > 0.1);
}

TEST(Gynaecology, TubeAndUterusComeBackAfterAPull) {
  // The tube is drawn up by 20 mm at the ampulla for a second and a half and let go. Five seconds later the tube's
  // nodes and the uterus's cornu are back within a hundredth of the tube's and the uterus's size.
  const Model& m = gynaecology();
  State s = initial_state(m);
  Work w = make_work(m);
  const int tube = m.strand_index("tube_left"), uterus = solid_index("uterus");
  ASSERT_GE(tube, 0);
  ASSERT_GE(uterus, 0);
  const interactions::StrandBody& body = m.strand_bodies[size_t(tube)];
  const interactions::StrandPlace held = interactions::place_at(body, 0.045);
  const Vec3d from = interactions::point_at(body, s.strands[size_t(tube)], held);
  StepReport report;
  double lifted = 0;
  const auto pulled_step = [&](double rise) {
    StepContext c{m, m.start, s, w, report};
    for (const Stage& stage : stages()) {
      if (std::string(stage.name) == "advance strands" && rise > 0) {
        tissue::StrandLoad pull;
        pull.element = held.element;
        pull.w = held.w;
        pull.k = 1200;
        pull.x0 = from + Vec3d{0, 0, rise};
        w.strands[size_t(tube)].loads.add(pull, {});
      }
      stage.run(c);
    }
  };
  for (int t = 0; t < 1500; ++t) pulled_step(0.020 * std::min(1.0, t / 700.0) + 1e-9);
  const Moved away = moved(m, s);
  lifted = interactions::point_at(body, s.strands[size_t(tube)], held).z - from.z;
  EXPECT_GT(lifted, 0.018);
  for (int t = 0; t < 5000; ++t) pulled_step(0);
  double tube_off = 0, uterus_off = 0;
  for (size_t n = 0; n < body.model.rest.size(); ++n)
    tube_off = std::max(tube_off, length(s.strands[size_t(tube)].x[n] - body.model.rest[n]));
  for (int n = 0; n < m.solids[size_t(uterus)].network.nodes; ++n)
    uterus_off =
        std::max(uterus_off, length(node_place(m, s, uterus, n) - m.solids[size_t(uterus)].network.rest[size_t(n)]));
  RecordProperty("pulled_away_um", int(away.most * 1e6));
  RecordProperty("tube_off_um", int(tube_off * 1e6));
  RecordProperty("uterus_off_um", int(uterus_off * 1e6));
  EXPECT_LT(tube_off, 0.01 * body.length());
  EXPECT_LT(uterus_off, 0.01 * 0.075);
  EXPECT_TRUE(report.fine());
}

TEST(Gynaecology, BearsWildHands) { bear_wild_hands(gynaecology(), 4000); }  // the soak: longer

}  // namespace
