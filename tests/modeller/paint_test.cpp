// What a brush leaves on bodies, and what scene operations leave around them.
#include <algorithm>
#include <cmath>

#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/picture/painted.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/tissue/network/network.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

Document with_bar(const Workplace& place) {
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "revolved",
        R"({"name": "bar", "tissue": "uterus", "from_mm": [0, -180, -110], "to_mm": [0, -120, -110],
            "radii_mm": [12, 12, 12], "cell_mm": 4})");
  apply(document, "hold", R"({"of": "bar", "centre_mm": [0, -185, -110], "radius_mm": 14})");
  return document;
}

std::size_t balls(const Document& document, const std::string& thing, const std::string& list) {
  const scene::JsonValue value = value_of(document, thing_named(document, thing));
  const scene::JsonValue* items = scene::json_at(value, list);
  return items ? items->items.size() : 0;
}

double stiffness_of_all(const Document& document) {
  const Built built = build(document);
  EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
  double sum = 0;
  if (!built.good()) return 0;
  const tissue::NetworkModel& n = built.model->solids[0].network;
  for (int i = 0; i < n.springs; ++i) sum += tissue::spring_stiffness(n, i);
  return sum;
}

TEST(Paint, AStrokeIsARowOfBallsThatHold) {
  const Workplace place;
  Document document = with_bar(place);
  const Built before = build(document);
  ASSERT_TRUE(before.good());
  apply(document, "paint",
        R"({"of": "bar", "what": "hold", "places_mm": [[0, -130, -98], [0, -126, -98], [0, -122, -98]],
            "radius_mm": 6})");
  EXPECT_EQ(balls(document, "bar", "/anchors"), 4u);
  const Built after = build(document);
  ASSERT_TRUE(after.good());
  const auto held = [](const Built& b) {
    const std::vector<std::uint8_t>& fixed = b.model->solids[0].network.fixed;
    return std::count(fixed.begin(), fixed.end(), std::uint8_t(tissue::kHeld));
  };
  EXPECT_GT(held(after), held(before));
  // over what is held already nothing is painted again
  apply(document, "paint",
        R"({"of": "bar", "what": "hold", "places_mm": [[0, -130, -98.5], [0, -126, -98]], "radius_mm": 6})");
  EXPECT_EQ(balls(document, "bar", "/anchors"), 4u);
  apply(document, "paint",
        R"({"of": "bar", "what": "hold", "places_mm": [[0, -126, -98]], "radius_mm": 5, "erase": true})");
  EXPECT_EQ(balls(document, "bar", "/anchors"), 1u) << "4 mm apart, all three are under the rubber";
  while (document.undo()) {
  }
  EXPECT_FALSE(thing_named(document, "port:umbilical").name.empty());
}

TEST(Paint, StiffnessIsWhatSpringsHave) {
  const Workplace place;
  Document document = with_bar(place);
  const double before = stiffness_of_all(document);
  apply(document, "paint",
        R"({"of": "bar", "what": "stiffness", "places_mm": [[0, -150, -110]], "radius_mm": 200, "stiffness": 2})");
  EXPECT_NEAR(stiffness_of_all(document) / before, 2, 1e-3);
  apply(document, "paint",
        R"({"of": "bar", "what": "stiffness", "places_mm": [[0, -150, -110]], "radius_mm": 200, "stiffness": 1})");
  EXPECT_NEAR(stiffness_of_all(document) / before, 1, 1e-3) << "what comes later counts";
}

TEST(Paint, IsShownAsItIs) {
  const Workplace place;
  Document document = with_bar(place);
  apply(document, "paint",
        R"({"of": "bar", "what": "stiffness", "places_mm": [[0, -130, -98]], "radius_mm": 8, "stiffness": 4})");
  const Painted stiffness = painted_on(document, "bar", "stiffness");
  EXPECT_DOUBLE_EQ(stiffness.at({0, -0.130, -0.098}), 4);
  EXPECT_DOUBLE_EQ(stiffness.at({0, -0.160, -0.098}), 1);
  EXPECT_EQ(painted_on(document, "bar", "hold").at({0, -0.184, -0.110}), 1);
  EXPECT_EQ(painted_on(document, "bar", "bonds").at({0, -0.184, -0.110}), 0);
}

