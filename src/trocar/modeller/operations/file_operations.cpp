// Bodies from files that other programs made: triangles, tetrahedra, and parts of machines' drawings.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

constexpr double kCells = 700;  // of a body whose cells nobody has chosen

void write_beside(const fs::path& path, const std::string& bytes) {
  if (const std::string said = core::write_file(path, bytes.data(), bytes.size()); !said.empty())
    throw core::BadInput(
        {{{path.generic_string(), 0, 0}, tr("expected a file that can be written, got \"{}\"", said)}});
}

/// As a body. @throws core::BadInput with what keeps it open
geometry::TriMesh mended(const fs::path& path, const geometry::TriMesh& mesh) {
  geometry::MendedMesh out = geometry::mend(mesh);
  if (out.after.is_body() && !out.mesh.triangles.empty()) return std::move(out.mesh);
  std::string left;
  for (const std::string& words : out.left) left += (left.empty() ? "" : "; ") + words;
  throw core::BadInput({{{path.generic_string(), 0, 0},
                         tr("expected a surface that can be closed, got: {}",
                            left.empty() ? std::string(tr("one that encloses nothing")) : left)}});
}

/// A closed mesh [m] from a file of triangles; a part that is not there is told through `o`.
geometry::TriMesh closed_mesh(const JsonObject& o, const fs::path& path) {
  const geometry::SurfaceFile file = geometry::read_surface_file(path);
  geometry::TriMesh mesh;
  for (const geometry::SurfacePart& part : file.parts)
    if (!o.has("part") || part.name == o.text("part")) geometry::append(mesh, part.mesh);
  if (mesh.triangles.empty()) {
    o.fault(o.has("part") ? "part" : "file", "expected a file with this part, got none");
    return mesh;
  }
  const double unit = o.has("unit_mm") ? o.number("unit_mm") * 1e-3 : file.metres > 0 ? file.metres : 1e-3;
  for (Vec3d& p : mesh.positions) p = p * unit;
  return mended(path, mesh);
}

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

void put_surface(const JsonObject& o, Draft& draft, const geometry::TriMesh& mesh, JsonValue& solid) {
  const std::string name = o.text("name") + ".stl";
  const fs::path path = draft.document().root().parent_path() / name;
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const Vec3d middle = (box.low + box.high) / 2.0;  // the file's origin, so that it is scaled about its middle
  geometry::TriMesh about_middle = mesh;
  for (Vec3d& p : about_middle.positions) p = p - middle;
  write_beside(path, geometry::to_stl(about_middle, 1e-3));
  JsonValue surface = scene::json_object();
  scene::put(surface, "file", scene::json_text(name));
  scene::put(surface, "unit_mm", number(1));
  const Vec3d centre = o.has("centre_mm") ? o.vec3("centre_mm") : middle * 1e3 + o.vec3("place_mm");
  scene::put(surface, "place_mm", point(centre));
  scene::put(solid, "surface", surface);
  draft.say(tr("{:.2f} mL in {} triangles", 1e6 * geometry::volume(mesh), mesh.triangles.size()));
}

/// Control points are where the file has them: what moves a body moves it afterwards.
void put_nurbs(const JsonObject& o, Draft& draft, const CadPart& part, JsonValue& solid) {
  JsonValue nurbs = *part.nurbs;
  if (o.has("place_mm")) {
    const Vec3d by = o.vec3("place_mm");
    for (scene::JsonMember& key : nurbs.members)
      if (key.key == "net_mm")
        for (JsonValue& row : key.value.items)
          for (JsonValue& p : row.items) p = point(Vec3d{p.items[0].number, p.items[1].number, p.items[2].number} + by);
  }
  scene::put(solid, "nurbs", nurbs);
  draft.say("the file's own NURBS, exactly");
}

void put_tetrahedra(const JsonObject& o, Draft& draft, const fs::path& path, JsonValue& solid) {
  const std::string name = o.text("name") + path.extension().string();
  const fs::path copy = draft.document().root().parent_path() / name;
  std::error_code error;
  if (!fs::equivalent(path, copy, error)) write_beside(copy, core::read_file(path, std::size_t(1) << 30));
  JsonValue mesh = scene::json_object();
  scene::put(mesh, "file", scene::json_text(name));
  if (o.has("unit_mm")) scene::put(mesh, "unit_mm", number(o.number("unit_mm")));
  if (o.has("cell_mm")) scene::put(mesh, "refill_mm", number(o.number("cell_mm")));
  if (o.has("place_mm")) scene::put(mesh, "place_mm", point(o.vec3("place_mm")));
  scene::put(solid, "mesh", mesh);
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
  if (holds_tetrahedra(path)) {
    put_tetrahedra(o, draft, path, solid);
    return add_thing(draft, "solid", solid, "");
  }
  geometry::TriMesh mesh;
  if (is_cad_file(path)) {
    const std::vector<CadPart> parts = read_cad_file(path, o.number("within_mm", 0.05) * 1e-3);
    const CadPart* part = chosen_part(o, parts);
    if (!part) return;
    mesh = mended(path, part->mesh);
    if (o.text("as") == "nurbs" && !part->nurbs)
      return o.fault("as", tr("expected a part that is one closed NURBS, got one of {} faces: take it as a "
                              "surface, and fit_spline to that",
                              part->faces));
    if (part->nurbs && o.text("as") != "surface")
      put_nurbs(o, draft, *part, solid);
    else
      put_surface(o, draft, mesh, solid);
  } else {
    mesh = closed_mesh(o, path);
    if (mesh.triangles.empty()) return;
    if (o.text("as") == "nurbs")
      return o.fault("as", "expected a STEP or IGES file: to triangles one is fitted, by fit_spline");
    put_surface(o, draft, mesh, solid);
  }
  scene::put(solid, "cell_mm", number(cell_mm(o, mesh)));
  add_thing(draft, "solid", solid, "");
}

}  // namespace

std::vector<Operation> file_operations() {
  return {
      {{"from_file",
        "A solid from another program's file: triangles (OBJ, STL, PLY, glTF, VTK), whose holes are closed; "
        "tetrahedra (Gmsh .msh, VTK); STEP and IGES. A copy is saved next to the document.",
        {scene::needed(keys::text("file", "where it is, relative to the document")),
         scene::needed(keys::name("name", "what the body is called")),
         scene::needed(keys::name("tissue", "its material")),
         keys::text("part",
                    "of several in the file: its name, of STEP and IGES its number; default: all, or the only one"),
         keys::number("cell_mm", 0.1, 100, "edge of its cells; default: about 700 of them; of tetrahedra: its own"),
         keys::number("unit_mm", 1e-6, 1e6, "unit of its coordinates, default: what its format or size says"),
         keys::vec3("place_mm", -2000, 2000, "where the file's origin goes, default where it is"),
         keys::vec3("centre_mm", -2000, 2000, "where its middle goes instead; of surfaces"),
         keys::name("look", "its material; default: the one that is called as the body is"),
         keys::choice("as", {"surface", "nurbs"},
                      "of STEP and IGES: its triangles, or the one closed NURBS that it is; default: this where it is"),
         keys::number("within_mm", 0.001, 10, "of STEP and IGES: how far triangles may be from it, default 0.05")}},
       from_file}};
}

}  // namespace trocar::modeller
