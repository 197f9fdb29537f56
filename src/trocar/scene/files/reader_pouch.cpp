// Of organ files: closed walls and what is inside them.
#include <fmt/format.h>

#include <trocar/scene/description/capacity.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

constexpr double kMaxPouchNodes = 20'000;

Contents contents_of(const JsonObject& o) {
  Contents c;
  for (const JsonObject& part : o.objects("contents")) {
    const std::string kind = part.text("kind");
    c.kind = kind == "gas" ? Contents::gas : kind == "constant" ? Contents::constant : Contents::liquid;
    c.pressure = part.number("pressure_Pa");
    c.bulk = 1e3 * part.number("bulk_kPa", 1e-3 * c.bulk);
    c.density = part.number("density_kg_m3", c.kind == Contents::liquid ? 1000 : 0);
    if (part.has("bulk_kPa") && c.kind != Contents::liquid)
      part.fault("bulk_kPa", fmt::format("expected a bulk modulus of a liquid only, got one of \"{}\"", kind));
  }
  return c;
}

}  // namespace

void Reading::pouch(const JsonObject& o) {
  Pouch p;
  p.name = o.text("name");
  p.tissue = o.text("tissue");
  p.look = o.text("look", p.name);
  refer(Reference::To::tissue, o, "tissue");
  p.sections = sections(o);
  p.thickness = from_mm(o.number("thickness_mm", 1));
  if (o.has("spacing_mm")) p.spacing = from_mm(o.number("spacing_mm"));
  for (const JsonObject& h : o.objects("held"))
    p.held.push_back({from_mm(h.vec3("centre_mm")), from_mm(h.number("radius_mm", 1)), 0, h.at()});
  p.held_on = o.texts("held_on");
  for (std::size_t i = 0; i < p.held_on.size(); ++i)
    m_references.push_back({Reference::To::solid_or_strand, p.held_on[i], o.at("held_on", i)});
  if (o.has("held_reach_mm")) p.held_reach = from_mm(o.number("held_reach_mm"));
  p.contents = contents_of(o);
  p.cuttable = o.flag("cuttable", p.cuttable);
  p.at = o.at();
  p.spacing_at = o.at("spacing_mm");
  const double nodes = extent_of(p).nodes;
  if (!(nodes <= kMaxPouchNodes))
    tell(m_faults, {p.spacing_at, fmt::format("expected a spacing that gives at most {} nodes, got about {:.3g}",
                                              kMaxPouchNodes, nodes)});
  description.pouches.push_back(std::move(p));
}

}  // namespace trocar::scene
