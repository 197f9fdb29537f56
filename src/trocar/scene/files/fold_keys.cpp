// Keys of organ files: strands, the sheets and membranes between a strand and its base, closed walls and what is inside
// them.
#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/capacity.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

void check_within(const JsonObject& o, const char* key, double whole) {
  if (o.has(key) && beyond(units::mm.read(o.number(key)), whole))
    o.fault(key, tr("expected an arc length on the strand (at most {:.1f} mm), got {}", whole * 1000, o.number(key)));
}

void check_rises(const JsonObject& o) {
  if (o.has("from_mm") && o.has("to_mm") && !(o.number("from_mm") < o.number("to_mm")))
    o.fault("to_mm", tr("expected more than from_mm = {}, got {}", o.number("from_mm"), o.number("to_mm")));
}

const Table<StrandStation>& station() {
  using R = Rows<StrandStation>;
  static const Table<StrandStation> table{
      "station",
      "Thickness of a strand at one place; linear between stations.",
      {needed(R::number("s_mm", units::mm, &StrandStation::s, 0, 5000, "arc length from the start")),
       needed(R::number("radius_mm", units::mm, &StrandStation::radius, 0.05, 100, "outer radius")),
       R::number("lumen_mm", units::mm, &StrandStation::lumen, 0, 100,
                 "radius of the lumen, default {}: a solid cord")}};
  return table;
}

void check_strand_station(const JsonObject& o, Strand& s, Context&) {
  StrandStation& now = s.stations.back();
  const double last = s.stations.size() > 1 ? s.stations[s.stations.size() - 2].s : -1;
  if (o.has("s_mm") && now.s <= last)
    o.fault("s_mm", tr("expected more than {} mm (stations go by rising s_mm), got {}", last * 1000, now.s * 1000));
  if (o.has("lumen_mm") && now.lumen >= now.radius)
    o.fault("lumen_mm",
            tr("expected less than the outer radius of {} mm, got {}", now.radius * 1000, now.lumen * 1000));
  check_within(o, "s_mm", curve_length(s.centreline));
  if (!o.has("s_mm")) now.s = last;  // the next one is compared with the last that is right
}

const Table<Landmark>& landmark() {
  using R = Rows<Landmark>;
  static const Table<Landmark> table{
      "landmark",
      "A named part of a strand, for exercises.",
      {needed(R::name("name", &Landmark::name, "its name in exercises")),
       needed(R::number("from_mm", units::mm, &Landmark::from, 0, 5000, "arc length where it begins")),
       needed(R::number("to_mm", units::mm, &Landmark::to, 0, 5000, "arc length where it ends"))},
      [](const JsonObject& o, Landmark&, Context&) { check_rises(o); }};
  return table;
}

void check_landmark(const JsonObject& o, Strand& s, Context&) {
  check_within(o, "to_mm", curve_length(s.centreline));
  const Landmark& mark = s.landmarks.back();
  for (std::size_t i = 0; i + 1 < s.landmarks.size(); ++i)
    if (!mark.name.empty() && s.landmarks[i].name == mark.name)
      o.fault("name", tr("expected every landmark of a strand once, got \"{}\" again", mark.name));
}

const Table<StrandEnd>& strand_end() {
  using R = Rows<StrandEnd>;
  static const Table<StrandEnd> table{
      "strand end",
      "Where a strand's end hangs: on a solid, at a fixed place, or nowhere.",
      {R::ref("solid", Reference::To::solid, &StrandEnd::organ, "the solid whose skin next to the end carries it"),
       R::flag("fixed", &StrandEnd::fixed, "true: held where it is")},
      [](const JsonObject& o, StrandEnd& end, Context&) {
        if (end.fixed && o.has("solid")) o.fault("fixed", "expected either a solid or \"fixed\": true, got both");
      }};
  return table;
}

void check_strand(const JsonObject& o, Strand& s, Context&) {
  check_apart(o, "centreline_mm", s.centreline);
  if (!o.names("start")) s.start.at = s.at;
  if (!o.names("end")) s.end.at = s.at;
  const double whole = curve_length(s.centreline);
  if (o.has("spacing_mm") && whole / s.spacing > kMaxStrandNodes)
    o.fault("spacing_mm",
            tr("expected a spacing that gives at most {} nodes, got about {:.3g}", kMaxStrandNodes, whole / s.spacing));
}

