// Panes of a window: they fill the picture without lying on each other, show different things, cost what they cost,
// and their cameras are turned by hand.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/pictures/analysis_choice.hpp>
#include <trocar/scene/compile/compile.hpp>

#include "../sim/small_scene.hpp"
#include "shell/panes.hpp"
#include "shell/settings.hpp"

namespace trocar::app {
namespace {

constexpr Layout kAll[] = {Layout::one, Layout::side_by_side, Layout::corner, Layout::four};
const Area kWhole{0, 0, 1001, 703};

bool overlap(const Area& a, const Area& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

TEST(Layout, PanesLieWithinThePictureAndOnlyTheSmallOneOnAnother) {
  for (const Layout layout : kAll) {
    const std::vector<Area> areas = areas_of(layout, kWhole, 1);
    ASSERT_EQ(int(areas.size()), panes_in(layout));
    double covered = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
      const Area& a = areas[i];
      EXPECT_TRUE(a.x >= kWhole.x && a.x + a.width <= kWhole.x + kWhole.width) << i;
      EXPECT_TRUE(a.y >= kWhole.y && a.y + a.height <= kWhole.y + kWhole.height) << i;
      EXPECT_TRUE(a.x == std::floor(a.x) && a.width == std::floor(a.width)) << "whole pixels";
      covered += double(a.width) * double(a.height);
      for (std::size_t k = 0; k < i && layout != Layout::corner; ++k) EXPECT_FALSE(overlap(areas[k], a)) << i;
    }
    EXPECT_GT(covered, 0.98 * double(kWhole.width) * double(kWhole.height)) << name_of(layout);
  }
}

TEST(Layout, TinyWindowsHavePanesOfAPixelAtLeast) {
  for (const Layout layout : kAll)
    for (const Area& a : areas_of(layout, {0, 0, 3, 2}, 2)) EXPECT_TRUE(a.width >= 1 && a.height >= 1);
}

TEST(Layout, GoesThroughAllAndBegins) {
  std::set<Layout> seen;
  Layout layout = Layout::one;
  for (int i = 0; i < 4; ++i) seen.insert(layout), layout = after(layout);
  EXPECT_EQ(seen.size(), 4u);
  EXPECT_EQ(layout, Layout::one);
}

TEST(Layout, APaneTakesWhatAnotherShowedAndGivesItsOwn) {
  LayoutChoice choice;
  choice.put(0, PaneShows::analysis);
  EXPECT_EQ(choice.panes[0], PaneShows::analysis);
  EXPECT_EQ(choice.panes[3], PaneShows::endoscope);
  const std::set<PaneShows> all(choice.panes.begin(), choice.panes.end());
  EXPECT_EQ(all.size(), 4u);
  EXPECT_FALSE(choice.shows(PaneShows::outside)) << "one pane only";
}

TEST(Layout, OnePictureCostsOneAndSeveralMore) {
  EXPECT_NEAR(load_of(areas_of(Layout::one, kWhole, 1), kWhole), 1, 1e-9);
  EXPECT_GT(load_of(areas_of(Layout::corner, kWhole, 1), kWhole), 1.2);
  EXPECT_LT(load_of(areas_of(Layout::four, kWhole, 1), kWhole),
            load_of(areas_of(Layout::side_by_side, kWhole, 1), kWhole));
}

TEST(Layout, IsKeptInTheSettings) {
  Settings s;
  s.views.layout = Layout::four;
  s.views.put(1, PaneShows::analysis);
  std::vector<core::Fault> faults;
  const scene::MemoryFiles files{{"settings.json", settings_text(s)}};
  EXPECT_EQ(read_settings("settings.json", faults, &files), s);
  EXPECT_TRUE(faults.empty());
}

TEST(Layout, SettingsThatNameOneThingTwiceArePutRight) {
  std::vector<core::Fault> faults;
  const scene::MemoryFiles files{
      {"settings.json", R"({"format": 1, "layout": "four", "pane_1": "outside", "pane_2": "outside"})"}};
  const LayoutChoice views = read_settings("settings.json", faults, &files).views;
  EXPECT_EQ(views.panes[0], PaneShows::outside);
  EXPECT_EQ(std::set<PaneShows>(views.panes.begin(), views.panes.end()).size(), 4u);
}

TEST(Panes, TurnTheirOwnCameraAndNoOther) {
  Panes panes(small::model());
  const PaneCameras before = panes.cameras;
  EXPECT_FALSE(panes.turn(PaneShows::endoscope, 0.3, 0.1)) << "hands lead that one";
  EXPECT_EQ(panes.cameras, before);
  EXPECT_TRUE(panes.turn(PaneShows::outside, 0.3, 0.1));
  EXPECT_NEAR(panes.cameras.outside.yaw, before.outside.yaw + 0.3, 1e-9);
  EXPECT_EQ(panes.cameras.analysis_orbit, before.analysis_orbit);
  EXPECT_TRUE(panes.closer(PaneShows::second_scope, 0.2));
  EXPECT_GT(panes.cameras.second.pose.depth, before.second.pose.depth);
  panes.cameras.analysis_from_endoscope = true;
  EXPECT_FALSE(panes.turn(PaneShows::analysis, 0.3, 0.1));
}

TEST(Panes, EachHasItsOwnExposureMemoryAndOnlyAnalysisHasFigures) {
  const Panes panes(small::model());
  std::set<int> eyes;
  for (const PaneShows shows : {PaneShows::endoscope, PaneShows::second_scope, PaneShows::outside}) {
    const view::ViewOptions options = panes.options(shows);
    eyes.insert(options.eye_index);
    EXPECT_FALSE(options.analysis.on());
  }
  EXPECT_EQ(eyes.size(), 3u);
  EXPECT_TRUE(panes.options(PaneShows::analysis).analysis.on());
}

TEST(Panes, TheSecondWindowHasAPaneOfItsOwnUnlessTheFirstOneShowsThat) {
  Panes panes(small::model());
  LayoutChoice choice;
  choice.layout = Layout::corner;
  panes.lay_out(choice, kWhole, 1, {640, 480});
  const double without = panes.load();
  EXPECT_EQ(panes.panes().size(), 2u);
  choice.elsewhere = PaneShows::endoscope;
  panes.lay_out(choice, kWhole, 1, {640, 480});
  EXPECT_EQ(panes.panes().size(), 2u);
  EXPECT_EQ(panes.canvas_elsewhere(), nullptr) << "the first pane's picture serves";
  choice.elsewhere = PaneShows::analysis;
  panes.lay_out(choice, kWhole, 1, {640, 480});
  ASSERT_EQ(panes.panes().size(), 3u);
  EXPECT_TRUE(panes.panes()[2].elsewhere);
  EXPECT_NE(panes.canvas_elsewhere(), nullptr);
  EXPECT_GT(panes.load(), without);
  panes.lay_out(choice, kWhole, 1, {0, 0});
  EXPECT_EQ(panes.panes().size(), 2u) << "not open yet";
}

TEST(Panes, ATallPaneShowsTheWholeCircleAndAWideOneIsAsItWas) {
  render::Frame frame;
  frame.camera.vertical_fov = 1;
  fit_to({0, 0, 800, 600}, frame);
  EXPECT_EQ(frame.camera.vertical_fov, 1.0f);
  EXPECT_EQ(frame.look.mask_diameter, 1.0f);
  fit_to({0, 0, 300, 600}, frame);
  EXPECT_NEAR(frame.look.mask_diameter, 0.5f, 1e-6f);
  EXPECT_NEAR(std::tan(frame.camera.vertical_fov / 2), 2 * std::tan(0.5f), 1e-5f);
}

}  // namespace
}  // namespace trocar::app
