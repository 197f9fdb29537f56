#include <algorithm>

#include <trocar/core/files.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/import_preview.hpp>

namespace trocar::modeller {
namespace {

constexpr double kDrawingUnit = 1e-3;  // STEP and IGES are read in millimetres

void take_part(ImportPreview& out, std::string name, const geometry::TriMesh& mesh) {
  out.parts.push_back({std::move(name), geometry::bounds(mesh.positions), std::fabs(geometry::volume(mesh))});
  out.volume += out.parts.back().volume;
  out.triangles += mesh.triangles.size();
}

void read_surface_preview(const fs::path& file, ImportPreview& out) {
  const geometry::SurfaceFile read = geometry::read_surface_file(file);
  out.metres = read.metres;
  out.notes = read.notes;
  for (const geometry::SurfacePart& part : read.parts) {
    const geometry::TriMesh mesh = geometry::merged_equal(part.mesh);
    take_part(out, part.name, mesh);
    out.closed = out.closed && geometry::examine(mesh).is_body();
  }
}

void read_drawing_preview(const fs::path& file, ImportPreview& out) {
  out.kind = ImportPreview::Kind::drawing;
  out.metres = kDrawingUnit;
  int number = 0;
  for (const CadPart& part : read_cad_file(file, 5e-4)) {
    geometry::TriMesh mesh = part.mesh;
    for (Vec3d& p : mesh.positions) p = p / kDrawingUnit;
    take_part(out, std::to_string(++number), mesh);
  }
}

void read_tet_preview(const fs::path& file, ImportPreview& out) {
  out.kind = ImportPreview::Kind::tetrahedra;
  const geometry::TetFile read =
      geometry::read_tets(core::read_file(file, geometry::kMaxMeshBytes), file.generic_string(), 1);
  take_part(out, file.stem().string(), geometry::surface_of(geometry::repair(read.mesh).mesh).mesh);
}

}  // namespace

ImportPreview preview_of(const fs::path& file) {
  ImportPreview out;
  if (is_cad_file(file))
    read_drawing_preview(file, out);
  else if (holds_tetrahedra(file))
    read_tet_preview(file, out);
  else
    read_surface_preview(file, out);
  out.box = out.parts.front().box;
  for (const ImportPreview::Part& part : out.parts) {
    const geometry::Bounds& b = part.box;
    out.box.low = {std::min(out.box.low.x, b.low.x), std::min(out.box.low.y, b.low.y),
                   std::min(out.box.low.z, b.low.z)};
    out.box.high = {std::max(out.box.high.x, b.high.x), std::max(out.box.high.y, b.high.y),
                    std::max(out.box.high.z, b.high.z)};
  }
  const geometry::UnitGuess guess = geometry::guess_unit(out.box);
  out.guess = out.metres > 0 ? out.metres : guess.metres > 0 ? guess.metres : 1e-3;
  return out;
}

}  // namespace trocar::modeller
