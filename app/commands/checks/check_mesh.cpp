#include "commands/checks/check_mesh.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/import_preview.hpp>
#include <trocar/scene/compile/mesh_cost.hpp>

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

Json as_json(Vec3d p) { return {p.x, p.y, p.z}; }

Json as_json(const geometry::TetFacts& f) {
  Json out{{"nodes", f.nodes}, {"cells", f.cells}, {"volume_ml", f.volume * 1e6}};
  if (f.nodes > f.unused_nodes) out["box_m"] = {as_json(f.box.low), as_json(f.box.high)};
  out.update({{"smallest_cell_ml", f.smallest_volume * 1e6},
              {"largest_cell_ml", f.largest_volume * 1e6},
              {"smallest_dihedral_deg", f.smallest_dihedral},
              {"parts", f.parts},
              {"surface_triangles", f.surface_triangles},
              {"odd_edges", f.odd_edges},
              {"crowded_faces", f.crowded_faces},
              {"overlapping_faces", f.overlapping_faces},
              {"inverted", f.inverted},
              {"flat", f.flat},
              {"duplicate_cells", f.duplicate_cells},
              {"duplicate_nodes", f.duplicate_nodes},
              {"unused_nodes", f.unused_nodes}});
  return out;
}

/// What slivers would cost in a soft organ; empty where that is little.
std::string slivers(const geometry::TetMesh& mesh) {
  scene::Tissue liver;  // as scenes/tissues.json has it
  liver.young = 5400;
  liver.density = 1060;
  liver.p1 = 2;
  liver.p2 = 100;
  liver.strain_cap = 0.1;
  liver.damping_ms = 6;
  const scene::MeshCost now = scene::cost_of(mesh, liver);
  if (now.substeps < scene::kManySubsteps) return {};
  const std::optional<scene::Refill> refill = scene::refill_of(mesh, liver, now);
  return refill ? "as a liver " + scene::in_words(mesh, now, *refill) : std::string{};
}

/// In metres; the note of a guess is added. @throws core::BadInput where somebody must choose
double unit_of_mesh(const fs::path& path, std::optional<double> given, const geometry::Extent& extent, double said,
                    Json& notes) {
  if (given) return *given;
  const geometry::UnitChoice choice = geometry::choose_unit(extent, said, "--unit-mm");
  if (!choice.question.empty()) throw core::BadInput({{{path.generic_string(), 0, 0}, choice.question}});
  if (!choice.note.empty()) notes.push_back(choice.note);
  return choice.metres;
}

Json describe_tets(const fs::path& path, std::optional<double> given) {
  geometry::TetFile file =
      geometry::read_tets(core::read_file(path, geometry::kMaxMeshBytes), path.generic_string(), given.value_or(1));
  geometry::TetRepair repaired = geometry::repair(file.mesh);
  if (repaired.mesh.cells.empty())
    throw core::BadInput({{{path.generic_string(), 0, 0}, "expected cells with a volume, got flat ones only"}});
  Json notes = file.notes;
  if (!given) {
    const geometry::Extent extent{geometry::bounds(repaired.mesh.points), geometry::inspect(repaired.mesh).volume};
    const double unit = unit_of_mesh(path, given, extent, file.metres, notes);
    for (Vec3d& p : file.mesh.points) p = p * unit;
    repaired = geometry::repair(file.mesh);
  }
  const geometry::TetFacts mended = geometry::inspect(repaired.mesh);
  Json out{{"file", path.string()}, {"kind", "tetrahedra"}, {"format", file.format}, {"notes", notes}};
  out["mesh"] = as_json(geometry::inspect(file.mesh));
  out["repairs"] = Json::array();
  for (const geometry::Mended& m : repaired.mended) out["repairs"].push_back(geometry::in_words(m));
  out["left_as_is"] = geometry::left_as_is(repaired.mesh);
  if (!repaired.mended.empty()) out["repaired"] = as_json(mended);
  if (const std::string costs = slivers(repaired.mesh); !costs.empty()) out["left_as_is"].push_back(costs);
  out["verdict"] = out["repairs"].empty() && out["left_as_is"].empty() ? "good" : "to mend";
  return out;
}

