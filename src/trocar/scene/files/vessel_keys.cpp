#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/vessel_keys.hpp>

namespace trocar::scene {
namespace {

void check_wall(const JsonObject& o, VesselLine& line, Context&) {
  for (std::size_t i = 0; i < line.rides_on.size(); ++i) line.rides_at.push_back(o.at("rides_on", i));
  const bool both = o.names("modulus_kPa") && o.names("thickness_mm");
  const bool any = o.names("modulus_kPa") || o.names("thickness_mm") || o.names("poisson");
  if (o.names("wave_speed_m_s") ? any : !both)
    o.fault(o.at(), tr("expected either \"wave_speed_m_s\" or \"modulus_kPa\" and \"thickness_mm\", got {}",
                       o.names("wave_speed_m_s") ? "both" : (any ? "one of the two" : "none")));
}

void check_end(const JsonObject& o, EndLine&, Context&) {
  const bool resists = o.names("near_mmHg_s_mL") || o.names("far_mmHg_s_mL");
  if (o.names("flow_mL_min") == resists)
    o.fault(o.at(), tr("expected either \"flow_mL_min\" or resistances, got {}", resists ? "both" : "none"));
}

using vessels::VesselSource;

void check_source(const JsonObject& o, SourceLine& line, Context&) {
  const bool steady = line.kind == VesselSource::Kind::steady;
  if (!steady) line.pressure = 0;
  if (steady && !o.has("pressure_mmHg")) line.pressure = units::mmhg.read(93);
  if (!steady && o.has("pressure_mmHg"))
    o.fault("pressure_mmHg", "expected a pressure of a steady source only, as the heart has its own, got one");
}

template <class T>
Row<VesselTree> list_row(const char* name, const Table<T>& (*table)(), std::size_t at_least, std::size_t at_most,
                         const char* meaning) {
  Key key = keys::objects(
      name, [table]() -> const Shape& { return table(); }, at_least, meaning);
  key.max_count = at_most;
  return {std::move(key)};
}

constexpr std::size_t kMostSources = 1000;

}  // namespace

const Table<VesselLine>& vessel() {
  using R = Rows<VesselLine>;
  using L = VesselLine;
  static const Table<L> table{
      "vessel",
      "A piece of artery or vein between two nodes. Its wall: a wave speed, or a modulus and a thickness.",
      {needed(R::name("name", &L::name, "its name in exercises and results")),
       needed(R::name("from", &L::from_node, "the node it comes from, towards the heart in arteries")),
       needed(R::name("to", &L::to_node, "the node it leads to")),
       needed(R::points("path_mm", units::mm, &L::path, -kFar, kFar, 2, "its middle line, drawn through these points")),
       R::number("length_mm", units::mm, &L::length, 0.01, 5000,
                 "length if it is more tortuous than its path, default: the path's"),
       needed(R::number("radius_mm", units::mm, &L::radius, 0.001, 50,
                        "of its lumen at its beginning, at the mean pressure")),
       R::number("radius_to_mm", units::mm, &L::radius_to, 0.001, 50, "at its end, default: the same"),
       R::number(
           "wave_speed_m_s", units::one, [](auto& l) -> auto& { return l.wall.wave_speed; }, 0.1, 100, "of the pulse"),
       R::number(
           "modulus_kPa", units::kilo, [](auto& l) -> auto& { return l.wall.modulus; }, 0.1, 1e6,
           "Young's modulus of its wall"),
       R::number(
           "thickness_mm", units::mm, [](auto& l) -> auto& { return l.wall.thickness; }, 0.001, 10, "of its wall"),
       R::number(
           "poisson", units::one, [](auto& l) -> auto& { return l.wall.poisson; }, 0, 0.5,
           "of its wall, default {}, as in the formula of Moens and Korteweg"),
       R::number("loss", units::one, &L::loss, 0, 1000,
                 "pressure loss of a stenosis or a bend besides friction, in rho u^2 / 2, default {}"),
       R::texts("rides_on", &L::rides_on, "solids, strands, membranes and pouches that carry it where they are near"),
       R::number("reach_mm", units::mm, &L::reach, 0.1, 100, "how near that is, default {}")},
      check_wall};
  return table;
}

const Table<EndLine>& vessel_end() {
  using R = Rows<EndLine>;
  using L = EndLine;
  static const Unit ml_min{[](double v) { return v / 60e6; }, [](double v) { return v * 60e6; }};
  static const Table<L> table{
      "vessel end",
      "The outflow of a node: a mean flow without reflection, or a resistance in series with a compliance parallel to "
      "a second resistance.",
      {needed(R::name("node", &L::name_of_node, "a node at which vessels end")),
       R::number("flow_mL_min", ml_min, &L::flow, 0.001, 20000, "mean flow"),
       R::number("at_mmHg", units::mmhg, &L::flow_pressure, 1, 300, "with this mean pressure at the node, default {}"),
       R::number("time_s", units::one, &L::time, 0, 100,
                 "time constant of the pressure's decay without inflow, default {}"),
       R::number("near_mmHg_s_mL", units::mmhg_s_ml, &L::r_near, 0, 1e9, "first resistance"),
       R::number("far_mmHg_s_mL", units::mmhg_s_ml, &L::r_far, 0, 1e9, "second resistance"),
       R::number("compliance_mL_mmHg", units::ml_mmhg, &L::compliance, 0, 1000, "between the two, default {}"),
       R::number("pressure_mmHg", units::mmhg, &L::pressure, -100, 300, "beyond them, default {}")},
      check_end};
  return table;
}

const Table<SourceLine>& vessel_source() {
  using R = Rows<SourceLine>;
  using L = SourceLine;
  using Kind = VesselSource::Kind;
  static const Table<L> table{
      "vessel source",
      "The inflow of a node. Clips between every source and a hole stop its bleeding.",
      {needed(R::name("node", &L::name_of_node, "the node")),
       R::choice("kind", Choices<Kind>{{"heart", Kind::heart}, {"steady", Kind::steady}}, &L::kind,
                 "default {}: its beat; steady: one pressure"),
       R::number("pressure_mmHg", units::mmhg, &L::pressure, -100, 300, "of a steady one, default 93"),
       R::number("resistance_mmHg_s_mL", units::mmhg_s_ml, &L::resistance, 0, 1e9,
                 "between it and the node, default {}"),
       R::flag("venous", &L::venous, "default {}: falls with the loss of blood, as arteries do")},
      check_source};
  return table;
}

const Table<vessels::Heart>& heart() {
  using R = Rows<vessels::Heart>;
  using H = vessels::Heart;
  static const Table<H> table{
      "heart",
      "Its beat; at rest, before any loss of blood.",
      {R::number("rate_per_min", units::one, &H::rate, 10, 300, "default {}"),
       R::number("systolic_mmHg", units::mmhg, &H::systolic, 10, 300, "default {:.0f}"),
       R::number("diastolic_mmHg", units::mmhg, &H::diastolic, 0, 250, "default {:.0f}"),
       R::number("breaths_per_min", units::one, &H::breaths, 0, 100,
                 "default {}; where the scene has `breathing`, its rate counts instead"),
       R::number("arterial_swing_mmHg", units::mmhg, &H::arterial_swing, 0, 50,
                 "of breathing in arteries, default {:.0f}"),
       R::number("venous_swing_mmHg", units::mmhg, &H::venous_swing, 0, 50, "in veins, default {:.0f}")}};
  return table;
}

const Table<VesselTree>& vessel_file_keys() {
  using R = Rows<VesselTree>;
  using T = VesselTree;
  static const Table<T> table{
      "vessel file", "Arteries or veins: a graph of vessels and its sources.",
      of_file<T>({needed(R::name("name", &T::name, "of all of them")),
                  R::own(keys::choice("kind", {"arteries", "veins"},
                                      "default arteries; opened veins ooze also at low pressure")),
                  R::flag(
                      "tree", [](auto& t) -> auto& { return t.graph.tree; },
                      "default {}; true: vessels that meet again are a fault"),
                  R::number(
                      "blood_L", units::litre, [](auto& t) -> auto& { return t.graph.blood.volume; }, 0.01, 100,
                      "in the whole patient, default {}"),
                  R::number("pulse_gain", units::one, &T::pulse_gain, 0, 50,
                            "gain of the pulse's force on tissue and of its display, default {}: physical"),
                  R::own(keys::object(
                      "heart", []() -> const Shape& { return heart(); }, "default: as at rest")),
                  needed(list_row("vessels", vessel, 1, vessels::kMaxSegments, "in any order")),
                  list_row("ends", vessel_end, 0, vessels::kMaxSegments, "nodes without an end are closed"),
                  needed(list_row("sources", vessel_source, 1, kMostSources, "what feeds them"))})};
  return table;
}

}  // namespace trocar::scene
