#include <cmath>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/writer.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::scene {
namespace {

/// The shortest decimal v for which read(v) is exactly `value`; where there is none (reading may skip a double), the
/// nearest one.
template <class Read>
double in_file(double guess, double value, Read&& read) {
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}e}", guess, digits - 1);
    const double v = core::to_double(text);
    if (read(v) == value) return v;
  }
  for (const double v : {std::nextafter(guess, -1e300), std::nextafter(guess, 1e300)})
    if (read(v) == value) return v;
  return guess;
}

JsonValue mm(double metres) {
  return json_number(in_file(metres * 1000, metres, [](double v) { return v / 1000; }));
}
JsonValue mm(Vec3d p) { return json_array({mm(p.x), mm(p.y), mm(p.z)}); }
JsonValue mm(const std::vector<Vec3d>& points) {
  std::vector<JsonValue> items;
  for (const Vec3d& p : points) items.push_back(mm(p));
  return json_array(std::move(items));
}
JsonValue diameter_mm(double radius) {
  return json_number(in_file(radius * 2000, radius, [](double v) { return v / 1000 / 2; }));
}
/// A thousand of the unit: kPa of Pa.
JsonValue kilo(double value) {
  return json_number(in_file(value / 1000, value, [](double v) { return v * 1000; }));
}
JsonValue deg(double radians) {
  return json_number(in_file(radians * 180 / portable::pi, radians, [](double v) { return v * portable::pi / 180; }));
}

template <class T, class Write>
JsonValue list(const std::vector<T>& things, Write&& write) {
  std::vector<JsonValue> items;
  for (const T& thing : things) items.push_back(write(thing));
  return json_array(std::move(items));
}

void put_name(JsonValue& o, const char* key, const std::string& name) {
  if (!name.empty()) put(o, key, json_text(name));
}

JsonValue written(const Tissue& t) {
  JsonValue o = json_object();
  put_name(o, "name", t.name);
  for (const TissueFigure& f : kTissueFigures) put(o, f.key, json_number(t.*f.value));
  put(o, "source", json_text(t.source));
  JsonValue sources = json_object();
  for (size_t i = 0; i < kTissueFigures.size(); ++i) put_name(sources, kTissueFigures[i].key, t.source_of[i]);
  if (!sources.members.empty()) put(o, "sources", std::move(sources));
  return o;
}

JsonValue written(const Section& s) {
  JsonValue o = json_object();
  put(o, "centre_mm", mm(s.centre));
  put(o, "across_mm", mm(s.across));
  put(o, "deep_mm", mm(s.deep));
  if (s.squareness != 2) put(o, "squareness", json_number(s.squareness));
  return o;
}

JsonValue written(const Anchor& a) {
  JsonValue o = json_object();
  put(o, "centre_mm", mm(a.centre));
  put(o, "radius_mm", mm(a.radius));
  if (a.stiffness > 0) put(o, "stiffness_N_m", json_number(a.stiffness));
  return o;
}

/// By the file's name: what stands there is not written.
JsonValue written(const TetSource& t) {
  JsonValue o = json_object();
  put_name(o, "file", t.file);
  if (t.label > 0) {
    put(o, "label", json_number(t.label));
    put(o, "smoothing", json_number(t.smoothing));
  } else {
    put(o, "unit_mm", mm(t.unit));
  }
  put(o, "place_mm", mm(t.place));
  return o;
}

JsonValue written(const Solid& s) {
  JsonValue o = json_object();
  put_name(o, "name", s.name);
  put_name(o, "tissue", s.tissue);
  put_name(o, "look", s.look);
  if (!s.sections.empty()) put(o, "sections", list(s.sections, [](const Section& x) { return written(x); }));
  if (s.tets) put(o, s.tets->label > 0 ? "voxels" : "mesh", written(*s.tets));
  if (s.cell > 0) put(o, "cell_mm", mm(s.cell));
  const bool lattice = !s.tets && !s.cuttable;
  if (lattice) put(o, "skin_edge_mm", mm(s.skin_edge));
  if (lattice) put(o, "fine_edge_mm", mm(s.fine_edge));
  if (s.cuttable) put(o, "cuttable", json_flag(true));
  if (length(s.fibre) > 0)
    put(o, "fibre", json_array({json_number(s.fibre.x), json_number(s.fibre.y), json_number(s.fibre.z)}));
  if (s.fibre_ratio != 1) put(o, "fibre_ratio", json_number(s.fibre_ratio));
  if (!s.anchors.empty()) put(o, "anchors", list(s.anchors, [](const Anchor& x) { return written(x); }));
  return o;
}

