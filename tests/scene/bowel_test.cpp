// The bowel scene as written and compiled: how much gut there is, where it begins, and that its mesentery carries all
// of it.
#include <functional>
#include <queue>

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
    for (const interactions::Attachment& hold : fold.holds) {
      if (hold.point.body.is(BodyKind::strand))
        ++on_arcade;
      else if (!hold.point.in_space())
        ++on_gut;
    }
    EXPECT_EQ(on_arcade, fold.sheet.columns) << seed;
    EXPECT_EQ(on_gut, fold.sheet.columns) << seed;  // none of it in space
  }
}

/// From one node the shortest ways over springs to all others [m].
std::vector<double> ways_over_springs(const tissue::NetworkModel& network, int from) {
  std::vector<std::vector<int>> beside(std::size_t(network.nodes));
  for (int s = 0; s < network.springs; ++s) {
    const int a = network.spring_nodes[std::size_t(2 * s)], b = network.spring_nodes[std::size_t(2 * s + 1)];
    beside[std::size_t(a)].push_back(b);
    beside[std::size_t(b)].push_back(a);
  }
  std::vector<double> way(std::size_t(network.nodes), 1e9);
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  front.push({0, from});
  while (!front.empty()) {
    const auto [so_far, here] = front.top();
    front.pop();
    if (so_far >= way[std::size_t(here)]) continue;
    way[std::size_t(here)] = so_far;
    for (const int next : beside[std::size_t(here)])
      front.push({so_far + length(network.rest[std::size_t(next)] - network.rest[std::size_t(here)]), next});
  }
  return way;
}

/// Loops lie a millimetre from each other, in cells of six: from one to the next it is as far as along the gut.
TEST(BowelScene, LoopsHangTogetherOnlyAlongTheGut) {
  for (const std::uint64_t seed : {0, 2}) {
    Description d = bowel();
    vary(d, seed);
    const sim::Model model = compile(d);
    const tissue::NetworkModel& gut = model.solids[std::size_t(model.organ_index("jejunum"))].network;
    const std::vector<Section>& sections = jejunum(d).sections;
    std::vector<double> along(sections.size(), 0);
    std::vector<int> node(sections.size(), 0);  // in the middle of each section
    for (std::size_t i = 0; i < sections.size(); ++i) {
      if (i > 0) along[i] = along[i - 1] + length(sections[i].centre - sections[i - 1].centre);
      for (int n = 0; n < gut.nodes; ++n)
        if (length(gut.rest[std::size_t(n)] - sections[i].centre) <
            length(gut.rest[std::size_t(node[i])] - sections[i].centre))
          node[i] = n;
    }
    int looked = 0;
    for (std::size_t i = 5; i < sections.size(); i += 10) {
      const std::vector<double> way = ways_over_springs(gut, node[i]);
      for (std::size_t j = 0; j < sections.size(); ++j) {
        if (std::fabs(along[i] - along[j]) < 0.1) continue;
        ++looked;
        EXPECT_GT(way[std::size_t(node[j])], 0.5 * std::fabs(along[i] - along[j]))
            << "seed " << seed << ": " << i << " " << j;
      }
    }
    EXPECT_GT(looked, 300);
  }
}

TEST(BowelScene, EveryStationLiesOnTheGutAndFacesOutOfIt) {
  const sim::Model model = compile(bowel());
  const int gut = model.organ_index("jejunum");
  int stations = 0;
  for (const sim::MarkModel& mark : model.marks) {
    if (mark.name.rfind("station_", 0) != 0) continue;
    ++stations;
    EXPECT_EQ(mark.at.body, BodyId::organ(size_t(gut))) << mark.name;
    EXPECT_GT(mark.normal.z, 0) << mark.name;
  }
  EXPECT_EQ(stations, 128);
}

}  // namespace
}  // namespace trocar::scene