TEST(Paint, OnWhatHasNoneIsTold) {
  const Workplace place;
  Document document = with_bar(place);
  EXPECT_NE(fault_of(document, "paint", R"({"of": "bar", "what": "bonds", "places_mm": [[0, 0, 0]], "radius_mm": 3})")
                .find("expected a pouch that has bonds"),
            std::string::npos);
  apply(document, "cord",
        R"({"name": "cord", "tissue": "round_ligament", "line_mm": [[0, 0, 0], [9, 0, 0]], "radius_mm": 2})");
  EXPECT_NE(fault_of(document, "paint", R"({"of": "cord", "what": "hold", "places_mm": [[0, 0, 0]], "radius_mm": 3})")
                .find("expected a solid or a pouch, got a strand"),
            std::string::npos);
}

TEST(Paint, FibresMakeABodyStifferAlongTheirStroke) {
  const Workplace place;
  Document document = with_bar(place);
  const auto share_along = [&] {  // of all springs' stiffness, what lies along y
    const Built built = build(document);
    EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
    if (!built.good()) return 0.0;
    const tissue::NetworkModel& n = built.model->solids[0].network;
    double along = 0, all = 0;
    for (int i = 0; i < n.springs; ++i) {
      const Vec3d d = n.rest[std::size_t(n.spring_nodes[2 * std::size_t(i) + 1])] -
                      n.rest[std::size_t(n.spring_nodes[2 * std::size_t(i)])];
      const double c = d.y / length(d), k = tissue::spring_stiffness(n, i);
      all += k, along += k * c * c;
    }
    return along / all;
  };
  const double plain = share_along();
  apply(document, "fibres", R"({"of": "bar", "ratio": 2})");
  const double along = share_along();
  EXPECT_GT(along, 1.1 * plain);
  apply(document, "fibres", R"({"of": "bar", "line_mm": [[-10, -150, -98], [10, -150, -98]]})");
  EXPECT_LT(share_along(), plain) << "a stroke across stands for what ran along";
  EXPECT_EQ(balls(document, "bar", "/fibres_mm"), 1u);
}

TEST(Place, TiltIsWhereThingsFall) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "tilt", R"({"head_down_deg": 15})");
  std::vector<core::Fault> ignored;
  const auto gravity = [&] {
    return point_of(scene::parse_json(document.text(document.root()), "", ignored).root.find("gravity_m_s2")->value);
  };
  EXPECT_NEAR(gravity().y, 2.54, 0.01) << "towards the head";
  EXPECT_NEAR(gravity().z, -9.476, 0.01);
  apply(document, "tilt", R"({"left_down_deg": 30})");
  EXPECT_NEAR(gravity().x, 9.81 / 2, 0.01) << "x goes to the patient's left";
  EXPECT_NEAR(length(gravity()), 9.81, 1e-3);
}

/// The scene is like the modelling place: what it adds to that place's lists must not stand for all of them.
TEST(Place, APortAndItsInstrumentStandBesideThoseOfThePlace) {
  const Workplace place;
  Document document = with_bar(place);
  apply(document, "port", R"({"name": "flank", "position_mm": [110, -40, -20], "diameter_mm": 12})");
  apply(document, "tool", R"({"instrument": "grasper", "port": "flank", "tip_mm": [60, -110, -80]})");
  apply(document, "scope", R"({"angle_deg": 30})");
  apply(document, "mark", R"({"name": "here", "on": "bar", "place_mm": [0, -150, -98], "colour": "blue"})");
  apply(document, "vary", R"({"girths_of": ["bar"], "radius": 0.1, "stiffness": 0.2})");
  const Built built = build(document);
  ASSERT_TRUE(built.good()) << core::to_string(built.faults.front());
  EXPECT_EQ(built.model->hands.size(), 3u);
  EXPECT_EQ(thing_named(document, "port:umbilical").kind, "port");
  EXPECT_EQ(built.model->marks.size(), 1u);
}

}  // namespace
}  // namespace trocar::modeller