JsonValue written(const StrandStation& s) {
  JsonValue o = json_object();
  put(o, "s_mm", mm(s.s));
  put(o, "radius_mm", mm(s.radius));
  if (s.lumen > 0) put(o, "lumen_mm", mm(s.lumen));
  return o;
}

JsonValue written(const Landmark& l) {
  JsonValue o = json_object();
  put_name(o, "name", l.name);
  put(o, "from_mm", mm(l.from));
  put(o, "to_mm", mm(l.to));
  return o;
}

void put_end(JsonValue& strand, const char* key, const StrandEnd& end) {
  if (end.organ.empty() && !end.fixed) return;
  JsonValue o = json_object();
  put_name(o, "solid", end.organ);
  if (end.fixed) put(o, "fixed", json_flag(true));
  put(strand, key, std::move(o));
}

JsonValue written(const Strand& s) {
  JsonValue o = json_object();
  put_name(o, "name", s.name);
  put_name(o, "tissue", s.tissue);
  put_name(o, "look", s.look);
  put(o, "centreline_mm", mm(s.centreline));
  put(o, "stations", list(s.stations, [](const StrandStation& x) { return written(x); }));
  if (!s.landmarks.empty()) put(o, "landmarks", list(s.landmarks, [](const Landmark& x) { return written(x); }));
  put_end(o, "start", s.start);
  put_end(o, "end", s.end);
  put(o, "spacing_mm", mm(s.spacing));
  put(o, "foundation_N_m2", json_number(s.foundation));
  put(o, "foundation_limit_mm", mm(s.foundation_limit));
  put(o, "cuttable", json_flag(s.cuttable));
  put(o, "fimbriated", json_flag(s.fimbriated));
  return o;
}

JsonValue written(const Wall& w) {
  JsonValue o = json_object();
  put_name(o, "name", w.name);
  put_name(o, "look", w.look);
  std::vector<JsonValue> rows;
  for (int r = 0; r < w.rows; ++r) {
    const auto row = w.net.begin() + r * w.columns;
    rows.push_back(mm(std::vector<Vec3d>(row, row + w.columns)));
  }
  put(o, "net_mm", json_array(std::move(rows)));
  put(o, "edge_mm", mm(w.edge));
  return o;
}

JsonValue written(const Sheet& s) {
  JsonValue o = json_object();
  put_name(o, "name", s.name);
  put_name(o, "look", s.look);
  put_name(o, "strand", s.strand);
  put(o, "from_mm", mm(s.from));
  put(o, "to_mm", mm(s.to));
  put(o, "base_mm", mm(s.base));
  put_name(o, "base_organ", s.base_organ);
  return o;
}

JsonValue written(const Membrane& m) {
  JsonValue o = json_object();
  put_name(o, "name", m.name);
  put_name(o, "tissue", m.tissue);
  put_name(o, "look", m.look);
  put_name(o, "strand", m.strand);
  put(o, "from_mm", mm(m.from));
  put(o, "to_mm", mm(m.to));
  put(o, "base_mm", mm(m.base));
  if (!m.base_on.empty()) put(o, "base_on", list(m.base_on, [](const std::string& x) { return json_text(x); }));
  put(o, "base_reach_mm", mm(m.base_reach));
  put(o, "thickness_mm", mm(m.thickness));
  put(o, "spacing_mm", mm(m.spacing));
  put(o, "cuttable", json_flag(m.cuttable));
  return o;
}

JsonValue written(const Contents& c) {
  JsonValue o = json_object();
  put(o, "kind", json_text(c.kind == Contents::gas ? "gas" : c.kind == Contents::constant ? "constant" : "liquid"));
  put(o, "pressure_Pa", json_number(c.pressure));
  if (c.kind == Contents::liquid) put(o, "bulk_kPa", json_number(1e-3 * c.bulk));
  put(o, "density_kg_m3", json_number(c.density));
  return o;
}

JsonValue written(const Pouch& p) {
  JsonValue o = json_object();
  put_name(o, "name", p.name);
  put_name(o, "tissue", p.tissue);
  put_name(o, "look", p.look);
  put(o, "sections", list(p.sections, [](const Section& x) { return written(x); }));
  put(o, "thickness_mm", mm(p.thickness));
  put(o, "spacing_mm", mm(p.spacing));
  if (!p.held.empty()) put(o, "held", list(p.held, [](const Anchor& x) { return written(x); }));
  if (!p.held_on.empty()) put(o, "held_on", list(p.held_on, [](const std::string& x) { return json_text(x); }));
  put(o, "held_reach_mm", mm(p.held_reach));
  if (p.contents.kind != Contents::nothing) put(o, "contents", written(p.contents));
  put(o, "cuttable", json_flag(p.cuttable));
  return o;
}

