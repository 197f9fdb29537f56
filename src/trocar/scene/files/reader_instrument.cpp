// Instrument files.
#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {

void Reading::instrument(const JsonObject& o, const std::filesystem::path&) {
  Instrument i;
  i.name = o.text("name");
  i.title = o.text("title");
  const std::string kind = o.text("kind");
  i.kind = kind == "grasper"             ? InstrumentKind::grasper
           : kind == "clip_applier"      ? InstrumentKind::clip_applier
           : kind == "scissors"          ? InstrumentKind::scissors
           : kind == "suction_irrigator" ? InstrumentKind::suction_irrigator
           : kind == "hook"              ? InstrumentKind::hook
           : kind == "bipolar"           ? InstrumentKind::bipolar
                                         : InstrumentKind::probe;
  const auto mm = [&](const char* key, double& value) {
    if (o.has(key)) value = from_mm(o.number(key));
  };
  if (o.has("shaft_diameter_mm")) i.shaft_radius = from_mm(o.number("shaft_diameter_mm")) / 2;
  mm("shaft_length_mm", i.shaft_length);
  mm("jaw_length_mm", i.jaw_length);
  mm("jaw_width_mm", i.jaw_width);
  mm("jaw_thickness_mm", i.jaw_thickness);
  mm("parallel_gap_mm", i.parallel_gap);
  mm("clip_length_mm", i.clip_length);
  if (i.parallel_gap > 0) i.opening = 0;
  if (o.has("opening_deg")) i.opening = from_deg(o.number("opening_deg"));
  i.pinch_max = o.number("pinch_max_N", i.pinch_max);
  i.friction = o.number("friction", i.friction);
  i.clips = o.integer("clips", i.clips);
  for (const JsonObject& e : o.objects("electrode")) {
    i.electrode.radius = from_mm(e.number("radius_mm", 1));
    i.electrode.efficiency = e.number("efficiency", i.electrode.efficiency);
    i.electrode.stick_force = e.number("stick_force_N", i.electrode.stick_force);
    i.electrode.seals = from_mm(e.number("seals_mm", 0));
  }
  i.at = o.at();
  if (o.has("electrode") && o.has("kind") && !has_electrode(i.kind))
    o.fault("electrode", fmt::format("expected an electrode only in a hook or bipolar forceps, got one in a {}", kind));
  if (i.parallel_gap > 0 && i.opening > 0)
    o.fault("opening_deg", "expected 0 or nothing beside parallel_gap_mm (jaws turn or stay parallel), got an angle");
  if (i.clips > 0 && o.has("kind") && i.kind != InstrumentKind::clip_applier)
    o.fault("clips", fmt::format("expected clips only in a clip_applier, got {} in a {}", i.clips, kind));
  description.instruments.push_back(std::move(i));
}

}  // namespace trocar::scene
