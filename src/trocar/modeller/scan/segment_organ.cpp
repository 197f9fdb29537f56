#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>
#include <trocar/volumes/organ/label_surface.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

[[noreturn]] void refuse_organ(const fs::path& file, std::string message) {
  throw core::BadInput({{{file.generic_string(), 0, 0}, std::move(message)}});
}

volumes::LabelSurface surface_of_segment(const Scan& scan, const OrganWish& wish) {
  volumes::SurfaceOptions options;
  options.most_triangles = wish.most_triangles;
  volumes::LabelSurface made = volumes::label_surface(scan.labels(), scan.segment_there(wish.segment), options);
  if (!made.is_body)
    refuse_organ(scan.path(),
                 "expected a segment whose surface is a closed body, got one that is not: smooth it, or keep "
                 "its largest part");
  if (std::fabs(made.ml / made.ml_of_label - 1) > wish.within)
    refuse_organ(scan.path(),
                 fmt::format("expected a surface of the segment's {:.2f} mL, got {:.2f}", made.ml_of_label, made.ml));
  return made;
}

}  // namespace

SegmentOrgan make_organ(Document& document, const Scan& scan, const OrganWish& wish) {
  const volumes::LabelSurface made = surface_of_segment(scan, wish);
  const geometry::Bounds box = geometry::bounds(made.mesh.positions);
  const SegmentOrgan out{made.ml_of_label, made.ml, made.mesh.triangles.size(), (box.low + box.high) / 2.0 * 1e3,
                         (box.high - box.low) * 1e3};
  JsonValue surface = scene::json_object(), solid = scene::json_object();
  const std::string file = wish.name + ".stl";
  scene::put(surface, "file", scene::json_text(file));
  scene::put(surface, "unit_mm", number(1));
  if (wish.centre_mm) scene::put(surface, "place_mm", point(*wish.centre_mm - out.middle_mm));
  const double cell = wish.cell_mm > 0 ? wish.cell_mm : std::round(10 * std::cbrt(made.ml * 1e3 / 700)) / 10;
  scene::put(solid, "name", scene::json_text(wish.name));
  scene::put(solid, "tissue", scene::json_text(wish.tissue));
  if (!wish.look.empty()) scene::put(solid, "look", scene::json_text(wish.look));
  scene::put(solid, "surface", surface);
  scene::put(solid, "cell_mm", number(cell));
  if (wish.cuttable) scene::put(solid, "cuttable", scene::json_flag(true));
  Draft draft(document);
  add_thing(draft, "solid", solid, "");  // refuses a name that is taken before anything is written
  const fs::path path = document.root().parent_path() / file;
  const std::string bytes = geometry::to_stl(made.mesh, 1e-3);
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  if (const std::string said = core::write_file(path, bytes.data(), bytes.size()); !said.empty())
    refuse_organ(path, fmt::format("expected a file that can be written, got \"{}\"", said));
  document.change("organ from " + wish.segment, draft.texts());
  return out;
}

}  // namespace trocar::modeller
