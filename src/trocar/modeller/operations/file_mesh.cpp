#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/modeller/operations/file_mesh.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonObject;

constexpr const char* kUnitKey = "unit_mm";

void scale_mesh(geometry::TriMesh& mesh, double by) {
  for (Vec3d& p : mesh.positions) p = p * by;
}

}  // namespace

geometry::TriMesh mended(const fs::path& path, const geometry::TriMesh& mesh, std::vector<std::string>& notes) {
  geometry::MendedMesh out = geometry::mend(mesh);
  if (out.after.is_body() && !out.mesh.triangles.empty() && out.after.encloses()) {
    for (const geometry::Change& change : out.changes) notes.push_back(tr("mended: {}", change.words));
    const auto pieces = std::count_if(out.after.shells.list.begin(), out.after.shells.list.end(),
                                      [](const geometry::Shell& shell) { return !shell.is_cavity; });
    if (pieces > 1)
      notes.push_back(
          tr("{} separate pieces are taken as one body; \"part\" takes one of the file's parts, if it has several",
             pieces));
    return std::move(out.mesh);
  }
  std::string left = geometry::joined_notes(out.left);
  if (!notes.empty()) left += tr(" (of the file: {})", geometry::joined_notes(notes));
  throw core::BadInput(
      {{{path.generic_string(), 0, 0},
        tr("expected a surface that can be closed, got: {}; close or thicken it in the program that made it",
           left.empty() ? std::string(tr("one that encloses nothing")) : left)}});
}

geometry::TriMesh chosen_parts(const JsonObject& o, const geometry::SurfaceFile& file) {
  geometry::TriMesh mesh;
  std::vector<std::string> known;
  for (const geometry::SurfacePart& part : file.parts) {
    if (!o.has("part") || part.name == o.text("part")) geometry::append(mesh, part.mesh);
    known.push_back(part.name);
  }
  if (mesh.triangles.empty()) o.fault("part", scene::unknown_name("part of the file", o.text("part"), known));
  return mesh;
}

std::optional<double> chosen_unit(const JsonObject& o, const geometry::Extent& extent, double said,
                                  std::vector<std::string>& notes) {
  if (o.has(kUnitKey)) {
    const double metres = o.number(kUnitKey) * 1e-3;
    if (!geometry::is_organs_volume(extent, metres)) notes.push_back(tr("organs hold 0.1 mL to 20 L"));
    return metres;
  }
  const geometry::UnitChoice choice = geometry::choose_unit(extent, said, "\"unit_mm\"");
  if (!choice.question.empty()) {
    o.fault(kUnitKey, choice.question);
    return std::nullopt;
  }
  if (!choice.note.empty()) notes.push_back(choice.note);
  return choice.metres;
}

std::optional<FileMesh> mesh_from_file(const JsonObject& o, const fs::path& path) {
  const geometry::SurfaceFile file = geometry::read_surface_file(path);
  FileMesh out{chosen_parts(o, file), file.notes};
  if (out.mesh.triangles.empty()) return std::nullopt;
  const geometry::Extent open{geometry::bounds(out.mesh.positions), 0};  // its volume is known once it is closed
  const double about =
      o.has(kUnitKey) ? o.number(kUnitKey) * 1e-3 : geometry::choose_unit(open, file.metres, "").metres;
  scale_mesh(out.mesh, about);
  out.mesh = mended(path, out.mesh, out.notes);
  const geometry::Extent extent = geometry::in_unit(geometry::extent_of(out.mesh), about);
  const std::optional<double> unit = chosen_unit(o, extent, file.metres, out.notes);
  if (!unit) return std::nullopt;
  if (*unit != about) scale_mesh(out.mesh, *unit / about);
  return out;
}

}  // namespace trocar::modeller
