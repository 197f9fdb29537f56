#include <algorithm>

#include <trocar/core/files.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/modeller/operations/import_preview.hpp>

namespace trocar::modeller {
namespace {

constexpr double kWithin = 5e-4;  // [m] of drawings: their size is looked at only

void take_part(ImportPreview& out, std::string name, const geometry::TriMesh& mesh) {
  const geometry::TriMesh merged = geometry::merged_equal(mesh);
  const geometry::Diagnosis found = geometry::examine(merged);
  const double volume = found.encloses() ? std::fabs(found.volume) : 0;
  out.parts.push_back({std::move(name), geometry::bounds(merged.positions), volume, merged.triangles.size(),
                       found.is_body() && found.encloses()});
  out.volume += volume;
  out.triangles += merged.triangles.size();
  out.closed = out.closed && out.parts.back().closed;
}

void read_surface_preview(const fs::path& file, ImportPreview& out) {
  const geometry::SurfaceFile read = geometry::read_surface_file(file);
  out.format = read.format;
  out.metres = read.metres;
  out.notes = read.notes;
  for (const geometry::SurfacePart& part : read.parts) take_part(out, part.name, part.mesh);
}

void read_drawing_preview(const fs::path& file, ImportPreview& out) {
  out.kind = ImportPreview::Kind::drawing;
  out.format = "STEP or IGES";
  int number = 0;
  for (const CadPart& part : read_cad_file(file, kWithin)) {
    geometry::TriMesh mesh = part.mesh;
    for (Vec3d& p : mesh.positions) p = p / part.unit;
    out.metres = part.unit;
    take_part(out, std::to_string(++number), mesh);
  }
}

void read_tet_preview(const fs::path& file, ImportPreview& out) {
  out.kind = ImportPreview::Kind::tetrahedra;
  const geometry::TetFile read =
      geometry::read_tets(core::read_file(file, geometry::kMaxMeshBytes), file.generic_string(), 1);
  out.format = read.format;
  out.notes = read.notes;
  out.metres = read.metres;
  take_part(out, file.stem().string(), geometry::surface_of(geometry::repair(read.mesh).mesh).mesh);
}

}  // namespace

std::vector<double> ImportPreview::units() const {
  std::vector<double> all{1e-3, 1e-2, 1};
  if (metres > 0 &&
      std::none_of(all.begin(), all.end(), [this](double unit) { return std::fabs(unit / metres - 1) < 1e-9; }))
    all.insert(all.begin(), metres);
  return all;
}

geometry::Extent ImportPreview::extent() const {
  geometry::Extent all{box, 0};
  for (const Part& part : parts) all.volume = std::max(all.volume, part.volume);
  return all;
}

ImportPreview preview_of(const fs::path& file) {
  ImportPreview out;
  if (is_cad_file(file))
    read_drawing_preview(file, out);
  else if (is_tet_file(file))
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
  out.guess = geometry::choose_unit(out.extent(), out.metres, "").metres;
  return out;
}

}  // namespace trocar::modeller