/// A fold's border on its strand, the other one, and where it ends on a strand that may not be known yet.
template <class Fold>
std::vector<Row<Fold>> border_rows() {
  using R = Rows<Fold>;
  return {
      needed(R::ref("strand", Reference::To::strand, &Fold::strand, "the strand along one border")),
      needed(R::number("from_mm", units::mm, &Fold::from, 0, 5000, "arc length on the strand where it begins")),
      needed(R::number("to_mm", units::mm, &Fold::to, 0, 5000, "arc length on the strand where it ends")),
      needed(R::points("base_mm", units::mm, &Fold::base, -kFar, kFar, 2, "the other border, in the same direction"))};
}

template <class Fold>
std::vector<Row<Fold>> joined(std::vector<Row<Fold>> first, const std::vector<Row<Fold>>& middle,
                              const std::vector<Row<Fold>>& last) {
  first.insert(first.end(), middle.begin(), middle.end());
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

void check_sheet(const JsonObject& o, Sheet& s, Context& c) {
  check_rises(o);
  c.reading->ends_on(s.strand, s.to, o.at("to_mm"));
}

void check_membrane(const JsonObject& o, Membrane& m, Context& c) {
  check_rises(o);
  check_apart(o, "base_mm", m.base);
  if ((m.to - m.from) / m.spacing > kMaxStrandNodes)
    o.fault("spacing_mm", tr("expected a spacing that gives at most {} columns, got about {:.3g}", kMaxStrandNodes,
                             (m.to - m.from) / m.spacing));
  c.reading->ends_on(m.strand, m.to, o.at("to_mm"));
}

constexpr double kWater = 1000;  // [kg/m^3]

void check_contents(const JsonObject& o, Contents& c, Context&) {
  if (c.kind == Contents::nothing) c.kind = Contents::liquid;
  if (!o.has("density_kg_m3")) c.density = c.kind == Contents::liquid ? kWater : 0;
  if (o.has("bulk_kPa") && c.kind != Contents::liquid)
    o.fault("bulk_kPa", tr("expected a bulk modulus of a liquid only, got one of \"{}\"", o.text("kind")));
}

const Table<Contents>& contents() {
  using R = Rows<Contents>;
  static const Table<Contents> table{
      "contents",
      "The contents of a pouch and their pressure.",
      {needed(R::choice("kind",
                        Choices<Contents::Kind>{
                            {"liquid", Contents::liquid}, {"gas", Contents::gas}, {"constant", Contents::constant}},
                        &Contents::kind, "liquid: p0 + K (V0 - V) / V0; gas: Boyle's law; constant: p0 at any volume")),
       needed(R::number("pressure_Pa", units::one, &Contents::pressure, -90000, 1e6,
                        "p0, above the surroundings, at the middle of the undeformed shape")),
       R::number("bulk_kPa", units::kilo, &Contents::bulk, 0.1, 1e7,
                 "K of a liquid, default {}: its resistance to compression")
           .only([](const Contents& c) { return c.kind == Contents::liquid; }),
       R::number("density_kg_m3", units::one, &Contents::density, 0, 25000, "default: liquid 1000, else 0")
           .only([](const Contents&) { return true; })},
      check_contents};
  return table;
}

constexpr double kMaxPouchNodes = 20'000;

void check_pouch(const JsonObject& o, Pouch& p, Context&) {
  check_one_shape(o, {"sections", "surface", "nurbs", "tube", "revolved"});
  if (p.free && !p.held.empty())
    o.fault("held", "expected no held places for a free wall, got " + std::to_string(p.held.size()));
  const double nodes = extent_of(p).nodes;
  if (!(nodes <= kMaxPouchNodes))
    o.fault(p.spacing_at,
            tr("expected a spacing that gives at most {} nodes, got about {:.3g}", kMaxPouchNodes, nodes));
}

}  // namespace

