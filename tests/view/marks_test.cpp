// Marks in the picture: discs with numbers, stripes that go with their tubes.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/bodies/digits.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {
namespace {

const sim::Model& scene_of(const char* name) {
  static std::vector<std::pair<std::string, std::unique_ptr<sim::Model>>> all;
  for (const auto& [known, model] : all)
    if (known == name) return *model;
  const std::string file = TROCAR_SOURCE_DIR "/scenes/" + std::string(name) + "/scene.json";
  all.emplace_back(name, std::make_unique<sim::Model>(scene::compile(scene::read_scene(file))));
  return *all.back().second;
}

int listed(SceneView& view, const sim::State& state) {
  const render::Frame frame = view.frame(state, {});
  return int(std::count_if(frame.items.begin(), frame.items.end(), [&](const render::DrawItem& i) {
    return i.part > 0 && view.parts()[i.part - std::size_t(1)].group == PartGroup::marks;
  }));
}

TEST(MarksInThePicture, AreDrawnOnceEach) {
  for (const char* name : {"box_pegs", "box_vessels"}) {
    const auto backend = render::make_null_backend();
    SceneView view(scene_of(name), *backend);
    EXPECT_EQ(listed(view, sim::initial_state(scene_of(name))), int(scene_of(name).marks.size())) << name;
  }
}

TEST(MarksInThePicture, AStripeIsGoneWhereItsTubeIsCut) {
  const sim::Model& model = scene_of("box_vessels");
  const auto backend = render::make_null_backend();
  SceneView view(model, *backend);
  sim::State state = sim::initial_state(model);
  const int before = listed(view, state);
  const sim::MarkModel& mark = model.marks.front();
  interactions::Cut& cut = state.cuts[std::size_t(state.cut_count++)];
  cut = {};
  cut.strand = mark.body();
  cut.s = mark.s;
  cut.fraction = 1;
  tissue::cut_element(state.strands[std::size_t(mark.body())], mark.at.element);
  EXPECT_EQ(listed(view, state), before - 1);
}

TEST(Digits, HaveInkWhereTheirStrokesAre) {
  EXPECT_EQ(ink_at("0", 0, 0, 0.05), 0) << "a nought is hollow";
  EXPECT_EQ(ink_at("0", -0.27, 0, 0.05), 1);
  EXPECT_EQ(ink_at("1", 0.04, 0, 0.05), 1);
  EXPECT_EQ(ink_at("10", 0.45, 0, 0.05), 0) << "the second digit's middle";
  EXPECT_EQ(ink_at("10", 0.45 + 0.27, 0, 0.05), 1);
  EXPECT_EQ(ink_at("", 0, 0, 0.05), 0);
  for (const char* digit : {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"})
    for (const double y : {-0.7, 0.7}) EXPECT_EQ(ink_at(digit, 0, y, 0.05), 0) << digit << " is one high";
}

}  // namespace
}  // namespace trocar::view
