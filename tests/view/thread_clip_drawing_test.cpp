// A clip on thread is drawn where it holds the thread, turned as it sits, and no more once it has come off.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/suture/thread/thread_work.hpp>
#include <trocar/view/instruments/clip_shape.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {
namespace {

const sim::Model& sewing_box() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_suture/scene.json"));
  return model;
}

constexpr double kReach = 0.004, kLegs = 0.0085;  // [m] from a clip's bend to the thread; its length
const Vec3d kAxis = normalised(Vec3d{0.6, 0, 0.8}), kOpen{0, 1, 0};

/// On the thread at `s`, as an applier leaves one there.
void clip_thread_at(sim::State& state, double s) {
  const suture::ThreadModel& thread = sewing_box().objects.sutures.list[0].thread;
  const double place[1] = {s};
  ASSERT_TRUE(suture::set_clip(thread, state.objects.sutures[0].thread, state.clip_count, place, kAxis, kOpen));
  interactions::Clip& c = state.clips[std::size_t(state.clip_count++)];
  c = {};
  c.strand = -1;
  c.vessel = -1;  // suture 0
  c.s = s;
  c.cover = 1;
  c.reach = kReach;
  c.length = kLegs;
}

/// What is drawn of the part "clips".
std::vector<render::DrawItem> drawn_clips(SceneView& view, const sim::State& state) {
  std::vector<render::DrawItem> clips;
  for (const render::DrawItem& item : view.frame(state, {}).items)
    if (item.part > 0 && view.parts()[item.part - std::size_t(1)].name == "clips") clips.push_back(item);
  return clips;
}
Vec3d column(const render::DrawItem& item, std::size_t i) {
  const auto& m = item.transform.m;
  return {double(m[4 * i]), double(m[4 * i + 1]), double(m[4 * i + 2])};
}

TEST(ThreadClipDrawing, ItLiesWhereItHoldsTheThreadWithItsLegsToBothSides) {
  const auto backend = render::make_null_backend();
  SceneView view(sewing_box(), *backend);
  sim::State state = sim::initial_state(sewing_box());
  EXPECT_TRUE(drawn_clips(view, state).empty());
  clip_thread_at(state, 0.050);
  const std::vector<render::DrawItem> clips = drawn_clips(view, state);
  ASSERT_EQ(clips.size(), 1u);
  const suture::ThreadModel& thread = sewing_box().objects.sutures.list[0].thread;
  const Vec3d held = suture::point_at(thread, state.objects.sutures[0].thread, 0.050);
  const Vec3d bend = column(clips[0], 3);
  EXPECT_LT(length(bend + kReach * kAxis - held), 1e-4);
  EXPECT_GT(dot(normalised(column(clips[0], 0)), kOpen), 0.999);
  EXPECT_GT(dot(normalised(column(clips[0], 2)), kAxis), 0.999);
  EXPECT_LT(kReach, kLegs) << "the thread runs between bend and tips";
}

TEST(ThreadClipDrawing, EachOfTwoLiesAtItsOwnPlace) {
  const auto backend = render::make_null_backend();
  SceneView view(sewing_box(), *backend);
  sim::State state = sim::initial_state(sewing_box());
  clip_thread_at(state, 0.030);
  clip_thread_at(state, 0.080);
  const std::vector<render::DrawItem> clips = drawn_clips(view, state);
  ASSERT_EQ(clips.size(), 2u);
  const suture::ThreadModel& thread = sewing_box().objects.sutures.list[0].thread;
  for (const double s : {0.030, 0.080}) {
    const Vec3d held = suture::point_at(thread, state.objects.sutures[0].thread, s);
    const auto near = [&](const render::DrawItem& c) { return length(column(c, 3) + kReach * kAxis - held) < 1e-4; };
    EXPECT_EQ(std::count_if(clips.begin(), clips.end(), near), 1) << s;
  }
}

TEST(ThreadClipDrawing, OneThatHasComeOffIsNotDrawn) {
  const auto backend = render::make_null_backend();
  SceneView view(sewing_box(), *backend);
  sim::State state = sim::initial_state(sewing_box());
  clip_thread_at(state, 0.050);
  state.objects.sutures[0].thread.clip_count = 0;
  EXPECT_TRUE(drawn_clips(view, state).empty());
}

}  // namespace
}  // namespace trocar::view
