// Files of vessels: what is shipped is sound and flows as it should; what is not sound is told, all of it, with its
// place.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/vessels/flow.hpp>

namespace trocar::scene {
namespace {

constexpr double kMmHg = vessels::kPascalPerMmHg;

const VesselTree& pelvis() {
  static const VesselTree tree = read_vessels(TROCAR_SOURCE_DIR "/scenes/vessels/pelvis.json");
  return tree;
}
int number_of(const VesselTree& tree, const std::string& name) {
  const auto it =
      std::find_if(tree.vessels.begin(), tree.vessels.end(), [&](const Vessel& v) { return v.name == name; });
  return it == tree.vessels.end() ? -1 : int(it - tree.vessels.begin());
}

std::string file_with(const std::string& vessels, const std::string& rest = "") {
  return "{\"format\": 1, \"name\": \"t\", \"sources\": [{\"node\": \"a\"}],\n\"vessels\": [\n" + vessels + "\n]" +
         rest + "}";
}
const std::string kGood =
    "{\"name\": \"one\", \"from\": \"a\", \"to\": \"b\", \"path_mm\": [[0, 0, 0], [0, 0, 100]], \"radius_mm\": 1, "
    "\"wave_speed_m_s\": 8}";

std::vector<core::Fault> faults_of(const std::string& text) {
  const MemoryFiles files{{"v.json", text}};
  return check_file("v.json", &files);
}
bool told(const std::vector<core::Fault>& faults, int line, const std::string& words) {
  return std::any_of(faults.begin(), faults.end(), [&](const core::Fault& f) {
    return f.at.line == line && f.message.find(words) != std::string::npos;
  });
}

TEST(VesselFile, ThePelvisIsReadWithPathsAndGraphInOneOrder) {
  const VesselTree& tree = pelvis();
  ASSERT_EQ(tree.vessels.size(), tree.graph.segments.size());
  const int uterine = number_of(tree, "uterine_left");
  ASSERT_GE(uterine, 0);
  const vessels::VesselSegment& s = tree.graph.segments[size_t(uterine)];
  EXPECT_DOUBLE_EQ(s.length, 0.125);
  EXPECT_DOUBLE_EQ(s.radius, 0.0008);
  EXPECT_EQ(tree.nodes[size_t(s.to)], "cervix_left");
  EXPECT_EQ(tree.vessels[size_t(uterine)].rides_on, std::vector<std::string>{"uterus"});
  EXPECT_TRUE(vessels::check(tree.graph).empty());
}

TEST(VesselFile, RestFlowsAreThoseThatTheEndsAskFor) {
  const VesselTree& tree = pelvis();
  const vessels::FlowModel model = vessels::build(tree.graph);
  vessels::FlowState state = vessels::settled_state(model, 10);
  vessels::FlowWork work = vessels::make_work(model);
  const int ovary = number_of(tree, "ovarian_rami_left"), iliac = number_of(tree, "common_iliac_left");
  double to_ovary = 0, through_iliac = 0;
  constexpr int kTicks = 30'000;
  for (int t = 0; t < kTicks; ++t) {
    vessels::advance(model, {}, {}, state, work);
    to_ovary += 60e6 * vessels::read_wall(model, state, ovary, 0.5).flow / kTicks;
    through_iliac += 60e6 * vessels::read_wall(model, state, iliac, 0.5).flow / kTicks;
  }
  EXPECT_NEAR(to_ovary, 8, 0.8);
  EXPECT_NEAR(through_iliac, 250 + 12 + 20 + 12 + 8 + 3, 35) << "the ovarian artery brings some of it";
}

TEST(VesselFile, EachSideOfACutUterineArteryBleedsAndBothNeedAClip) {
  const VesselTree& tree = pelvis();
  const vessels::FlowModel model = vessels::build(tree.graph);
  const int uterine = number_of(tree, "uterine_upper_left");
  using vessels::Occlusion;
  const auto bled = [&](std::vector<Occlusion> clips) {
    vessels::FlowState state = vessels::settled_state(model, 5);
    vessels::FlowWork work = vessels::make_work(model);
    const std::vector<vessels::Opening> cut{{.segment = uterine,
                                             .s = 0.5,
                                             .kind = vessels::Opening::Kind::cut,
                                             .area = vessels::lumen_area(model, state, uterine, 0.5),
                                             .outside = 12 * kMmHg}};
    std::vector<vessels::OpeningFlow> flow(1);
    for (Occlusion& c : clips) c.segment = uterine, c.cover = 1;
    double sum[2] = {0, 0};
    for (int t = 0; t < 2000; ++t) {
      vessels::advance(model, {.openings = cut, .clips = clips}, flow, state, work);
      for (int side = 0; t >= 1000 && side < 2; ++side) sum[side] += double(flow[0].picolitres[side]);
    }
    return std::pair{sum[0], sum[1]};
  };
  const auto open = bled({});
  EXPECT_GT(open.first, 0);
  EXPECT_GT(open.second, 0) << "what comes from the ovarian artery";
  const auto one = bled({{.s = 0.3}});
  EXPECT_EQ(one.first, 0);
  EXPECT_GT(one.second, 0) << "the anastomosis";
  const auto both = bled({{.s = 0.3}, {.s = 0.7}});
  EXPECT_EQ(both.first, 0);
  EXPECT_EQ(both.second, 0);
}

TEST(VesselFile, EveryFaultOfAGraphIsToldWhereItStands) {
  EXPECT_TRUE(faults_of(file_with(kGood)).empty());
  const auto second = [](const std::string& fields) { return kGood + ",\n{\"name\": \"two\", " + fields + "}"; };
  const std::string ways = "\"path_mm\": [[0, 0, 100], [0, 50, 100]], ";
  EXPECT_TRUE(told(faults_of(file_with(
                       second("\"from\": \"b\", \"to\": \"c\", " + ways + "\"radius_mm\": 0, \"wave_speed_m_s\": 8"))),
                   4, "radius_mm"))
      << "no radius";
  EXPECT_TRUE(told(faults_of(file_with(second("\"from\": \"b\", \"to\": \"c\", " + ways + "\"radius_mm\": 1"))), 4,
                   "wave_speed_m_s"))
      << "no wall";
  EXPECT_TRUE(told(faults_of(file_with(
                       second("\"from\": \"x\", \"to\": \"y\", " + ways + "\"radius_mm\": 1, \"wave_speed_m_s\": 8"))),
                   4, "way to a source, node \"x\""))
      << "nothing feeds it";
  EXPECT_TRUE(told(faults_of(file_with(second("\"from\": \"b\", \"to\": \"c\", \"path_mm\": [[0, 20, 100], [0, 50, "
                                              "100]], \"radius_mm\": 1, \"wave_speed_m_s\": 8"))),
                   4, "meet the others at node \"b\""))
      << "it begins elsewhere";
  EXPECT_TRUE(told(faults_of(file_with(second("\"from\": \"a\", \"to\": \"b\", \"path_mm\": [[0, 0, 0], [0, 0, "
                                              "100]], \"radius_mm\": 1, \"wave_speed_m_s\": 8"),
                                       ",\n\"tree\": true")),
                   4, "cycle at node"))
      << "a cycle in a tree";
  EXPECT_TRUE(
      told(faults_of(file_with(kGood, ",\n\"ends\": [\n{\"node\": \"c\", \"flow_mL_min\": 5}]")), 6, "known node"))
      << "an end of nothing";
  EXPECT_TRUE(told(faults_of(file_with(kGood, ",\n\"ends\": [\n{\"node\": \"b\"}]")), 6, "either \"flow_mL_min\""))
      << "an end without a figure";
  EXPECT_TRUE(told(faults_of(file_with(kGood + ",\n" + kGood)), 4, "every vessel name once"));
}

TEST(VesselFile, MoreVesselsThanAnyBodyHasAreRefused) {
  std::string list = kGood;
  for (std::size_t i = 0; i <= vessels::kMaxSegments; ++i) list += ",{}";
  const std::vector<core::Fault> faults = faults_of(file_with(list));
  ASSERT_FALSE(faults.empty());
  EXPECT_NE(faults.front().message.find("20000"), std::string::npos) << faults.front().message;
}

TEST(VesselFile, AMillionVesselsAreALocatedFault) {
  std::string list = kGood;
  for (int i = 0; i < 1'000'000; ++i) list += ",{}";
  const std::vector<core::Fault> faults = faults_of(file_with(list));
  ASSERT_FALSE(faults.empty());
  EXPECT_GT(faults.front().at.line, 0);
  EXPECT_LT(faults.size(), 2000u) << "not one each";
}

TEST(VesselFile, FiguresThatAreNoNumbersAreToldWhereTheyStand) {
  for (const std::string bad : {"NaN", "-Infinity", "1e999", "-1", "0", "\"wide\"", "null"}) {
    const std::string second = ",\n{\"name\": \"two\", \"from\": \"b\", \"to\": \"c\",\n\"radius_mm\": " + bad +
                               ",\n\"path_mm\": [[0, 0, 100], [0, 50, 100]], \"wave_speed_m_s\": 8}";
    const std::vector<core::Fault> faults = faults_of(file_with(kGood + second));
    EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [](const core::Fault& f) { return f.at.line == 5; })) << bad;
  }
  const std::string path =
      ",\n{\"name\": \"two\", \"from\": \"b\", \"to\": \"c\", \"radius_mm\": 1, "
      "\"wave_speed_m_s\": 8,\n\"path_mm\": [[0, 0, 100], [0, NaN, 100]]}";
  const std::vector<core::Fault> faults = faults_of(file_with(kGood + path));
  EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [](const core::Fault& f) { return f.at.line == 5; }));
}

}  // namespace
}  // namespace trocar::scene
