// Scene files, and the tissue tables that they share: gravity, trocars, what is in the hands at the start, the scope.
#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/files/vessel_file.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

void Reading::scene(const JsonObject& o, const fs::path& folder) {
  description.name = o.text("name");
  description.title = o.text("title");
  description.file = o.at().file;
  description.gravity = o.vec3("gravity_m_s2", description.gravity);
  includes(o, "tissues", folder, tissue_shape(), &Reading::tissue_table, &Reading::tissue);
  organs(o, folder);
  includes(o, "vessels", folder, vessels_shape(), &Reading::vessels, &Reading::vessels);
  includes(o, "instruments", folder, instrument_shape(), &Reading::instrument, &Reading::instrument);
  for (const JsonObject& f : o.objects("fluids")) fluids(f);
  for (const JsonObject& b : o.objects("bleeder")) bleeder(b);
  for (const JsonObject& e : o.objects("energy")) energy(e);
  for (const JsonObject& w : o.objects("peristalsis")) wave(w);
  for (const JsonObject& b : o.objects("breathing")) breathing(b);
  for (const JsonObject& d : o.objects("detail")) detail(d);
  for (const JsonObject& p : o.objects("ports")) port(p);
  for (const JsonObject& t : o.objects("tools")) {
    refer(Reference::To::instrument, t, "instrument");
    description.placements.push_back(placement(t));
    description.placements.back().instrument = t.text("instrument");
    if (t.has("tip_mm")) m_tools.push_back(description.placements.back());
  }
  for (const JsonObject& s : o.objects("scope")) scope(s);
}

void Reading::vessels(const JsonObject& o, const fs::path&) {
  VesselTree tree = read_vessels(o, m_faults);
  for (const Vessel& v : tree.vessels)
    for (std::size_t i = 0; i < v.rides_on.size(); ++i)
      m_references.push_back({Reference::To::carrier, v.rides_on[i], v.rides_at[i]});
  if (tree.says_heart && !description.vessels.empty())
    tell(m_faults, {tree.heart_at,
                    "expected heart and blood of a patient in the scene's first file of vessels, got some "
                    "in a second one"});
  description.vessels.push_back(std::move(tree));
}

void Reading::fluids(const JsonObject& o) {
  FluidsSetting f;
  f.pool_middle = from_mm(o.vec3("pool_middle_mm"));
  f.pool_size = from_mm(o.number("pool_size_mm", 160));
  f.pool_on = o.texts("pool_on");
  f.drops = o.integer("drops", f.drops);
  f.at = o.at();
  for (std::size_t i = 0; i < f.pool_on.size(); ++i)
    m_references.push_back({Reference::To::solid, f.pool_on[i], o.at("pool_on", i)});
  description.fluids = std::move(f);
}

void Reading::bleeder(const JsonObject& o) {
  BleederSetting b;
  b.opens = o.number("opens_s", b.opens);
  for (const JsonObject& h : o.objects("holes")) {
    refer(Reference::To::vessel, h, "vessel");
    b.holes.push_back({h.text("vessel"), h.number("at"), from_mm(h.number("diameter_mm")), h.at()});
  }
  description.bleeder = std::move(b);
}

void Reading::energy(const JsonObject& o) {
  EnergySetting e;
  e.blend = o.text("yellow") == "blend";
  e.yellow_watts = o.number("yellow_W", e.yellow_watts);
  e.blue_watts = o.number("blue_W", e.blue_watts);
  e.bipolar_watts = o.number("bipolar_W", e.bipolar_watts);
  e.cell = from_mm(o.number("cell_mm", 0.5));
  e.bricks = o.integer("bricks", e.bricks);
  e.awake = o.integer("awake", e.awake);
  e.at = o.at();
  if (e.awake > e.bricks)
    o.fault("awake", fmt::format("expected no more than the {} bricks that are remembered, got {}", e.bricks, e.awake));
  description.energy = e;
}

void Reading::tissue_table(const JsonObject& o, const fs::path& folder) {
  for (const JsonObject& row : o.objects("tissues")) tissue(row, folder);
}

constexpr double kLeastFailure = 0.05;  // organs carry some strain at rest

void Reading::tissue(const JsonObject& o, const fs::path&) {
  Tissue t;
  t.name = o.text("name");
  t.young = 1000;
  for (const TissueFigure& f : kTissueFigures) t.*f.value = o.number(f.key, t.*f.value);
  t.source = o.text("source");
  for (const JsonObject& sources : o.objects("sources"))
    for (size_t i = 0; i < kTissueFigures.size(); ++i) t.source_of[i] = sources.text(kTissueFigures[i].key);
  t.at = o.at();
  // d sigma / d eps = E (1 + 2 p1 eps + 3 p2 eps^2) has no root  <=>  p1^2 < 3 p2
  if (t.p1 != 0 && !(t.p1 * t.p1 < 3 * t.p2))
    o.fault("p1",
            fmt::format("expected p1^2 < 3 p2 so that stress always rises with strain, got p1^2 = {} and 3 p2 = {}",
                        t.p1 * t.p1, 3 * t.p2));
  if (t.failure_strain > 0 && t.failure_strain < kLeastFailure)
    o.fault("failure_strain", fmt::format("expected 0 for tissue that never tears, or at least {}, got {}",
                                          kLeastFailure, t.failure_strain));
  description.tissues.push_back(std::move(t));
}

void Reading::port(const JsonObject& o) {
  Port p;
  p.name = o.text("name");
  p.position = from_mm(o.vec3("position_mm"));
  if (o.has("diameter_mm")) p.diameter = from_mm(o.number("diameter_mm"));
  p.at = o.at();
  description.ports.push_back(std::move(p));
}

Placement Reading::placement(const JsonObject& o) {
  refer(Reference::To::port, o, "port");
  Placement p;
  p.port = o.text("port");
  p.tip = from_mm(o.vec3("tip_mm"));
  p.roll = from_deg(o.number("roll_deg"));
  p.at = o.at("tip_mm");
  return p;
}

void Reading::scope(const JsonObject& o) {
  Scope s;
  if (o.has("angle_deg")) s.angle = from_deg(o.number("angle_deg"));
  s.field_of_view = from_deg(o.number("field_of_view_deg", 70));
  if (o.has("shaft_diameter_mm")) s.shaft_radius = from_mm(o.number("shaft_diameter_mm")) / 2;
  if (o.has("shaft_length_mm")) s.shaft_length = from_mm(o.number("shaft_length_mm"));
  description.scope = s;
  description.scope_placement = placement(o);
  if (o.has("tip_mm")) m_tools.push_back(description.scope_placement);
}

}  // namespace trocar::scene
