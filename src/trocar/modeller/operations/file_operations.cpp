// Bodies from files that other programs made: triangles, tetrahedra, and parts of machines' drawings.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/modeller/operations/beside.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/file_mesh.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

constexpr double kMostPlace = 2000;  // [mm] of a body in a scene
constexpr double kCells = 700;       // of a body whose cells nobody has chosen

/// The part of a drawing that is meant; none: told through `o`.
const CadPart* chosen_part(const JsonObject& o, const std::vector<CadPart>& parts) {
  std::string list;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (o.has("part") ? o.text("part") == std::to_string(i + 1) : parts.size() == 1) return &parts[i];
    list += fmt::format("{}{}, {}", i ? "; " : "", i + 1,
                        parts[i].nurbs ? "one closed NURBS" : fmt::format("{} faces", parts[i].faces));
  }
  o.fault("part", tr("expected the number of one of the file's parts: {}", list));
  return nullptr;
}

/// The drawing's part in the unit that its numbers are in: as the file says, or as the step does.
struct DrawnPart {
  geometry::TriMesh mesh;  ///< [m]
  double scale = 1;        ///< of what the file says
  std::vector<std::string> notes;
};
std::optional<DrawnPart> drawn_part(const JsonObject& o, const fs::path& path, const CadPart& part) {
  DrawnPart out;
  out.mesh = mended(path, part.mesh, out.notes);
  const geometry::Extent extent = geometry::in_unit(geometry::extent_of(out.mesh), part.unit);
  const std::optional<double> unit = chosen_unit(o, extent, part.unit, out.notes);
  if (!unit) return std::nullopt;
  out.scale = *unit / part.unit;
  for (Vec3d& p : out.mesh.positions) p = p * out.scale;
  return out;
}

/// False: a fault, told through `o`, of a key that can set it right.
bool is_near(const JsonObject& o, Vec3d centre) {
  const double most = std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z)});
  if (most <= kMostPlace) return true;
  o.fault("file", tr("expected a body within {:g} mm of the origin, got its middle at ({:.6g}, {:.6g}, {:.6g}): "
                     "\"centre_mm\" sets its middle, for instance [0, 0, 0]",
                     kMostPlace, centre.x, centre.y, centre.z));
  return false;
}

/// False: a fault, told through `o`.
bool put_surface(const JsonObject& o, Draft& draft, const geometry::TriMesh& mesh, JsonValue& solid) {
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const Vec3d middle = (box.low + box.high) / 2.0;
  const Vec3d centre = o.has("centre_mm") ? o.vec3("centre_mm") : middle * 1e3 + o.vec3("place_mm");
  if (!is_near(o, centre)) return false;
  scene::put(solid, "surface", surface_beside(draft.document(), o.text("name"), mesh, centre));
  draft.say(tr("{:.2f} mL in {} triangles", 1e6 * geometry::volume(mesh), mesh.triangles.size()));
  return true;
}

/// Control points are where the file has them: what moves a body moves it afterwards.
void put_nurbs(const JsonObject& o, Draft& draft, const CadPart& part, double scale, JsonValue& solid) {
  JsonValue nurbs = *part.nurbs;
  const Vec3d by = o.vec3("place_mm");
  if (o.has("place_mm") || scale != 1)
    for (scene::JsonMember& key : nurbs.members)
      if (key.key == "net_mm")
        for (JsonValue& row : key.value.items)
          for (JsonValue& p : row.items)
            p = point(scale * Vec3d{p.items[0].number, p.items[1].number, p.items[2].number} + by);
  scene::put(solid, "nurbs", nurbs);
  draft.say("the file's own NURBS, exactly");
}

/// False: a fault, told through `o`.
bool put_tetrahedra(const JsonObject& o, Draft& draft, const fs::path& path, const std::string& bytes,
                    JsonValue& solid) {
  const geometry::TetFile file = geometry::read_tets(bytes, path.generic_string());
  const geometry::TetMesh mesh = geometry::repair(file.mesh).mesh;
  if (mesh.cells.empty())
    throw core::BadInput({{{path.generic_string(), 0, 0}, "expected cells with a volume, got flat ones only"}});
  std::vector<std::string> notes = file.notes;
  const geometry::Extent extent{geometry::bounds(mesh.points), geometry::inspect(mesh).volume};
  const std::optional<double> unit = chosen_unit(o, extent, file.metres, notes);
  if (!unit) return false;
  JsonValue source = scene::json_object();
  const std::string name = put_beside(draft.document(), o.text("name"), path.extension().string(), bytes);
  scene::put(source, "file", scene::json_text(name));
  scene::put(source, "unit_mm", scene::json_number(*unit * 1e3));
  if (o.has("cell_mm")) scene::put(source, "refill_mm", number(o.number("cell_mm")));
  if (o.has("place_mm")) scene::put(source, "place_mm", point(o.vec3("place_mm")));
  scene::put(solid, "mesh", source);
  draft.say(tr("{:.2f} mL in {} tetrahedra", 1e6 * extent.volume * *unit * *unit * *unit, mesh.cells.size()));
  draft.say(notes);
  return true;
}

