#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/objects/fat_filling.hpp>
#include <trocar/scene/objects/fat_scene.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {
namespace {

constexpr double kFatFar = 2000;    // [mm]
constexpr int kMostLobules = 4000;  // of one body: what a tick bears

const Shape& fill_shape() {
  static const Shape shape{"fill",
                           "A thick line.",
                           {needed(keys::points("line_mm", -kFatFar, kFatFar, 1, "its middle; one point: a ball")),
                            needed(keys::number("radius_mm", 1, 100, "half its thickness"))}};
  return shape;
}

const Shape& nodule_shape() {
  static const Shape shape{
      "nodule",
      "Lobules within a thick line that are drawn as one lymph node. For display only; "
      "mechanically they are fat.",
      {needed(keys::points("line_mm", -kFatFar, kFatFar, 1, "its middle; one point: a ball")),
       needed(keys::number("radius_mm", 1, 100, "half its thickness")), needed(keys::text("look", "its material"))}};
  return shape;
}

const Shape& fat_shape() {
  static const Shape shape{
      "fat",
      "Fat and areolar tissue: lobules that septa tie to each other, and that hold on what they lie on. They are "
      "teased "
      "apart, cut, coagulated and boiled away.",
      {needed(keys::name("name", "its name in exercises")),
       keys::text("look", "its surface in the picture, default \"fat\""),
       needed(keys::objects("fills", fill_shape, 1, "its volume, except where other bodies are")),
       keys::objects("nodules", nodule_shape, 0, "lymph nodes in it, default none"),
       keys::texts("on", "strands, solids and pouches that it is attached to, where they are near"),
       keys::number("reach_mm", 0.2, 20, "how near that is, default 3"),
       keys::number("spacing_mm", 1, 10, "of its lobules, default 2.5"),
       keys::number("young_Pa", 100, 1e5, "small-strain modulus, default 3000"),
       keys::number("opens", 0.2, 5, "failure strain of a septum, default 1.2"),
       keys::number("serosa_N_m", 0, 1000,
                    "modulus times thickness of the serosa over its free faces, default 50; 0: none"),
       keys::number("serosa_opens", 0.2, 5, "strain at which that has torn, default 1"),
       keys::number("toughness_J_m2", 0.1, 1000, "fracture energy of its attachments, default 15"),
       keys::number("holds_to_mm", 0.5, 20, "opening at which an attachment has separated, default 4"),
       keys::number("water", 0.05, 0.95, "share of its mass that vaporises before it is removed, default 0.15"),
       keys::number("density_kg_m3", 500, 1500, "default 920")}};
  return shape;
}

tissue::FatDescription described(const FatSetting& s, const FatFilling& filling, const sim::Model& model) {
  tissue::FatDescription d;
  d.lobules = filling.lobules;
  d.free = filling.free;
  d.spacing = s.spacing;
  d.material = s.material;
  d.gravity = model.gravity;
  return d;
}

/// What lobules hang on: a rod or an organ that is near, else a wall.
interactions::BondSet roots_of(const FatSetting& s, const FatFilling& filling, const sim::Model& model) {
  interactions::BondSet set;
  set.name = s.name;
  set.of = BodyId(BodyKind::fat, model.fat.size());
  set.law = tissue::CohesiveLaw::of(s.toughness, s.opens);
  const double area = s.spacing * s.spacing / std::sqrt(2.0);
  std::vector<std::string> first, walls;
  for (const std::string& name : s.on) (model.membrane_index(name) >= 0 ? walls : first).push_back(name);
  const sim::DrawnBodies drawn(model);
  for (std::size_t i = 0; i < filling.lobules.size(); ++i) {
    sim::Attached on = attach_near(drawn, first, s.reach, filling.lobules[i]);
    if (on.point.in_space()) on = attach_near(drawn, walls, s.reach, filling.lobules[i]);
    if (on.point.in_space()) continue;
    set.bonds.push_back({interactions::at_node(drawn.all(), set.of, std::int32_t(i)), on.point, area, on.vertex});
  }
  return set;
}

FatSetting::Fill read_fill(const JsonObject& o) {
  FatSetting::Fill f;
  for (const Vec3d& p : o.points("line_mm")) f.line.push_back(p / 1000.0);
  f.radius = o.number("radius_mm", 1) / 1000;
  return f;
}

std::vector<interactions::FatNodule> nodules_of(const FatSetting& s, const FatFilling& filling) {
  std::vector<interactions::FatNodule> all;
  for (const FatSetting::Nodule& n : s.nodules) {
    interactions::FatNodule& nodule = all.emplace_back();
    nodule.look = n.look;
    for (std::size_t i = 0; i < filling.lobules.size(); ++i)
      if (within(n.in, filling.lobules[i])) nodule.lobules.push_back(std::int32_t(i));
  }
  return all;
}

void compile_one(const FatSetting& s, sim::Model& model, std::vector<core::Fault>& faults) try {
  for (const std::string& name : s.on)
    if (model.strand_index(name) < 0 && model.organ_index(name) < 0 && model.membrane_index(name) < 0)
      faults.push_back({s.at, tr("expected \"on\" to name strands, solids and pouches, got \"{}\"", name)});
  const FatFilling filling = filled(s, model);
  if (filling.lobules.empty() || int(filling.lobules.size()) > kMostLobules) {
    faults.push_back({s.at, tr("expected room for 1 to {} lobules of {} mm in \"{}\", got {}", kMostLobules,
                               1000 * s.spacing, s.name, filling.lobules.size())});
    return;
  }
  interactions::FatBody body;
  body.name = s.name;
  body.look = s.look;
  body.nodules = nodules_of(s, filling);
  interactions::BondSet roots = roots_of(s, filling, model);
  if (roots.bonds.empty()) {
    faults.push_back({s.at, tr("expected a body of \"on\" within {} mm of \"{}\", got none", 1000 * s.reach, s.name)});
    return;
  }
  body.fat = tissue::build(described(s, filling, model), sim::kTick);
  body.roots = std::int32_t(model.bonds.size());
  model.bonds.push_back(std::move(roots));
  model.fat.push_back(std::move(body));
} catch (const std::invalid_argument& e) {
  faults.push_back({s.at, "fat \"" + s.name + "\": expected a body that can be built, got: " + e.what()});
}

}  // namespace

