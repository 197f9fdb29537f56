#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/operations/beside.hpp>
#include <trocar/modeller/operations/values.hpp>

namespace trocar::modeller {
namespace {

bool says_the_same(const fs::path& file, std::string_view bytes) {
  try {
    return core::read_file(file, bytes.size()) == bytes;
  } catch (const core::BadInput&) {
    return false;  // longer, or no file at all
  }
}

}  // namespace

std::string put_beside(const Document& document, const std::string& stem, const std::string& extension,
                       std::string_view bytes) {
  std::error_code error;
  for (int i = 1;; ++i) {
    const std::string name = stem + (i == 1 ? "" : fmt::format("-{}", i)) + extension;
    const fs::path file = document.root().parent_path() / name;
    if (says_the_same(file, bytes)) return name;
    if (fs::exists(fs::symlink_status(file, error))) continue;
    core::put_file(file, bytes);
    return name;
  }
}

scene::JsonValue surface_beside(const Document& document, const std::string& name, const geometry::TriMesh& mesh,
                                Vec3d centre_mm) {
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  geometry::TriMesh about_middle = mesh;
  for (Vec3d& p : about_middle.positions) p = p - (box.low + box.high) / 2.0;
  scene::JsonValue surface = scene::json_object();
  const std::string file = put_beside(document, name, ".stl", geometry::to_stl(about_middle, 1e-3));
  scene::put(surface, "file", scene::json_text(file));
  scene::put(surface, "unit_mm", scene::json_number(1));
  scene::put(surface, "place_mm", point(centre_mm));
  return surface;
}

}  // namespace trocar::modeller