const Table<Anchor>& held_place() {
  using R = Rows<Anchor>;
  static const Table<Anchor> table{
      "held place",
      "Where a membrane is held or tied.",
      {needed(R::vec3("centre_mm", units::mm, &Anchor::centre, -kFar, kFar, "centre of a ball")),
       needed(R::number("radius_mm", units::mm, &Anchor::radius, 0.1, 500, "radius of the ball"))}};
  return table;
}

double curve_length(const std::vector<Vec3d>& p) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vec3d a = p[i == 0 ? 0 : i - 1], b = p[i], c = p[i + 1], d = p[std::min(i + 2, p.size() - 1)];
    Vec3d last = b;
    constexpr int pieces = 8;
    for (int k = 1; k <= pieces; ++k) {
      const double t = double(k) / pieces;
      const Vec3d x = 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                             t * t * t * (3.0 * b - a - 3.0 * c + d));
      sum += length(x - last);
      last = x;
    }
  }
  return sum;
}

const Table<Strand>& strand() {
  using R = Rows<Strand>;
  static const Table<Strand> table{
      "strand",
      "A thin tube or cord along a smooth line through points.",
      {needed(R::name("name", &Strand::name, "its name in scenes and exercises")),
       needed(R::ref("tissue", Reference::To::tissue, &Strand::tissue, "its material")), look_row<Strand>(),
       needed(R::points("centreline_mm", units::mm, &Strand::centreline, -kFar, kFar, 2,
                        "points on its centre line, from start to end")),
       needed(R::objects("stations", station, &Strand::stations, 1, "thickness along it, by rising s_mm",
                         check_strand_station)),
       R::objects("landmarks", landmark, &Strand::landmarks, 0, "named stretches", check_landmark),
       R::object("start", strand_end, &Strand::start, "default: free"),
       R::object("end", strand_end, &Strand::end, "default: free"),
       R::number("spacing_mm", units::mm, &Strand::spacing, 0.2, 50, "distance of its nodes, default {}")
           .placed(&Strand::spacing_at),
       R::number("foundation_N_m2", units::one, &Strand::foundation, 0, 1e6,
                 "elastic hold of its fold per length, default {}"),
       R::number("foundation_limit_mm", units::mm, &Strand::foundation_limit, 0, 500,
                 "displacement at which that hold has doubled, default {}: linear"),
       R::flag("cuttable", &Strand::cuttable, "default {}"),
       R::flag("fimbriated", &Strand::fimbriated, "its end flares into fimbriae, default {}")},
      check_strand};
  return table;
}

const Table<Sheet>& sheet() {
  using R = Rows<Sheet>;
  static const Table<Sheet> table{
      "sheet", "A thin fold drawn between a strand and a line of points.",
      joined<Sheet>({needed(R::name("name", &Sheet::name, "its name")), look_row<Sheet>()}, border_rows<Sheet>(),
                    {R::ref("base_organ", Reference::To::solid_or_strand, &Sheet::base_organ,
                            "solid or strand that carries the other border, default: none, it stays in place")}),
      check_sheet};
  return table;
}

const Table<Membrane>& membrane() {
  using R = Rows<Membrane>;
  static const Table<Membrane> table{
      "membrane", "A thin fold with mechanics of its own, between a stretch of a strand and a line of points.",
      joined<Membrane>(
          {needed(R::name("name", &Membrane::name, "its name in scenes and exercises")),
           needed(R::ref("tissue", Reference::To::tissue, &Membrane::tissue, "its material")), look_row<Membrane>()},
          border_rows<Membrane>(),
          {R::refs("base_on", Reference::To::solid_or_strand, &Membrane::base_on,
                   "solids and strands that carry the base where it is near them; elsewhere it stays in "
                   "place"),
           R::number("base_reach_mm", units::mm, &Membrane::base_reach, 0.1, 100,
                     "how near that is, from a strand's surface or a skin, default {}"),
           needed(R::number("thickness_mm", units::mm, &Membrane::thickness, 0.05, 20, "of the fold")),
           R::number("spacing_mm", units::mm, &Membrane::spacing, 0.3, 50, "distance of its nodes, default {}")
               .placed(&Membrane::spacing_at),
           R::flag("cuttable", &Membrane::cuttable, "default {}")}),
      check_membrane};
  return table;
}

