// The bowel scene as written and compiled: how much gut there is, where it begins, and that its mesentery carries all
// of it.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::scene {
namespace {

const Description& bowel() {
  static const Description read = read_scene(TROCAR_SOURCE_DIR "/scenes/bowel/scene.json");
  return read;
}
const Solid& jejunum(const Description& d) {
  for (const Solid& s : d.solids)
    if (s.name == "jejunum") return s;
  throw std::runtime_error("no jejunum");
}

TEST(BowelScene, HasMoreThan600MillimetresOfJejunumFromTheFlexureOn) {
  const std::vector<Section>& sections = jejunum(bowel()).sections;
  EXPECT_LT(length(sections.front().centre - Vec3d{0.030, 0.058, -0.138}), 0.005);
  double way = 0;
  for (std::size_t i = 1; i < sections.size(); ++i) way += length(sections[i].centre - sections[i - 1].centre);
  EXPECT_GT(way, 0.650);
  for (const Section& s : sections) {
    EXPECT_GT(length(s.across), 0.009);
    EXPECT_LT(length(s.across), 0.0125);
  }
}

TEST(BowelScene, TheMesenteryHangsOnTheArcadeAndCarriesTheGutAllAlong) {
  for (const std::uint64_t seed : {0, 1, 2}) {
    Description d = bowel();
    vary(d, seed);
    const sim::Model model = compile(d);
    ASSERT_EQ(model.membranes.size(), 1u);
    const sim::MembraneBody& fold = model.membranes.front();
    int on_gut = 0, on_arcade = 0;
    for (const interactions::BorderHold& hold : fold.holds) {
      if (hold.kind == interactions::BorderHold::strand)
        ++on_arcade;
      else if (hold.kind != interactions::BorderHold::space)
        ++on_gut;
    }
    EXPECT_EQ(on_arcade, fold.sheet.columns) << seed;
    EXPECT_EQ(on_gut, fold.sheet.columns) << seed;  // none of it in space
  }
}

TEST(BowelScene, EveryStationLiesOnTheGutAndFacesOutOfIt) {
  const sim::Model model = compile(bowel());
  const int gut = model.organ_index("jejunum");
  int stations = 0;
  for (const sim::MarkModel& mark : model.marks) {
    if (mark.name.rfind("station_", 0) != 0) continue;
    ++stations;
    EXPECT_EQ(mark.on, sim::MarkModel::organ) << mark.name;
    EXPECT_EQ(mark.body, gut) << mark.name;
    EXPECT_GT(mark.normal.z, 0) << mark.name;
  }
  EXPECT_EQ(stations, 128);
}

}  // namespace
}  // namespace trocar::scene
