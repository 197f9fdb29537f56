// Pictures as they were when somebody last looked at them and found them good: tests/app/golden. After a change of the
// look that is meant, look at the new ones and keep them:  TROCAR_RENEW_GOLDEN=1 app_test --gtest_filter='*Golden*'
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/sim/stages/step.hpp>

#include "commands/gallery/gallery_events.hpp"
#include "picture_difference.hpp"

namespace trocar::app {
namespace {

constexpr pictures::PictureSize kSize{320, 240};
constexpr double kMean = 1.0, kWorst = 6.0;  ///< CIE L*a*b*; two graphics drivers may differ by less

struct View {
  const char *name, *scene;
  int organ = -1;         ///< close up; -1: through the endoscope
  const char* show = "";  ///< as --show
};
void PrintTo(const View& view, std::ostream* out) { *out << view.name; }

constexpr View kViews[] = {
    {"pelvis", "gynaecology"},
    {"uterus", "gynaecology", 0},
    {"ovary", "gynaecology", 1},
    {"vessels", "bleeding_control", 2},
    {"digestive", "digestive"},
    {"liver_near", "digestive", 0},
    {"gallbladder", "gallbladder"},
    {"liver", "cutting", 0},
    {"edges", "gynaecology", -1, "organs=wireframe,folds=transparent"},
};

std::filesystem::path golden(const std::string& name) {
  return std::filesystem::path(TROCAR_SOURCE_DIR) / "tests/app/golden" / (name + ".png");
}

render::Image picture_of(const View& view) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(view.scene);
  const sim::Model& model = lesson->model;
  pictures::Pictures pictures(model, kSize, {{}, pictures::parse_show(view.show)});
  const sim::State start = sim::initial_state(model);
  if (view.organ < 0) return pictures.still(start);
  const std::vector<Vec3d> skin = skin_of(model, view.organ);
  Vec3d middle{};
  for (const Vec3d p : skin) middle += p / double(skin.size());
  return pictures.still(start, close_up(model, middle, 0.075));
}

class Golden : public testing::TestWithParam<View> {};

TEST_P(Golden, ThePictureIsAsItWasFoundGood) {
  const View view = GetParam();
  const render::Image picture = picture_of(view);
  if (std::getenv("TROCAR_RENEW_GOLDEN")) render::write_png(golden(view.name).string(), picture);
  const PictureDifference off = difference(picture, render::read_png(golden(view.name).string()));
  if (off.mean > kMean || off.worst > kWorst)
    render::write_png((std::filesystem::temp_directory_path() / fmt::format("trocar-{}.png", view.name)).string(),
                      picture);
  EXPECT_LE(off.mean, kMean) << "now: trocar-" << view.name << ".png in the temporary folder";
  EXPECT_LE(off.worst, kWorst) << "now: trocar-" << view.name << ".png in the temporary folder";
}
INSTANTIATE_TEST_SUITE_P(Views, Golden, testing::ValuesIn(kViews),
                         [](const auto& view) { return std::string(view.param.name); });

TEST(PictureDifferences, GrainIsNotSeenButATintAMissingThingAndAMovedOneAre) {
  const render::Image image = render::read_png(golden("pelvis").string());
  render::Image grainy = image, tinted = image, without = image, moved = image;
  unsigned seed = 1;
  for (std::uint8_t& c : grainy.rgb) {
    seed = seed * 1664525u + 1013904223u;
    c = std::uint8_t(std::clamp(int(c) + int(seed >> 29) - 4, 0, 255));
  }
  for (std::size_t i = 0; i < tinted.rgb.size(); i += 3) tinted.rgb[i + 2] = std::uint8_t(0.93 * tinted.rgb[i + 2]);
  for (int y = 110; y < 130; ++y)
    for (int x = 150; x < 180; ++x) std::fill_n(&without.rgb[3 * (std::size_t(y) * image.width + x)], 3, 40);
  for (std::size_t i = 9; i < image.rgb.size(); ++i) moved.rgb[i] = image.rgb[i - 9];
  EXPECT_LT(difference(image, grainy).mean, kMean);
  EXPECT_LT(difference(image, grainy).worst, kWorst);
  EXPECT_GT(difference(image, tinted).mean, kMean);
  EXPECT_GT(difference(image, without).worst, kWorst);
  EXPECT_GT(difference(image, moved).worst, kWorst);
}

}  // namespace
}  // namespace trocar::app