const char* kind_name(InstrumentKind kind) {
  switch (kind) {
    case InstrumentKind::grasper:
      return "grasper";
    case InstrumentKind::clip_applier:
      return "clip_applier";
    case InstrumentKind::scissors:
      return "scissors";
    case InstrumentKind::suction_irrigator:
      return "suction_irrigator";
    case InstrumentKind::hook:
      return "hook";
    case InstrumentKind::bipolar:
      return "bipolar";
    case InstrumentKind::probe:
      break;
  }
  return "probe";
}

JsonValue written(const ElectrodeSetting& e) {
  JsonValue o = json_object();
  put(o, "radius_mm", mm(e.radius));
  put(o, "efficiency", json_number(e.efficiency));
  put(o, "stick_force_N", json_number(e.stick_force));
  if (e.seals > 0) put(o, "seals_mm", mm(e.seals));
  return o;
}

JsonValue written(const Instrument& i) {
  JsonValue o = json_object();
  put_name(o, "name", i.name);
  put_name(o, "title", i.title);
  put(o, "kind", json_text(kind_name(i.kind)));
  put(o, "shaft_diameter_mm", diameter_mm(i.shaft_radius));
  put(o, "shaft_length_mm", mm(i.shaft_length));
  put(o, "jaw_length_mm", mm(i.jaw_length));
  put(o, "jaw_width_mm", mm(i.jaw_width));
  put(o, "jaw_thickness_mm", mm(i.jaw_thickness));
  if (i.parallel_gap > 0)
    put(o, "parallel_gap_mm", mm(i.parallel_gap));
  else
    put(o, "opening_deg", deg(i.opening));
  put(o, "pinch_max_N", json_number(i.pinch_max));
  put(o, "friction", json_number(i.friction));
  put(o, "clip_length_mm", mm(i.clip_length));
  if (i.clips > 0) put(o, "clips", json_number(i.clips));
  if (has_electrode(i.kind)) put(o, "electrode", written(i.electrode));
  return o;
}

JsonValue written(const Port& p) {
  JsonValue o = json_object();
  put_name(o, "name", p.name);
  put(o, "position_mm", mm(p.position));
  put(o, "diameter_mm", mm(p.diameter));
  return o;
}

JsonValue written(const Placement& p) {
  JsonValue o = json_object();
  put_name(o, "instrument", p.instrument);
  put_name(o, "port", p.port);
  put(o, "tip_mm", mm(p.tip));
  put(o, "roll_deg", deg(p.roll));
  return o;
}

JsonValue written(const Scope& s, const Placement& p) {
  JsonValue o = written(p);
  put(o, "angle_deg", deg(s.angle));
  put(o, "field_of_view_deg", deg(s.field_of_view));
  put(o, "shaft_diameter_mm", diameter_mm(s.shaft_radius));
  put(o, "shaft_length_mm", mm(s.shaft_length));
  return o;
}

JsonValue organs(const Description& d) {
  JsonValue o = json_object();
  put(o, "solids", list(d.solids, [](const Solid& x) { return written(x); }));
  put(o, "strands", list(d.strands, [](const Strand& x) { return written(x); }));
  put(o, "walls", list(d.walls, [](const Wall& x) { return written(x); }));
  put(o, "sheets", list(d.sheets, [](const Sheet& x) { return written(x); }));
  if (!d.membranes.empty()) put(o, "membranes", list(d.membranes, [](const Membrane& x) { return written(x); }));
  if (!d.pouches.empty()) put(o, "pouches", list(d.pouches, [](const Pouch& x) { return written(x); }));
  return json_array({std::move(o)});
}

/// As it was read, but for the places of its paths, which may have been moved.
JsonValue written(const VesselTree& tree) {
  JsonValue o = tree.text;
  for (JsonMember& member : o.members) {
    if (member.key != "vessels") continue;
    for (size_t i = 0; i < member.value.items.size() && i < tree.vessels.size(); ++i)
      for (JsonMember& key : member.value.items[i].members) {
        if (key.key == "path_mm") {
          key.value = mm(tree.vessels[i].path);
        } else if (key.key == "length_mm") {
          key.value = mm(tree.graph.segments[i].length);
        }
      }
  }
  return o;
}

