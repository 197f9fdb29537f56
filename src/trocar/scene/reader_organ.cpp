// Organ files: solids and walls, other organs that are part of them. Strands and what hangs on them: reader_strand.cpp.
#include <cmath>

#include <fmt/format.h>

#include <trocar/scene/reader_parts.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxSolidNodes = 60'000;  // ten of today's organs: a tick of more is far from real time

double area(const Section& s) {
  // of a super-ellipse: pi a b at exponent 2, towards 4 a b for a square (1 % good between)
  return (4 - 1.717 / s.squareness) * length(cross(s.across, s.deep));
}

Section section(const JsonObject& o) {
  Section s;
  s.centre = from_mm(o.vec3("centre_mm"));
  s.across = from_mm(o.vec3("across_mm"));
  s.deep = from_mm(o.vec3("deep_mm"));
  s.squareness = o.number("squareness", s.squareness);
  const double a = length(s.across), b = length(s.deep);
  for (const char* key : {"across_mm", "deep_mm"})
    if (o.has(key) && !(length(from_mm(o.vec3(key))) >= 1e-5))
      o.fault(key, "expected a half axis of at least 0.01 mm, got none");
  if (a > 0 && b > 0 && !(length(cross(s.across, s.deep)) >= 0.5 * a * b))
    o.fault("deep_mm", "expected half axes at least 30 degrees apart, got nearly parallel ones");
  return s;
}

/// Bounds what compile would have to make of it, before it tries.
void check_size(const JsonObject& o, const Solid& s) {
  double volume = 0, skin = 0;
  for (std::size_t i = 0; i + 1 < s.sections.size(); ++i) {
    const Section &a = s.sections[i], &b = s.sections[i + 1];
    const double height = length(b.centre - a.centre), top = area(a), bottom = area(b);
    volume += height / 3 * (top + bottom + std::sqrt(top * bottom));
    skin += height * 3 * (length(a.across) + length(a.deep) + length(b.across) + length(b.deep)) / 2;
  }
  const double nodes = 1.3 * volume / (s.cell * s.cell * s.cell);
  if (o.has("cell_mm") && nodes > kMaxSolidNodes)
    o.fault("cell_mm", fmt::format("expected a cell that fills the body with at most {} nodes, got about {:.3g}",
                                   kMaxSolidNodes, nodes));
  for (const auto& [key, edge] : {std::pair{"skin_edge_mm", s.skin_edge}, std::pair{"fine_edge_mm", s.fine_edge}})
    if (o.has(key) && 2.3 * skin / (edge * edge) > kMaxTriangles)
      o.fault(key, fmt::format("expected an edge that gives at most {} triangles, got about {:.3g}", kMaxTriangles,
                               2.3 * skin / (edge * edge)));
}

}  // namespace

void Reading::organs(const JsonObject& o, const fs::path& folder) {
  includes(o, "organs", folder, organ_shape(), &Reading::organ, &Reading::organ);
}

void Reading::organ(const JsonObject& o, const fs::path& folder) {
  organs(o, folder);
  for (const JsonObject& s : o.objects("solids")) solid(s);
  for (const JsonObject& s : o.objects("strands")) strand(s);
  for (const JsonObject& w : o.objects("walls")) wall(w);
  for (const JsonObject& s : o.objects("sheets")) sheet(s);
  for (const JsonObject& m : o.objects("membranes")) membrane(m);
}

void Reading::solid(const JsonObject& o) {
  Solid s;
  s.name = o.text("name");
  s.tissue = o.text("tissue");
  s.look = o.text("look", s.name);
  refer(Reference::To::tissue, o, "tissue");
  for (const JsonObject& part : o.objects("sections")) {
    s.sections.push_back(section(part));
    const std::size_t n = s.sections.size();
    if (n > 1 && part.has("centre_mm") && !(length(s.sections[n - 1].centre - s.sections[n - 2].centre) >= 1e-5))
      part.fault("centre_mm", "expected a centre at least 0.01 mm from the section before, got the same place");
  }
  s.cell = from_mm(o.number("cell_mm", 5));
  s.skin_edge = o.has("skin_edge_mm") ? from_mm(o.number("skin_edge_mm")) : s.cell;
  s.fine_edge = o.has("fine_edge_mm") ? from_mm(o.number("fine_edge_mm")) : s.skin_edge / 2;
  for (const JsonObject& a : o.objects("anchors"))
    s.anchors.push_back(
        {from_mm(a.vec3("centre_mm")), from_mm(a.number("radius_mm", 1)), a.number("stiffness_N_m"), a.at()});
  s.at = o.at();
  s.cell_at = o.at("cell_mm");
  check_size(o, s);
  description.solids.push_back(std::move(s));
}

void Reading::wall(const JsonObject& o) {
  Wall w;
  w.name = o.text("name");
  w.look = o.text("look", w.name);
  PointGrid grid = o.grid("net_mm");
  w.rows = int(grid.rows);
  w.columns = int(grid.columns);
  w.net = from_mm(std::move(grid.points));
  w.edge = from_mm(o.number("edge_mm", 4));
  w.at = o.at();
  double surface = 0;
  for (std::size_t r = 0; r + 1 < grid.rows; ++r)
    for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
      const Vec3d* p = w.net.data() + r * grid.columns + c;
      surface += length(cross(p[grid.columns + 1] - p[0], p[grid.columns] - p[1])) / 2;
    }
  if (o.has("edge_mm") && 2.3 * surface / (w.edge * w.edge) > kMaxTriangles)
    o.fault("edge_mm", fmt::format("expected an edge that gives at most {} triangles, got about {:.3g}", kMaxTriangles,
                                   2.3 * surface / (w.edge * w.edge)));
  description.walls.push_back(std::move(w));
}

}  // namespace trocar::scene