const Table<BondSetting>& bond_setting() {
  using R = Rows<BondSetting>;
  static const Table<BondSetting> table{
      "bonds",
      "Loose tissue between a membrane and other bodies: it attaches the membrane, and separates when it is pulled, "
      "pushed or cut.",
      {needed(R::name("name", &BondSetting::name, "its name in exercises")),
       needed(R::objects("places", held_place, &BondSetting::places, 1, "where the membrane is tied")),
       needed(R::refs("on", Reference::To::tied, &BondSetting::on,
                      "solids, strands, membranes, pouches and fat that it is tied to, where they are near")),
       R::number("reach_mm", units::mm, &BondSetting::reach, 0.1, 100,
                 "how near that is, from a strand's surface or a skin, default {}"),
       R::number("toughness_J_m2", units::one, &BondSetting::toughness, 0.1, 1e5,
                 "energy that separates a square metre, default {}"),
       R::number("opens_mm", units::mm, &BondSetting::opens, 0.2, 100, "opening at which it has separated, default {}"),
       R::number("oozes_mL_min_cm2", units::one, &BondSetting::oozes, 0, 100,
                 "blood from the raw surface that it leaves when it is torn or cut, until that is coagulated, "
                 "default {}"),
       R::number("breach_mL_min_cm2", units::one, &BondSetting::bleeds, 0, 100,
                 "the same where an organ has torn instead, as its tissue's fracture_J_m2 is less than the bond's "
                 "toughness; default {}")}};
  return table;
}

const Table<Pouch>& pouch() {
  using R = Rows<Pouch>;
  static const Table<Pouch> table{
      "pouch",
      "A thin closed membrane with contents: a gallbladder, a bladder. Its shape is one of: sections (a smooth loft), "
      "surface, "
      "nurbs, tube, revolved.",
      joined<Pouch>(
          {needed(R::name("name", &Pouch::name, "its name in scenes and exercises")),
           needed(R::ref("tissue", Reference::To::tissue, &Pouch::tissue, "of its wall")), look_row<Pouch>(),
           R::objects("sections", section, &Pouch::sections, 2, "from one end to the other, as a solid's",
                      [](const JsonObject& o, Pouch& p, Context&) { check_last_section(o, p); })},
          shape_rows<Pouch>(),
          {needed(R::number("thickness_mm", units::mm, &Pouch::thickness, 0.05, 20, "of the wall")),
           R::number("spacing_mm", units::mm, &Pouch::spacing, 0.3, 50, "distance of its nodes, default {}")
               .placed(&Pouch::spacing_at),
           R::objects("regions", stiffness_region, &Pouch::regions, 0,
                      "where its wall is stiffer or softer than its tissue, dab by dab"),
           R::objects("held", held_place, &Pouch::held, 0, "places where the wall is held"),
           R::refs("held_on", Reference::To::solid_or_strand, &Pouch::held_on,
                   "solids and strands that hold it where they are near; elsewhere it stays in place"),
           R::number("held_reach_mm", units::mm, &Pouch::held_reach, 0.1, 100,
                     "how near that is, from a strand's surface or a skin, default {}"),
           R::objects("bonds", bond_setting, &Pouch::bonds, 0, "bonds between the wall and other bodies"),
           R::object("contents", contents, &Pouch::contents, "default: nothing presses").only([](const Pouch& p) {
             return p.contents.kind != Contents::nothing;
           }),
           R::flag("cuttable", &Pouch::cuttable, "default {}"),
           R::flag("free", &Pouch::free, "true: it is attached to nothing; default {}"),
           R::ref("duct", Reference::To::strand, &Pouch::duct,
                  "the strand whose lumen opens into it, with the end that is nearer: parted without a clip, it lets "
                  "out what "
                  "is inside; default: none")}),
      check_pouch};
  return table;
}

}  // namespace trocar::scene
