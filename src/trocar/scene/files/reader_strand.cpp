// Of organ files: strands, and the sheets and membranes between a strand and its base.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

void check_within(const JsonObject& o, const char* key, double whole) {
  if (o.has(key) && beyond(from_mm(o.number(key)), whole))
    o.fault(key, fmt::format("expected an arc length on the strand (at most {:.1f} mm), got {}", whole * 1000,
                             o.number(key)));
}

void stations(const JsonObject& o, Strand& s, double whole) {
  double last = -1;
  for (const JsonObject& part : o.objects("stations")) {
    const StrandStation station{from_mm(part.number("s_mm")), from_mm(part.number("radius_mm", 1)),
                                from_mm(part.number("lumen_mm"))};
    if (part.has("s_mm") && station.s <= last)
      part.fault("s_mm", fmt::format("expected more than {} mm (stations go by rising s_mm), got {}", last * 1000,
                                     station.s * 1000));
    if (part.has("lumen_mm") && station.lumen >= station.radius)
      part.fault("lumen_mm", fmt::format("expected less than the outer radius of {} mm, got {}", station.radius * 1000,
                                         station.lumen * 1000));
    check_within(part, "s_mm", whole);
    if (part.has("s_mm")) last = station.s;
    s.stations.push_back(station);
  }
}

void landmarks(const JsonObject& o, Strand& s, double whole) {
  for (const JsonObject& part : o.objects("landmarks")) {
    const Landmark mark{part.text("name"), from_mm(part.number("from_mm")), from_mm(part.number("to_mm"))};
    if (part.has("from_mm") && part.has("to_mm") && !(mark.from < mark.to))
      part.fault("to_mm",
                 fmt::format("expected more than from_mm = {}, got {}", part.number("from_mm"), part.number("to_mm")));
    check_within(part, "to_mm", whole);
    for (const Landmark& other : s.landmarks)
      if (!mark.name.empty() && other.name == mark.name)
        part.fault("name", fmt::format("expected every landmark of a strand once, got \"{}\" again", mark.name));
    s.landmarks.push_back(mark);
  }
}

}  // namespace

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

StrandEnd Reading::strand_end(const JsonObject& strand, const char* key) {
  StrandEnd end;
  end.at = strand.at(key);
  for (const JsonObject& o : strand.objects(key)) {
    end.organ = o.text("solid");
    end.fixed = o.flag("fixed");
    refer(Reference::To::solid, o, "solid");
    if (end.fixed && o.has("solid")) o.fault("fixed", "expected either a solid or \"fixed\": true, got both");
  }
  return end;
}

void Reading::strand(const JsonObject& o) {
  Strand s;
  s.name = o.text("name");
  s.tissue = o.text("tissue");
  s.look = o.text("look", s.name);
  refer(Reference::To::tissue, o, "tissue");
  s.centreline = from_mm(o.points("centreline_mm"));
  for (std::size_t i = 1; i < s.centreline.size(); ++i)
    if (!(length(s.centreline[i] - s.centreline[i - 1]) >= 1e-5))
      o.fault(o.at("centreline_mm", i), "expected a point at least 0.01 mm from the one before, got the same place");
  s.start = strand_end(o, "start");
  s.end = strand_end(o, "end");
  s.spacing = from_mm(o.number("spacing_mm", 2.5));
  s.foundation = o.number("foundation_N_m2", s.foundation);
  s.foundation_limit = from_mm(o.number("foundation_limit_mm", 0));
  s.cuttable = o.flag("cuttable", s.cuttable);
  s.fimbriated = o.flag("fimbriated", s.fimbriated);
  s.at = o.at();
  s.spacing_at = o.at("spacing_mm");
  const double whole = curve_length(s.centreline);
  stations(o, s, whole);
  landmarks(o, s, whole);
  if (o.has("spacing_mm") && whole / s.spacing > kMaxStrandNodes)
    o.fault("spacing_mm", fmt::format("expected a spacing that gives at most {} nodes, got about {:.3g}",
                                      kMaxStrandNodes, whole / s.spacing));
  description.strands.push_back(std::move(s));
}

void Reading::sheet(const JsonObject& o) {
  Sheet s;
  s.name = o.text("name");
  s.look = o.text("look", s.name);
  s.strand = o.text("strand");
  refer(Reference::To::strand, o, "strand");
  s.from = from_mm(o.number("from_mm"));
  s.to = from_mm(o.number("to_mm"));
  if (o.has("from_mm") && o.has("to_mm") && !(s.from < s.to))
    o.fault("to_mm", fmt::format("expected more than from_mm = {}, got {}", o.number("from_mm"), o.number("to_mm")));
  s.base = from_mm(o.points("base_mm"));
  s.base_organ = o.text("base_organ");
  refer(Reference::To::solid_or_strand, o, "base_organ");
  s.at = o.at();
  m_sheet_ends.push_back({s.strand, s.to, o.at("to_mm")});
  description.sheets.push_back(std::move(s));
}

void Reading::membrane(const JsonObject& o) {
  Membrane m;
  m.name = o.text("name");
  m.tissue = o.text("tissue");
  refer(Reference::To::tissue, o, "tissue");
  m.look = o.text("look", m.name);
  m.strand = o.text("strand");
  refer(Reference::To::strand, o, "strand");
  m.from = from_mm(o.number("from_mm"));
  m.to = from_mm(o.number("to_mm"));
  if (o.has("from_mm") && o.has("to_mm") && !(m.from < m.to))
    o.fault("to_mm", fmt::format("expected more than from_mm = {}, got {}", o.number("from_mm"), o.number("to_mm")));
  m.base = from_mm(o.points("base_mm"));
  for (std::size_t i = 1; i < m.base.size(); ++i)
    if (!(length(m.base[i] - m.base[i - 1]) >= 1e-5))
      o.fault(o.at("base_mm", i), "expected a point at least 0.01 mm from the one before, got the same place");
  m.base_on = o.texts("base_on");
  for (std::size_t i = 0; i < m.base_on.size(); ++i)
    m_references.push_back({Reference::To::solid_or_strand, m.base_on[i], o.at("base_on", i)});
  if (o.has("base_reach_mm")) m.base_reach = from_mm(o.number("base_reach_mm"));
  m.thickness = from_mm(o.number("thickness_mm", 1));
  if (o.has("spacing_mm")) m.spacing = from_mm(o.number("spacing_mm"));
  m.cuttable = o.flag("cuttable", m.cuttable);
  m.at = o.at();
  m.spacing_at = o.at("spacing_mm");
  if ((m.to - m.from) / m.spacing > kMaxStrandNodes)
    o.fault("spacing_mm", fmt::format("expected a spacing that gives at most {} columns, got about {:.3g}",
                                      kMaxStrandNodes, (m.to - m.from) / m.spacing));
  m_sheet_ends.push_back({m.strand, m.to, o.at("to_mm")});
  description.membranes.push_back(std::move(m));
}

}  // namespace trocar::scene
