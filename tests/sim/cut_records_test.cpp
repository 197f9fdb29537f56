// One closing of the blades through several bodies: each leaves a record and an event of its own.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <trocar/sim/model/bodies.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr double kMiddle = 0.026;  // [m] of the bar, where the blades' plane is

/// A soft closed wall below the bar, held at both ends, so that each half stays where it is.
scene::Pouch bladder(const char* name, double z) {
  scene::Pouch p;
  p.name = name;
  p.tissue = "web";
  for (const double x : {-0.0045, -0.0015, 0.0015, 0.0045})
    p.sections.push_back({{kMiddle + x, small::kBarY, z}, {0, 0.003, 0}, {0, 0, 0.003}, 2});
  p.thickness = 0.001;
  p.spacing = 0.0018;
  for (const double x : {-0.0052, 0.0052}) p.held.push_back({{kMiddle + x, small::kBarY, z}, 0.0035, 0, {}});
  return p;
}

const Model& stacked() {
  static const Model made = [] {
    scene::Description d = small::description();
    for (scene::Instrument& i : d.instruments)
      if (i.name == "scissors") i.jaw_length = 0.030, i.opening = 0.9;
    d.pouches = {bladder("upper", -0.0085), bladder("lower", -0.0155)};
    d.walls.clear();
    d.fluids.reset();
    return scene::compile(d);
  }();
  return made;
}

}  // namespace

TEST(CutRecords, AnOrganAndTwoClosedWallsCutAtOnceAreThreeEvents) {
  small::Table t(stacked());
  const double over = 0.030, into = -0.0185;
  t.close(small::kScissors, 0);
  t.carry(small::kScissors, {kMiddle, 0.02, 0.05}, {kMiddle, small::kBarY, over}, 0.2);
  t.carry(small::kScissors, {kMiddle, small::kBarY, over}, {kMiddle, small::kBarY, into}, 0.2);
  t.events.clear();
  t.close_slowly(small::kScissors, 1, 150);
  t.steps(50);
  std::set<std::string> cut;
  int events = 0;
  for (const Event& e : t.events) {
    if (e.kind != Event::cut) continue;
    ++events;
    cut.insert(name_of(stacked(), e.body));
  }
  EXPECT_EQ(cut, (std::set<std::string>{"bar", "upper", "lower"}));
  EXPECT_EQ(events, 3);
  EXPECT_EQ(t.state.cut_count, 3);
}
