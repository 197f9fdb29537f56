// What pictures are asked for in words: cameras, parts, eyes, figures; films at a speed; and legends drawn into them.
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/pictures/analysis_choice.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/film_plan.hpp>
#include <trocar/pictures/legend_drawing.hpp>
#include <trocar/pictures/shown_parts.hpp>
#include <trocar/pictures/two_eyes.hpp>

namespace trocar::pictures {
namespace {

TEST(FilmPlan, PicturesLastAsLongAsTheSpeedSays) {
  const pictures::FilmPlan plan{2000, 6000, 0.25};
  EXPECT_EQ(plan.pictures(), 400u);  // 4 s, four times as long, 25 a second
  EXPECT_EQ(plan.tick(0), 2000u);
  EXPECT_EQ(plan.tick(1), 2010u);
  EXPECT_LE(plan.tick(plan.pictures() - 1), 6000u);
  EXPECT_EQ((pictures::FilmPlan{100, 100, 1}).pictures(), 1u);
}

// --- cameras ---

TEST(CameraChoice, NamesAndAnglesAreReadAndNonsenseIsRefused) {
  EXPECT_TRUE(pictures::parse_camera("endoscope").endoscope);
  for (const pictures::CameraPreset& preset : pictures::kCameraPresets)
    EXPECT_FALSE(pictures::parse_camera(preset.name).endoscope);
  const pictures::CameraChoice free = pictures::parse_camera("free:90,0,250");
  const view::Orbit orbit = pictures::orbit_of(free, {});
  EXPECT_NEAR(orbit.eye().x, 0.25, 1e-12);  // from the patient's left
  EXPECT_NEAR(orbit.eye().z, 0, 1e-12);
  for (const char* bad : {"", "back", "free:", "free:1,2", "free:1,2,3,4", "free:0,89,250", "free:0,0,5",
                          "free:nan,0,250", "free:0,nan,250", "free:0,0,nan", "free:0,0,inf"})
    EXPECT_THROW(pictures::parse_camera(bad), core::BadInput) << bad;
}

TEST(Pictures, AreForTwoEyesAsAsked) {
  EXPECT_FALSE(pictures::parse_stereo("off").on());
  const pictures::TwoEyes eyes = pictures::parse_stereo("anaglyph:5,60");
  EXPECT_EQ(eyes.mode, render::StereoMode::anaglyph);
  EXPECT_FLOAT_EQ(eyes.eyes.base, 0.005f);
  EXPECT_FLOAT_EQ(eyes.eyes.convergence, 0.06f);
  EXPECT_EQ(pictures::parse_stereo("rows").mode, render::StereoMode::row_interlaced);
  for (const char* bad : {"", "on", "anaglyph:5", "anaglyph:5,60,1", "rows:nan,60", "rows:99,60", "quad-buffer"})
    EXPECT_THROW(pictures::parse_stereo(bad), core::BadInput) << bad;
}

TEST(Pictures, ShowPartsAsAskedAndLaterWordsWin) {
  const std::vector<view::ScenePart> parts{{"uterus", view::PartGroup::organs}, {"tube", view::PartGroup::tubes}};
  using view::PartStyle;
  const auto styles = [&](const char* text) { return pictures::styles_of(pictures::parse_show(text), parts); };
  EXPECT_TRUE(styles("").empty());
  EXPECT_EQ(styles("organs=hidden,tube=wireframe"), (std::vector{PartStyle::hidden, PartStyle::wireframe}));
  EXPECT_EQ(styles("organs=hidden,uterus=transparent"), (std::vector{PartStyle::transparent, PartStyle::shaded}));
  EXPECT_NO_THROW(styles("clips=hidden")) << "a group that this scene has nothing of";
  for (const char* bad : {"uterus", "uterus=", "=hidden", "uterus=blue", "liver=hidden"})
    EXPECT_THROW(styles(bad), core::BadInput) << bad;
}

TEST(Orbit, KeepsItsDistanceWhenTurnedAndNeverTipsOver) {
  view::Orbit orbit;
  orbit.target = {0.1, -0.2, 0.05};
  for (int i = 0; i < 200; ++i) orbit.turn(0.3, 0.2);
  EXPECT_NEAR(length(orbit.eye() - orbit.target), orbit.distance, 1e-12);
  EXPECT_LT(orbit.pitch, 1.5708);
  orbit.zoom(1e9);
  EXPECT_LE(orbit.distance, 1.5);
  orbit.zoom(1e-9);
  EXPECT_GE(orbit.distance, 0.03);
  const Vec3d before = orbit.eye() - orbit.target;
  orbit.pan(0.1, 0.2);
  EXPECT_NEAR(length(orbit.eye() - orbit.target - before), 0, 1e-12);
}

TEST(AnalysisChoice, NamesQuantitiesAndTheirRanges) {
  EXPECT_FALSE(pictures::parse_analysis("").on());
  const view::AnalysisOptions o = pictures::parse_analysis("strain:35,forces:5,pressure");
  EXPECT_TRUE(o.strain && o.forces && o.pressure && !o.springs);
  EXPECT_NEAR(o.strain_range, 0.35, 1e-12);
  EXPECT_NEAR(o.force_length, 0.005, 1e-12);
  EXPECT_NEAR(o.pressure_most, 120, 1e-12);
  for (const char* bad :
       {"stress", "strain:", "strain:0", "strain:x", "strain:1e9", "forces:5mm", "strain forces", "solvers"})
    EXPECT_THROW(static_cast<void>(pictures::parse_analysis(bad)), core::BadInput) << bad;
}

TEST(LegendPainter, DrawsTheScalesColoursIntoThePictureAndNothingWhereThereIsNone) {
  view::AnalysisOptions o;
  o.strain = true;
  render::Image image{400, 300, std::vector<std::uint8_t>(3 * 400 * 300, 100)};
  const render::Image before = image;
  pictures::LegendPainter painter;
  painter.paint({}, image);
  EXPECT_EQ(image.rgb, before.rgb);
  painter.paint(legend_of(o), image);
  for (const double strain : {-0.19, 0.0, 0.19}) {
    const view::Colour wanted = colour_of_strain(o, strain);
    int found = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      found += std::abs(image.rgb[i] - 255 * double(wanted.r)) < 9 &&
               std::abs(image.rgb[i + 1] - 255 * double(wanted.g)) < 9 &&
               std::abs(image.rgb[i + 2] - 255 * double(wanted.b)) < 9;
    EXPECT_GT(found, 20) << strain;
  }
  render::Image tiny{20, 10, std::vector<std::uint8_t>(600, 7)};
  painter.paint(legend_of(o), tiny);
  EXPECT_EQ(tiny.rgb, std::vector<std::uint8_t>(600, 7)) << "it does not fit";
}

}  // namespace
}  // namespace trocar::pictures
