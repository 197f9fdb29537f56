// Closed surfaces from files of triangles.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

/// What the words of several things say, one after the other.
template <class Things, class Words>
std::string one_by_one(const Things& things, Words&& words) {
  std::string all;
  for (const auto& thing : things) all += (all.empty() ? "" : "; ") + std::string(words(thing));
  return all;
}

std::string faults_of(const geometry::Diagnosis& d) {
  return one_by_one(geometry::findings(d), [](const geometry::Finding& f) { return f.words; });
}

/// The parts that are asked for, as one; nothing, and a fault, where there is no such part.
std::optional<geometry::TriMesh> parts_of(const JsonObject& o, const geometry::SurfaceFile& file,
                                          const std::string& name) {
  if (name.empty()) return geometry::merged_equal(geometry::joined(file));
  std::vector<std::string> known;
  for (const geometry::SurfacePart& part : file.parts) {
    if (part.name == name) return geometry::merged_equal(part.mesh);
    known.push_back(part.name);
  }
  o.fault("part", unknown_name("part of the file", name, known));
  return {};
}

/// What to do about a file of several parts that are no body together.
std::string parts_to_choose(const geometry::SurfaceFile& file, const std::string& chosen) {
  constexpr std::size_t kShown = 6;
  if (!chosen.empty() || file.parts.size() < 2) return {};
  std::string words = " (\"part\" takes one of:";
  for (std::size_t i = 0; i < std::min(kShown, file.parts.size()); ++i)
    words += (i == 0 ? " " : ", ") + core::printable(file.parts[i].name);
  return words + (file.parts.size() > kShown ? tr(", and {} more)", file.parts.size() - kShown) : ")");
}

/// Closed and outwards, mended where it may be; false, and a fault, where it cannot be.
bool become_closed(const JsonObject& o, const std::string& parts, SurfaceSource& source) {
  const geometry::Diagnosis before = geometry::examine(source.mesh);
  if (before.is_body() && before.encloses()) return true;
  if (!source.mend) {
    o.fault("file", tr("expected a closed surface, as mending is off, got: {}{}", faults_of(before), parts));
    return false;
  }
  geometry::MendedMesh mended = geometry::mend(source.mesh);
  if (!mended.after.is_body() || mended.mesh.triangles.empty() || !mended.after.encloses()) {
    std::string left = one_by_one(mended.left, [](const std::string& words) { return words; });
    if (left.empty()) left = faults_of(mended.after);
    if (left.empty()) left = tr("one that encloses nothing");
    o.fault("file", tr("expected a surface that can be mended to a closed one, got: {}{}", left, parts));
    return false;
  }
  for (const geometry::Change& c : mended.changes) source.warnings.push_back(tr("it has defects; mended: {}", c.words));
  source.mesh = std::move(mended.mesh);
  return true;
}

/// Does it fit into the abdomen, and enclose something?
bool is_sensible(const JsonObject& o, const SurfaceSource& source) {
  const geometry::Bounds box = geometry::bounds(source.mesh.positions);
  for (int k = 0; k < 3; ++k)
    if (!(box.low[k] >= -kFar / 1000) || !(box.high[k] <= kFar / 1000)) {
      o.fault("file", tr("expected coordinates within {} mm, got some from {:.4g} to {:.4g} mm (\"unit_mm\" is "
                         "{:g})",
                         kFar, 1000 * box.low[k], 1000 * box.high[k], 1000 * source.unit));
      return false;
    }
  if (source.mesh.triangles.size() > std::size_t(kMaxTriangles)) {
    o.fault("file", tr("expected at most {} triangles, got {}", kMaxTriangles, source.mesh.triangles.size()));
    return false;
  }
  return true;
}

}  // namespace

bool is_organ_sized(const JsonObject& o, const geometry::Extent& extent, double unit, bool file_says,
                    std::vector<std::string>& warnings) {
  const geometry::UnitChoice choice = geometry::choose_unit(geometry::in_unit(extent, unit), unit, "\"unit_mm\"");
  if (choice.question.empty()) return true;
  if (file_says)
    warnings.push_back(choice.question);
  else
    o.fault("file", choice.question);
  return file_says;
}

std::string Reading::bytes_beside(const fs::path& folder, const std::string& name) {
  const auto refuse = [&](std::string message) { throw core::BadInput({{{name, 1, 1}, std::move(message)}}); };
  const fs::path named(name);
  if (named.empty() || named.is_absolute()) refuse("expected the name of a file beside the one that names it");
  if (m_library && !m_library->holds(folder / named)) refuse(m_library->refusal(name));
  if (++m_files > kMaxFiles) refuse(tr("expected at most {} files, got more", kMaxFiles));
  const fs::path path = (folder / named).lexically_normal();
  if (!m_memory) return core::read_file(path, geometry::kMaxMeshBytes);
  const auto found = m_memory->find(path);
  if (found == m_memory->end()) refuse("expected the name of a file, got none of this name");
  return found->second;
}

std::optional<SurfaceSource> Reading::surface_of(const JsonObject& o, SurfaceSource source, const fs::path& folder) {
  const std::optional<std::string> bytes = bytes_of(o, folder);
  if (!bytes) return {};
  const fs::path path = place_of(folder, source.file);
  std::string parts;
  double metres = 0;
  bool file_says = false;
  try {
    const geometry::SurfaceFile file = geometry::read_surfaces(
        *bytes, path.generic_string(),
        [this, &path](const std::string& name) { return bytes_beside(path.parent_path(), name); });
    std::optional<geometry::TriMesh> mesh = parts_of(o, file, source.part);
    if (!mesh) return {};
    source.mesh = std::move(*mesh);
    parts = parts_to_choose(file, source.part);
    if (file.axes != geometry::PatientAxes::none) source.warnings.push_back(geometry::turned_in_words(file.axes));
    file_says = file.metres > 0;
    metres = source.unit > 0 ? source.unit : file_says ? file.metres : 1e-3;
    for (Vec3d& p : source.mesh.positions) p = metres * p + source.place;
  } catch (const core::BadInput& e) {
    for (const core::Fault& f : e.faults()) tell(m_faults, f);
    return {};
  }
  if (!is_sensible(o, source) || !become_closed(o, parts, source)) return {};
  const geometry::Extent extent = geometry::extent_of(source.mesh);
  if (!(source.unit > 0) && !is_organ_sized(o, extent, metres, file_says, source.warnings)) return {};
  return source;
}

}  // namespace trocar::scene