JsonValue written(const FluidsSetting& f) {
  JsonValue o = json_object();
  put(o, "pool_middle_mm", mm(f.pool_middle));
  put(o, "pool_size_mm", mm(f.pool_size));
  if (!f.pool_on.empty()) put(o, "pool_on", list(f.pool_on, [](const std::string& x) { return json_text(x); }));
  put(o, "drops", json_number(f.drops));
  return o;
}

JsonValue written(const BleederSetting& b) {
  JsonValue o = json_object();
  put(o, "opens_s", json_number(b.opens));
  put(o, "holes", list(b.holes, [](const BleederSetting::Hole& h) {
        JsonValue hole = json_object();
        put_name(hole, "vessel", h.vessel);
        put(hole, "at", json_number(h.at));
        put(hole, "diameter_mm", mm(h.diameter));
        return hole;
      }));
  return o;
}

JsonValue written(const EnergySetting& e) {
  JsonValue o = json_object();
  put(o, "yellow", json_text(e.blend ? "blend" : "cut"));
  put(o, "yellow_W", json_number(e.yellow_watts));
  put(o, "blue_W", json_number(e.blue_watts));
  put(o, "bipolar_W", json_number(e.bipolar_watts));
  put(o, "cell_mm", mm(e.cell));
  put(o, "bricks", json_number(e.bricks));
  put(o, "awake", json_number(e.awake));
  return o;
}

JsonValue written(const WaveSetting& w) {
  JsonValue o = json_object();
  put_name(o, "solid", w.solid);
  if (!w.centreline.empty()) put(o, "centreline_mm", mm(w.centreline));
  put(o, "stations", list(w.stations, [](const WaveSetting::Station& s) {
        JsonValue station = json_object();
        put(station, "s_mm", mm(s.s));
        put(station, "pressure_kPa", kilo(s.pressure));
        put(station, "speed_mm_s", mm(s.speed));
        return station;
      }));
  put(o, "per_minute", json_number(w.per_minute));
  put(o, "width_mm", mm(w.width));
  put(o, "first_s", json_number(w.first));
  put(o, "cycle_s", json_number(w.cycle));
  put(o, "active_share", json_number(w.active_share));
  return o;
}

JsonValue written(const BreathingSetting& b) {
  JsonValue o = json_object();
  put(o, "per_minute", json_number(b.per_minute));
  put(o, "amplitude_mm", mm(b.amplitude));
  put(o, "direction", json_array({json_number(b.direction.x), json_number(b.direction.y), json_number(b.direction.z)}));
  put(o, "carries", list(b.carries, [](const BreathingSetting::Carried& c) {
        JsonValue body = json_object();
        put_name(body, "body", c.body);
        put(body, "share", json_number(c.share));
        return body;
      }));
  return o;
}

JsonValue written(const DetailSetting& d) {
  JsonValue o = json_object();
  put(o, "of", list(d.of, [](const std::string& name) { return json_text(name); }));
  put(o, "levels", list(d.levels, [](const DetailSetting::Level& l) {
        JsonValue level = json_object();
        put(level, "from_mm", mm(l.from));
        put(level, "error_mm", mm(l.error));
        put(level, "surface", json_number(l.surface));
        return level;
      }));
  return o;
}

}  // namespace

std::string write_scene(const Description& d) {
  JsonValue o = json_object();
  put(o, "format", json_number(1));
  put_name(o, "name", d.name);
  put_name(o, "title", d.title);
  put(o, "gravity_m_s2", json_array({json_number(d.gravity.x), json_number(d.gravity.y), json_number(d.gravity.z)}));
  put(o, "tissues", list(d.tissues, [](const Tissue& x) { return written(x); }));
  put(o, "organs", organs(d));
  if (!d.vessels.empty()) put(o, "vessels", list(d.vessels, [](const VesselTree& x) { return written(x); }));
  if (d.fluids) put(o, "fluids", written(*d.fluids));
  if (d.bleeder) put(o, "bleeder", written(*d.bleeder));
  if (d.energy) put(o, "energy", written(*d.energy));
  if (!d.peristalsis.empty())
    put(o, "peristalsis", list(d.peristalsis, [](const WaveSetting& x) { return written(x); }));
  if (d.breathing) put(o, "breathing", written(*d.breathing));
  if (!d.detail.empty()) put(o, "detail", list(d.detail, [](const DetailSetting& x) { return written(x); }));
  put(o, "instruments", list(d.instruments, [](const Instrument& x) { return written(x); }));
  put(o, "ports", list(d.ports, [](const Port& x) { return written(x); }));
  put(o, "tools", list(d.placements, [](const Placement& x) { return written(x); }));
  put(o, "scope", written(d.scope, d.scope_placement));
  return to_text(o);
}

}  // namespace trocar::scene