double cell_mm(const JsonObject& o, const geometry::TriMesh& mesh) {
  if (o.has("cell_mm")) return o.number("cell_mm");
  return std::max(0.1, std::round(1e4 * std::cbrt(std::fabs(geometry::volume(mesh)) / kCells)) / 10);
}

void from_file(const JsonObject& o, Draft& draft) {
  const fs::path path = whole_path(draft.document().root().parent_path() / o.text("file"));
  JsonValue solid = scene::json_object();
  scene::put(solid, "name", scene::json_text(o.text("name")));
  scene::put(solid, "tissue", scene::json_text(o.text("tissue")));
  if (o.has("look")) scene::put(solid, "look", scene::json_text(o.text("look")));
  Draft trial(draft.document());  // refuses a name that is taken before anything is written
  add_thing(trial, "solid", solid, "");
  if (is_tet_file(path)) {
    const std::string bytes = core::read_file(path, geometry::kMaxMeshBytes);
    if (put_tetrahedra(o, draft, path, bytes, solid)) add_thing(draft, "solid", solid, "");
    return;
  }
  geometry::TriMesh mesh;
  if (is_cad_file(path)) {
    const std::optional<double> unit = o.has("unit_mm") ? std::optional(o.number("unit_mm") * 1e-3) : std::nullopt;
    const std::vector<CadPart> parts = read_cad_file(path, o.number("within_mm", 0.05) * 1e-3, unit);
    const CadPart* part = chosen_part(o, parts);
    if (!part) return;
    std::optional<DrawnPart> there = drawn_part(o, path, *part);
    if (!there) return;
    if (o.text("as") == "nurbs" && !part->nurbs)
      return o.fault("as", tr("expected a part that is one closed NURBS, got one of {} faces: take it as a "
                              "surface, and fit_spline to that",
                              part->faces));
    mesh = std::move(there->mesh);
    if (part->nurbs && o.text("as") != "surface")
      put_nurbs(o, draft, *part, there->scale, solid);
    else if (!put_surface(o, draft, mesh, solid))
      return;
    draft.say(there->notes);
  } else {
    std::optional<FileMesh> there = mesh_from_file(o, path);
    if (!there) return;
    if (o.text("as") == "nurbs")
      return o.fault("as", "expected a STEP or IGES file: to triangles one is fitted, by fit_spline");
    mesh = std::move(there->mesh);
    if (!put_surface(o, draft, mesh, solid)) return;
    draft.say(there->notes);
  }
  scene::put(solid, "cell_mm", number(cell_mm(o, mesh)));
  add_thing(draft, "solid", solid, "");
}

}  // namespace

std::vector<Operation> file_operations() {
  return {
      {{"from_file",
        "A solid from another program's file: triangles (OBJ, STL, PLY, glTF, VTK), whose holes are closed; "
        "tetrahedra (Gmsh .msh, VTK); STEP and IGES. A copy is saved next to the document; `trocar check FILE` lists "
        "the "
        "file's parts.",
        {scene::needed(keys::text("file", "where it is, relative to the document")),
         scene::needed(keys::name("name", "what the body is called")),
         scene::needed(keys::name("tissue", "its material")),
         keys::text("part",
                    "of several in the file: its name, of STEP and IGES its number; default: all, or the only one"),
         keys::number("cell_mm", 0.1, 100, "edge of its cells; default: about 700 of them; of tetrahedra: its own"),
         keys::number("unit_mm", 1e-6, 1e6,
                      "unit of its coordinates, default: what its format says or its size suggests"),
         keys::vec3("place_mm", -2000, 2000, "where the file's origin goes, default where it is"),
         keys::vec3("centre_mm", -2000, 2000, "where its middle goes instead; of surfaces"),
         keys::name("look", "its material; default: the one that is called as the body is"),
         keys::choice("as", {"surface", "nurbs"},
                      "of STEP and IGES: its triangles, or the one closed NURBS that it is; default: this where it is"),
         keys::number("within_mm", 0.001, 10, "of STEP and IGES: how far triangles may be from it, default 0.05")}},
       from_file}};
}

}  // namespace trocar::modeller
