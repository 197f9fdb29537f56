#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/drive/readiness.hpp>
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
                 tr("expected a surface of the segment's {:.2f} mL, got {:.2f}", made.ml_of_label, made.ml));
  return made;
}

/// A ball in the middle of a mesh [m] that is moved [mm].
JsonValue attachment(const geometry::TriMesh& mesh, Vec3d by_mm, double cell_mm) {
  const scene::Anchor hold = hold_in_middle(mesh, 1e-3 * cell_mm);
  JsonValue ball = scene::json_object();
  scene::put(ball, "centre_mm", point(hold.centre * 1e3 + by_mm));
  scene::put(ball, "radius_mm", number(hold.radius * 1e3));
  return ball;
}

}  // namespace

SegmentOrgan make_organ(Document& document, const Scan& scan, const OrganWish& wish) {
  if (const auto counts = volumes::voxels_per_label(scan.labels()); counts[scan.segment_there(wish.segment)] == 0)
    refuse_organ(scan.path(), tr("The segment \"{}\" is empty. Paint, threshold or grow it first.", wish.segment));
  const volumes::LabelSurface made = surface_of_segment(scan, wish);
  const geometry::Bounds box = geometry::bounds(made.mesh.positions);
  const SegmentOrgan out{made.ml_of_label, made.ml, made.mesh.triangles.size(), (box.low + box.high) / 2.0 * 1e3,
                         (box.high - box.low) * 1e3};
  JsonValue surface = scene::json_object(), solid = scene::json_object();
  const std::string file = wish.name + ".stl";
  scene::put(surface, "file", scene::json_text(file));
  scene::put(surface, "unit_mm", number(1));
  const Vec3d centre = wish.centre_mm ? *wish.centre_mm : wish.place_mm ? wish.place_mm(out.size_mm) : out.middle_mm;
  scene::put(surface, "place_mm", point(centre));
  const double cell = wish.cell_mm > 0 ? wish.cell_mm : std::round(10 * std::cbrt(made.ml * 1e3 / 700)) / 10;
  scene::put(solid, "name", scene::json_text(wish.name));
  scene::put(solid, "tissue", scene::json_text(wish.tissue));
  if (!wish.look.empty()) scene::put(solid, "look", scene::json_text(wish.look));
  scene::put(solid, "surface", surface);
  scene::put(solid, "cell_mm", number(cell));
  if (wish.attach)
    scene::put(solid, "anchors", scene::json_array({attachment(made.mesh, centre - out.middle_mm, cell)}));
  if (wish.cuttable) scene::put(solid, "cuttable", scene::json_flag(true));
  Draft draft(document);
  add_thing(draft, "solid", solid, "");  // refuses a name that is taken before anything is written
  const fs::path path = document.root().parent_path() / file;
  geometry::TriMesh about_middle = made.mesh;  // so that it is scaled about its middle
  for (Vec3d& p : about_middle.positions) p = p - out.middle_mm * 1e-3;
  const std::string bytes = geometry::to_stl(about_middle, 1e-3);
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  if (const std::string said = core::write_file(path, bytes.data(), bytes.size()); !said.empty())
    refuse_organ(path, tr("expected a file that can be written, got \"{}\"", said));
  document.change("organ from " + wish.segment, draft.texts());
  return out;
}

}  // namespace trocar::modeller
