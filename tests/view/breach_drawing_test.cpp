// Liver that has been torn off with a scarred gallbladder is seen raw where it was torn, and nowhere else.
#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/bodies/breach_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {
namespace {

const sim::Model& scarred() {
  static const sim::Model model =
      scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder_bed_scarred/scene.json"));
  return model;
}

TEST(BreachDrawing, ShowsRawLiverOnceItHasBeenTorn) {
  const auto backend = render::make_null_backend();
  BreachDrawing drawing(scarred(), 0, *backend);
  sim::State state = sim::initial_state(scarred());
  drawing.update(state);
  EXPECT_FALSE(drawing.any());
  EXPECT_EQ(drawing.organ(), scarred().organ_index("liver"));
  state.bonds[0][0] = {1, interactions::BondState::cut};
  drawing.update(state);
  EXPECT_FALSE(drawing.any()) << "a scar that was cut leaves the liver whole";
  state.bonds[0][1] = {1, interactions::BondState::pulled};
  drawing.update(state);
  EXPECT_TRUE(drawing.any());
  state.bonds[0][1].cause = interactions::BondState::staunched;
  drawing.update(state);
  EXPECT_TRUE(drawing.any()) << "coagulated it is there still";
}

TEST(BreachDrawing, IsAnItemOfThePictureAndDrawable) {
  const auto backend = render::make_null_backend();
  SceneView view(scarred(), *backend);
  sim::State state = sim::initial_state(scarred());
  const std::size_t before = view.frame(state, {}).items.size();
  for (interactions::BondState& bond : state.bonds[0]) bond = {1, interactions::BondState::pulled};
  const render::Frame frame = view.frame(state, {});
  EXPECT_EQ(frame.items.size(), before + 2) << "the torn liver, and the bed around it";
  EXPECT_NO_THROW(render::draw_frame(*backend, frame, render::Target::off_screen(64, 48)));
}

}  // namespace
}  // namespace trocar::view
