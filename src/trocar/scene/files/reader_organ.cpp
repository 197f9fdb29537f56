// Organ files: solids and walls, other organs that are part of them. Strands and what hangs on them: reader_strand.cpp.
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/geometry/formats/nrrd.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxSolidNodes = 60'000;  // ten of today's organs: a tick of more is far from real time

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

constexpr int kMaxSolidCells = 100'000;

void take(const JsonObject& o, TetSource source, Solid& s) {
  if (source.mesh.cells.empty()) return o.fault("file", "expected cells with a volume, got flat ones only");
  if (source.mesh.points.size() > std::size_t(kMaxSolidNodes) || source.mesh.cells.size() > std::size_t(kMaxSolidCells))
    return o.fault("file", fmt::format("expected at most {} nodes and {} cells, got {} and {}", kMaxSolidNodes,
                                       kMaxSolidCells, source.mesh.points.size(), source.mesh.cells.size()));
  for (Vec3d& p : source.mesh.points) p += source.place;
  s.tets = std::move(source);
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

/// One shape, and what belongs to it.
void check_shape(const JsonObject& o, const Solid& s) {
  int shapes = 0;
  for (const char* key : {"sections", "mesh", "voxels"}) {
    shapes += o.names(key);
    if (o.names(key) && shapes == 2) o.fault(key, "expected one shape, got a second one");
  }
  if (shapes == 0) o.fault(o.at(), "expected a shape (sections, mesh or voxels), got none");
  if (!o.names("mesh") && !o.names("cell_mm")) o.fault(o.at(), "expected \"cell_mm\", got none");
  if (o.names("mesh") && o.names("cell_mm"))
    o.fault("cell_mm", "expected no cell_mm beside a mesh, whose cells are as they are, got one");
  const bool lattice = o.names("sections") && !s.cuttable;
  for (const char* key : {"fibre", "fibre_ratio"})
    if (o.names(key) && lattice)
      o.fault(key, "expected fibres in tetrahedra only (mesh, voxels or cuttable), got some in a lattice");
  if (o.names("fibre") && !(length(s.fibre) > 1e-6)) o.fault("fibre", "expected a direction, got none");
  for (const char* key : {"skin_edge_mm", "fine_edge_mm"})
    if (o.names(key) && !lattice)
      o.fault(key, "expected skin edges for a lattice only, got one for tetrahedra, whose faces are the skin");
}

}  // namespace

std::optional<std::string> Reading::bytes_of(const JsonObject& o, const fs::path& folder) {
  const fs::path named(o.text("file"));
  if (!o.has("file")) return {};
  if (named.empty() || named.is_absolute()) {
    o.fault("file", fmt::format("expected a file name relative to this file, got \"{}\"", named.generic_string()));
    return {};
  }
  if (m_library && !m_library->holds(folder / named)) {
    o.fault("file", m_library->refusal(named.generic_string()));
    return {};
  }
  if (++m_files > kMaxFiles) {
    o.fault("file", fmt::format("expected at most {} files, got more", kMaxFiles));
    return {};
  }
  const fs::path path = (folder / named).lexically_normal();
  if (m_memory) {
    const auto found = m_memory->find(path);
    if (found != m_memory->end()) return found->second;
    o.fault("file", fmt::format("expected the name of a file, got \"{}\"", named.generic_string()));
    return {};
  }
  try {
    return core::read_file(path, geometry::kMaxMeshBytes);
  } catch (const core::BadInput& e) {
    o.fault("file", e.faults().front().message + " (" + path.generic_string() + ")");
    return {};
  }
}

void Reading::mesh_of(const JsonObject& o, const fs::path& folder, Solid& s) {
  TetSource source;
  source.file = o.text("file");
  source.unit = from_mm(o.number("unit_mm", 1));
  source.place = from_mm(o.vec3("place_mm"));
  const std::optional<std::string> bytes = bytes_of(o, folder);
  if (!bytes) return;
  try {
    const std::string shown = (folder / source.file).lexically_normal().generic_string();
    source.mesh = geometry::repair(geometry::read_tets(*bytes, shown, source.unit).mesh).mesh;
  } catch (const core::BadInput& e) {
    for (const core::Fault& f : e.faults()) tell(m_faults, f);
    return;
  }
  take(o, std::move(source), s);
}

