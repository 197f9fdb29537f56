// Drawn vessels: tubes around their lines, in two where they are cut, wider with the pulse and its gain.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/view/bodies/vessel_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::view {
namespace {

double nearest_to_tube(Vec3f p) { return std::hypot(double(p.y), double(p.z)); }  // as drawn it lies along x

TEST(VesselDrawing, IsATubeOfTheVesselsRadiusAroundItsLine) {
  const auto backend = render::make_null_backend();
  const VesselDrawing drawn(small::model(), false, *backend);
  double least = 1, most = 0;
  for (const Vec3f p : drawn.buffer().positions) {
    if (p.x < 0.01f || p.x > 0.07f || nearest_to_tube(p) > 0.002) continue;
    least = std::min(least, nearest_to_tube(p));
    most = std::max(most, nearest_to_tube(p));
  }
  EXPECT_NEAR(least, 0.00075, 0.0001);
  EXPECT_NEAR(most, 0.00075, 0.0001);
}

TEST(VesselDrawing, WhatIsCutThroughEndsInTwoStumpsThatAreRedWithBlood) {
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(small::model());
  VesselDrawing drawn(small::model(), false, *backend);
  const std::size_t before = drawn.buffer().positions.size();
  const auto bloody = [&] {
    return std::count_if(drawn.buffer().paint.begin(), drawn.buffer().paint.end(),
                         [](const Paint& p) { return p.blood > 100; });
  };
  EXPECT_EQ(bloody(), 0);
  state.openings[0].vessel = small::kTubeArtery;
  state.openings[0].s = 0.5;
  state.openings[0].through = 1;
  state.openings[0].area = 1e-6;
  state.opening_count = 1;
  drawn.update(state);
  EXPECT_GT(drawn.buffer().positions.size(), before) << "a ring and a cap more on each side";
  EXPECT_GT(bloody(), 8);
}

TEST(VesselDrawing, WidensWithThePressureTimesTheGain) {
  const auto width = [](double gain, double pressure) {
    scene::Description d = small::description();
    d.vessels[0].pulse_gain = gain;
    const sim::Model m = scene::compile(d);
    const auto backend = render::make_null_backend();
    sim::State state = sim::initial_state(m);
    for (double& p : state.flow.p) p = pressure * vessels::kPascalPerMmHg;
    VesselDrawing drawn(m, false, *backend);
    drawn.update(state);
    double most = 0;
    for (const Vec3f p : drawn.buffer().positions)
      if (p.x > 0.01f && p.x < 0.07f && nearest_to_tube(p) < 0.002) most = std::max(most, nearest_to_tube(p));
    return most;
  };
  const double physical = width(1, 120) - width(1, 80), shown = width(10, 120) - width(10, 80);
  EXPECT_GT(physical, 1e-6);
  EXPECT_NEAR(shown / physical, 10, 1.5);
}

TEST(VesselDrawing, WhatAFoldCarriesIsDrawnWithinItAfterEveryFold) {
  const sim::Model pelvis = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  const auto backend = render::make_null_backend();
  SceneView view(pelvis, *backend);
  const render::Frame frame = view.frame(sim::initial_state(pelvis), {});
  int within = 0;
  for (const render::DrawItem& i : frame.items) {
    if (i.part == 0 || view.parts()[i.part - std::size_t(1)].group != PartGroup::vessels || !i.translucent) continue;
    EXPECT_GT(i.nearer, 0.05f);
    EXPECT_LT(i.material.rim_alpha, i.material.alpha) << "soft at its sides";
    ++within;
  }
  EXPECT_EQ(within, 2) << "arteries and veins";
}

TEST(VesselDrawing, OfAFoldGetsThinnerOnItsWay) {
  const sim::Model pelvis = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  const auto backend = render::make_null_backend();
  const VesselDrawing drawn(pelvis, false, *backend, {}, VesselDrawing::Lie::in_a_fold);
  const auto radius = [&](std::size_t ring) {  // of rings of eight
    return double(length(drawn.buffer().positions[8 * ring] - drawn.buffer().positions[8 * ring + 4])) / 2;
  };
  EXPECT_GT(radius(14), 1.15 * radius(22)) << "the first one is a tubal artery; its ends thin out besides";
}

TEST(VesselDrawing, AClipOnNothingButAVesselIsDrawnThere) {
  const sim::Model pelvis = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(pelvis);
  SceneView view(pelvis, *backend);
  const std::size_t before = view.frame(state, {}).items.size();
  interactions::Clip& clip = state.clips[0];
  clip.vessel = pelvis.vessel_index("tubal_left") + 1;
  clip.s = 0.01;
  clip.opening[1] = clip.axis[2] = 1;
  clip.length = 0.0085;
  state.clip_count = 1;
  EXPECT_EQ(view.frame(state, {}).items.size(), before + 1);
  state.clips[0].vessel = 0;
  EXPECT_EQ(view.frame(state, {}).items.size(), before) << "one that has been dropped is not";
}

}  // namespace
}  // namespace trocar::view
