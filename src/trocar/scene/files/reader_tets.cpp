// Solids from files of meshes and volumes.
#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/geometry/voxel_files/nrrd.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

/// The mesh's surface filled again: what was said of its cells is said of none that are left. Throws
/// std::invalid_argument where the surface is open, or finer than the cubes.
void refill(TetSource& source) {
  constexpr double kKept = 0.95;  // of its volume; what is thinner than a cube and a half is lost
  const double before = geometry::volume(source.mesh);
  geometry::TetMesh filled = geometry::stuffed(geometry::surface_of(source.mesh).mesh, source.refill,
                                               {.most_cells = kMaxSolidCells, .largest_part = true});
  const double after = geometry::volume(filled);
  source.warnings.clear();
  if (after < kKept * before || after > before / kKept)
    source.warnings.push_back(tr("filled with new cells it has {:.3g} of {:.3g} ml: a smaller \"refill_mm\" keeps more",
                                 1e6 * after, 1e6 * before));
  source.mesh = std::move(filled);
}

void take(const JsonObject& o, TetSource source, Solid& s) {
  if (source.mesh.cells.empty()) return o.fault("file", "expected cells with a volume, got flat ones only");
  if (source.mesh.points.size() > std::size_t(kMaxSolidNodes) || source.mesh.cells.size() > std::size_t(kMaxSolidCells))
    return o.fault("file", tr("expected at most {} nodes and {} cells, got {} and {}", kMaxSolidNodes, kMaxSolidCells,
                              source.mesh.points.size(), source.mesh.cells.size()));
  for (Vec3d& p : source.mesh.points) p += source.place;
  s.tets = std::move(source);
}

}  // namespace

std::optional<std::string> Reading::bytes_of(const JsonObject& o, const fs::path& folder, const char* key) {
  const fs::path named(o.text(key));
  if (!o.has(key)) return {};
  if (named.empty() || named.is_absolute()) {
    o.fault(key, tr("expected a file name relative to this file, got \"{}\"", named.generic_string()));
    return {};
  }
  const fs::path path = place_of(folder, named);
  if (m_library && !m_library->holds(path)) {
    o.fault(key, m_library->refusal(named.generic_string()));
    return {};
  }
  return bytes_at(o, path, key);
}

std::optional<std::string> Reading::bytes_at(const JsonObject& o, const fs::path& path, const char* key) {
  if (++m_files > kMaxFiles) {
    o.fault(key, tr("expected at most {} files, got more", kMaxFiles));
    return {};
  }
  if (const std::string* bytes = m_memory ? m_memory->text_of(path) : nullptr) return *bytes;
  if (!MemoryFiles::disk_too(m_memory)) {
    o.fault(key, tr("expected the name of a file, got \"{}\"", o.text(key)));
    return {};
  }
  try {
    return core::read_file(path, geometry::kMaxMeshBytes);
  } catch (const core::BadInput& e) {
    o.fault(key, e.faults().front().message + " (" + path.generic_string() + ")");
    return {};
  }
}

void Reading::mesh_of(const JsonObject& o, TetSource source, const fs::path& folder, Solid& s) {
  const std::optional<std::string> bytes = bytes_of(o, folder);
  if (!bytes) return;
  try {
    const std::string shown = place_of(folder, source.file).generic_string();
    const geometry::TetFile file = geometry::read_tets(*bytes, shown, source.unit);
    geometry::TetRepair repaired = geometry::repair(file.mesh);
    const geometry::Extent extent{geometry::bounds(repaired.mesh.points), geometry::volume(repaired.mesh)};
    if (!o.has("unit_mm") && !is_organ_sized(o, extent, source.unit, file.metres > 0, source.warnings)) return;
    if (file.metres > 0) source.warnings.push_back(geometry::turned_in_words(file.axes));
    for (const geometry::Mended& m : repaired.mended)
      source.warnings.push_back(tr("it has defects; mended: {}", geometry::in_words(m)));
    for (const std::string& left : geometry::left_as_is(repaired.mesh))
      source.warnings.push_back(tr("it has defects; not mended: {}", left));
    source.mesh = std::move(repaired.mesh);
    if (source.refill > 0) refill(source);
  } catch (const core::BadInput& e) {
    for (const core::Fault& f : e.faults()) tell(m_faults, f);
    return;
  } catch (const std::invalid_argument& e) {
    return o.fault("refill_mm", tr("expected cubes that fill the mesh's surface, got: {}", e.what()));
  }
  take(o, std::move(source), s);
}

void Reading::voxels_of(const JsonObject& o, TetSource source, const fs::path& folder, Solid& s) {
  const std::optional<std::string> bytes = bytes_of(o, folder);
  if (!bytes) return;
  try {
    const std::string shown = place_of(folder, source.file).generic_string();
    const geometry::NrrdVolume volume = geometry::read_nrrd(*bytes, shown);
    source.warnings = volume.notes;
    const geometry::Voxels voxels = geometry::voxels_of(volume, shown);
    source.mesh = geometry::stuffed(geometry::field_of_label(voxels, source.label, source.smoothing), s.cell,
                                    {.most_cells = kMaxSolidCells, .largest_part = true});
  } catch (const core::BadInput& e) {
    for (const core::Fault& f : e.faults()) tell(m_faults, f);
    return;
  } catch (const std::invalid_argument& e) {
    return o.fault("label", tr("expected a label that can be filled with tetrahedra, got: {}", e.what()));
  }
  take(o, std::move(source), s);
}

}  // namespace trocar::scene