Key FatScene::row() {
  Key row = keys::objects(kKey, fat_shape, 0, "fat between other bodies, default none");
  row.max_count = 16;
  return row;
}

FatSetting FatScene::read(const JsonObject& o) {
  FatSetting s;
  s.name = o.text("name");
  s.look = o.text("look", "fat");
  for (const JsonObject& fill : o.objects("fills")) s.fills.push_back(read_fill(fill));
  for (const JsonObject& n : o.objects("nodules")) s.nodules.push_back({read_fill(n), n.text("look")});
  s.on = o.texts("on");
  s.reach = o.number("reach_mm", 1000 * s.reach) / 1000;
  s.spacing = o.number("spacing_mm", 1000 * s.spacing) / 1000;
  s.toughness = o.number("toughness_J_m2", s.toughness);
  s.opens = o.number("holds_to_mm", 1000 * s.opens) / 1000;
  s.material.young = o.number("young_Pa", s.material.young);
  s.material.yields = 0.5 * o.number("opens", s.material.opens);
  s.material.opens = o.number("opens", s.material.opens);
  s.material.serosa = o.number("serosa_N_m", s.material.serosa);
  s.material.serosa_opens = o.number("serosa_opens", s.material.serosa_opens);
  s.material.water = o.number("water", s.material.water);
  s.material.density = o.number("density_kg_m3", s.material.density);
  s.at = o.at();
  s.text = o.value();
  return s;
}

void FatScene::bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp) {
  for (FatSetting& s : settings)
    for (FatSetting::Fill& f : s.fills)
      for (Vec3d& p : f.line) p = warp(p);
  for (FatSetting& s : settings)
    for (FatSetting::Nodule& n : s.nodules)
      for (Vec3d& p : n.in.line) p = warp(p);
}

void FatScene::compile(const std::vector<Setting>& settings, const Description&, sim::Model& model,
                       std::vector<core::Fault>& faults) {
  for (const FatSetting& s : settings) compile_one(s, model, faults);
}

}  // namespace trocar::scene
