#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/interactions/objects/bag_build.hpp>
#include <trocar/scene/objects/bag_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

constexpr double kLeastDeep = 0.75;  // of the mouth's width: its bottom is half a ball

const Shape& bag_shape() {
  static const Shape shape{
      "bag",
      "A retrieval bag, which comes out of the sleeve of an instrument of the kind \"bag\". Things are put into it "
      "through "
      "its mouth, which is drawn shut before it goes out by the port.",
      {needed(keys::name("name", "its name in exercises")),
       keys::text("look", "material of its cloth, default \"bag_film\""),
       keys::number("mouth_mm", 20, 120, "diameter of its open hoop, default 60"),
       keys::number("deep_mm", 20, 250,
                    "from the mouth to the bottom, at least three quarters of mouth_mm; default 110"),
       keys::number("weight_g", 1, 50, "mass of the cloth with adhering fluid, default 4")}};
  return shape;
}

/// Every rigid object, and every pouch: anything may be put into it.
void note_points(const sim::Model& model, interactions::BagModel& m) {
  m.rigids = std::int32_t(interactions::part_of<interactions::Rigid>(model).list.size());
  m.points = m.rigids;
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    if (!model.membranes[i].sheet.closed()) continue;
    const std::int32_t nodes = model.membranes[i].sheet.nodes();
    m.pouches.push_back({std::int32_t(i), m.points, nodes, 0});
    m.points += nodes;
  }
}

bool brings_bags(const sim::HandModel& hand) {
  return std::any_of(hand.rack.begin(), hand.rack.end(),
                     [](const interactions::ToolModel& tool) { return tool.can().bag; });
}

}  // namespace

Key BagScene::row() {
  Key row = keys::objects(kKey, bag_shape, 0, "the retrieval bag, default none");
  row.max_count = 1;
  return row;
}

BagSetting BagScene::read(const JsonObject& o) {
  BagSetting s;
  s.name = o.text("name");
  s.look = o.text("look", "bag_film");
  s.mouth = o.number("mouth_mm", 1000 * s.mouth) / 1000;
  s.deep = o.number("deep_mm", 1000 * s.deep) / 1000;
  s.weight = o.number("weight_g", 1000 * s.weight) / 1000;
  s.at = o.at();
  s.text = o.value();
  if (s.deep < kLeastDeep * s.mouth)
    o.fault(o.names("deep_mm") ? "deep_mm" : "mouth_mm",
            tr("expected deep_mm to be at least {} times mouth_mm, got a shallower bag", kLeastDeep));
  return s;
}

void BagScene::compile(const std::vector<Setting>& settings, const Description&, sim::Model& model,
                       std::vector<core::Fault>&) {
  for (const BagSetting& s : settings) {
    interactions::BagDescription d;
    d.hoop = 0.5 * s.mouth;
    d.deep = s.deep;
    d.weight = s.weight;
    interactions::BagModel m = interactions::build(d);
    m.name = s.name;
    m.look = s.look;
    note_points(model, m);
    interactions::part_of<interactions::Bag>(model).list.push_back(std::move(m));
  }
}

void BagScene::expect_hand(const std::vector<Setting>& settings, const sim::Model& model,
                           std::vector<core::Fault>& faults) {
  for (const BagSetting& s : settings)
    if (std::none_of(model.hands.begin(), model.hands.end(), brings_bags))
      faults.push_back({s.at, tr("expected an instrument of the kind \"bag\" that fits a hand's trocar, "
                                 "to bring in \"{}\", got none",
                                 s.name)});
}

}  // namespace trocar::scene
