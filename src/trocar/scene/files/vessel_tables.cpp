// The keys of vessel files. Units are those of the clinic: mmHg, mL, litres.
#include <trocar/scene/files/vessel_file.hpp>

namespace trocar::scene {
namespace {

constexpr double kFar = 2000;  // [mm]

const Shape& vessel() {
  static const Shape shape{
      "vessel",
      "A piece of artery or vein between two nodes. Its wall: a wave speed, or a modulus and a thickness.",
      {needed(keys::name("name", "what exercises and results call it")),
       needed(keys::name("from", "the node it comes from, towards the heart in arteries")),
       needed(keys::name("to", "the node it leads to")),
       needed(keys::points("path_mm", -kFar, kFar, 2, "its middle line, drawn through these points")),
       keys::number("length_mm", 0.01, 5000, "where it is more tortuous than its path, default: the path's"),
       needed(keys::number("radius_mm", 0.001, 50, "of its lumen at its beginning, at the mean pressure")),
       keys::number("radius_to_mm", 0.001, 50, "at its end, default: the same"),
       keys::number("wave_speed_m_s", 0.1, 100, "of the pulse"),
       keys::number("modulus_kPa", 0.1, 1e6, "Young's modulus of its wall"),
       keys::number("thickness_mm", 0.001, 10, "of its wall"),
       keys::number("poisson", 0, 0.5, "of its wall, default 0, as in the formula of Moens and Korteweg"),
       keys::number("loss", 0, 1000, "what a narrow or a bend costs beside friction, in rho u^2 / 2, default 0"),
       keys::texts("rides_on", "solids, strands, membranes and pouches that it goes with where they are near"),
       keys::number("reach_mm", 0.1, 100, "how near that is, default 4")}};
  return shape;
}

const Shape& vessel_end() {
  static const Shape shape{
      "vessel end",
      "Where a node's blood goes: a mean flow, without reflection, or a resistance, then a compliance beside another.",
      {needed(keys::name("node", "a node at which vessels end")),
       keys::number("flow_mL_min", 0.001, 20000, "mean flow"),
       keys::number("at_mmHg", 1, 300, "with this mean pressure at the node, default 90"),
       keys::number("time_s", 0, 100, "with which the pressure falls when nothing comes, default 1"),
       keys::number("near_mmHg_s_mL", 0, 1e9, "first resistance"),
       keys::number("far_mmHg_s_mL", 0, 1e9, "second resistance"),
       keys::number("compliance_mL_mmHg", 0, 1000, "between the two, default 0"),
       keys::number("pressure_mmHg", -100, 300, "beyond them, default 5")}};
  return shape;
}

const Shape& vessel_source() {
  static const Shape shape{"vessel source",
                           "What feeds a node. Clips must stand between every source and a hole to stop its bleeding.",
                           {needed(keys::name("node", "the node")),
                            keys::choice("kind", {"heart", "steady"}, "default heart: its beat; steady: one pressure"),
                            keys::number("pressure_mmHg", -100, 300, "of a steady one, default 93"),
                            keys::number("resistance_mmHg_s_mL", 0, 1e9, "between it and the node, default 0"),
                            keys::flag("venous", "default false: falls with the loss of blood, as arteries do")}};
  return shape;
}

const Shape& heart() {
  static const Shape shape{
      "heart",
      "Its beat; at rest, before any loss of blood.",
      {keys::number("rate_per_min", 10, 300, "default 72"), keys::number("systolic_mmHg", 10, 300, "default 120"),
       keys::number("diastolic_mmHg", 0, 250, "default 80"),
       keys::number("breaths_per_min", 0, 100, "default 14; where the scene has `breathing`, its rate counts instead"),
       keys::number("arterial_swing_mmHg", 0, 50, "of breathing in arteries, default 3"),
       keys::number("venous_swing_mmHg", 0, 50, "in veins, default 2")}};
  return shape;
}

std::vector<Key> vessels_keys() {
  Key list = needed(keys::objects("vessels", vessel, 1, "in any order"));
  list.max_count = vessels::kMaxSegments;
  Key ends = keys::objects("ends", vessel_end, 0, "nodes without an end are closed");
  ends.max_count = vessels::kMaxSegments;
  return {keys::text("$schema", "where editors find this kind of file's schema"),
          keys::format(1),
          needed(keys::name("name", "of all of them")),
          keys::choice("kind", {"arteries", "veins"}, "default arteries; opened veins ooze also at low pressure"),
          keys::flag("tree", "default false; true: vessels that meet again are a fault"),
          keys::number("blood_L", 0.01, 100, "in the whole patient, default 5"),
          keys::number("pulse_gain", 0, 50,
                       "of the pulse's force on tissue and of what is shown of it, default 1: physical"),
          keys::object("heart", heart, "default: as at rest"),
          std::move(list),
          std::move(ends),
          needed(keys::objects("sources", vessel_source, 1, "what feeds them"))};
}

}  // namespace

const Shape& vessels_shape() {
  static const Shape shape{"vessel file", "Arteries or veins: a graph of vessels and what feeds it.", vessels_keys()};
  return shape;
}

}  // namespace trocar::scene
