// The short form of the abuse soak: one organ of each kind for a moment, and all come back.
#include "abuse.hpp"

#include <gtest/gtest.h>

#include <trocar/scene/compile.hpp>
#include <trocar/scene/reader.hpp>

using namespace trocar;

TEST(Abuse, OrgansBearSomeSecondsAndReturnToTheirShape) {
  const sim::Model model =
      abuse::untearable(scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json")));
  abuse::Attack attack(model, 3);
  const int tube = model.strand_index("tube_left");
  ASSERT_GE(tube, 0);
  const abuse::Round r = attack.round(model.solids.size() + size_t(tube), 6);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.grasps, 0);
  EXPECT_TRUE(r.let_go);
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to them";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}

TEST(Abuse, ALiverThatCanBeCutBearsItAndReturnsToItsShape) {
  const sim::Model model =
      abuse::untearable(scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json")));
  abuse::Attack attack(model, 4);
  const abuse::Round r = attack.round(0, 4);
  std::printf("%d grasps, at most %.3f J and %.1f N, %.2f %% off after the rest\n", r.grasps, r.most_energy,
              r.most_force, 100 * r.worst().share);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to it";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  EXPECT_TRUE(r.let_go);
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}

TEST(Abuse, ALiverCutAtRandomStaysFinite) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  abuse::Attack attack(model, 5, true);
  const abuse::Round r = attack.round(0, 6);
  std::printf("%d cuts, at most %.3f J and %.1f N\n", attack.state().cut_count, r.most_energy, r.most_force);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(attack.state().cut_count, 0);
  EXPECT_LT(r.most_energy, 5) << "[J]";
}

TEST(Abuse, TissueThatTearsStaysFinite) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  abuse::Attack attack(model, 3);
  const abuse::Round r = attack.round(model.solids.size() + size_t(model.strand_index("tube_left")), 4);
  std::printf("%d tears, at most %.3f J and %.1f N\n", r.tears, r.most_energy, r.most_force);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.tears, 0);
  EXPECT_LT(r.most_energy, 5) << "[J]";
}

TEST(Abuse, AFilledGallbladderBearsItAndKeepsItsContents) {
  const sim::Model model =
      abuse::untearable(scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json")));
  abuse::Attack attack(model, 6);
  const abuse::Round r = attack.round(model.solids.size() + model.strands.size(), 4);
  EXPECT_EQ(r.organ, "gallbladder");
  std::printf("%d grasps, at most %.3f J and %.1f N, %.2f %% off after the rest\n", r.grasps, r.most_energy,
              r.most_force, 100 * r.worst().share);
  EXPECT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
  EXPECT_GT(r.most_energy, 1e-3) << "[J] something was done to it";
  EXPECT_LT(r.most_energy, 5) << "[J]";
  const tissue::EnclosureState& inside = attack.state().membranes[0].enclosure;
  EXPECT_EQ(inside.leaking, 0u);
  EXPECT_NEAR(inside.pressure, 1000, 100);
  for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
}
