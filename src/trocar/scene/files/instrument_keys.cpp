// Keys of instrument files.
#include <trocar/scene/files/keys.hpp>

namespace trocar::scene {
namespace {

const Table<ElectrodeSetting>& electrode() {
  using R = Rows<ElectrodeSetting>;
  using E = ElectrodeSetting;
  static const Table<E> table{
      "electrode",
      "The part of a hook or of bipolar forceps that current leaves from; without this key, with the defaults.",
      {R::number("radius_mm", units::mm, &E::radius, 0.5, 1.5, "of its contact with tissue, default {}"),
       R::number("efficiency", units::one, &E::efficiency, 0.3, 0.6,
                 "share of the generator's power that heats tissue, default {}"),
       R::number("stick_force_N", units::one, &E::stick_force, 0, 20, "that tears it off char, default {}"),
       R::number("seals_mm", units::mm, &E::seals, 0.1, 10,
                 "largest outer diameter of vessels that it seals, default 1, between jaws 3")}};
  return table;
}

Choices<interactions::ToolKind> kinds() {
  Choices<interactions::ToolKind> out;
  for (const interactions::KindOfTool& k : interactions::kToolKinds) out.emplace_back(k.name, k.kind);
  return out;
}

std::vector<Row<Instrument>> instrument_rows() {
  using R = Rows<Instrument>;
  using I = Instrument;
  return {
      needed(R::name("name", &I::name, "what scenes call it")),
      R::text("title", &I::title, "one line for people"),
      needed(R::choice("kind", kinds(), &I::kind, "what it does")),
      R::number("shaft_diameter_mm", units::diameter, &I::shaft_radius, 1, 30, "default {}"),
      R::number("shaft_length_mm", units::mm, &I::shaft_length, 50, 1000,
                "from the handle to the jaws' joint, default {}"),
      R::number("jaw_length_mm", units::mm, &I::jaw_length, 1, 100, "default {}"),
      R::number("jaw_width_mm", units::mm, &I::jaw_width, 0.2, 30, "default {}"),
      R::number("jaw_thickness_mm", units::mm, &I::jaw_thickness, 0.2, 20, "of one jaw, default {}"),
      R::number("opening_deg", units::deg, &I::opening, 0, 180, "between the open jaws, default {:.0f}")
          .only([](const I& i) { return !(i.parallel_gap > 0); }),
      R::number("parallel_gap_mm", units::mm, &I::parallel_gap, 0, 50,
                "between parallel jaws when open, default {}: they turn"),
      R::number("foot_mm", units::mm, &I::foot, 0, 20,
                "of a hook: from its wire's axis to the foot's end, to where jaws would open, default {}: it has none"),
      R::number("pinch_max_N", units::one, &I::pinch_max, 0, 200,
                "between the jaws with the handle closed, default {}"),
      R::number("friction", units::one, &I::friction, 0, 10, "pull that the grip bears per pinch force, default {}"),
      R::number("clip_length_mm", units::mm, &I::clip_length, 0.5, 50, "of a closed clip, default {}"),
      R::integer("clips", &I::clips, 0, 1000, "in the magazine, default {}"),
      R::object("electrode", electrode, &I::electrode, "of a hook or bipolar forceps").only([](const I& i) {
        return i.can().coagulate;
      })};
}

void check_instrument(const JsonObject& o, Instrument& i, Context&) {
  using interactions::Abilities;
  if (i.parallel_gap > 0 && !o.has("opening_deg")) i.opening = 0;
  const std::string kind = o.text("kind");
  if (o.has("electrode") && o.has("kind") && !i.can().coagulate)
    o.fault("electrode", fmt::format("expected an electrode only in a {}, got one in a {}",
                                     kinds_that(&Abilities::coagulate), kind));
  if (i.parallel_gap > 0 && i.opening > 0)
    o.fault("opening_deg", "expected 0 or nothing beside parallel_gap_mm (jaws turn or stay parallel), got an angle");
  if (i.foot > 0 && o.has("kind") && !i.can().hook)
    o.fault("foot_mm",
            fmt::format("expected a foot only in a {}, got one in a {}", kinds_that(&Abilities::hook), kind));
  if (i.foot > 0 && i.foot <= 0.5 * i.jaw_thickness)
    o.fault("foot_mm", "expected 0 or more than half of jaw_thickness_mm (the wire's radius), got no more than that");
  if (i.clips > 0 && o.has("kind") && !i.can().set_clips)
    o.fault("clips", fmt::format("expected clips only in a {}, got {} in a {}", kinds_that(&Abilities::set_clips),
                                 i.clips, kind));
}

}  // namespace

const Table<Instrument>& instrument() {
  static const Table<Instrument> table{"instrument", "An instrument's shape and grip.", instrument_rows(),
                                       check_instrument};
  return table;
}
const Table<Instrument>& instrument_file_keys() {
  static const Table<Instrument> table{"instrument file", "An instrument's shape and grip.", of_file(instrument_rows()),
                                       check_instrument};
  return table;
}

}  // namespace trocar::scene
