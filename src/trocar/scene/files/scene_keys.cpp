// Keys of scene files, and of the tissue tables that they share: gravity, trocars, what is in the hands at the start,
// the scope, fluids, current.
#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/scene/json/like.hpp>

namespace trocar::scene {
namespace {

const Shape& tissue_sources() {
  static const Shape shape = [] {
    Shape s{"sources", "Where single figures of a tissue come from: a publication, or \"our estimate\".", {}};
    for (const TissueFigure& figure : kTissueFigures) s.keys.push_back(keys::text(figure.key, "of this figure"));
    return s;
  }();
  return shape;
}

void read_sources(const JsonObject& o, Tissue& t, Context&) {
  for (const JsonObject& sources : o.objects("sources"))
    for (std::size_t i = 0; i < kTissueFigures.size(); ++i) t.source_of[i] = sources.text(kTissueFigures[i].key);
}
std::optional<JsonValue> written_sources(const Tissue& t, bool) {
  JsonValue o = json_object();
  for (std::size_t i = 0; i < kTissueFigures.size(); ++i)
    if (!t.source_of[i].empty()) put(o, kTissueFigures[i].key, json_text(t.source_of[i]));
  return o.members.empty() ? std::nullopt : std::optional<JsonValue>(std::move(o));
}

constexpr double kLeastFailure = 0.05;  // organs carry some strain at rest

void check_tissue(const JsonObject& o, Tissue& t, Context&) {
  // d sigma / d eps = E (1 + 2 p1 eps + 3 p2 eps^2) has no root  <=>  p1^2 < 3 p2
  if (t.p1 != 0 && !(t.p1 * t.p1 < 3 * t.p2))
    o.fault("p1", tr("expected p1^2 < 3 p2 so that stress always rises with strain, got p1^2 = {} and 3 p2 = {}",
                     t.p1 * t.p1, 3 * t.p2));
  if (t.failure_strain > 0 && t.failure_strain < kLeastFailure)
    o.fault("failure_strain",
            tr("expected 0 for tissue that never tears, or at least {}, got {}", kLeastFailure, t.failure_strain));
}

const Table<Port>& port() {
  using R = Rows<Port>;
  static const Table<Port> table{
      "port",
      "A trocar: the point about which an instrument turns.",
      {needed(R::name("name", &Port::name, "its name for instruments")),
       needed(R::vec3("position_mm", units::mm, &Port::position, -kFar, kFar, "the pivot, in the abdominal wall")),
       R::number("diameter_mm", units::mm, &Port::diameter, 2, 40, "inner diameter, default {}"),
       R::number("seal_friction_N", units::one, &Port::seal_friction, 0, 5,
                 "of its seal along a shaft, felt with a haptic device; default {}"),
       R::number("stiffness_N_mm", units::kilo, &Port::stiffness, 0, 100,
                 "stiffness of the abdominal wall around it against a shaft's sideways load; 0: rigid; default {}"),
       R::number("drift_mm", units::mm, &Port::drift, 0, 10,
                 "how far it moves from its place during an operation; default {}")}};
  return table;
}

/// @param of  finds the placement in a T
template <class T, class Of>
std::vector<Row<T>> placement_rows(Of of) {
  using R = Rows<T>;
  return {needed(R::ref(
              "port", Reference::To::port, [of](auto& t) -> auto& { return of(t).port; }, "the port it passes")),
          needed(R::vec3(
                     "tip_mm", units::mm, [of](auto& t) -> auto& { return of(t).tip; }, -kFar, kFar,
                     "position of its tip at the start")
                     .placed([of](auto& t) -> auto& { return of(t).at; })),
          R::number(
              "roll_deg", units::deg, [of](auto& t) -> auto& { return of(t).roll; }, -360, 360,
              "turned about its shaft, default {}")};
}

const Table<Placement>& tool() {
  using R = Rows<Placement>;
  static const Table<Placement> table{
      "tool", "An instrument in a hand at the start.", [] {
        std::vector<Row<Placement>> rows = placement_rows<Placement>([](auto& p) -> auto& { return p; });
        rows.insert(rows.begin(), needed(R::ref("instrument", Reference::To::instrument, &Placement::instrument,
                                                "which instrument")));
        rows.push_back(R::ref("holds", Reference::To::pouch, &Placement::holds,
                              "a pouch: its jaws begin closed on that end of it which is held in space near its tip, "
                              "and which nothing else holds then; default nothing"));
        return rows;
      }()};
  return table;
}

void check_tool(const JsonObject& o, Description& d, Context& c) {
  if (o.has("tip_mm")) c.reading->reaches(d.placements.back());
}

std::vector<Row<Description>> scope_rows() {
  using R = Rows<Description>;
  std::vector<Row<Description>> rows = placement_rows<Description>([](auto& d) -> auto& { return d.scope_placement; });
  rows.push_back(R::number(
      "angle_deg", units::deg, [](auto& d) -> auto& { return d.scope.angle; }, 0, 90,
      "between its shaft and its view, default {}"));
  rows.push_back(R::number(
      "field_of_view_deg", units::deg, [](auto& d) -> auto& { return d.scope.field_of_view; }, 20, 140,
      "full cone, default {}"));
  rows.push_back(R::number(
      "shaft_diameter_mm", units::diameter, [](auto& d) -> auto& { return d.scope.shaft_radius; }, 1, 30,
      "default {}"));
  rows.push_back(R::number(
      "shaft_length_mm", units::mm, [](auto& d) -> auto& { return d.scope.shaft_length; }, 50, 1000, "default {}"));
  return rows;
}

const Table<Description>& scope() {
  static const Table<Description> table{"scope", "The endoscope and its pose at the start.", scope_rows(),
                                        [](const JsonObject& o, Description& d, Context& c) {
                                          if (o.has("tip_mm")) c.reading->reaches(d.scope_placement);
                                        }};
  return table;
}

const Table<FluidsSetting>& fluids() {
  using R = Rows<FluidsSetting>;
  using F = FluidsSetting;
  static const Table<F> table{
      "fluids",
      "Free blood: drops and pooled fluid. Without this key lost blood is only counted.",
      {needed(
           R::vec3("pool_middle_mm", units::mm, &F::pool_middle, -kFar, kFar, "centre of the field for pooled fluid")),
       R::number("pool_size_mm", units::mm, &F::pool_size, 20, 1000, "edge of that field, default {}"),
       R::refs("pool_on", Reference::To::solid, &F::pool_on,
               "solids whose tops are part of its floor, as they lie, beside the walls"),
       R::integer("drops", &F::drops, 64, 65536, "at a time, default {}"),
       R::number("pool_mL", units::millilitre, &F::pool_at_start, 0, 500, "pooled blood at the start, default {}"),
       R::number("pool_bile_mL", units::millilitre, &F::bile_at_start, 0, 500,
                 "pooled bile at the start, default {}")}};
  return table;
}

using Hole = BleederSetting::Hole;

const Table<Hole>& hole() {
  using R = Rows<Hole>;
  static const Table<Hole> table{
      "hole",
      "A possible bleeding point of a vessel.",
      {needed(R::ref("vessel", Reference::To::vessel, &Hole::vessel, "artery or vein of the scene")),
       needed(R::number(
           "at", units::one, [](auto& h) -> auto& { return h.at; }, 0, 1, "position along it: 0 its start, 1 its end")),
       needed(R::number("diameter_mm", units::mm, &Hole::diameter, 0.01, 20, "of the hole"))},
      [](const JsonObject& o, Hole& h, Context&) { h.where = o.at(); }};
  return table;
}

const Table<BleederSetting>& bleeder() {
  using R = Rows<BleederSetting>;
  static const Table<BleederSetting> table{
      "bleeder",
      "Spontaneous bleeding from one of these holes: the first, unless the scene's variation lets the seed "
      "choose.",
      {needed(R::objects("holes", hole, &BleederSetting::holes, 1, "possible holes")),
       R::number("opens_s", units::one, &BleederSetting::opens, 0, 36000, "time after the start, default {}")}};
  return table;
}

const Table<EnergySetting>& energy() {
  using R = Rows<EnergySetting>;
  using E = EnergySetting;
  static const Table<E> table{
      "energy",
      "Settings of the generator. Without this key instruments have no current and nothing is heated.",
      {R::choice("yellow", Choices<bool>{{"cut", false}, {"blend", true}}, &E::blend,
                 "mode of the yellow pedal, default {}"),
       R::number("yellow_W", units::one, &E::yellow_watts, 0, 120, "default {}"),
       R::number("blue_W", units::one, &E::blue_watts, 0, 120, "coagulation, default {}"),
       R::number("bipolar_W", units::one, &E::bipolar_watts, 0, 120, "blue pedal, bipolar forceps, default {}"),
       R::number("cell_mm", units::mm, &E::cell, 0.25, 0.75, "edge of the cells in which heat is computed, default {}"),
       R::integer("bricks", &E::bricks, 8, 4096, "of 8 x 8 x 8 cells that can be remembered, default {}"),
       R::integer("awake", &E::awake, 8, 2048, "of them that can be warm at once, default {}")},
      [](const JsonObject& o, E& e, Context&) {
        if (e.awake > e.bricks)
          o.fault("awake", tr("expected no more than the {} bricks that are remembered, got {}", e.bricks, e.awake));
      }};
  return table;
}

/// Everything that is named has its levels in one place.
void check_details(const JsonObject& o, Description& d, Context&) {
  const std::vector<std::string>& of = d.detail.back().of;
  const auto named = [](const std::vector<std::string>& names, std::size_t many, const std::string& name) {
    const auto end = names.begin() + std::ptrdiff_t(many);
    return std::find(names.begin(), end, name) != end;
  };
  for (std::size_t i = 0; i < of.size(); ++i) {
    bool again = named(of, i, of[i]);
    for (std::size_t k = 0; k + 1 < d.detail.size(); ++k)
      again = again || named(d.detail[k].of, d.detail[k].of.size(), of[i]);
    if (again) o.fault(o.at("of", i), tr("expected everything once, got \"{}\" again", of[i]));
  }
}

/// Files that a scene names, or objects that stand there.
template <class T>
Row<Description> included(const char* name, const Table<T>& (*table)(), std::vector<T> Description::*list,
                          void (Reading::*read)(const JsonObject&, const std::filesystem::path&), const char* meaning) {
  return needed(Rows<Description>::own(
      keys::includes(
          name, [table]() -> const Shape& { return table(); }, meaning),
      [read](const JsonObject& o, Description&, Context& c) { (c.reading->*read)(o, c.folder); },
      [table, list](const Description& d, bool) {
        return listed(d.*list, [table](const T& t) { return table().written(t); });
      }));
}

Row<Description> organs_row() {
  return needed(Rows<Description>::own(
      keys::includes(
          "organs", []() -> const Shape& { return organ_keys(); }, "organs: files or objects"),
      [](const JsonObject& o, Description&, Context& c) { c.reading->organs(o, c.folder); },
      [](const Description& d, bool) { return json_array({organ_keys().written(d)}); }));
}

Row<Description> vessels_row() {
  return Rows<Description>::own(
      keys::includes("vessels", vessels_shape, "arteries and veins: files or objects"),
      [](const JsonObject& o, Description&, Context& c) { c.reading->vessels(o, c.folder); },
      [](const Description& d, bool) {
        return d.vessels.empty() ? std::nullopt : std::optional<JsonValue>(listed(d.vessels, written_vessels));
      });
}

/// Kinds of objects bring their keys.
template <class Kind>
Row<Description> objects_row(Kind kind) {
  return Rows<Description>::own(
      kind.row(),
      [kind](const JsonObject& o, Description& d, Context& c) {
        for (const JsonObject& one : o.objects(kind.kKey)) {
          if constexpr (requires { kind.read(one, c); })  // it names other things
            settings_of(kind, d.objects).push_back(kind.read(one, c));
          else
            settings_of(kind, d.objects).push_back(kind.read(one));
        }
      },
      [kind](const Description& d, bool) {
        const auto& all = settings_of(kind, d.objects);
        return all.empty() ? std::nullopt
                           : std::optional<JsonValue>(listed(all, [kind](const auto& x) { return kind.written(x); }));
      });
}

std::vector<Row<Description>> scene_rows() {
  using R = Rows<Description>;
  using D = Description;
  std::vector<Row<Description>> rows{
      needed(R::name("name", &D::name, "its name in exercises")),
      R::own(keys::text(kLike, "a scene file that supplies the missing keys")),
      R::text("title", &D::title, "one line for lists"),
      R::vec3("gravity_m_s2", units::one, &D::gravity, -100, 100, "in the patient's frame, default {}"),
      included("tissues", tissue, &D::tissues, &Reading::tissues, "materials: tables in files, or rows"),
      organs_row(),
      vessels_row(),
      R::object("fluids", fluids, &D::fluids, "drops and pooled fluid, default none"),
      R::object("bleeder", bleeder, &D::bleeder, "spontaneous bleeding of a vessel, default none"),
      R::object("energy", energy, &D::energy, "current and heat, default none"),
      R::objects("peristalsis", wave, &D::peristalsis, 0, "waves of hollow organs, default none"),
      R::object("breathing", breathing, &D::breathing, "default none"),
      R::objects("detail", detail, &D::detail, 0, "level of detail, default: by visibility", check_details),
      R::objects("marks", mark, &D::marks, 0, "marks for exercises, default none"),
      R::object("variation", variation, &D::variation, "random variation by seed, default none"),
      R::name("variant", &D::variant, "a variant that every seed has; default: drawn by the seed"),
      included("instruments", instrument, &D::instruments, &Reading::instruments, "instruments: files or objects"),
      needed(R::objects("ports", port, &D::ports, 1, "trocars")),
      needed(R::objects("tools", tool, &D::placements, 0, "in the order of the hands: left, right, assistant",
                        check_tool)),
      needed(R::object(
          "scope", scope, [](auto& d) -> auto& { return d; }, "the endoscope"))};
  ObjectScenes::for_each([&rows](auto kind) { rows.push_back(objects_row(kind)); });
  return rows;
}

}  // namespace

const Table<Tissue>& tissue() {
  using R = Rows<Tissue>;
  using T = Tissue;
  static const Table<T> table{
      "tissue",
      "A material: sigma = E eps (1 + p1 |eps| + p2 eps^2), continued linearly beyond strain_cap.",
      {needed(R::name("name", &T::name, "its name for solids and strands")),
       needed(R::number("density_kg_m3", units::one, &T::density, 1, 25000, "mass per volume")),
       needed(R::number("young_Pa", units::one, &T::young, 1, 1e9, "Young's modulus E at small strain")),
       R::number("poisson", units::one, &T::poisson, 0.25, 0.45,
                 "Poisson's ratio of organs, default {}, that of springs alone; more costs a volume force"),
       R::number("p1", units::one, &T::p1, -1000, 1000, "first shape factor, default {}; monotone law: p1^2 < 3 p2"),
       R::number("p2", units::one, &T::p2, 0, 1e6, "second shape factor, default {}"),
       R::number("strain_cap", units::one, &T::strain_cap, 0.01, 5,
                 "strain beyond which the law is continued linearly, default {}"),
       R::number("failure_strain", units::one, &T::failure_strain, 0, 10,
                 "strain at which it tears, default {}: never"),
       R::number("damping_ms", units::one, &T::damping_ms, 0, 1000, "stiffness-proportional damping time, default {}"),
       R::number("fracture_J_m2", units::one, &T::fracture, 0, 1e6,
                 "of an organ: energy that tears a square metre off its surface, where bonds are tougher than "
                 "that; default {}: bonds never tear it"),
       R::number("puncture_N", units::one, &T::puncture, 0, 50,
                 "force at which a suture needle's tip pierces its surface; a ground injection needle needs a third; "
                 "default {}; 0: not pierceable"),
       R::number("stitch_damage_N", units::one, &T::stitch_damage, 0, 100,
                 "pull of a thread from which a stitch damages it; three times that cuts through; default {}: 2"),
       R::number("strangle_N", units::one, &T::strangle, 0, 200,
                 "tension of a sling's loop that cuts through a strand of it, default {}: 8"),
       needed(R::text("source", &T::source, "source of the figures: a publication, or \"our estimate\"")),
       R::own(keys::object("sources", tissue_sources, "sources of single figures, where they differ"), read_sources,
              written_sources)},
      check_tissue};
  return table;
}

const Table<Description>& tissue_file_keys() {
  static const Table<Description> table{"tissue table", "Materials.",
                                        of_file<Description>({needed(Rows<Description>::objects(
                                            "tissues", tissue, &Description::tissues, 1, "one row per material"))})};
  return table;
}

const Table<Description>& scene_file_keys() {
  static const Table<Description> table{"scene", "Organs, instruments and their poses.", of_file(scene_rows()),
                                        [](const JsonObject& o, Description& d, Context&) { d.file = o.at().file; }};
  return table;
}

}  // namespace trocar::scene