void Reading::voxels_of(const JsonObject& o, const fs::path& folder, Solid& s) {
  TetSource source;
  source.file = o.text("file");
  source.label = o.integer("label", 1);
  source.smoothing = o.integer("smoothing", source.smoothing);
  source.place = from_mm(o.vec3("place_mm"));
  const std::optional<std::string> bytes = bytes_of(o, folder);
  if (!bytes) return;
  try {
    const std::string shown = (folder / source.file).lexically_normal().generic_string();
    const geometry::Voxels voxels = geometry::read_nrrd(*bytes, shown);
    source.mesh = geometry::stuffed(geometry::field_of_label(voxels, source.label, source.smoothing), s.cell,
                                    {.most_cells = kMaxSolidCells, .largest_part = true});
  } catch (const core::BadInput& e) {
    for (const core::Fault& f : e.faults()) tell(m_faults, f);
    return;
  } catch (const std::invalid_argument& e) {
    return o.fault("label", fmt::format("expected a label that can be filled with tetrahedra, got: {}", e.what()));
  }
  take(o, std::move(source), s);
}

void Reading::organs(const JsonObject& o, const fs::path& folder) {
  includes(o, "organs", folder, organ_shape(), &Reading::organ, &Reading::organ);
}

void Reading::organ(const JsonObject& o, const fs::path& folder) {
  organs(o, folder);
  for (const JsonObject& s : o.objects("solids")) solid(s, folder);
  for (const JsonObject& s : o.objects("strands")) strand(s);
  for (const JsonObject& w : o.objects("walls")) wall(w);
  for (const JsonObject& s : o.objects("sheets")) sheet(s);
  for (const JsonObject& m : o.objects("membranes")) membrane(m);
  for (const JsonObject& p : o.objects("pouches")) pouch(p);
}

std::vector<Section> Reading::sections(const JsonObject& o) {
  std::vector<Section> all;
  for (const JsonObject& part : o.objects("sections")) {
    all.push_back(section(part));
    const std::size_t n = all.size();
    if (n > 1 && part.has("centre_mm") && !(length(all[n - 1].centre - all[n - 2].centre) >= 1e-5))
      part.fault("centre_mm", "expected a centre at least 0.01 mm from the section before, got the same place");
  }
  return all;
}

void Reading::solid(const JsonObject& o, const fs::path& folder) {
  Solid s;
  s.name = o.text("name");
  s.tissue = o.text("tissue");
  s.look = o.text("look", s.name);
  refer(Reference::To::tissue, o, "tissue");
  s.sections = sections(o);
  s.cell = o.has("mesh") ? 0 : from_mm(o.number("cell_mm", 5));
  s.cuttable = o.flag("cuttable", s.cuttable);
  s.fibre = o.vec3("fibre");
  s.fibre_ratio = o.number("fibre_ratio", s.fibre_ratio);
  check_shape(o, s);
  for (const JsonObject& mesh : o.objects("mesh")) mesh_of(mesh, folder, s);
  for (const JsonObject& voxels : o.objects("voxels")) voxels_of(voxels, folder, s);
  s.skin_edge = o.has("skin_edge_mm") ? from_mm(o.number("skin_edge_mm")) : s.cell;
  s.fine_edge = o.has("fine_edge_mm") ? from_mm(o.number("fine_edge_mm")) : s.skin_edge / 2;
  for (const JsonObject& a : o.objects("anchors"))
    s.anchors.push_back(
        {from_mm(a.vec3("centre_mm")), from_mm(a.number("radius_mm", 1)), a.number("stiffness_N_m"), a.at()});
  s.at = o.at();
  s.cell_at = o.at("cell_mm");
  if (!s.tets) check_size(o, s);
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