Json describe_surface(const fs::path& path, std::optional<double> given) {
  const modeller::ImportPreview read = modeller::preview_of(path);
  const bool drawing = read.kind == modeller::ImportPreview::Kind::drawing;
  Json notes = read.notes;
  const double unit = unit_of_mesh(path, given, read.extent(), read.metres, notes);
  Json out{{"file", path.string()}, {"kind", drawing ? "drawing" : "surface"},
           {"format", read.format}, {"unit_mm", 1e3 * unit},
           {"notes", notes},        {"surface_parts", Json::array()}};
  for (const modeller::ImportPreview::Part& part : read.parts)
    out["surface_parts"].push_back({{"name", part.name},
                                    {"triangles", part.triangles},
                                    {"size_mm", as_json((part.box.high - part.box.low) * (1e3 * unit))},
                                    {"volume_ml", part.volume * 1e6 * unit * unit * unit},
                                    {"closed", part.closed}});
  out["verdict"] = read.closed ? "good" : "to mend";
  return out;
}

constexpr std::size_t kMostParts = 50, kShownParts = 3;  // all are listed up to so many; of more these

void print_parts(const Json& m) {
  fmt::print("{}", tr("  {}, 1 unit is {:g} mm\n", m["format"].get<std::string>(), m["unit_mm"].get<double>()));
  const Json& parts = m["surface_parts"];
  std::vector<const Json*> shown;
  for (const Json& part : parts) shown.push_back(&part);
  if (shown.size() > kMostParts) {  // the largest only
    std::stable_sort(shown.begin(), shown.end(),
                     [](const Json* a, const Json* b) { return (*a)["triangles"] > (*b)["triangles"]; });
    shown.resize(kShownParts);
  }
  for (const Json* one : shown) {
    const Json& part = *one;
    const Json& size = part["size_mm"];
    const double volume = part["volume_ml"];
    fmt::print("{}", tr("  part \"{}\": {} triangles, {:.4g} x {:.4g} x {:.4g} mm, {}\n",
                        core::printable(part["name"].get<std::string>()), part["triangles"].get<int>(),
                        size[0].get<double>(), size[1].get<double>(), size[2].get<double>(),
                        part["closed"].get<bool>() ? tr("{:.4g} ml, closed", volume)
                        : volume > 0               ? tr("about {:.4g} ml, with holes", volume)
                                                   : std::string(tr("an open sheet: it encloses nothing"))));
  }
  if (shown.size() < parts.size()) fmt::print("{}", tr("  and {} more parts\n", parts.size() - shown.size()));
  for (const Json& note : m["notes"]) fmt::print("  {}\n", note.get<std::string>());
}

}  // namespace

bool is_mesh_file(const fs::path& path) {
  const std::string extension = core::in_small_letters(path.extension().string());
  static constexpr const char* kMeshes[] = {".msh", ".vtk",  ".vtp",  ".vtu", ".obj",  ".stl", ".ply",
                                            ".glb", ".gltf", ".step", ".stp", ".iges", ".igs"};
  return std::find(std::begin(kMeshes), std::end(kMeshes), extension) != std::end(kMeshes);
}

Json describe_mesh(const fs::path& path, std::optional<double> unit) {
  return modeller::is_tet_file(path) ? describe_tets(path, unit) : describe_surface(path, unit);
}

void print_mesh(const Json& m) {
  if (m.contains("surface_parts")) return print_parts(m);
  const auto facts = [](const char* what, const Json& f) {
    fmt::print(
        "{}", tr("  {}: {} nodes, {} tetrahedra, {:.4g} ml (cells {:.3g} to {:.3g} ml), smallest dihedral angle {:.3g} "
                 "degrees,\n    {} triangles on the surface, parts: {}\n",
                 what, f["nodes"].get<int>(), f["cells"].get<int>(), f["volume_ml"].get<double>(),
                 f["smallest_cell_ml"].get<double>(), f["largest_cell_ml"].get<double>(),
                 f["smallest_dihedral_deg"].get<double>(), f["surface_triangles"].get<int>(), f["parts"].get<int>()));
  };
  facts(m["format"].get<std::string>().c_str(), m["mesh"]);
  for (const Json& note : m["notes"]) fmt::print("  {}\n", note.get<std::string>());
  for (const Json& repair : m["repairs"]) fmt::print("{}", tr("  to mend: {}\n", repair.get<std::string>()));
  for (const Json& left : m["left_as_is"]) fmt::print("{}", tr("  not mended: {}\n", left.get<std::string>()));
  if (m.contains("repaired")) facts("mended", m["repaired"]);
}

}  // namespace trocar::app
